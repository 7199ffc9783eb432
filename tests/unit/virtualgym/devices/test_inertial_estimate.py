"""What sensors and guesses make of true turns, one joint at a time."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixtures.people import mannequin
from virtualgym.body import pose_bones
from virtualgym.devices import inertial_estimate, mocopi_skeleton
from virtualgym.devices.inertial_errors import Errors
from virtualgym.devices.inertial_estimate import Turns

STEP_S = 1 / 50
N = 1500


@pytest.fixture(scope="module")
def still():
    """One random stance, held for a minute and a half; a world with y up."""
    figure = mannequin.dressed("m2")
    rig = mocopi_skeleton.Rig.of(figure.skeleton)
    bones = pose_bones.pose(figure.skeleton, mannequin.stance(np.random.default_rng(8), spread=0.3))
    y_up = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
    world = np.repeat((y_up @ rig.turns(bones))[None], N, axis=0)
    return Turns(rig.hierarchy, world, np.zeros((N, 3)))


def angles_deg(found, true):
    """Return the angles between turns, degrees."""
    relative = found @ np.swapaxes(true, -1, -2)
    return np.degrees(Rotation.from_matrix(relative.reshape(-1, 3, 3)).magnitude())


def test_an_estimate_without_errors_is_the_true_motion(still):
    felt, heading = inertial_estimate.guess(still, STEP_S, Errors(), np.random.default_rng(0))
    np.testing.assert_allclose(felt.world, still.world, atol=1e-9)
    assert not heading.any()


@pytest.mark.parametrize(
    ("errors", "expected_deg"),
    [
        (Errors(noise_deg=2.0), 2.0 * np.sqrt(8 / np.pi)),  # the mean length of a normal vector
        (Errors(tilt_deg=2.0, tilt_s=0.1), 2.0 * np.sqrt(np.pi / 2)),
    ],
)
def test_sensors_are_off_by_what_is_stated(still, errors, expected_deg):
    felt, _ = inertial_estimate.guess(still, STEP_S, errors, np.random.default_rng(1))
    for joint in inertial_estimate.SENSED:
        mean = angles_deg(felt.of(joint), still.of(joint)).mean()
        assert mean == pytest.approx(expected_deg, rel=0.12), joint


def test_heading_errors_turn_about_the_vertical_and_are_told_of_the_hips(still):
    errors = Errors(drift_deg_min=30.0, heading_deg=4.0)
    felt, heading = inertial_estimate.guess(still, STEP_S, errors, np.random.default_rng(2))
    turn = Rotation.from_matrix(felt.of("root") @ np.swapaxes(still.of("root"), -1, -2))
    np.testing.assert_allclose(turn.as_rotvec(), heading[:, None] * [0, 1, 0], atol=1e-9)
    assert heading[0] == 0 and np.abs(heading).max() > np.radians(2)


def test_what_carries_no_sensor_follows_those_that_do(still):
    errors = Errors(mount_deg=6.0)
    felt, _ = inertial_estimate.guess(still, STEP_S, errors, np.random.default_rng(3))
    for upper, lower in (("l_up_arm", "l_low_arm"), ("r_up_leg", "r_low_leg")):
        off = [felt.of(joint) @ np.swapaxes(still.of(joint), -1, -2) for joint in (upper, lower)]
        np.testing.assert_allclose(off[0], off[1], atol=1e-9)
        assert angles_deg(felt.of(lower), still.of(lower)).min() > 1


def test_a_missed_bend_of_the_trunk_is_a_share_of_it(still):
    felt, _ = inertial_estimate.guess(still, STEP_S, Errors(trunk=0.4), np.random.default_rng(4))
    real = angles_deg(still.of("torso_7"), still.of("root"))[0]
    ours = angles_deg(felt.of("torso_7"), felt.of("root"))[0]
    assert real > 3
    assert ours == pytest.approx(0.6 * real, rel=1e-6)


def test_a_swivel_leaves_the_ends_of_the_limb_in_line(still):
    felt, _ = inertial_estimate.guess(
        still, STEP_S, Errors(swivel_deg=15.0), np.random.default_rng(5)
    )
    shape = still.hierarchy
    ends = [turns.hung(shape)[:, shape.joints.index("l_low_arm")] for turns in (still, felt)]
    start = still.hung(shape)[:, shape.joints.index("l_up_arm")]
    hand = still.hung(shape)[:, shape.joints.index("l_hand")]
    span = (hand - start) / np.linalg.norm(hand - start, axis=1, keepdims=True)
    away = [
        np.linalg.norm(np.cross(elbow - start, span), axis=1) for elbow in ends
    ]  # the elbow turns about the line from shoulder to hand
    np.testing.assert_allclose(away[1], away[0], rtol=1e-6)
    assert np.linalg.norm(ends[1] - ends[0], axis=1).max() > 0.01


def test_acceleration_tilts_the_hips_sensor(still):
    time_s = np.arange(N) * STEP_S
    root = np.zeros((N, 3))
    root[:, 2] = 0.5 * np.sin(2 * np.pi * 0.25 * time_s)
    moving = Turns(still.hierarchy, still.world, root)
    felt, _ = inertial_estimate.guess(moving, STEP_S, Errors(leak=0.5), np.random.default_rng(6))
    tilt = Rotation.from_matrix(felt.of("root") @ np.swapaxes(still.of("root"), -1, -2))
    expected = 0.5 * 0.5 * (2 * np.pi * 0.25) ** 2 / 9.81
    middle = slice(100, -100)
    assert np.abs(tilt.as_rotvec()[middle, 0]).max() == pytest.approx(expected, rel=0.05)
    assert np.abs(tilt.as_rotvec()[middle, 1:]).max() < 1e-9
