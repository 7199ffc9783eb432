"""Covariance of triangulated points: against displaced cameras and against draws."""

from dataclasses import replace

import numpy as np
from scipy import optimize

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion, selection
from courtside.calibration.court import sfm_alignment
from fixtures.cameras import networks_made, scene
from fixtures.cameras.scene import opencv_projection

XYZ = np.array([[3.0, 6.7, 1.0], [0.5, 2.0, 0.0], [5.0, 12.0, 2.5]])
SMALL = np.array([1e-4] * 3 + [1e-3] * 3 + [0.0] * 5)  # of an image's columns
SMALL_LENS = np.array([0.5, 2e-4, 0.5, 0.5, 1e-3, 1e-3, 1e-4, 1e-4])


def pair():
    return selection.images_only(networks_made.make(3, 10), [0, 1])


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
    by_column = point_covariance.sensitivity(network, XYZ)
    sizes = np.concatenate([SMALL, SMALL, SMALL_LENS, SMALL_LENS])
    for column in np.flatnonzero(sizes):
        step = np.zeros(len(sizes))
        step[column] = sizes[column]
        ahead, behind = (triangulated(moved_cameras(network, s * step), clicks) for s in (1, -1))
        change = (ahead - behind) / 2
        expected = by_column[:, :, column] * sizes[column]
        np.testing.assert_allclose(change, expected, atol=2e-3 * np.abs(expected).max() + 1e-9)


def test_a_camera_before_which_a_place_does_not_lie_takes_no_part():
    """Behind one of three cameras, or not seen by it, a place is that of the other two."""
    network = selection.images_only(networks_made.make(3, 10), [0, 1, 2])
    turned = network.cam_from_world.copy()
    turned[2] = np.diag([-1.0, 1, -1]) @ turned[2]  # it looks the other way
    whole = np.ones((len(XYZ), 3), dtype=bool)
    hidden = whole & [True, True, False]
    away = replace(network, cam_from_world=turned)
    expected = point_covariance.sensitivity(pair(), XYZ)
    columns = [*range(22), *range(33, 49)]  # of the first two images and lenses
    for found in (
        point_covariance.sensitivity(away, XYZ),
        point_covariance.sensitivity(network, XYZ, hidden),
    ):
        np.testing.assert_allclose(found[:, :, columns], expected, rtol=1e-9, atol=1e-12)
        others = np.setdiff1d(np.arange(found.shape[2]), columns)
        assert not found[:, :, others].any()
    assert point_covariance.sensitivity(network, XYZ, whole)[:, :, others].any()
    alone = point_covariance.sensitivity(network, XYZ, whole & [True, False, False])
    assert np.isnan(alone).all()


def test_places_in_parts_and_no_place_at_all(monkeypatch):
    network = pair()
    covariance = np.diag(np.concatenate([SMALL, SMALL, SMALL_LENS, SMALL_LENS]) ** 2)
    whole = point_covariance.point_covariance(network, covariance, XYZ)
    monkeypatch.setattr(point_covariance, "PLACES", 1)
    in_parts = point_covariance.point_covariance(network, covariance, XYZ)
    np.testing.assert_array_equal(in_parts, whole)
    nothing = np.zeros((0, 3))
    assert point_covariance.point_covariance(network, covariance, nothing).shape == (0, 3, 3)
    assert point_covariance.field(network, covariance)(nothing).shape[:2] == (0, 3)


def test_covariance_is_that_of_drawn_cameras():
    network, rng = pair(), np.random.default_rng(0)
    clicks = seen_by(network)
    sizes = np.concatenate([SMALL, SMALL, SMALL_LENS, SMALL_LENS])
    root = rng.normal(size=(38, 38)) / np.sqrt(38) * sizes[:, None]  # correlated
    drawn = np.array(
        [
            sfm_alignment.reconstruct(moved_cameras(network, root @ rng.normal(size=38)), clicks)
            for _ in range(600)
        ]
    )
    predicted = point_covariance.point_covariance(network, root @ root.T, XYZ)
    for n in range(len(XYZ)):
        found = np.cov(drawn[:, n].T)
        whitening = np.linalg.inv(np.linalg.cholesky(predicted[n]))
        # of 600 draws: an entry scatters by 1 / sqrt(600), on the diagonal by sqrt(2 / 600)
        np.testing.assert_allclose(whitening @ found @ whitening.T, np.eye(3), atol=0.24)


def test_the_field_of_errors_correlates_places_as_the_cameras_do():
    network, rng = pair(), np.random.default_rng(1)
    sizes = np.concatenate([SMALL, SMALL, SMALL_LENS, SMALL_LENS])
    root = rng.normal(size=(38, 38)) / np.sqrt(38) * sizes[:, None]
    covariance = root @ root.T
    found = point_covariance.field(network, covariance)(XYZ)
    by_column = point_covariance.sensitivity(network, XYZ)
    for one, other in ((0, 0), (0, 1), (1, 0)):
        expected = by_column[one] @ covariance @ by_column[other].T
        np.testing.assert_allclose(
            found[one] @ found[other].T, expected, atol=1e-9 + 1e-6 * expected.max()
        )


def test_places_outside_of_a_picture_are_placed_by_the_other_cameras():
    cameras = scene.ring(3)
    places = np.array([[0.3, 0.2, 1.0], [-0.5, 0.1, 0.2]])
    narrow = replace(cameras[2], size=np.array([8, 8]))  # it shows none of the places
    assert point_covariance.shown(cameras, places).all()
    assert not point_covariance.shown([narrow], places).any()
    network = conversion.network_of(cameras)
    covariance = np.diag(np.full(network.n_columns, 1e-6))
    found = point_covariance.field(network, covariance, [*cameras[:2], narrow])(places)
    seen = np.tile([True, True, False], (len(places), 1))
    expected = point_covariance.point_covariance(network, covariance, places, seen)
    np.testing.assert_allclose(found @ found.swapaxes(1, 2), expected, rtol=1e-6)
    alone = point_covariance.views([cameras[0], narrow, narrow], places)  # of one picture only
    assert alone.all()


def test_a_place_between_two_cameras_that_face_each_other_is_the_least_certain():
    """On the line between them its depth is open; beside it, errors fall with the angle."""
    middle = np.array([3.0, 6.7, 2.0])
    poses = [scene.look_at([side, 6.7, 2.0], middle) for side in (-17, 23)]
    facing = [replace(scene.ring(1)[0], cam_from_world=pose) for pose in poses]
    network = conversion.network_of(facing)
    small = np.diag(np.full(network.n_columns, 1e-8))
    places = middle + np.array([[0, 0, 0], [5, 0, 0], [0, 0.2, 0], [0, 1, 0], [0, 0, 4]])
    covariance = point_covariance.point_covariance(network, small, places)
    on_line, one_beside, *beside = np.sqrt(np.trace(covariance, axis1=1, axis2=2))
    assert min(on_line, one_beside) > max(beside)
    assert beside == sorted(beside, reverse=True)


def test_certain_cameras_give_certain_points():
    network = pair()
    assert not point_covariance.point_covariance(network, np.zeros((38, 38)), XYZ).any()


def test_a_frame_that_moves_moves_the_points():
    """All cameras shifted along x together: the points follow, and nothing else."""
    network = pair()
    step = np.zeros(38)
    for v in (0, 1):
        step[11 * v + 3 : 11 * v + 6] = -network.cam_from_world[v, :, 0]
    shift = point_covariance.sensitivity(network, XYZ) @ step
    np.testing.assert_allclose(shift, np.tile([1.0, 0, 0], (3, 1)), atol=1e-9)
