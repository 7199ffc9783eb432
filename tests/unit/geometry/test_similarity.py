"""Similarities against exact truth, scipy's rotation fit, and a camera's own picture."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.geometry import similarity
from fixtures.cameras.scene import opencv_projection, points, ring
from fixtures.cameras.similarities import TRUE, assert_same


def test_exact_points_give_the_transform_and_its_inverse():
    x_in_a = points(6)
    x_in_b = 2.5 * Rotation.from_matrix(TRUE.rotation).apply(x_in_a) + TRUE.translation
    assert_same(similarity.umeyama(x_in_a, x_in_b), TRUE)
    assert_same(similarity.umeyama(x_in_b, x_in_a), TRUE.inverse())
    np.testing.assert_allclose(TRUE.inverse().points(x_in_b), x_in_a, atol=1e-12)


def test_a_camera_shows_the_same_picture_in_both_frames():
    camera = ring(3, dist=(-0.1, 0.02, 1e-3, 1e-3, 0))[1]
    moved = TRUE.camera(camera)
    xyz = points(9)
    xy = opencv_projection(moved, TRUE.points(xyz))
    np.testing.assert_allclose(xy, opencv_projection(camera, xyz), atol=1e-9)
    np.testing.assert_allclose(
        moved.centre_in_world, TRUE.points(camera.centre_in_world), atol=1e-12
    )
    rotation = moved.cam_from_world[:, :3]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)


def test_a_rigid_motion_keeps_lengths():
    xyz = points(20)
    motion = similarity.rigid(xyz, TRUE.points(xyz))
    assert motion.scale == 1.0
    np.testing.assert_allclose(motion.rotation, TRUE.rotation, atol=1e-9)
    middle = TRUE.points(xyz).mean(axis=0)
    np.testing.assert_allclose(motion.points(xyz.mean(axis=0)), middle, atol=1e-9)


def test_the_rotation_is_scipys_and_the_fit_is_the_least_squares_one():
    rng = np.random.default_rng(0)
    x_in_a, weight = points(10), rng.uniform(0.2, 3, 10)
    x_in_b = TRUE.points(x_in_a) + rng.normal(0, 0.2, (10, 3))
    found = similarity.umeyama(x_in_a, x_in_b, weight)
    middle_a, middle_b = (np.average(x, axis=0, weights=weight) for x in (x_in_a, x_in_b))
    theirs, _ = Rotation.align_vectors(x_in_b - middle_b, x_in_a - middle_a, weight)
    np.testing.assert_allclose(found.rotation, theirs.as_matrix(), atol=1e-7)

    def cost(scale, shift):
        placed = similarity.Sim3(scale, found.rotation, shift).points(x_in_a)
        return (weight * ((placed - x_in_b) ** 2).sum(axis=1)).sum()

    least = cost(found.scale, found.translation)
    assert all(cost(found.scale * factor, found.translation) > least for factor in (0.999, 1.001))
    for step in 0.01 * np.eye(3):
        assert cost(found.scale, found.translation + step) > least


@pytest.mark.parametrize("mirror", [1, -1])
def test_kabsch_gives_scipys_rotations_and_never_a_reflection(mirror):
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(2, 5, 8, 3))
    products = np.einsum("nji,njk->nik", b * [1, 1, mirror], a)
    found, trace = similarity.kabsch(products)
    np.testing.assert_allclose(trace, np.einsum("nij,nij->n", found, products))
    np.testing.assert_allclose(np.linalg.det(found), 1)
    for rotation, x_in_a, x_in_b in zip(found, a, b * [1, 1, mirror], strict=True):
        theirs, _ = Rotation.align_vectors(x_in_b, x_in_a)
        np.testing.assert_allclose(rotation, theirs.as_matrix(), atol=1e-9)


@pytest.mark.parametrize(
    ("x_in_a", "x_in_b", "message"),
    [
        (points(2), points(2), "expected three points or more"),
        (np.outer(range(5), [1, 2, 3]), points(5), "expected .* not on one line"),
        (points(5) * np.nan, points(5), "expected finite points"),
        (points(5), points(4), r"expected .* found \(5, 3\), \(4, 3\)"),
    ],
    ids=["two", "line", "missing", "shapes"],
)
def test_points_without_a_transform_are_programming_faults(x_in_a, x_in_b, message):
    with pytest.raises(ValueError, match=message):
        similarity.umeyama(x_in_a, x_in_b)
