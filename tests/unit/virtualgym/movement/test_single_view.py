"""Free motion before a camera: claps in place; the body stays, faces the camera, and moves."""

import numpy as np
import pytest

from fixtures.people import performers
from virtualgym.body import stance
from virtualgym.movement import single_view


def sampled(motion, step_s=0.05):
    """Return times, stances and joints: name -> (T, 3) m."""
    times = np.arange(0, motion.seconds, step_s)
    stances = [motion.stance(time_s) for time_s in times]
    placed = [stance.joints(each, performers.BODY) for each in stances]
    return times, stances, {joint: np.array([p[joint] for p in placed]) for joint in placed[0]}


@pytest.fixture(scope="module")
def minute():
    motion = performers.perform("single_view", 1, free_s=48.0)
    return motion, *sampled(motion)


def test_a_single_view_motion_lasts_as_long_as_asked_with_a_clap_at_each_end(minute):
    motion, *_ = minute
    assert {"clap_1", "clap_2", "tpose_1_start", "tpose_2_stop"} < set(motion.events)
    assert motion.events["clap_1"] < 6 and motion.seconds - motion.events["clap_2"] < 5
    assert 50 < motion.events["clap_2"] - motion.events["clap_1"] < 58
    for seed in range(4):
        longest = performers.perform("single_view", seed, free_s=20.0).seconds
        assert 22 < longest < 20 + 14.5, "what a take's length may be planned by"


def test_arms_are_level_and_still_in_the_t_poses_and_palms_meet_at_claps(minute):
    motion, times, _, joints = minute
    for number in (1, 2):
        start, stop = (motion.events[f"tpose_{number}_{end}"] for end in ("start", "stop"))
        out = (times > start) & (times < stop)
        for side in ("left", "right"):
            arm = joints[f"{side}_wrist"][out] - joints[f"{side}_shoulder"][out]
            assert np.abs(arm[:, 2]).max() < 1e-6, "level"
            assert np.ptp(joints[f"{side}_wrist"][out], axis=0).max() < 1e-6, "still"
        held = (times > motion.events[f"clap_{number}"]) & (
            times < motion.events[f"clap_{number}"] + 0.25
        )
        apart = np.linalg.norm(joints["left_wrist"][held] - joints["right_wrist"][held], axis=1)
        np.testing.assert_allclose(apart, 2 * performers.BODY.palm, atol=0.005)


def test_the_player_stays_in_view_and_mostly_faces_the_net(minute):
    _, _, stances, _ = minute
    places = np.array([each.pelvis[:2] for each in stances])
    assert np.abs(places - places[0]).max() < 0.6
    assert 1.5 < places[0, 1] < 3.2, "so far from the net, at y = 6.7 m, that a camera fits between"
    ahead = np.array([each.world_from_pelvis[1, 2] for each in stances])
    assert ahead.min() > 0.2 and np.median(ahead) > 0.98 and ahead.min() < 0.8


def test_arms_elbows_knees_and_feet_all_move(minute):
    _, _, stances, joints = minute
    assert performers.angles(stances, "left_upper_arm", "left_forearm").max() > 100
    assert performers.angles(stances, "right_thigh", "right_shank").max() > 60
    assert (joints["left_wrist"][:, 2] > joints["head"][:, 2] + 0.2).any()
    assert (joints["left_ankle"][:, 2] > performers.BODY.ankle_height + 0.02).any()
    assert np.ptp([each.pelvis[2] for each in stances]) > 0.15, "squats"


def test_a_free_motion_has_no_jumps(minute):
    motion, *_ = minute
    _, _, fine = sampled(motion, 0.02)
    for joint, limit in (("left_wrist", 4.5), ("right_ankle", 3.5), ("head", 1.5)):
        assert np.linalg.norm(np.diff(fine[joint], axis=0), axis=1).max() / 0.02 < limit


@pytest.mark.parametrize("claps", [1, 3])
def test_any_number_of_claps(claps):
    motion = performers.perform("single_view", 0, free_s=9.0, claps=claps)
    claps_s = [motion.events[f"clap_{k}"] for k in range(1, claps + 1)]
    assert f"clap_{claps + 1}" not in motion.events and (np.diff(claps_s) > 5).all()


def test_hands_may_bounce_and_a_clap_there_must_be():
    motion = performers.perform("single_view", 0, free_s=0.0, bouncing=True)
    assert "clap_2_rebound_2" in motion.events
    with pytest.raises(ValueError, match="claps >= 1"):
        performers.perform("single_view", 0, claps=0)


def test_every_figure_ends_as_it_began():
    rng = np.random.default_rng(0)
    for name, make in single_view.FIGURES.items():
        figure = make(1.0, rng)
        times = [time_s for time_s, _ in figure.moves]
        assert times == sorted(times) and all(0 < t < figure.lasts_s for t in times), name
        if figure.steps:
            assert figure.steps[-1][2:5] == (0.0, 0.0, 0.0), f"{name}: back where it was"
            assert figure.steps[-1][1] < figure.lasts_s
