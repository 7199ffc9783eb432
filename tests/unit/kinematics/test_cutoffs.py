"""The cut-off that residual analysis chooses, against the one that is best by the truth."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.kinematics import cutoffs, filtering, measures, skeleton_filter
from courtside.records import tables
from courtside.records.keypoints import derived_joints
from courtside.study.errors import InputError
from fixtures.people import footwork, walker

CONFIG = Path(__file__).parents[3] / "config"
DERIVED = derived_joints.read(CONFIG / "derived_joints.yaml")


def player(rate_hz, sigma_m, seed=1):
    _, path = footwork.neck(rate_hz, 24, seed)
    noise = np.random.default_rng(seed).normal(0, sigma_m, path.shape)
    return path, path + noise


@pytest.mark.parametrize("rate_hz", [30.0, 60.0])
@pytest.mark.parametrize("sigma_m", [0.005, 0.015, 0.025])
def test_white_noise_and_a_cutoff_near_the_best_are_found(rate_hz, sigma_m):
    path, noisy = player(rate_hz, sigma_m)
    choice = cutoffs.choose_cutoff(noisy, rate_hz)
    assert choice.noise_m == pytest.approx(sigma_m, rel=0.06)

    def error(cutoff_hz):
        return np.sqrt(np.mean((filtering.zero_lag(noisy, rate_hz, cutoff_hz, 4) - path) ** 2))

    best = min(error(cutoff) for cutoff in np.arange(1.0, 8.0, 0.25))
    assert error(choice.cutoff_hz) < 1.15 * best


def test_more_noise_means_a_lower_cutoff():
    chosen = [cutoffs.choose_cutoff(player(60.0, s)[1], 60.0).cutoff_hz for s in (0.003, 0.03)]
    assert chosen[0] > 1.3 * chosen[1]


def test_the_residual_is_what_the_filter_takes_away():
    _, noisy = player(30.0, 0.01)
    choice = cutoffs.choose_cutoff(noisy, 30.0)
    at = choice.candidates_hz.tolist().index(5.0)
    expected = np.sqrt(np.mean((noisy - filtering.zero_lag(noisy, 30.0, 5.0, 4)) ** 2))
    assert choice.residual_m[at] == pytest.approx(expected, rel=1e-12)
    assert (np.diff(choice.residual_m) < 0).all()


def test_slow_noise_raises_the_cutoff_as_the_docstring_says():
    path, noisy = player(60.0, 0.02)
    slow = path + footwork.noise(len(path), 60.0, 0.02, 0.1, np.random.default_rng(0))
    ours, theirs = (cutoffs.choose_cutoff(xyz, 60.0).cutoff_hz for xyz in (noisy, slow))
    assert theirs > 1.5 * ours


def test_gaps_are_left_out():
    _, noisy = player(30.0, 0.015)
    whole = cutoffs.choose_cutoff(noisy, 30.0)
    noisy[200:260] = np.nan
    holed = cutoffs.choose_cutoff(noisy, 30.0)
    assert holed.cutoff_hz == pytest.approx(whole.cutoff_hz, rel=0.2)


def test_nothing_but_noise_gets_the_lowest_and_too_little_is_refused():
    noise = np.random.default_rng(0).normal(0, 0.01, (600, 3))
    assert cutoffs.choose_cutoff(noise, 30.0).cutoff_hz == 1.0
    with pytest.raises(InputError, match=r"expected 30 known frames.*found 20; state a number of"):
        cutoffs.choose_cutoff(noise[:20], 30.0)
    with pytest.raises(InputError, match=r"expected 30 known frames.*found 20; state a number of"):
        cutoffs.choose_cutoff(noise[:80].reshape(20, 4, 3), 30.0)  # of four joints


def test_a_take_too_slow_for_any_cutoff_is_refused():
    noise = np.random.default_rng(0).normal(0, 0.01, (600, 3))
    assert cutoffs.choose_cutoff(noise, 2.3).cutoff_hz == 1.0
    with pytest.raises(InputError, match=r"expected 2\.22 frames.*found 2; state a number of Hz"):
        cutoffs.choose_cutoff(noise, 2.0)


def test_a_group_is_chosen_for_or_has_its_number():
    time_s, neck = footwork.neck(30, 10)
    record = footwork.record(
        footwork.body(neck, time_s)[0], time_s, 0.01, 0.0, np.random.default_rng(0)
    )
    wanted = {"head": 6, "trunk": "residual", "arms": 10.0, "legs": "residual"}
    found = cutoffs.by_group(record, walker.SKELETON, wanted, path="raw.npz")
    assert (found["head"].cutoff_hz, found["arms"].cutoff_hz) == (6.0, 10.0)
    assert len(found["head"].candidates_hz) == 0
    assert found["trunk"].noise_m == pytest.approx(0.01, rel=0.1)
    legs = [walker.SKELETON.index(joint) for joint in walker.SKELETON.groups["legs"]]
    still = record.xyz.copy()
    still[:, :, legs] += 1.0
    moved = cutoffs.by_group(replace(record, xyz=still), walker.SKELETON, wanted, path="raw.npz")
    assert moved["legs"].cutoff_hz == pytest.approx(found["legs"].cutoff_hz, rel=1e-3)
    unseen = still.copy()
    unseen[:, :, legs] = np.nan
    with pytest.raises(InputError, match=r"raw\.npz: filter_motion\.cutoff_hz\.legs: .*found 0;"):
        cutoffs.by_group(replace(record, xyz=unseen), walker.SKELETON, wanted, path="raw.npz")


def test_cutoffs_say_how_they_were_chosen(tmp_path):
    stated = cutoffs.Choice(6.0, np.zeros(0), np.zeros(0), float("nan"))
    found = cutoffs.Choice(4.5, np.array([4.0, 5.0]), np.array([0.011, 0.009]), 0.01)
    path = tmp_path / "cutoffs.csv"
    tables.write(path, cutoffs.table({"head": stated, "trunk": found}, 4))
    rows = pd.read_csv(path)
    assert rows.group.tolist() == ["head", "trunk", "trunk"]
    assert rows.cutoff_hz.tolist() == [6.0, 4.5, 4.5]
    assert np.isnan(rows.residual_mm.iloc[0])
    assert rows.residual_mm.iloc[1] == pytest.approx(11.0)
    assert cutoffs.read(path) == ({"head": 6.0, "trunk": 4.5}, 4)


@pytest.mark.parametrize("text", ["", "group,cutoff_hz\nhead,6\n", "damaged"])
def test_a_damaged_table_of_cutoffs_is_one_line(tmp_path, text):
    path = tmp_path / "cutoffs.csv"
    path.write_text(text)
    with pytest.raises(InputError, match="a table of cut-offs"):
        cutoffs.read(path)


RATES = (10.0, 12.0, 25.0, 60.0, 120.0, 240.0)
WANTED = {"head": 6, "trunk": 6, "arms": 10, "legs": 8}


@pytest.mark.parametrize("rate_hz", RATES)
@pytest.mark.parametrize("residual", [False, True])
def test_every_frame_rate_is_filtered_and_measured(rate_hz, residual, caplog):
    n_frames = int(6 * rate_hz)
    record = walker.points(n_frames)
    record = replace(record, time_s=np.arange(n_frames) / rate_hz)
    points = skeleton_filter.prepare(record, 0.2)
    wanted = dict.fromkeys(WANTED, "residual") if residual else WANTED
    with caplog.at_level("WARNING", logger="courtside"):
        choices = cutoffs.by_group(points, walker.SKELETON, wanted, path="x.npz")
    most = 0.45 * rate_hz
    assert all(choice.cutoff_hz <= most for choice in choices.values())
    too_high = [name for name, hz in WANTED.items() if hz > most] if not residual else []
    assert len(caplog.messages) == bool(too_high)
    for name in too_high:
        assert f"{name} {WANTED[name]}" in caplog.text
        assert choices[name].cutoff_hz == pytest.approx(most, rel=0.01)
    if not residual:
        same = [name for name in WANTED if name not in too_high]
        assert all(choices[name].cutoff_hz == WANTED[name] for name in same)
    each_hz = np.array(walker.SKELETON.by_group({k: c.cutoff_hz for k, c in choices.items()}))
    smooth = skeleton_filter.smooth(points, each_hz, 4)
    assert np.isfinite(smooth.xyz).all()
    how = measures.Filter(each_hz, 4)
    people = measures.measure(smooth, points, DERIVED, "blazepose33", how, {"p1": "f"})
    speed = np.linalg.norm(people[0].points["neck"].velocity, axis=1)
    assert np.nanmedian(speed) == pytest.approx(0.02 * rate_hz, rel=0.1)
