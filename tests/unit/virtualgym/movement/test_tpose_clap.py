"""T-pose and clap: level, still, straight; the palms' wrists a palm's thickness apart."""

from itertools import pairwise

import numpy as np
import pytest

from fixtures.people.performers import BODY, angles, filmed, performed, speed
from virtualgym.movement import tpose_clap

SEEDS = range(2)


def wrists_apart(joints):
    return np.linalg.norm(joints["left_wrist"] - joints["right_wrist"], axis=1)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("number", [1, 2])
def test_the_t_pose_is_level_straight_and_still(seed, number):
    times, _, joints = filmed("tpose_clap", seed)
    events = performed("tpose_clap", seed).events
    start, stop = events[f"tpose_{number}_start"], events[f"tpose_{number}_stop"]
    assert stop - start >= 1.0
    held = (times >= start) & (times <= stop)
    for joint, xyz in joints.items():
        assert np.ptp(xyz[held], axis=0).max() < 0.001, joint
    across = (joints["left_wrist"] - joints["right_wrist"])[held]
    assert abs(np.degrees(np.arcsin(across[:, 2] / np.linalg.norm(across, axis=1)))).max() < 1
    span = BODY.shoulder_width + 2 * (BODY.upper_arm + BODY.forearm)
    np.testing.assert_allclose(np.linalg.norm(across, axis=1), span, atol=1e-6)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["tpose_clap", "tpose_clap_bouncing"])
def test_the_palms_touch_at_the_event_and_stay_pressed(name, seed):
    times, stances, joints = filmed(name, seed)
    events, apart = performed(name, seed).events, wrists_apart(joints)
    for number in (1, 2):
        contacts = [t for n, t in events.items() if n.startswith(f"clap_{number}")]
        held = (times > contacts[-1] + 0.01) & (times < contacts[-1] + 0.26)
        np.testing.assert_allclose(apart[held], 2 * BODY.palm, atol=1e-6)
        first = apart[np.searchsorted(times, contacts[0])]
        assert 2 * BODY.palm <= first < 2 * BODY.palm + 0.025  # skin gives a little
        closing = (times > events[f"tpose_{number}_stop"]) & (times < contacts[0])
        assert np.all(np.diff(apart[closing]) < 0)
        for side in ("left", "right"):
            straight = angles(stances, f"{side}_upper_arm", f"{side}_forearm")
            assert straight[closing | held].max() < 1e-4


@pytest.mark.parametrize("seed", SEEDS)
def test_bouncing_hands_touch_three_times(seed):
    times, _, joints = filmed("tpose_clap_bouncing", seed)
    events, apart = performed("tpose_clap_bouncing", seed).events, wrists_apart(joints)
    contacts = [events[name] for name in ("clap_1", "clap_1_rebound_1", "clap_1_rebound_2")]
    assert np.all(np.diff(contacts) > 0.05)
    for before, after in pairwise(contacts):
        between = apart[(times > before) & (times < after)]
        assert between.max() > 2 * BODY.palm + 0.008  # apart again
        assert apart[np.searchsorted(times, after)] < 2 * BODY.palm + 0.025
    near = apart[(times > contacts[0]) & (times < contacts[-1] + 0.2)]
    assert near.min() >= 2 * BODY.palm - 1e-6  # never one inside the other


def test_a_held_clap_has_one_contact():
    names = [n for n in performed("tpose_clap").events if n.startswith("clap_1")]
    assert names == ["clap_1"]


def test_palms_face_down_then_one_another():
    spread, closed = tpose_clap.straight(0.0), tpose_clap.straight(np.pi / 2)
    for side, inwards in (("left", -1), ("right", 1)):
        np.testing.assert_allclose(spread[side][3], [0, -1, 0], atol=1e-12)
        np.testing.assert_allclose(closed[side][3], [inwards, 0, 0], atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_hands_come_together_at_human_speeds(seed):
    _, _, joints = filmed("tpose_clap", seed)
    assert 1.5 < speed(joints["left_wrist"]).max() < 6


def test_the_closed_angle_is_that_of_the_triangle():
    arm = BODY.upper_arm + BODY.forearm
    aside = BODY.shoulder_width / 2 + arm * np.cos(tpose_clap.closed(BODY))
    assert aside == pytest.approx(BODY.palm)
