"""Trials are read whole, and their statistics are those worked out by hand or by textbook formulas."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from courtside.evaluation.tables import calibration
from fixtures.cameras import trials_made

SFM, PAPER = ("sfm", 18, True), ("paper", 3, True)


def test_files_become_one_table(tmp_path):
    parts = [
        trials_made.structure({SFM: [1.0, 2.0], PAPER: [5.0, 6.0]}),
        trials_made.structure(2, offset=1),
        trials_made.known({("known", 18, False): [1.0, None]}),
    ]
    for at, part in enumerate(parts):
        part.to_csv(tmp_path / f"{at}.csv", index=False)
    rows = calibration.read(sorted(tmp_path.glob("*.csv")))
    # Two draws without a result stand for both methods of the structure that has one.
    assert len(rows) == 4 + 4 + 2
    assert rows["in_sample"].dtype == bool
    assert (rows.loc[rows["method"] == "known", "in_sample"] == [False, False]).all()
    failed = calibration.pick(rows, mapper="global", offset=1)
    assert sorted(zip(failed["method"], failed["n_clicks"], strict=True)) == [
        ("paper", 3), ("paper", 3), ("sfm", 18), ("sfm", 18),
    ]  # fmt: skip
    assert failed["volume_rms_cm"].isna().all()
    assert (failed["outcome"] != "").all()
    assert (rows["condition"] == "").all()


def test_where_all_fail_the_usual_ways_have_failed():
    rows = calibration.tidy(trials_made.structure(3))
    assert len(rows) == 3 * len(calibration.USUAL)
    assert set(rows["method"]) == {"sfm", "sim3", "paper"}


def test_the_spread_is_of_finite_values():
    found = calibration.spread([*range(101), np.nan, None])
    assert found.to_dict() == {"n": 101, "p05": 5, "median": 50, "p95": 95}
    nothing = calibration.spread([np.nan])
    assert nothing["n"] == 0
    assert np.isnan(nothing["median"])


def test_a_summary_counts_failures():
    parts = [trials_made.structure({SFM: [1.0, 3.0]}), trials_made.structure(2, offset=1)]
    found = calibration.summary(
        calibration.tidy(pd.concat(parts)), ["method", "n_bridging"], "volume_rms_cm"
    )
    assert found.iloc[0][["n", "n_failed", "median"]].tolist() == [2, 2, 2.0]


def test_structures_are_counted_once():
    parts = [
        trials_made.structure({SFM: [1.0, 3.0], PAPER: [None, None]}),
        trials_made.structure(2, offset=1),
        trials_made.known({("known", 18, True): [1.0]}),
    ]
    rows = calibration.tidy(pd.concat(parts))
    found = calibration.structures_of(rows)
    assert found["offset"].tolist() == [0, 1]
    assert found["solved_share"].tolist() == [1.0, 0.0]
    assert found["registered_share"].tolist() == [1.0, 0.5]
    of_paper = calibration.structures_of(calibration.pick(rows, method="paper"))
    assert of_paper["solved_share"].tolist() == [0.0, 0.0]


def test_pairs_are_of_one_draw():
    rows = calibration.tidy(trials_made.structure({SFM: [3.0, 5.0, 9.0]}))
    reference = calibration.tidy(trials_made.known({("known", 18, True): [1.0, 10.0]}))
    difference = calibration.against(rows, reference, ["session", "draw"])
    np.testing.assert_allclose(difference, [2.0, -5.0, np.nan])
    with pytest.raises(pd.errors.MergeError):
        calibration.against(rows, pd.concat([reference, reference]), ["session", "draw"])


def one_sided(values):
    """Return the upper 95 % limit of a mean by the normal approximation."""
    return np.mean(values) + stats.norm.ppf(0.95) * np.std(values) / np.sqrt(len(values))


def test_the_limit_of_one_structure_is_the_textbooks():
    values = np.random.default_rng(1).normal(0.05, 0.2, 100)
    limit = calibration.upper_limit(values, np.zeros(100), np.zeros(100))
    assert abs(limit - one_sided(values)) < 0.005


def test_trials_of_one_scene_do_not_count_as_many():
    scenes = np.random.default_rng(2).normal(0, 1, 25)
    values, scene = np.repeat(scenes, 40), np.repeat(np.arange(25), 40)
    limit = calibration.upper_limit(values, scene, np.zeros(1000))
    assert abs(limit - one_sided(scenes)) < 0.04
    assert limit - np.mean(values) > 4 * (one_sided(values) - np.mean(values))


def test_the_structure_counts_within_its_scene():
    structures = np.random.default_rng(3).normal(0, 1, 25)
    values, structure = np.repeat(structures, 40), np.repeat(np.arange(25), 40)
    limit = calibration.upper_limit(values, np.zeros(1000), structure)
    assert abs(limit - one_sided(structures)) < 0.04


def test_a_limit_needs_two_values():
    assert calibration.upper_limit(np.full(5, 0.3), np.zeros(5), np.zeros(5)) == pytest.approx(0.3)
    assert np.isnan(calibration.upper_limit(np.array([0.3, np.nan]), np.zeros(2), np.zeros(2)))
