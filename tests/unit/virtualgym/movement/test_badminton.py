"""Strokes and ways of badminton drills."""

import numpy as np
import pytest

from fixtures.people.performers import COURT, filmed, perform, performed, speed

SEEDS = range(2)


@pytest.mark.parametrize("seed", range(5))
def test_a_shot_swings_as_fast_as_players_do(seed):
    times, stances, joints = filmed("shot", seed)
    events = performed("shot", seed).events
    speeds = speed(joints["right_wrist"])
    window = (times[1:] > events["hit_start"]) & (times[1:] < events["hit_stop"])
    assert 7.5 < speeds[window].max() < 12.5
    assert speeds[window].max() == speeds.max()
    fastest = times[1:][speeds.argmax()]
    assert abs(fastest - events["hit"]) < 0.15
    at_hit = np.searchsorted(times, events["hit"])
    for joint in ("right_wrist", "right_elbow"):  # overhead
        assert joints[joint][at_hit, 2] > joints["right_shoulder"][at_hit, 2] + 0.15
    assert stances[at_hit].racket[2] > 0.7


def test_a_shot_lies_within_its_take():
    motion = performed("shot")
    assert motion.events["hit_stop"] - motion.events["hit_start"] == pytest.approx(16 / 30)
    assert 1 < motion.events["hit_start"] < motion.events["hit_stop"] < motion.seconds - 1


@pytest.mark.parametrize("seed", SEEDS)
def test_footwork_leaves_the_base_for_all_corners_of_its_half(seed):
    times, stances, _ = filmed("footwork", seed)
    pelvis = np.array([each.pelvis for each in stances])
    assert times[-1] > 20
    assert np.ptp(pelvis[:, 0]) > 2.2
    assert np.ptp(pelvis[:, 1]) > 2.4
    speeds = speed(pelvis * [1, 1, 0])
    assert 1.9 < speeds.max() < 3.2
    resting = np.concatenate([pelvis[:50], pelvis[-80:]])
    assert np.linalg.norm(resting[:, :2] - resting[0, :2], axis=1).max() < 0.4


@pytest.mark.parametrize("seed", SEEDS)
def test_every_joint_stays_in_its_half_of_the_court(seed):
    _, _, joints = filmed("footwork", seed)
    width, length = COURT.size_m
    for xyz in joints.values():
        assert xyz[:, 0].min() > -0.5
        assert xyz[:, 0].max() < width + 0.5
        assert xyz[:, 1].min() > -0.5
        assert xyz[:, 1].max() < length / 2 + 0.5


def test_strokes_of_footwork_are_only_shown_those_of_a_rally_are_real():
    shown, real = (speed(filmed(name)[2]["right_wrist"]).max() for name in ("footwork", "rally"))
    assert real > 8
    assert shown < 0.8 * real


def test_a_lunge_is_low_long_and_back():
    times, stances, joints = filmed("lunge")
    events = performed("lunge").events
    pelvis = np.array([each.pelvis for each in stances])
    for name in ("hit_1", "hit_2"):
        at = np.searchsorted(times, events[name])
        feet = joints["left_ankle"][at, :2] - joints["right_ankle"][at, :2]
        assert np.linalg.norm(feet) > 0.7
        assert pelvis[at, 2] < pelvis[0, 2] - 0.05
        assert pelvis[at, 1] > pelvis[0, 1] + 0.8  # nearer to the net
    assert np.linalg.norm(pelvis[-1, :2] - pelvis[0, :2]) < 0.4


def test_the_number_of_visits_follows_the_time():
    assert perform("rally", seconds=8.0).seconds < 14
    assert 30 < perform("rally", seconds=30.0).seconds < 36
