"""Onsets and ends of stances against the virtual gym's plants."""

import numpy as np
import pytest
import scipy

from courtside.footwork import stances, tracks
from courtside.kinematics import skeleton_filter
from fixtures.people import footwork, walker, walking_feet

SECONDS = 5.0


@pytest.fixture(scope="module")
def errors():
    """Return errors and sigmas (n, 2) of onsets and ends over some runs; each step is found."""
    found = {"onset": [], "end": []}
    for seed in range(4):
        plan = walking_feet.gait(stride_m=0.4 + 0.2 * seed)
        points, feet = walking_feet.record(plan, SECONDS, seed=seed)
        for side, foot in feet.items():
            own, _ = tracks.tracks(points, 0, side, walking_feet.CUTOFFS)
            stood, _ = stances.of_tracks(own, len(points.time_s))
            onset, end = walking_feet.true_steps(foot, SECONDS)
            for what, true in (("onset", onset), ("end", end)):
                rows = [(getattr(s, f"{what}_s"), getattr(s, f"{what}_sigma_s")) for s in stood]
                rows = np.array([row for row in rows if 0.1 < row[0] < SECONDS - 0.1])
                assert len(rows) == len(true)
                found[what] += list(np.column_stack([rows[:, 0] - true, rows[:, 1]]))
    return {what: np.array(rows) for what, rows in found.items()}


@pytest.mark.parametrize("what", ["onset", "end"])
def test_onsets_and_ends_are_near_and_their_sigma_holds(errors, what):
    error, sigma = errors[what].T
    assert np.median(abs(error)) < 0.02
    assert np.mean(abs(error) <= 1.645 * sigma) >= 0.8
    assert np.median(sigma) < 0.03


@pytest.mark.parametrize("rate_hz", [10, 12, 15])
def test_sigma_holds_at_low_frame_rates(rate_hz):
    found = []
    for seed in range(6):
        plan = walking_feet.gait(stride_m=0.4 + 0.2 * (seed % 4), swing_s=0.5, stance_s=0.5)
        points, feet = walking_feet.record(plan, SECONDS, seed=seed, rate_hz=rate_hz)
        for side, foot in feet.items():
            own, _ = tracks.tracks(points, 0, side, walking_feet.CUTOFFS)
            stood, _ = stances.of_tracks(own, len(points.time_s))
            steps = walking_feet.true_steps(foot, SECONDS - 0.5)
            for what, true in zip(("onset", "end"), steps, strict=True):
                at = np.array([getattr(one, f"{what}_s") for one in stood])
                sigma = np.array([getattr(one, f"{what}_sigma_s") for one in stood])
                apart = np.abs(at - true[:, None])
                near = np.nanargmin(apart, axis=1)
                found += list(np.take_along_axis(apart, near[:, None], axis=1)[:, 0] / sigma[near])
    assert np.sqrt(np.mean(np.square(found))) < 1.3
    assert np.mean(np.array(found) <= 2) >= 0.95


def drop_jump(height_m, flight_s, rate_hz):
    """Return filtered keypoints of who drops from a box at 1 s, and the feet's three true times.

    They land, leave 0.2 s later, and land again after the flight. Nothing but g moves them in air.
    """
    g, time_s = scipy.constants.g, np.arange(3.5 * rate_hz) / rate_hz
    lands_s = 1 + np.sqrt(2 * height_m / g)
    leaves_s, again_s = lands_s + 0.2, lands_s + 0.2 + flight_s
    high = height_m - g / 2 * np.maximum(time_s - 1, 0) ** 2
    up_s = np.clip(time_s - leaves_s, 0, flight_s)
    high = np.where(time_s < lands_s, high, g / 2 * up_s * (flight_s - up_s))
    feet = dict.fromkeys(("ankle", "heel", "foot_index"), (0 * high, high))
    return left_foot(feet, 1.45 + high, time_s), (lands_s, leaves_s, again_s)


