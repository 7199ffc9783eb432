"""Trials are read whole; their statistics match values by hand or from textbook formulas."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from courtside.evaluation.tables import calibration
from fixtures.cameras import trials_made

SFM, PAPER = ("sfm", 18, True), ("paper", 3, True)


def test_files_are_read_into_one_table(tmp_path):
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


def test_trials_of_one_strength_are_read_or_all(tmp_path):
    made = trials_made.structure({SFM: [1.0, 2.0]})
    made.assign(click_strength=1.0).to_csv(tmp_path / "one.csv", index=False)
    made.assign(click_strength=3.0).to_csv(tmp_path / "three.csv", index=False)
    paths = sorted(tmp_path.glob("*.csv"))
    assert set(calibration.read(paths)["click_strength"]) == {1.0}
    every = calibration.read(paths, click_strength=None)
    assert every["click_strength"].tolist() == [1.0, 1.0, 3.0, 3.0]
    assert len(calibration.table(every)) == 2 * len(calibration.table(calibration.read(paths)))


def test_if_all_structures_fail_the_usual_ways_count_as_failed():
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


def test_differences_pair_trials_of_one_draw():
    rows = calibration.tidy(trials_made.structure({SFM: [3.0, 5.0, 9.0]}))
    reference = calibration.tidy(trials_made.known({("known", 18, True): [1.0, 10.0]}))
    difference = calibration.against(rows, reference, ["session", "draw"])
    np.testing.assert_allclose(difference, [2.0, -5.0, np.nan])
    with pytest.raises(pd.errors.MergeError):
        calibration.against(rows, pd.concat([reference, reference]), ["session", "draw"])


def one_sided(values):
    """Return the upper 95 % limit of a mean by the normal approximation."""
    return np.mean(values) + stats.norm.ppf(0.95) * np.std(values) / np.sqrt(len(values))


def limit_of(values, hall=0, structure=0, draw=None):
    """Return the limit of trials; without `draw` each is another person's."""
    made = pd.DataFrame({"value": values, "hall": hall, "structure": structure, "session": "s"})
    return calibration.upper_limit(made.assign(draw=range(len(made)) if draw is None else draw))


def test_the_limit_for_one_structure_matches_the_textbook():
    values = np.random.default_rng(1).normal(0.05, 0.2, 100)
    assert abs(limit_of(values) - one_sided(values)) < 0.005


def test_trials_of_one_hall_do_not_count_as_independent():
    halls = np.random.default_rng(2).normal(0, 1, 25)
    values = np.repeat(halls, 40)
    limit = limit_of(values, hall=np.repeat(np.arange(25), 40))
    assert abs(limit - one_sided(halls)) < 0.04
    assert limit - np.mean(values) > 4 * (one_sided(values) - np.mean(values))


def test_the_structure_counts_within_its_hall():
    structures = np.random.default_rng(3).normal(0, 1, 25)
    structure, draw = np.repeat(np.arange(25), 40), np.tile(np.arange(40), 25)
    limit = limit_of(np.repeat(structures, 40), structure=structure, draw=draw)
    assert abs(limit - one_sided(structures)) < 0.04


def test_a_limit_needs_two_values():
    assert limit_of(np.full(5, 0.3)) == pytest.approx(0.3)
    assert np.isnan(limit_of([0.3, np.nan]))


OUT = ("sfm", 18, False)
KNOWN, KNOWN_OUT, KNOWN8 = ("known", 18, True), ("known", 18, False), ("known", 8, True)


@pytest.fixture(scope="module")
def table():
    parts = [
        trials_made.structure({SFM: [1.0, 2.0], OUT: [2.0, 3.0], PAPER: [7.0, 9.0]}, n_bridging=40),
        trials_made.structure({SFM: [1.5, 2.5], OUT: [3.0, 4.0], PAPER: [9.0, 9.0]}, n_bridging=75),
        trials_made.structure({SFM: [8.0, 8.0], OUT: [8.0, 8.0]}, n_bridging=40, offset=1),
        trials_made.structure(2, n_bridging=10),
        trials_made.known({KNOWN: [0.5, 0.5], KNOWN_OUT: [1.0, 1.0], KNOWN8: [7.0, 7.0]}),
    ]
    return calibration.table(calibration.tidy(pd.concat(parts)))


def row(table, choice, n_bridging=np.nan):
    method, n_clicks, in_sample = choice
    of = calibration.pick(table, method=method, n_clicks=n_clicks, in_sample=in_sample)
    same = of["n_bridging"].isna() if np.isnan(n_bridging) else of["n_bridging"] == n_bridging
    return of[same].squeeze()


