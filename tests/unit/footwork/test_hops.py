"""Low hops of both feet: found with their times, cut into stances, and nothing else is one."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import scipy

from courtside.footwork import feet, hops
from courtside.footwork.stances import Stance
from courtside.kinematics import skeleton_filter
from fixtures.people import footwork, performers, walker
from virtualgym.body import stance

NAN = float("nan")
RATE_HZ = 30
CUTOFFS = [6.0 if "hip" in name else 8.0 for name in walker.SKELETON.joints]
HEEL_M, TIP_M = 0.05, 0.13  # behind the ankle and before the joint of the toes


def skeletons(name, seed=0, sigma_m=0.006, start_s=0.0, stop_s=8.0, **options):
    """Return filtered keypoints of a motion, with noise, and the motion."""
    motion = performers.perform(name, seed, **options)
    time_s = np.arange(round((stop_s - start_s) * RATE_HZ)) / RATE_HZ
    placed = [stance.joints(motion.stance(start_s + t), performers.BODY) for t in time_s]
    neck = np.array([(p["left_shoulder"] + p["right_shoulder"]) / 2 for p in placed])
    xyz, _ = footwork.body(neck, time_s)
    names = walker.SKELETON.joints
    for side in stance.SIDES:
        ankle, toe = (np.array([p[f"{side}_{part}"] for p in placed]) for part in ("ankle", "toe"))
        ahead = (toe - ankle) / np.linalg.norm(toe - ankle, axis=1, keepdims=True)
        for part in ("hip", "knee", "ankle"):
            xyz[:, names.index(f"{side}_{part}")] = [p[f"{side}_{part}"] for p in placed]
        xyz[:, names.index(f"{side}_heel")] = ankle - HEEL_M * ahead
        xyz[:, names.index(f"{side}_foot_index")] = toe + TIP_M * ahead
    made = footwork.record(xyz, time_s, sigma_m, 0.0, np.random.default_rng(seed))
    return skeleton_filter.smooth(made, CUTOFFS, 4), motion


@pytest.mark.parametrize("seed", range(4))
def test_every_hop_of_a_rally_is_found_in_time_and_nothing_else(seed):
    points, motion = skeletons("exchange", seed, seconds=8.0)
    true = np.array([hop for hop in motion.hops if hop[1] < 7.8])
    found = hops.find(points, 0)
    assert len(found) == len(true) > 1
    error_s = np.abs([(hop.off_s, hop.land_s) for hop in found] - true)
    assert error_s.max() < 0.04
    assert error_s.mean() < 0.015
    assert all(0.005 < hop.land_sigma_s < 0.02 for hop in found)


@pytest.mark.parametrize("name", ["rally", "walk", "lunge"])
def test_running_walking_and_lunging_are_no_hops(name):
    for seed in range(2):
        assert hops.find(skeletons(name, seed)[0], 0) == []


def test_hops_in_the_events_end_and_begin_stances():
    points, motion = skeletons("exchange", seconds=8.0)
    contacts, steps, events = feet.find(points, CUTOFFS)
    found = events[events.event == "split_step"]
    true = [land_s for _, land_s in motion.hops if land_s < 7.8]
    assert found.stop_s.tolist() == pytest.approx(true, abs=0.03)
    assert np.isfinite(found[["x_m", "y_m", "quality"]].to_numpy()).all()
    for off_s, land_s in motion.hops:
        flies = (points.time_s > off_s + 0.02) & (points.time_s < land_s - 0.02)
        assert (contacts.probability[0, flies] < 0.5).all()
    assert (steps.kind == "split_step").sum() >= len(true)


def test_a_gap_or_a_skeleton_without_heels_gives_no_hop():
    points, motion = skeletons("exchange", seconds=8.0)
    off_s, land_s = motion.hops[0]
    xyz = points.xyz.copy()
    xyz[0, (points.time_s > off_s) & (points.time_s < land_s)] = np.nan
    assert len(hops.find(replace(points, xyz=xyz), 0)) == len(hops.find(points, 0)) - 1
    joints = np.array([name.replace("heel", "sole") for name in points.joints.tolist()])
    assert hops.find(replace(points, joints=joints), 0) is None
    slow = replace(points, time_s=points.time_s * 2)
    assert hops.find(slow, 0) is None


def jumping(flight_s, rate_hz, ahead_m_s=0.0, push_m=0.15):
    """Return filtered keypoints of a jump of both feet that leaves the floor at 2 s.

    The body is pushed up over `push_m`; heels leave the floor before the toes, and land after them.
    """
    time_s = np.arange(4 * rate_hz) / rate_hz
    leaves_m_s, fallen_s = scipy.constants.g * flight_s / 2, np.clip(time_s - 2.0, 0, flight_s)
    rise = leaves_m_s * fallen_s - scipy.constants.g / 2 * fallen_s**2
    push_s = 2 * push_m / leaves_m_s
    ends = [2.0 - push_s - 0.5, 2.0 - push_s, 2.0, 2.0 + flight_s]
    ends += [ends[-1] + push_s, ends[-1] + push_s + 0.5]
    lands = leaves_m_s * np.array([0, 0, 1, -1, 0, 0])
    low = scipy.interpolate.CubicHermiteSpline(ends, [0, -push_m, 0, 0, -push_m, 0], lands)
    inside = (time_s >= ends[0]) & (time_s <= ends[-1]) & (rise == 0)
    crouch = np.where(inside, low(time_s), 0.0)
    roll = np.interp(time_s, [1.88, 2.0, 2.0 + flight_s, 2.08 + flight_s], [0, 1, 1, 0])
    height = 1.45 + rise + crouch + 0.05 * roll
    neck = np.column_stack([0 * rise, ahead_m_s * fallen_s, height])
    xyz, _ = footwork.body(neck, time_s)
    for side, x in (("left", -0.15), ("right", 0.15)):
        for part, ahead, high, rolls in (
            ("ankle", 0.0, 0.08, 0.07), ("heel", -0.05, 0.03, 0.08), ("foot_index", 0.15, 0.02, 0.0)
        ):  # fmt: skip
            place = np.column_stack([x + 0 * rise, ahead + neck[:, 1], high + rise + rolls * roll])
            xyz[:, walker.SKELETON.index(f"{side}_{part}")] = place
    made = footwork.record(xyz, time_s, 0.004, 0.0, np.random.default_rng(0))
    return skeleton_filter.smooth(made, CUTOFFS, 4)


@pytest.mark.parametrize("rate_hz", [30, 60, 120])
@pytest.mark.parametrize(
    ("flight_s", "ahead_m_s"), [(0.36, 0), (0.44, 0), (0.5, 0), (0.6, 0), (0.5, 2), (0.6, 2)]
)
def test_a_jump_lasts_as_long_as_its_flight(flight_s, ahead_m_s, rate_hz):
    _, steps, events = feet.find(jumping(flight_s, rate_hz, ahead_m_s), CUTOFFS)
    (row,) = events[events.foot == "both"].to_dict("records")
    assert row["event"] == "jump"
    assert row["stop_s"] - row["start_s"] == pytest.approx(flight_s, abs=0.036)
    sigma_s = np.hypot(row["start_sigma_s"], row["stop_sigma_s"])
    assert abs(row["stop_s"] - row["start_s"] - flight_s) < 1.645 * sigma_s
    assert (steps.kind == "jump").sum() == 2


def test_a_low_hop_is_no_jump():
    _, _, events = feet.find(jumping(0.2, 60), CUTOFFS)
    assert events.event.tolist() == ["split_step"]


HOP = hops.Hop(1.0, 0.01, 1.15, 0.012)


def stood(onset_s, end_s, seen_s=(0.0, 2.0)):
    return Stance(onset_s, 0.02, end_s, 0.02, np.zeros(2), 0.01, 0.9, seen_s)


def test_a_stance_that_saw_no_hop_becomes_two():
    before, after = hops.cut([stood(NAN, 1.6)], [HOP])
    assert (before.end_s, after.onset_s, after.end_s) == (1.0, 1.15, 1.6)
    assert (before.end_sigma_s, after.onset_sigma_s) == (0.01, 0.012)
    assert np.isnan(before.onset_s)


def test_an_end_and_an_onset_near_a_hop_are_moved_to_it():
    before, after = hops.cut([stood(NAN, 0.95), stood(1.22, NAN)], [HOP])
    assert (before.end_s, after.onset_s) == (1.0, 1.15)


def test_a_foot_that_is_not_seen_to_land_keeps_its_stances():
    seen = [stood(NAN, 0.95), stood(1.6, NAN)]
    assert hops.cut(seen, [HOP]) == seen
    assert hops.cut([], [HOP]) == []
    cut_by_a_gap = [stood(NAN, NAN, (0.0, 0.5))]
    assert hops.cut(cut_by_a_gap, [HOP]) == cut_by_a_gap


@pytest.mark.parametrize("short", [(1.02, 1.5), (1.0, 1.1), (0.98, 1.05)])
def test_no_stance_near_a_hop_ends_before_it_begins(short):
    made = hops.cut([stood(0.1, 0.6), stood(0.7, 0.95), stood(*short), stood(1.7, NAN)], [HOP])
    assert all(each.since_s < each.until_s for each in made)
    between = [b.since_s - a.until_s for a, b in itertools.pairwise(made)]
    assert min(between) > 0


def test_probabilities_follow_the_stances_near_a_hop_only():
    time_s = np.arange(60) / 30
    known = np.full((60, 3), 0.9)
    made = hops.lifted(time_s, known, hops.cut([stood(NAN, NAN)], [HOP]), [HOP])
    flies = (time_s > 1.0) & (time_s < 1.15)
    np.testing.assert_allclose(made[flies], 0.1)
    np.testing.assert_array_equal(made[~flies], known[~flies])


def test_a_stance_that_a_gap_cuts_stands_in_no_later_hop():
    time_s, earlier = np.arange(60) / 30, stood(NAN, NAN, (0.0, 0.5))
    stances = hops.cut([earlier, stood(NAN, NAN, (0.6, 2.0))], [HOP])
    made = hops.lifted(time_s, np.full((60, 3), 0.9), stances, [HOP])
    np.testing.assert_allclose(made[(time_s > 1.0) & (time_s < 1.15)], 0.1)
