"""Walks: human speeds and steps; players that pass one another."""

import numpy as np
import pytest

from fixtures.people.performers import BODY, COURT, filmed, perform, performed, speed


def places(motion, times):
    return np.array([motion.stance(time_s).pelvis[:2] for time_s in times])


@pytest.mark.parametrize("seed", range(3))
def test_a_walk_has_human_speed_and_steps(seed):
    _, stances, _ = filmed("walk", seed)
    speeds = speed(np.array([s.pelvis for s in stances]) * [1, 1, 0])
    cruising = speeds[len(speeds) // 3 : 2 * len(speeds) // 3]
    assert 1.0 < np.median(cruising) < 1.6
    lands = np.sort(
        np.concatenate([performed("walk", seed).planted(s)[1:-1, 0] for s in ("left", "right")])
    )
    assert 0.4 < np.median(np.diff(lands)) < 0.7  # s per step
    assert abs(speeds[[0, -1]]).max() < 1e-6


def test_both_feet_are_never_off_the_floor_in_a_walk():
    _, _, joints = filmed("walk")
    lowest = np.minimum(joints["left_toe"][:, 2], joints["right_toe"][:, 2])
    assert lowest.max() < BODY.toe_height + 0.005


@pytest.mark.parametrize("seed", range(3))
def test_two_players_cross_close_by_in_views_along_both_sides_of_the_court(seed):
    motions = [perform("crossing", seed + 10 * lane, lane=lane) for lane in (0, 1)]
    times = np.arange(0, min(m.seconds for m in motions), 0.02)
    apart = places(motions[0], times) - places(motions[1], times)
    assert 0.7 < np.linalg.norm(apart, axis=1).min() < 1.3
    for axis in (0, 1):
        assert np.sum(np.diff(np.sign(apart[:, axis])) != 0) >= 2  # out and back


def test_more_turns_cross_more_often():
    assert perform("crossing", n_turns=3).seconds > 1.8 * perform("crossing", n_turns=1).seconds


def test_a_third_lane_is_refused():
    with pytest.raises(ValueError, match="lane 0 or 1"):
        perform("crossing", lane=2)


def test_who_stands_beside_the_lanes_keeps_the_feet_still_and_sways_a_little():
    _, stances, joints = filmed("stand", 4)
    for ankle in ("left_ankle", "right_ankle"):
        assert np.ptp(joints[ankle], axis=0).max() < 1e-9
    swayed = np.ptp(joints["left_shoulder"], axis=0).max()
    assert 0.002 < swayed < 0.1
    assert stances[0].world_from_pelvis[1, 2] > 0.99  # towards the net
    times = np.arange(0, 12, 0.1)
    for lane in (0, 1):
        apart = places(perform("crossing", lane, lane=lane), times) - stances[0].pelvis[:2]
        assert 0.7 < np.linalg.norm(apart, axis=1).min() < 3


@pytest.mark.parametrize(("half", "side"), [("near", 1), ("far", -1)])
def test_who_strolls_stays_outside_of_the_court_as_long_as_asked(half, side):
    motion = perform("stroll", 2, half=half, seconds=30.0)
    walked = places(motion, np.arange(0, 30, 0.1)) - np.array(COURT.size_m) / 2
    assert np.all(side * walked[:, 0] > COURT.size_m[0] / 2 + 0.5)
    assert np.ptp(walked[:, 1]) > 0.8 * COURT.size_m[1]
    assert motion.seconds > 30.0


def test_a_round_between_claps_ends_where_it_began():
    _, stances, _ = filmed("tpose_clap")
    pelvis = np.array([each.pelvis for each in stances])
    np.testing.assert_allclose(pelvis[0, :2], pelvis[-1, :2], atol=1e-6)
    assert np.ptp(pelvis[:, 1]) > 0.8
    forward = stances[0].world_from_pelvis[:, 2]
    assert forward[1] > 0.9  # towards the net
    assert np.all(pelvis[:, :2] > -0.5)
    assert np.all(pelvis[:, :2] < np.array(COURT.size_m) * [1, 0.5])
