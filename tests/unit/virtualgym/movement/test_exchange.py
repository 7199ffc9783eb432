"""A rally of two: who hits when, split steps, first steps, feet on the floor."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from fixtures.people.performers import BODY, COURT, RATE_HZ, perform, speed
from virtualgym.body import stance
from virtualgym.movement import exchange

SECONDS = 9.0
HALVES = ("near", "far")
CASES = [(seed, half) for seed in range(2) for half in HALVES]


@cache
def shots(seed):
    return exchange.script(np.random.default_rng(seed), SECONDS)


@cache
def played(seed, half):
    """Return the motion, the times (T,) and the joints (name -> (T, 3) m) of one player."""
    rng = np.random.default_rng(seed)
    motion = perform("exchange", seed, half=half, seconds=SECONDS, script_rng=rng)
    times = np.arange(0, motion.seconds, 1 / RATE_HZ)
    placed = [stance.joints(motion.stance(time_s), BODY) for time_s in times]
    joints = {name: np.array([each[name] for each in placed]) for name in placed[0]}
    return motion, times, joints


@pytest.mark.parametrize("seed", range(8))
def test_the_players_hit_in_turns_as_long_as_the_shuttle_flies(seed):
    fed_s, made = shots(seed)
    assert [shot.player for shot in made] == [at % 2 for at in range(len(made))]
    hits_s = [fed_s, *(shot.hit_s for shot in made)]
    for (before, after), shot in zip(pairwise(hits_s), made, strict=True):
        shortest, longest = exchange.FLIGHT_S[shot.corner.split("_")[0]]
        assert shortest <= after - before <= longest
    assert min(made[-2].hit_s, made[-1].hit_s) >= SECONDS
    for one, next_one in zip(made, made[2:], strict=False):
        assert one.corner != next_one.corner


@pytest.mark.parametrize("seed", range(2))
def test_both_players_follow_one_script(seed):
    _, made = shots(seed)
    for player, half in enumerate(HALVES):
        events = played(seed, half)[0].events
        scripted = [shot.hit_s for shot in made if shot.player == player]
        found = [events[f"hit_{number + 1}"] for number in range(len(scripted))]
        assert found == pytest.approx(scripted)


@pytest.mark.parametrize(("seed", "half"), CASES)
def test_the_wrist_is_far_and_where_the_corner_is_at_each_hit(seed, half):
    _, times, joints = played(seed, half)
    waist = (joints["left_hip"] + joints["right_hip"]) / 2
    reach = np.linalg.norm(joints["right_wrist"] - waist, axis=1)
    _, made = shots(seed)
    for shot in made:
        if shot.player == HALVES.index(half):
            at = np.searchsorted(times, shot.hit_s)
            near = slice(at - 15, at + 16)
            assert reach[at] > 0.9 * reach[near].max()
            high = joints["right_wrist"][at, 2] > joints["right_shoulder"][at, 2] + 0.15
            assert high == shot.corner.startswith("rear")


@pytest.mark.parametrize(("seed", "half"), CASES)
def test_a_split_step_lands_about_the_opponents_hit_and_the_first_step_follows(seed, half):
    motion, _, _ = played(seed, half)
    fed_s, made = shots(seed)
    hits_s = [fed_s, *(shot.hit_s for shot in made)]
    answered = [hits_s[at] for at, shot in enumerate(made) if shot.player == HALVES.index(half)]
    assert motion.events[f"first_step_{len(answered)}"] > answered[-1]
    for number, hit_s in enumerate(answered, 1):
        step_s = motion.events[f"first_step_{number}"]
        assert 0.05 < step_s - hit_s < 0.75
        if f"split_{number}_stop" in motion.events:
            start_s, stop_s = (motion.events[f"split_{number}_{end}"] for end in ("start", "stop"))
            assert -0.06 < stop_s - hit_s < 0.4
            assert exchange.AIR_S[0] <= stop_s - start_s <= exchange.AIR_S[1] + 1e-9
            assert 0.1 - 1e-9 <= step_s - stop_s <= 0.32 + 1e-9


def test_some_hits_are_answered_without_a_split_step():
    made = [perform("exchange", seed, seconds=6.0) for seed in range(14)]
    names = [name for motion in made for name in motion.events]
    steps = sum(name.startswith("first_step") for name in names)
    splits = sum(name.startswith("split") and name.endswith("stop") for name in names)
    assert 0.6 * steps < splits < steps


@pytest.mark.parametrize(("seed", "half"), CASES)
def test_in_a_split_step_both_feet_are_low_above_the_floor_and_the_body_falls_freely(seed, half):
    motion, times, joints = played(seed, half)
    hips = (joints["left_hip"] + joints["right_hip"])[:, 2] / 2
    falls = np.gradient(np.gradient(hips, times), times)
    assert motion.hops
    for off_s, land_s in motion.hops:
        inside = (times > off_s + 0.01) & (times < land_s - 0.01)
        lifted = [joints[f"{side}_toe"][inside, 2] - BODY.toe_height for side in stance.SIDES]
        assert np.min(lifted) > 0.001
        assert 0.01 < np.max(np.min(lifted, axis=0)) < 0.06
        assert falls[inside].mean() == pytest.approx(-9.81, abs=2.5)  # poses change meanwhile
        before = (times > off_s - 0.06) & (times < off_s - 0.04)
        for side in stance.SIDES:
            assert joints[f"{side}_toe"][before, 2] == pytest.approx(BODY.toe_height, abs=1e-3)


@pytest.mark.parametrize(("seed", "half"), CASES)
def test_no_foot_leaves_the_floor_between_landing_and_first_step(seed, half):
    motion, times, joints = played(seed, half)
    for number in range(1, 9):
        if f"split_{number}_stop" not in motion.events:
            continue
        landed_s = motion.events[f"split_{number}_stop"] + 0.035  # both feet
        step_s = motion.events[f"first_step_{number}"]
        height = np.stack([joints[f"{side}_toe"][:, 2] for side in stance.SIDES])
        standing = (times > landed_s) & (times < step_s)
        assert np.abs(height[:, standing] - BODY.toe_height).max() < 1e-3
        after = (times > step_s + 0.05) & (times < step_s + 0.08)
        assert height[:, after].max() > BODY.toe_height + 0.005


@pytest.mark.parametrize(("seed", "half"), CASES)
def test_standing_feet_do_not_slide_and_no_foot_sinks(seed, half):
    motion, times, joints = played(seed, half)
    for side in stance.SIDES:
        ankle = joints[f"{side}_ankle"]
        assert joints[f"{side}_toe"][:, 2].min() > BODY.toe_height - 1e-3
        for start_s, stop_s in motion.planted(side):
            inside = (times >= start_s) & (times <= stop_s)
            if inside.any():
                assert np.ptp(ankle[inside], axis=0).max() < 0.004
                assert ankle[inside, 2] == pytest.approx(BODY.ankle_height, abs=0.002)


@pytest.mark.parametrize(("seed", "half"), CASES)
def test_players_stay_in_their_half_and_run_no_faster_than_players(seed, half):
    _, _, joints = played(seed, half)
    hips = (joints["left_hip"] + joints["right_hip"]) / 2
    assert 1.8 < speed(hips * [1, 1, 0]).max() < 4.0
    assert speed(hips * [0, 0, 1]).max() < 2.0
    net_m, (width, length) = COURT.size_m[1] / 2, COURT.size_m
    for xyz in joints.values():
        y = xyz[:, 1] if half == "near" else length - xyz[:, 1]
        assert -0.6 < y.min() < y.max() < net_m + 0.3
        assert -0.6 < xyz[:, 0].min() < xyz[:, 0].max() < width + 0.6
