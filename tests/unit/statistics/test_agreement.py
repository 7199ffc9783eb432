"""Verdicts on made-up networks, and limits of agreement: published example, coverage."""

import numpy as np
import pandas as pd
import pytest

from courtside.statistics import agreement
from courtside.study.errors import InputError

NETWORKS = ("old", "new")


def values(measures, *, subjects=12, repeats=6, seed=0):
    """Return long rows of both networks; `measures`: name -> (sd of repeats, bias, new's noise)."""
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


def test_networks_that_may_be_exchanged_are_not_said_to_differ():
    """Limits of 0.8 smallest detectable changes, by three subjects: at most 5 % are a `no`."""
    noise = 0.8 * np.sqrt(2)
    table = compared({f"m{at}": (1.0, 0.0, noise) for at in range(150)}, subjects=3, repeats=5)
    assert (table["verdict"] == "no").mean() <= 0.05
    unsure = table[(table["verdict"] == "unsure") & (table["upper"] > table["detectable"])]
    assert len(unsure) > 20
    assert unsure["sentence"].str.startswith("unsure for m").all()
    assert unsure["sentence"].str.contains("exceed the smallest detectable change").all()


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


# Cardiac output of 12 subjects by radionuclide ventriculography, and less that by impedance
# cardiography: Bland & Altman 2007, table 1.
OUTPUT = {
    1: [(7.83, 6.57), (7.42, 5.62), (7.89, 6.9), (7.12, 6.57), (7.88, 6.35)],
    2: [(6.16, 4.06), (7.26, 4.29), (6.71, 4.26), (6.54, 4.09)],
    3: [(4.75, 4.71), (5.24, 5.5), (4.86, 5.08), (4.78, 5.02), (6.05, 6.01), (5.42, 5.67)],
    4: [(4.21, 4.14), (3.61, 4.2), (3.72, 4.61), (3.87, 4.68), (3.92, 5.04)],
    5: [(3.13, 3.03), (2.98, 2.86), (2.85, 2.77), (3.17, 2.46), (3.09, 2.32), (3.12, 2.43)],
    6: [(5.92, 5.9), (6.42, 5.81), (5.92, 5.7), (6.27, 5.76)],
    7: [(7.13, 5.09), (6.62, 4.63), (6.58, 4.61), (6.93, 5.09)],
    8: [(4.54, 4.72), (4.81, 4.61), (5.11, 4.36), (5.29, 4.2), (5.39, 4.36), (5.57, 4.2)],
    9: [(4.48, 3.17), (4.92, 3.12), (3.97, 2.96)],
    10: [(4.22, 4.35), (4.65, 4.62), (4.74, 3.16), (4.44, 3.53), (4.5, 3.53)],
    11: [(6.78, 7.2), (6.07, 6.09), (6.52, 7.0), (6.42, 7.1), (6.41, 7.4), (5.76, 6.8)],
    12: [(5.06, 4.5), (4.72, 4.2), (4.9, 3.8), (4.8, 3.8), (4.9, 4.2), (5.1, 4.5)],
}


def simulated(rng, counts, sd_between, sd_within, bias=0.0):
    subject = np.repeat(np.arange(len(counts)), counts)
    own = rng.normal(0, sd_between, len(counts))
    return subject, bias + own[subject] + rng.normal(0, sd_within, len(subject))


def test_limits_are_those_of_the_published_example():
    """The paper: mean difference 0.60, standard deviation of single differences 0.99."""
    pairs = [(subject, rv - ic) for subject, values in OUTPUT.items() for rv, ic in values]
    found = agreement.limits(*zip(*pairs, strict=True))
    assert found.bias == pytest.approx(0.60, abs=0.005)
    assert np.hypot(found.sd_between, found.sd_within) == pytest.approx(0.99, abs=0.005)
    assert found.upper - found.bias == pytest.approx(1.96 * 0.9906, abs=0.001)
    assert found.lower + found.upper == pytest.approx(2 * found.bias)


def test_known_components_are_found():
    subject, difference = simulated(np.random.default_rng(1), [8] * 4000, 2.0, 1.0, bias=0.7)
    found = agreement.limits(subject, difference)
    assert found.bias == pytest.approx(0.7, abs=0.1)
    assert found.sd_between == pytest.approx(2.0, rel=0.03)
    assert found.sd_within == pytest.approx(1.0, rel=0.02)
    assert found.upper == pytest.approx(0.7 + 1.96 * np.sqrt(5), rel=0.03)
    assert found.upper_interval[0] < found.upper < found.upper_interval[1]
    assert found.upper_interval[1] - found.upper_interval[0] < 0.3


