"""Covariances of a network's columns: against the information, numpy, and repeated networks."""

from dataclasses import replace

import numpy as np

from courtside.calibration.bundle import inverses, selection, solver
from fixtures.cameras import networks_made


def test_covariance_of_columns_is_the_inverse_of_the_information():
    made = networks_made.make(3, 10)
    known = replace(made, xyz_mean=made.xyz.copy(), xyz_sigma=np.full(10, 0.01))
    normal = solver.normal_equations(known)
    covariance = normal.covariance()
    assert not covariance[~normal.active].any() and not covariance[:, ~normal.active].any()
    part = covariance[np.ix_(normal.active, normal.active)]
    scale = np.outer(*[np.sqrt(np.diag(part))] * 2)  # the numbers' units differ by many orders
    product = (normal.information * scale) @ (part / scale)
    np.testing.assert_allclose(product, np.eye(len(part)), atol=1e-6)


def free_network(noise_px=0.0):
    """Return three images of 30 points with known lenses: only frame and scale are free."""
    made = networks_made.make(1, 30, noise_px=noise_px)
    return replace(made, lens_mean=made.lens.copy(), lens_sigma=np.zeros_like(made.lens))


def gauge(network):
    """Return the steps (K, 7) of all images that move, rotate or scale the world: pixels stay."""
    free = np.zeros((network.n_columns, 7))
    for v, pose in enumerate(network.cam_from_world):
        rotation, shift = pose[:, :3], pose[:, 3]
        turn, move = 11 * v + np.arange(3), 11 * v + np.arange(3, 6)
        for axis in range(3):
            # The world moved by e: R (x - e) + t. Turned by w: R exp(-w) x + t = exp(-R w) R x + t,
            # while a turn of a camera turns its t too.
            free[move, axis] = -rotation[:, axis]
            free[turn, 3 + axis] = -rotation[:, axis]
            free[move, 3 + axis] = np.cross(rotation[:, axis], shift)
        free[move, 6] = shift
    return free


def without(span, matrix):
    """Return a covariance with some directions projected out."""
    basis = np.linalg.qr(span)[0]
    rest = np.eye(len(matrix)) - basis @ basis.T
    return rest @ matrix @ rest


def test_the_pseudo_inverse_is_that_of_numpy_in_units_of_the_information():
    information = np.array(selection.marginalise(free_network(), [0, 1, 2]).information)
    active = np.diag(information) > 0
    scale = np.diag(information)[active] ** -0.5
    part = information[np.ix_(active, active)] * np.outer(scale, scale)
    expected = np.linalg.pinv(part, rcond=1e-9, hermitian=True) * np.outer(scale, scale)
    found = inverses.pseudo_inverse(information)
    assert not found[~active].any() and not found[:, ~active].any()
    np.testing.assert_allclose(
        found[np.ix_(active, active)] / np.outer(scale, scale),
        expected / np.outer(scale, scale),
        atol=1e-6 * np.abs(expected / np.outer(scale, scale)).max(),
    )


def test_the_pseudo_inverse_is_the_spread_of_repeated_networks_up_to_their_frame():
    """Against images adjusted to drawn pixels: frame and scale projected out of both."""
    true = free_network()
    information = selection.marginalise(true, [0, 1, 2]).information
    active = np.diag(information) > 0
    span = gauge(true)[active]
    assert np.abs(information[np.ix_(active, active)] @ span).max() < 1e-5 * information.max()
    rng, n_draws, steps = np.random.default_rng(0), 250, []
    for _ in range(n_draws):
        drawn = replace(true, xy=true.xy + 0.1 * rng.normal(size=true.xy.shape))
        found, _ = solver.adjust(drawn, tolerance=1e-10)
        steps.append(found.difference(true)[active] / 0.1)
    scale = np.sqrt(np.diag(information))[active]  # of the steps, so that all count alike
    span = span * scale[:, None]
    predicted = inverses.pseudo_inverse(information)[np.ix_(active, active)]
    predicted = without(span, predicted * np.outer(scale, scale))
    drawn = without(span, np.cov((np.array(steps) * scale).T))
    extent, axes = np.linalg.eigh(predicted)
    known = extent > 1e-8 * extent[-1]
    assert known.sum() == 18 - 7
    white = axes[:, known] / np.sqrt(extent[known])
    # An entry scatters by 1 / sqrt(n_draws), on the diagonal by sqrt(2 / n_draws).
    np.testing.assert_allclose(white.T @ drawn @ white, np.eye(11), atol=4 * np.sqrt(2 / n_draws))


def test_the_pseudo_inverse_says_nothing_of_frame_and_scale():
    information = selection.marginalise(free_network(), [0, 1, 2]).information
    active = np.diag(information) > 0
    scale = np.sqrt(np.diag(information))[active]
    span = gauge(free_network())[active] * scale[:, None]
    found = inverses.pseudo_inverse(information)[np.ix_(active, active)] * np.outer(scale, scale)
    assert np.abs(found @ span).max() < 1e-4 * np.abs(found).max() * np.abs(span).max()
