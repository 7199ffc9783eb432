"""Strokes of virtual players, whose hits are known; motions without a stroke."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import scipy

from courtside.evaluation.movement import strokes as evaluation
from courtside.kinematics import filtering
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


def test_the_caption_of_the_rally_says_from_which_height_a_stroke_is_overhead():
    assert detect.OVERHEAD == 1 / 5
    text = Path("workflow/report/draw_rally.rst").read_text(encoding="utf-8")
    words = "overhead if the wrist is above the shoulders by a fifth of arm and trunk,"
    assert words in " ".join(text.split())


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


def ready(rate_hz, seed):
    """Return 20 s in ready position, with gaps of half a second and 3 mm of noise.

    The body sways at 0.63 m/s at most: less than before any stroke.
    """
    places = {"shoulder": 1.45, "elbow": 1.2, "wrist": 1.25, "hip": 0.95, "knee": 0.5, "ankle": 0.1}
    rng, time_s = np.random.default_rng(seed), np.arange(20 * rate_hz) / rate_hz
    sides = [0.2 if name.startswith("left") else -0.2 for name in strokes_made.JOINTS]
    heights = [places[name.split("_")[1]] for name in strokes_made.JOINTS]
    body = np.stack([np.zeros(12), sides, heights], axis=1)
    body[strokes_made.JOINTS.index("right_wrist")] = 0.45, -0.3, 1.3
    body[strokes_made.JOINTS.index("right_elbow")] = 0.15, -0.25, 1.2
    sway = 0.25 * np.sin(2 * np.pi * (0.4 * time_s + rng.random()))
    xyz = body + np.outer(sway, [0, 1, 0])[:, None]
    xyz += rng.normal(0, 0.004 * np.sqrt(rate_hz / 30), xyz.shape)
    xyz[(time_s + 0.5) % 2 < 0.5] = np.nan
    return strokes_made.record(time_s, filtering.zero_lag_points(xyz, rate_hz, 7.0, 4))


@pytest.mark.parametrize("rate_hz", [60, 120])
def test_who_is_lost_now_and_then_in_ready_position_plays_no_stroke(rate_hz):
    for seed in range(3):
        points = ready(rate_hz, seed)
        assert np.nanmedian(signals.of_person(points, 0).arms["right"].reach) > detect.FAR["low"]
        assert not len(detect.table(points, {"p1": "right"}))
        assert detect.playing_hand(signals.of_person(points, 0)) is None


@pytest.mark.parametrize("rate_hz", [30, 60, 120])
def test_a_dip_of_speed_in_a_run_is_no_stop(rate_hz):
    """In a run that slows a little the left arm swings; at the stop the right hand reaches."""
    time_s = np.arange(4 * rate_hz) / rate_hz
    places = np.repeat(ready(rate_hz, 0).xyz[0, rate_hz : rate_hz + 1], len(time_s), axis=0)
    speed = scipy.interpolate.PchipInterpolator(
        [0, 1.0, 1.2, 1.4, 2.0, 2.5, 3.0, 4.0], [1.7, 1.7, 1.55, 1.7, 1.7, 0.1, 1.0, 1.0]
    )
    for side, at_s, ahead in (("left", 1.2, 0.6), ("right", 2.5, 0.2)):
        swing = ahead * np.exp(-(((time_s - at_s) / 0.3) ** 2))
        wrist = strokes_made.JOINTS.index(f"{side}_wrist")
        places[:, wrist, 0] = places[:, strokes_made.JOINTS.index("left_hip"), 0] + 0.1 + swing
    places[..., 0] += speed.antiderivative()(time_s)[:, None]
    found = signals.of_person(strokes_made.record(time_s, places), 0)
    assert detect.playing_hand(found) == "right"


def test_the_height_of_a_wrist_that_is_lost_at_the_hit_is_empty():
    points, _ = strokes_made.take(seed=1)
    time_s = np.arange(4 * len(points.time_s) - 3) / (4 * strokes_made.RATE_HZ)
    xyz = scipy.interpolate.make_interp_spline(points.time_s, points.xyz[0])(time_s)
    whole = detect.table(strokes_made.record(time_s, xyz), {"p1": "right"})
    low = np.flatnonzero(~whole.overhead.astype(bool))[0]
    wrist = strokes_made.JOINTS.index("right_wrist")
    xyz[np.abs(time_s - whole.time_s[low] - 0.1) < 0.12, wrist] = np.nan
    rows = detect.table(strokes_made.record(time_s, xyz), {"p1": "right"})
    assert rows.time_s.tolist() == whole.time_s.tolist()
    assert rows.height_m.isna().tolist() == [at == low for at in range(len(rows))]
    assert rows.x_m.tolist() == whole.x_m.tolist()


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


@pytest.mark.parametrize("lost", ["left_elbow", "left_wrist"])
def test_strokes_are_found_though_the_other_arm_is_never_seen(lost):
    points, truth = strokes_made.take(seed=1, noise_m=0.004)
    points.xyz[:, :, strokes_made.JOINTS.index(lost)] = np.nan
    rows = detect.table(points, {"p1": "right"})
    hits_s = [time_s for time_s in evaluation.hits(truth, "p1") if time_s < points.time_s[-1] - 0.3]
    assert len(hits_s) >= 2
    np.testing.assert_allclose(rows.time_s, hits_s, atol=0.07)


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


@pytest.mark.parametrize("lost", [slice(None), [strokes_made.JOINTS.index("right_wrist")]])
def test_intervals_of_low_strokes_beside_gaps_hold_their_errors(lost):
    """The stop that tells the time may lie in the gap: errors are 0.15 s, not 0.02."""
    errors = []
    for seed in (11, 12):
        points, truth = strokes_made.take(seed=seed, seconds=20, noise_m=0.004)
        hits = np.array(evaluation.hits(truth, "p1"))
        for start in np.random.default_rng(seed).integers(0, 40, 4):
            xyz = points.xyz[0].copy()
            gaps = (np.arange(len(xyz)) + start) % 60 < 20
            xyz[np.ix_(gaps, np.arange(xyz.shape[1])[lost])] = np.nan
            rows = detect.table(strokes_made.record(points.time_s, xyz), {"p1": "right"})
            for row in rows[~rows.overhead.astype(bool) & (rows.quality < 0.8)].itertuples():
                errors.append((np.abs(hits - row.time_s).min(), row.sigma_s))
    error_s, sigma_s = np.array(errors).T
    assert len(errors) >= 10
    assert np.mean(error_s < 1.645 * sigma_s) >= 0.7