def left_foot(feet, neck_m, time_s, seed=0):
    """Return filtered keypoints of a body whose left foot's parts go along and above the floor."""
    xyz, _ = footwork.body(np.column_stack([0 * time_s, 0 * time_s, neck_m]), time_s)
    for part, y, z in (("ankle", 0.0, 0.08), ("heel", -0.05, 0.03), ("foot_index", 0.15, 0.02)):
        along, high = feet[part]
        place = np.column_stack([0 * time_s - 0.15, y + along, z + high])
        xyz[:, walker.SKELETON.index(f"left_{part}")] = place
    made = footwork.record(xyz, time_s, 0.006, 0.0, np.random.default_rng(seed))
    return skeleton_filter.smooth(made, walking_feet.CUTOFF_HZ, 4)


def walk(m_s, stance_s, period_s, stands, seed, n=10, rate_hz=60):
    """Return filtered keypoints of a walk, and when the left foot leaves the floor n times, s.

    `stands`: from and until when heel and toe stand, shares of a stance. `m_s` < 0: backwards.
    """
    time_s, onset_s = np.arange((n + 2) * period_s * rate_hz) / rate_hz, period_s * np.arange(n)
    feet = {}
    for part, lift_m in (("heel", 0.1), ("foot_index", 0.06)):
        lands, leaves = stance_s * np.array(stands[part])
        swing = (time_s[:, None] - onset_s - leaves) / (period_s + lands - leaves)
        share = np.clip(swing, 0, 1)
        along = m_s * period_s * (share**2 * (3 - 2 * share)).sum(axis=1)
        feet[part] = along, lift_m * np.sin(np.pi * share).sum(axis=1)
    feet["ankle"] = feet["heel"]
    points = left_foot(feet, np.full(len(time_s), 1.45), time_s, seed)
    return points, onset_s + stance_s


BACKWARDS = {"heel": (0.4, 1.0), "foot_index": (0.0, 0.88)}


@pytest.mark.parametrize(("m_s", "stance_s", "period_s"), [(-1.0, 0.7, 1.1), (-1.4, 0.6, 1.0)])
def test_backwards_a_foot_stands_until_its_heel_leaves(m_s, stance_s, period_s):
    found = []
    for seed in range(3):
        points, leaves_s = walk(m_s, stance_s, period_s, BACKWARDS, seed)
        own, _ = tracks.tracks(points, 0, "left", walking_feet.CUTOFFS)
        stood, _ = stances.of_tracks(own, len(points.time_s))
        ends = [(one.end_s, one.end_sigma_s) for one in stood[:-1]]
        found += [(end - true, sigma) for (end, sigma), true in zip(ends, leaves_s, strict=True)]
    error, sigma = np.array(found).T
    assert abs(np.median(error)) < 0.025
    assert np.mean(abs(error) <= 1.645 * sigma) >= 0.9


@pytest.mark.parametrize("rate_hz", [30, 60, 120])
@pytest.mark.parametrize("height_m", [0.2, 0.3, 0.4, 0.6])
def test_feet_that_fall_land_and_leave_in_time(height_m, rate_hz):
    points, true_s = drop_jump(height_m, 0.45, rate_hz)
    own, _ = tracks.tracks(points, 0, "left", walking_feet.CUTOFFS)
    before, after = stances.of_tracks(own, len(points.time_s))[0][-2:]
    found_s = np.array([before.onset_s, before.end_s, after.onset_s])
    sigma_s = np.array([before.onset_sigma_s, before.end_sigma_s, after.onset_sigma_s])
    assert np.abs(found_s - true_s).max() < 0.025
    assert (np.abs(found_s - true_s) < 1.645 * sigma_s).all()


def test_stances_that_the_take_cuts_have_no_onset_or_end_and_a_place():
    points, feet = walking_feet.record(walking_feet.gait(), SECONDS)
    own, _ = tracks.tracks(points, 0, "left", walking_feet.CUTOFFS)
    stood, probability = stances.of_tracks(own, len(points.time_s))
    assert np.isnan(stood[0].onset_s)
    assert np.isnan(stood[-1].end_s)
    # The middle of heel and toe lies 6 cm before the ankle.
    places = np.array([p.place + np.array([0, 0.06]) for p in feet["left"].plants])
    np.testing.assert_allclose([s.xy for s in stood], places, atol=0.04)
    assert probability[:5].min() > 0.9  # of foot, heel and toe
    assert (probability[:, 1:] <= probability[:, :1] + 1e-9).all()


def test_frames_that_are_not_known_have_no_probability():
    stood, probability = stances.of_tracks([], 7)
    assert stood == []
    assert np.isnan(probability).all()
