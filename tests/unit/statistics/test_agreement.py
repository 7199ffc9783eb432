"""Verdicts on networks made by hand: equal, biased, noisy, few subjects; pairs from the same takes only."""

import numpy as np
import pandas as pd
import pytest

from courtside.statistics import agreement
from courtside.study.errors import InputError

NETWORKS = ("old", "new")


def values(measures, *, subjects=12, repeats=6, seed=0):
    """Return long rows of both networks; `measures`: name -> (sd of repeats, bias, own noise of the new)."""
    rng = np.random.default_rng(seed)
    rows = []
    for name, (spread, bias, noise) in measures.items():
        for subject in range(subjects):
            for repeat in range(repeats):
                true = 100 * subject + rng.normal(0, spread)
                for model, value in (("old", true), ("new", true + bias + rng.normal(0, noise))):
                    where = (f"p{subject}", "s", f"t{subject}-{repeat}", model, "file", name, "m")
                    rows.append((*where, value, "same"))
    names = ["subject", "session", "take", "model", "calibration", "measure", "unit"]
    return pd.DataFrame(rows, columns=[*names, "value", "definition"])


def compared(measures, **options):
    rows = values(measures, **options)
    return agreement.compare(agreement.pair(rows, NETWORKS), NETWORKS).set_index("measure")


def test_networks_are_exchanged_only_where_they_differ_less_than_repeats():
    table = compared(
        {"close": (1.0, 0.1, 0.3), "biased": (1.0, 4.0, 0.3), "noisy": (1.0, 0.0, 3.0)}
    )
    assert table["verdict"].to_dict() == {"close": "yes", "biased": "no", "noisy": "no"}
    close = table.loc["close"]
    assert close["bias"] == pytest.approx(0.1, abs=0.1)
    assert close["detectable"] == pytest.approx(1.96 * np.sqrt(2), rel=0.2)
    assert close["upper"] - close["bias"] == pytest.approx(1.96 * 0.3, rel=0.2)
    assert (close["n_subjects"], close["n"]) == (12, 72)
    assert close["sentence"].startswith(
        "old and new may be exchanged for close: limits of agreement"
    )
    assert table.loc["biased", "sentence"].startswith("not for biased: limits of agreement 3.")
    assert "exceed the smallest detectable change" in table.loc["biased", "sentence"]


def test_three_subjects_are_not_sure():
    table = compared({"close": (1.0, 0.0, 0.9)}, subjects=3, repeats=5, seed=2)
    row = table.loc["close"]
    assert row["verdict"] == "unsure"
    assert (
        max(-row["lower"], row["upper"])
        < row["detectable"]
        < max(-row["lower_from"], row["upper_to"])
    )
    assert "as far as 3 subjects tell" in row["sentence"]


def test_independent_errors_of_one_size_have_limits_as_wide_as_the_smallest_change():
    rng = np.random.default_rng(5)
    rows = values({"equal": (0.0, 0.0, 0.0)}, subjects=300, repeats=10)
    rows["value"] += rng.normal(0, 2.0, len(rows))
    row = agreement.compare(agreement.pair(rows, NETWORKS), NETWORKS).iloc[0]
    assert row["upper"] - row["bias"] == pytest.approx(row["detectable"], rel=0.03)
    assert row["detectable_second"] == pytest.approx(row["detectable"], rel=0.05)


def test_too_few_repeats_are_refused_or_said():
    with pytest.raises(InputError, match="expected 5 takes or more of 3 subjects or more, found"):
        compared({"close": (1.0, 0.0, 0.3)}, subjects=3, repeats=4)
    rows = values({"full": (1.0, 0.0, 0.3), "rare": (1.0, 0.0, 0.3)})
    rows.loc[(rows["measure"] == "rare") & (rows["subject"] != "p1"), "value"] = np.nan
    table = agreement.compare(agreement.pair(rows, NETWORKS), NETWORKS).set_index("measure")
    assert table["verdict"].to_dict() == {"full": "yes", "rare": "unknown"}
    assert np.isnan(table.loc["rare", "upper"])


def test_pairs_are_of_one_take_and_calibration():
    rows = values({"a": (1.0, 0.0, 0.0)}, subjects=2, repeats=2)
    assert (lambda p: (p["first"] == p["second"]).all())(agreement.pair(rows, NETWORKS))
    with pytest.raises(
        InputError, match=r"expected values of third, found those of \['new', 'old'\]"
    ):
        agreement.pair(rows, ("old", "third"))
    rows.loc[rows["model"] == "new", "calibration"] = "other"
    with pytest.raises(InputError, match="same takes and calibration"):
        agreement.pair(rows, NETWORKS)


def test_different_definitions_are_marked():
    rows = values({"neck": (1.0, 0.0, 0.1), "knee": (1.0, 0.0, 0.1)})
    rows.loc[(rows["model"] == "new") & (rows["measure"] == "neck"), "definition"] = "trained"
    table = agreement.compare(agreement.pair(rows, NETWORKS), NETWORKS).set_index("measure")
    assert table["definitions_differ"].to_dict() == {"neck": "same / trained", "knee": ""}
    assert table.loc["neck", "sentence"].endswith("defined differently: same / trained")
