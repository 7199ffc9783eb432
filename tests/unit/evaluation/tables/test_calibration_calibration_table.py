"""The table of calibrations says what its hand-made trials were made to say."""

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation.tables import calibration
from fixtures.cameras import trials_made

SFM, OUT, PAPER = ("sfm", 18, True), ("sfm", 18, False), ("paper", 3, True)
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


def test_errors_are_of_all_draws_and_offsets(table):
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


def test_the_reference_is_the_same_draw_of_offset_0(table):
    found = row(table, SFM, 75)
    assert (found.vs_reference_n, found.vs_reference_mean_cm) == (2, 0.5)
    assert found.vs_reference_upper_cm == pytest.approx(0.5)
    own = row(table, SFM, 40)
    assert (own.vs_reference_n, own.vs_reference_mean_cm) == (2, 0.0)
    assert row(table, PAPER, 75).vs_reference_mean_cm == 1.0


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


def test_walks_through_one_scene_are_no_scenes():
    """Two walks each through eight scenes: the limit is wider where scenes differ than where walks do."""
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
