"""Anatomy and smoothness of every motion."""

import numpy as np
import pytest

from fixtures.people.performers import BODY, COURT, RATE_HZ, angles, filmed, performed, speed
from virtualgym.body.stance import SEGMENTS, SIDES
from virtualgym.movement import catalogue, player

CASES = [(name, 0) for name in catalogue.MOTIONS] + [("shot", 1), ("rally", 1), ("crossing", 1)]


@pytest.mark.parametrize(("name", "seed"), CASES)
def test_speeds_and_accelerations_are_those_of_a_body(name, seed):
    _, _, joints = filmed(name, seed)
    for joint, xyz in joints.items():
        assert speed(xyz).max() < (20 if joint.endswith("hand") else 15), joint
        steps = np.diff(xyz, 2, axis=0) * RATE_HZ**2
        assert np.linalg.norm(steps, axis=1).max() < 600, joint  # a jump of 15 mm would be 600


@pytest.mark.parametrize("name", ["rally", "tpose_clap_bouncing"])
def test_velocities_have_no_jump(name):
    motion, step = performed(name), 1e-4
    rng = np.random.default_rng(0)
    for time_s in rng.uniform(0.1, motion.seconds - 0.1, 150):
        ways = [
            np.concatenate([s.pelvis, *s.directions.values()])
            for s in (motion.stance(time_s + k * step) for k in (-1, 0, 1))
        ]
        change = np.abs((ways[2] - 2 * ways[1] + ways[0]) / step).max()
        assert change < 0.5  # rad/s or m/s between neighbours 0.1 ms apart


@pytest.mark.parametrize(("name", "seed"), CASES)
def test_knees_and_elbows_bend_as_human_ones(name, seed):
    _, stances, _ = filmed(name, seed)
    for side in SIDES:
        assert angles(stances, f"{side}_thigh", f"{side}_shank").max() < 150
        assert angles(stances, f"{side}_upper_arm", f"{side}_forearm").max() < 150
        for each in stances[::10]:
            thigh, shank = each.directions[f"{side}_thigh"], each.directions[f"{side}_shank"]
            toes = each.directions[f"{side}_foot"] * [1, 1, 0]
            forward = toes / np.linalg.norm(toes) + each.world_from_pelvis[:, 2]
            assert (thigh - shank) @ forward > 0  # the knee is in front of the line hip to ankle


@pytest.mark.parametrize(("name", "seed"), CASES)
def test_planted_feet_do_not_slide_and_none_sinks(name, seed):
    times, _, joints = filmed(name, seed)
    for side in SIDES:
        ankle, toe = joints[f"{side}_ankle"], joints[f"{side}_toe"]
        assert ankle[:, 2].min() > BODY.ankle_height - 0.001
        assert toe[:, 2].min() > BODY.toe_height - 0.001
        spans = performed(name, seed).planted(side)
        assert len(spans) >= (1 if name == "stand" else 2)  # feet that never step stay planted
        for start, stop in spans:
            flat = ankle[(times >= start) & (times <= stop)]
            assert len(flat) < 2 or np.ptp(flat, axis=0).max() < 0.002


@pytest.mark.parametrize("name", catalogue.MOTIONS)
def test_a_stance_is_made_of_unit_vectors_and_rotations(name):
    _, stances, _ = filmed(name)
    for each in stances[::25]:
        assert set(each.directions) == set(SEGMENTS)
        ways = [*each.directions.values(), *each.palms.values()]
        ways += [] if each.racket is None else [each.racket]
        np.testing.assert_allclose(np.linalg.norm(ways, axis=1), 1, atol=1e-9)
        for side in SIDES:
            assert abs(each.palms[side] @ each.directions[f"{side}_hand"]) < 1e-9
        for part in ("pelvis", "thorax", "head"):
            turn = getattr(each, f"world_from_{part}")
            np.testing.assert_allclose(turn.T @ turn, np.eye(3), atol=1e-9)
            assert np.linalg.det(turn) > 0
            assert turn[2, 1] > 0.5  # upright


@pytest.mark.parametrize("name", catalogue.MOTIONS)
def test_the_trunk_turns_within_its_range(name):
    _, stances, _ = filmed(name)
    for each in stances[::10]:
        for lower, upper in (("pelvis", "thorax"), ("thorax", "head")):
            turn = getattr(each, f"world_from_{lower}").T @ getattr(each, f"world_from_{upper}")
            assert np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1))) < 100


def test_arms_swing_against_the_legs():
    _, stances, joints = filmed("walk")
    forward = np.array([each.world_from_thorax[:, 2] for each in stances])
    feet = np.sum((joints["right_ankle"] - joints["left_ankle"]) * forward, axis=1)
    hand = np.sum((joints["left_wrist"] - joints["left_shoulder"]) * forward, axis=1)
    assert np.corrcoef(feet, hand)[0, 1] > 0.8


def test_before_and_after_the_motion_the_player_stays():
    motion = performed("shot")
    np.testing.assert_array_equal(motion.stance(-1).pelvis, motion.stance(0).pelvis)
    late = motion.stance(motion.seconds + 5)
    np.testing.assert_array_equal(late.pelvis, motion.stance(motion.seconds).pelvis)


@pytest.mark.parametrize("wrong", [{"hand": "both"}, {"half": "north"}])
def test_a_player_has_a_hand_and_a_half(wrong):
    with pytest.raises(ValueError, match="hand left or right and half near or far"):
        player.Player(BODY, COURT, np.random.default_rng(0), **wrong)
