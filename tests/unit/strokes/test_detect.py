"""Strokes of virtual players, whose hits are known; motions without a stroke."""

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation.movement import strokes as evaluation
from courtside.records.strokes import STROKE_COLUMNS
from courtside.strokes import detect, signals
from fixtures.people import strokes_made

SEEDS = range(5)


@pytest.fixture(scope="module")
def compared():
    """Return errors of drills with noise, left- and right-handed, hands not stated."""
    parts = []
    for seed in SEEDS:
        hand = ("left", "right")[seed % 2]
        points, truth = strokes_made.take(seed=seed, hand=hand, noise_m=0.01)
        rows = evaluation.table(detect.table(points, {}), points, truth)
        parts.append(rows.assign(true_hand=hand))
    return pd.concat(parts, ignore_index=True)


def test_every_hit_is_found_within_two_frames_and_nothing_else(compared):
    counted = compared[compared.result != "cut"]
    assert len(counted) >= 12
    assert (counted.result == "found").all()
    assert counted.error_ms.abs().max() < 70
    assert counted.error_ms.abs().median() < 33
    assert counted.within_90_percent.mean() >= 0.75


@pytest.mark.parametrize("n_frames", [1, 3])
def test_a_take_of_few_frames_has_no_strokes(n_frames):
    points, _ = strokes_made.take(seed=1)
    found = detect.table(points.frames(slice(n_frames)), {"p1": "right"})
    assert found.empty
    assert list(found.columns) == STROKE_COLUMNS


def test_the_playing_hand_is_found(compared):
    found = compared[compared.result == "found"]
    assert (found.hand == found.true_hand).all()


def test_a_stated_hand_is_taken_and_a_row_says_where_it_was():
    points, _ = strokes_made.take(seed=1)
    rows = detect.table(points, {"p1": "right"})
    assert set(rows.hand_from) == {"stated"}
    assert list(rows.columns) == STROKE_COLUMNS
    assert rows.height_m[rows.overhead].gt(1.7).all()
    assert rows.height_m[~rows.overhead.astype(bool)].lt(1.4).all()
    trunk = signals.of_person(points, 0).trunk.place
    frame = np.argmin(abs(points.time_s - rows.time_s[0]))
    np.testing.assert_allclose(
        rows.loc[0, ["x_m", "y_m"]].astype(float), trunk[frame, :2], atol=0.05
    )
    assert (rows.quality == 1).all()


@pytest.mark.parametrize("name", ["walk", "tpose_clap", "stand"])
def test_walks_t_poses_and_claps_are_no_strokes(name):
    points, _ = strokes_made.take(name, seed=2, seconds=8)
    assert not len(detect.table(points, {"p1": "right"}))
    assert not len(detect.table(points, {}))


def test_frames_without_the_wrist_lower_the_quality():
    points, truth = strokes_made.take(seed=1)
    hit_s = evaluation.hits(truth, "p1")[0]
    near = np.abs(points.time_s - hit_s - 0.2) < 0.1
    wrist = strokes_made.JOINTS.index("right_wrist")
    points.reason[0, near, wrist] = 5
    rows = detect.table(points, {"p1": "right"})
    assert rows.quality[0] < 0.8
    assert (rows.quality[1:] == 1).all()
    whole = detect.table(strokes_made.take(seed=1)[0], {"p1": "right"})
    assert (rows.speed_m_s <= whole.speed_m_s).all()
    points.reason[0, np.abs(points.time_s - hit_s) < 0.2, wrist] = 5
    rows = detect.table(points, {"p1": "right"})
    assert np.isnan(rows.speed_m_s[0])
    assert rows.speed_m_s[1:].equals(whole.speed_m_s[1:])


def test_a_person_who_was_never_seen_has_no_strokes():
    points, _ = strokes_made.take(seed=1)
    points.xyz[:] = np.nan
    assert not len(detect.table(points, {}))


def test_at_a_slow_rate_the_times_are_known_worse():
    points, _ = strokes_made.take(seed=1)
    slow = strokes_made.record(points.time_s[::3], points.xyz[0, ::3])
    fast, slow = (detect.table(each, {"p1": "right"}) for each in (points, slow))
    assert len(slow) == len(fast)
    assert slow.sigma_s.min() > 2 * fast.sigma_s.max()
