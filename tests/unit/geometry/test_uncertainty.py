"""Covariance of triangulated points: against displaced cameras and against draws."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize

import networks_made
from courtside.geometry import alignment, bundle, control_points, uncertainty
from scene import opencv_projection

XYZ = np.array([[3.0, 6.7, 1.0], [0.5, 2.0, 0.0], [5.0, 12.0, 2.5]])
SMALL = np.array([1e-4] * 3 + [1e-3] * 3 + [0.0] * 5)  # of an image's columns
SMALL_LENS = np.array([0.5, 2e-4, 0.5, 0.5, 1e-3, 1e-3, 1e-4, 1e-4])


def pair():
    return control_points.alone(networks_made.make(3, 10), [0, 1])


def moved_cameras(network, step):
    return networks_made.fixed_cameras(network.moved(step, np.zeros((0, 3))))


def triangulated(cameras, clicks):
    """Return the points of least squared pixel errors, by SciPy and OpenCV."""

    def error(xyz):
        seen = [opencv_projection(c, xyz.reshape(-1, 3)) - clicks[c.name] for c in cameras]
        return np.concatenate(seen, axis=None)

    found = optimize.least_squares(error, XYZ.ravel(), method="lm", xtol=1e-12, ftol=1e-12)
    return found.x.reshape(-1, 3)


def seen_by(network):
    return {c.name: opencv_projection(c, XYZ) for c in networks_made.fixed_cameras(network)}


def test_sensitivity_is_that_of_displaced_cameras():
    network = pair()
    clicks = seen_by(network)
    by_column = uncertainty.sensitivity(network, XYZ)
    sizes = np.concatenate([SMALL, SMALL, SMALL_LENS, SMALL_LENS])
    for column in np.flatnonzero(sizes):
        step = np.zeros(len(sizes))
        step[column] = sizes[column]
        ahead, behind = (triangulated(moved_cameras(network, s * step), clicks) for s in (1, -1))
        change = (ahead - behind) / 2
        expected = by_column[:, :, column] * sizes[column]
        np.testing.assert_allclose(change, expected, atol=2e-3 * np.abs(expected).max() + 1e-9)


def test_covariance_is_that_of_drawn_cameras():
    network, rng = pair(), np.random.default_rng(0)
    clicks = seen_by(network)
    sizes = np.concatenate([SMALL, SMALL, SMALL_LENS, SMALL_LENS])
    root = rng.normal(size=(38, 38)) / np.sqrt(38) * sizes[:, None]  # correlated
    drawn = np.array(
        [
            alignment.reconstruct(moved_cameras(network, root @ rng.normal(size=38)), clicks)
            for _ in range(600)
        ]
    )
    predicted = uncertainty.point_covariance(network, root @ root.T, XYZ)
    for n in range(len(XYZ)):
        found = np.cov(drawn[:, n].T)
        whitening = np.linalg.inv(np.linalg.cholesky(predicted[n]))
        # of 600 draws: an entry scatters by 1 / sqrt(600), on the diagonal by sqrt(2 / 600)
        np.testing.assert_allclose(whitening @ found @ whitening.T, np.eye(3), atol=0.24)


def test_certain_cameras_give_certain_points():
    network = pair()
    assert not uncertainty.point_covariance(network, np.zeros((38, 38)), XYZ).any()


def test_a_frame_that_moves_moves_the_points():
    """All cameras shifted along x together: the points follow, and nothing else."""
    network = pair()
    step = np.zeros(38)
    for v in (0, 1):
        step[11 * v + 3 : 11 * v + 6] = -network.cam_from_world[v, :, 0]
    shift = uncertainty.sensitivity(network, XYZ) @ step
    np.testing.assert_allclose(shift, np.tile([1.0, 0, 0], (3, 1)), atol=1e-9)


def test_covariance_of_columns_is_the_inverse_of_the_information():
    made = networks_made.make(3, 10)
    known = replace(made, xyz_mean=made.xyz.copy(), xyz_sigma=np.full(10, 0.01))
    normal = bundle.normal_equations(known)
    covariance = uncertainty.of_columns(normal)
    assert not covariance[~normal.active].any() and not covariance[:, ~normal.active].any()
    part = covariance[np.ix_(normal.active, normal.active)]
    scale = np.outer(*[np.sqrt(np.diag(part))] * 2)  # the numbers' units differ by many orders
    product = (normal.information * scale) @ (part / scale)
    np.testing.assert_allclose(product, np.eye(len(part)), atol=1e-6)


def test_mahalanobis_counts_sigmas():
    covariance = np.stack([np.diag([1.0, 4, 9]), np.array([[2.0, 1, 0], [1, 2, 0], [0, 0, 1]])])
    found = uncertainty.mahalanobis(np.array([[1.0, 2, 3], [1, 1, 0]]), covariance)
    assert found == pytest.approx([3.0, 2 / 3])
