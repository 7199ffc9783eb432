"""Forward kinematics against trigonometry and against products of 4x4 matrices."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy, forward


def posed(parents, translation, rotation):
    names = tuple(f"j{at}" for at in range(len(parents)))
    shape = Hierarchy(names, np.array(parents), np.array(translation[0], dtype=float))
    return PosedHierarchy(
        shape, np.arange(len(translation)) / 50.0, np.array(translation, float), rotation
    )


def test_a_bent_arm_is_where_trigonometry_says():
    angles = np.radians([[0, 0, 0], [30, 45, 0], [90, -90, 70]])
    rotation = (
        Rotation.from_rotvec(angles.reshape(9, 1) * [[0, 0, 1]]).as_matrix().reshape(3, 3, 3, 3)
    )
    translation = np.tile([[1.0, 2, 3], [0.3, 0, 0], [0.25, 0, 0]], (3, 1, 1))
    xyz, world = forward(posed([NO_PARENT, 0, 1], translation, rotation))
    first, second = angles[:, 0], angles[:, 0] + angles[:, 1]
    elbow = np.stack([1 + 0.3 * np.cos(first), 2 + 0.3 * np.sin(first), np.full(3, 3.0)], axis=1)
    wrist = elbow + 0.25 * np.stack([np.cos(second), np.sin(second), 0 * second], axis=1)
    np.testing.assert_allclose(xyz, np.stack([translation[:, 0], elbow, wrist], axis=1), atol=1e-12)
    total = Rotation.from_rotvec(angles.sum(axis=1)[:, None] * [[0, 0, 1]]).as_matrix()
    np.testing.assert_allclose(world[:, 2], total, atol=1e-12)


def test_branches_and_several_roots_are_products_of_matrices():
    rng = np.random.default_rng(3)
    parents = [NO_PARENT, 0, 0, 1, 2, NO_PARENT, 5, 3]
    rotation = Rotation.random(4 * 8, rng=rng).as_matrix().reshape(4, 8, 3, 3)
    moving = posed(parents, rng.normal(size=(4, 8, 3)), rotation)
    xyz, world = forward(moving)
    for frame in range(4):
        matrices = []
        for joint, parent in enumerate(parents):
            local = np.eye(4)
            local[:3, :3] = rotation[frame, joint]
            local[:3, 3] = moving.translation[frame, joint]
            matrices.append(local if parent == NO_PARENT else matrices[parent] @ local)
        np.testing.assert_allclose(xyz[frame], [m[:3, 3] for m in matrices], atol=1e-12)
        np.testing.assert_allclose(world[frame], [m[:3, :3] for m in matrices], atol=1e-12)


def test_forward_kinematics_of_no_frames_is_empty():
    xyz, _ = forward(posed([NO_PARENT, 0], np.ones((1, 2, 3)), np.tile(np.eye(3), (1, 2, 1, 1))))
    assert xyz.tolist() == [[[1, 1, 1], [2, 2, 2]]]
    shape = Hierarchy(("a",), np.array([NO_PARENT]), np.zeros((1, 3)))
    empty = PosedHierarchy(shape, np.empty(0), np.empty((0, 1, 3)), np.empty((0, 1, 3, 3)))
    assert [part.shape for part in forward(empty)] == [(0, 1, 3), (0, 1, 3, 3)]


@pytest.mark.parametrize("parents", [[0, NO_PARENT], [NO_PARENT, 1], [NO_PARENT, -2]])
def test_a_parent_after_its_child_is_refused(parents):
    with pytest.raises(ValueError, match="comes before"):
        Hierarchy(("a", "b"), np.array(parents), np.zeros((2, 3)))


def test_shapes_that_disagree_are_refused():
    with pytest.raises(ValueError, match="2 joints"):
        Hierarchy(("a", "b"), np.array([NO_PARENT]), np.zeros((2, 3)))
    shape = Hierarchy(("a",), np.array([NO_PARENT]), np.zeros((1, 3)))
    with pytest.raises(ValueError, match="translation"):
        PosedHierarchy(shape, np.zeros(2), np.zeros((3, 1, 3)), np.zeros((2, 1, 3, 3)))