def test_errors_pool_all_draws_and_offsets(table):
    found = row(table, SFM, 40)
    assert (found.n, found.n_failed, found.n_structures) == (4, 0, 2)
    assert found.volume_rms_cm_median == 5.0
    assert found.volume_rms_cm_p95 == np.quantile([1, 2, 8, 8], 0.95)
    assert found.xy_cm_median == 10.0
    assert found.predicted_volume_cm_median == 2.5
    assert found.coverage90 == pytest.approx(0.8)


def test_a_structure_without_result_is_counted(table):
    found = row(table, SFM, 10)
    assert (found.n, found.n_failed, found.n_structures) == (0, 2, 1)
    assert (found.solved_share, found.registered_share) == (0.0, 0.5)
    assert np.isnan(found.volume_rms_cm_median)


def test_the_reference_is_the_same_draw_and_choice_of_images(table):
    found = row(table, SFM, 75)
    assert (found.vs_reference_n, found.vs_reference_mean_cm) == (2, 0.5)
    assert found.vs_reference_upper_cm == pytest.approx(0.5)
    own = row(table, SFM, 40)
    assert (own.vs_reference_n, own.vs_reference_mean_cm) == (4, 0.0)
    assert row(table, PAPER, 75).vs_reference_mean_cm == 1.0


def test_the_limit_to_the_reference_counts_choices_of_images():
    """Three choices of 10 images, by 0, 1 and 2 cm worse than the same ones of 40."""
    parts = [
        trials_made.structure({SFM: [1.0 + more] * 9}, n_bridging=n_bridging, offset=offset)
        for offset in range(3)
        for n_bridging, more in ((10, float(offset)), (40, 0.0))
    ]
    found = row(calibration.table(calibration.tidy(pd.concat(parts))), SFM, 10)
    assert (found.vs_reference_n, found.vs_reference_mean_cm) == (27, 1.0)
    assert 1.5 < found.vs_reference_upper_cm <= 2.0


def test_known_points_are_those_of_most_clicks_scored_alike(table):
    assert row(table, OUT, 75).vs_known_mean_cm == 2.5
    assert row(table, SFM, 75).vs_known_mean_cm == 1.5
    assert row(table, KNOWN8).vs_known_mean_cm == 6.5
    assert row(table, SFM, 40).vs_known_n == 4
    assert row(table, SFM, 75).vs_known_p95_cm == pytest.approx(1.95)


def test_sessions_that_differ_in_seeds_are_pooled():
    parts = [
        trials_made.structure(
            {SFM: [value, value]},
            session=f"scenes-{seed}",
            condition="scenes",
            seed=seed,
            n_bridging=40,
        )
        for seed, value in ((1, 1.0), (2, 2.0), (3, 6.0))
    ]
    parts.append(trials_made.structure({SFM: [50.0, 50.0]}, session="other", n_bridging=40))
    found = calibration.table(calibration.tidy(pd.concat(parts)))
    assert found["session"].tolist() == ["other", "scenes-1", "scenes-2", "scenes-3", "all 3"]
    pooled = found.iloc[-1]
    assert (pooled.n, pooled.volume_rms_cm_median) == (6, 2.0)
    assert np.isnan(pooled.seed)


def test_settings_keep_sessions_of_a_condition_apart():
    parts = [
        trials_made.structure({SFM: [1.0]}, session=f"speed-{at}", condition="speed", speed_kmh=at)
        for at in (1, 2)
    ]
    found = calibration.table(calibration.tidy(pd.concat(parts)))
    assert found["speed_kmh"].tolist() == [1, 2]


def test_walks_through_one_scene_share_its_cluster():
    """Two walks in each of eight scenes: the limit is wider if scenes differ than if walks do."""
    limits = []
    for of_scene in (True, False):
        parts = []
        for at in range(16):
            seed, walk_seed = divmod(at, 2)
            value = float(seed if of_scene else 1.2 + 4.6 * walk_seed)
            labels = {"session": f"s-{at}", "condition": "s", "seed": seed, "walk_seed": walk_seed}
            parts.append(trials_made.structure({SFM: [value] * 9}, n_bridging=40, **labels))
            zero = {KNOWN: [0.0] * 9}
            parts.append(trials_made.known(zero, **labels))
        found = calibration.table(calibration.tidy(pd.concat(parts)))
        limits.append(row(found[found["session"] == "all 16"], SFM, 40).vs_known_upper_cm)
    assert limits[0] > limits[1] + 0.1 > 3.6