@pytest.mark.parametrize(
    ("counts", "between", "within"),
    [
        ([5] * 3, 1.0, 0.5),
        ([5] * 3, 0.2, 1.0),
        ([5] * 10, 1.0, 1.0),
        ([3, 4, 8, 5, 6, 10], 0.7, 1.0),
        ([5, 5, 5, 30], 2.0, 0.5),
        ([5, 5, 40], 2.0, 0.5),
        ([5, 5, 5, 5, 5, 40], 2.0, 0.5),
    ],
)
def test_intervals_hold_the_true_limits_as_often_as_they_say(counts, between, within):
    rng = np.random.default_rng(2)
    true = 1.959964 * np.hypot(between, within)
    inside = []
    for _ in range(800):
        found = agreement.limits(*simulated(rng, counts, between, within))
        inside.append(found.upper_interval[0] <= true <= found.upper_interval[1])
        inside.append(found.lower_interval[0] <= -true <= found.lower_interval[1])
    assert 0.92 <= np.mean(inside) <= 0.985


def test_the_smallest_detectable_change_of_a_known_error():
    rng = np.random.default_rng(3)
    subject, value = simulated(rng, [20] * 500, 30.0, 1.5)
    change, interval = agreement.smallest_detectable_change(subject, value)
    assert change == pytest.approx(1.96 * np.sqrt(2) * 1.5, rel=0.02)
    assert interval[0] < change < interval[1]


def test_the_interval_of_the_smallest_detectable_change_covers():
    rng = np.random.default_rng(4)
    true = 1.96 * np.sqrt(2)
    inside = []
    for _ in range(1500):
        _, interval = agreement.smallest_detectable_change(*simulated(rng, [5] * 3, 9.0, 1.0))
        inside.append(interval[0] <= true <= interval[1])
    assert 0.93 <= np.mean(inside) <= 0.97


def test_nothing_is_said_of_one_subject_or_without_repeats():
    for subject in ([1, 1, 1], [1, 2, 3]):
        with pytest.raises(ValueError, match="two subjects at least"):
            agreement.limits(subject, [0.1, 0.2, 0.3])


def test_the_smallest_detectable_change_is_that_of_the_network_that_was_used():
    rows = values({"noisy": (1.0, 0.0, 3.0)})
    table = agreement.compare(agreement.pair(rows, NETWORKS), NETWORKS)
    found = {name: agreement.detectable_of(table, NETWORKS, name) for name in (*NETWORKS, "other")}
    assert found["other"] is None
    for name, spread in (("old", 1.0), ("new", np.hypot(1.0, 3.0))):
        (row,) = found[name].to_dict("records")
        assert row["detectable"] == pytest.approx(1.96 * np.sqrt(2) * spread, rel=0.2)
        assert (row["measure"], row["freedom"]) == ("noisy", 60)


def test_what_changes_between_sessions_is_not_the_spread_of_repeats():
    """A true change of 30 between two sessions; repeats within each have a spread of 1."""
    first = values({"moved": (1.0, 4.0, 0.3)})
    later = values({"moved": (1.0, 4.0, 0.3)}, seed=1).assign(session="later")
    later["value"] += 30
    rows = pd.concat([first, later], ignore_index=True)
    (row,) = agreement.compare(agreement.pair(rows, NETWORKS), NETWORKS).to_dict("records")
    assert row["detectable"] == pytest.approx(1.96 * np.sqrt(2), rel=0.2)
    assert row["detectable_second"] == pytest.approx(1.96 * np.sqrt(2), rel=0.2)
    assert (row["verdict"], row["freedom"], row["n_subjects"]) == ("no", 2 * 12 * 5, 12)


def test_repeats_are_counted_within_one_session():
    rows = values({"close": (1.0, 0.0, 0.3)}, subjects=3, repeats=6)
    rows.loc[rows["take"].str.endswith(("-3", "-4", "-5")), "session"] = "later"
    pairs = agreement.pair(rows, NETWORKS)
    with pytest.raises(InputError, match=r"in one session at most {'p0': 3, 'p1': 3, 'p2': 3}"):
        agreement.compare(pairs, NETWORKS)
    (row,) = agreement.compare(pairs, NETWORKS, min_repeats=3).to_dict("records")
    assert (row["n"], row["freedom"]) == (18, 12)
