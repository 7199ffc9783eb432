"""Onsets and ends of stances against the virtual gym's plants."""

import numpy as np
import pytest

from courtside.footwork import stances, tracks
from fixtures.people import walking_feet

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
