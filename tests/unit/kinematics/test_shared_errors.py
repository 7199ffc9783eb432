"""Errors that joints share: variances of values by hand, and of drawn errors."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.kinematics import shared_errors
from courtside.records.keypoints import skeleton
from fixtures.people import walker

JOINTS = ["left_hip", "left_knee", "left_ankle", "right_knee"]


def errors(network=0.0, shared=0.0):
    """Return errors of four joints in one frame: 10 mm of their own per axis, and others."""
    found = shared_errors.independent(np.broadcast_to(1e-4 * np.eye(3), (1, 4, 3, 3)))
    return replace(
        found,
        network=np.full((1, 4), network),
        alike=shared_errors.alike(JOINTS),
        shared=[np.full((1, 3, 1), shared)] * 4,
    )


def along_x(*signs):
    return [np.array([[sign, 0.0, 0.0]]) for sign in signs]


def test_independent_errors_add_their_squares():
    assert errors().variance([0, 1], along_x(1, -1))[0] == pytest.approx(2e-4)
    assert errors().variance([0, 1, 2], along_x(1, -2, 1))[0] == pytest.approx(6e-4)


def test_what_all_joints_share_cancels_in_a_difference():
    assert errors(shared=0.05).variance([0, 1], along_x(1, -1))[0] == pytest.approx(2e-4)
    both = errors(shared=0.05).variance([0, 1], along_x(0.5, 0.5))[0]
    assert both == pytest.approx(0.5e-4 + 0.05**2)


def test_neighbours_of_a_limb_err_alike_and_others_do_not():
    found = errors(network=4e-4)
    alike = shared_errors.NEIGHBOURS
    assert found.variance([0, 1], along_x(1, -1))[0] == pytest.approx(2e-4 + 8e-4 * (1 - alike))
    for one, other in ((0, 2), (1, 3)):
        assert found.variance([one, other], along_x(1, -1))[0] == pytest.approx(10e-4)
    across = [np.array([[1.0, 0, 0]]), np.array([[0, 1.0, 0]])]
    assert found.variance([0, 1], across)[0] == pytest.approx(10e-4)


def test_correlations_of_all_joints_are_possible():
    matrix = shared_errors.alike(walker.SKELETON.joints)
    np.testing.assert_array_equal(matrix, matrix.T)
    assert np.linalg.eigvalsh(matrix).min() > 0
    assert (matrix > 0).sum() == walker.N_JOINTS + 2 * 8  # two lines of each of four limbs


def test_a_record_gives_its_parts():
    record = walker.points(n_frames=10)
    network = np.broadcast_to(0.01 * np.eye(3), (*record.xyz.shape, 3)).copy()
    network[0, 1] = np.nan
    known = replace(record, covariance_network=network, offset=np.full_like(record.xyz, 0.02))
    found = shared_errors.of_person(known, 0, lambda xyz: xyz[:, :, None] * [1.0, 2.0])
    np.testing.assert_allclose(found.network[0], 0.01 * shared_errors.NETWORK_SHARE)
    assert not found.network[1].any()
    np.testing.assert_array_equal(found.covariance, record.covariance_2d[0])
    for at, joint in enumerate(record.joints):
        if joint in skeleton.JOINTS:
            np.testing.assert_allclose(found.shared[at][..., 0], 0.02)
            np.testing.assert_allclose(found.shared[at][..., 2], 2 * record.xyz[0][:, at])
        else:
            assert np.isnan(found.shared[at]).all()


def test_a_wrong_vertical_turns_all_joints_alike():
    def still(xyz):
        return np.zeros((*xyz.shape, 1))

    frame = np.diag([0.01, 0.04, 0.09])
    moved = shared_errors.with_frame(still, frame)(np.array([[0.0, 0, 2], [3, 0, 0]]))
    covariance = moved @ moved.transpose(0, 2, 1)
    # Two metres up, a turn about y moves along x; three metres along x, it moves along z.
    np.testing.assert_allclose(covariance[0], np.diag([4 * 0.04, 4 * 0.01, 0.09]), atol=1e-12)
    np.testing.assert_allclose(covariance[1], np.diag([0, 0, 9 * 0.04 + 0.09]), atol=1e-12)
    assert shared_errors.with_frame(still, np.zeros((3, 3))) is still
