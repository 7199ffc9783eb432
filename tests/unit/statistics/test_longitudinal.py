"""Changes over sessions: false alarms, real changes, mixtures; tables of measures."""

import numpy as np
import pandas as pd
import pytest

from courtside.statistics import longitudinal
from courtside.study.errors import InputError


def rows(sessions, measure="neck_distance", subject="p1"):
    """Return long rows; `sessions`: list of (name, values, other labels)."""
    tables = []
    for name, values, labels in sessions:
        for at, value in enumerate(values):
            take = pd.DataFrame(
                {"person": [subject], "measure": [measure], "value": [value], "unit": ["m"]}
            )
            label = {"session": name, "take": f"t{at}", "model": "net"}
            label |= {"calibration": "sfm-n40", **labels}
            tables.append(longitudinal.labelled(take, label))
    return pd.concat(tables, ignore_index=True)


def compared(table, detectable=None, **options):
    own = longitudinal.of_subject(table, "p1", **options)
    values = longitudinal.over_sessions(own)
    errors = longitudinal.errors_of_measurement(own, detectable)
    return values, longitudinal.changes(values, errors)


def test_changes_are_of_means_in_the_order_of_sessions():
    table = rows(
        [
            ("first", [10.0, 11.0, 9.0], {}),
            ("b", [12.0, 14.0], {}),
        ]
    )
    values, changes = compared(table)
    assert values["session"].tolist() == ["first", "b"]
    assert values["value"].tolist() == [10.0, 13.0]
    assert values["n_takes"].tolist() == [3, 2]
    row = changes.iloc[0]
    assert (row["session"], row["against"], row["change"]) == ("b", "first", 3.0)
    sem = np.sqrt((2 * 1.0 + 1 * 2.0) / 3)  # pooled over both sessions
    assert row["freedom"] == 3
    assert row["detectable"] == pytest.approx(3.182446 * sem * np.sqrt(1 / 3 + 1 / 2))
    assert row["verdict"] == "within"


def test_values_say_whose_they_are_and_of_which_takes():
    table = rows([("a", [8.0, np.nan, 7.9], {}), ("b", [9.0], {})])
    values = compared(table)[0]
    assert values["person"].tolist() == ["p1", "p1"]
    assert values["takes"].tolist() == ["t0+t2", "t0"]
    assert values["n_takes"].tolist() == [2, 1]


def test_without_a_change_one_in_twenty_is_called_real():
    rng = np.random.default_rng(0)
    table = rows([("a", np.zeros(3), {}), ("b", np.zeros(4), {})])
    table = pd.concat([table.assign(measure=f"m{at}") for at in range(1500)], ignore_index=True)
    table["value"] = rng.normal(8.0, 0.3, len(table))
    alarms = compared(table)[1]["verdict"] == "real"
    assert len(alarms) == 1500
    assert 0.035 < alarms.mean() < 0.065


def test_a_large_change_is_real_and_one_take_each_tells_nothing():
    steady = [("a", [8.0, 8.1, 7.9], {}), ("b", [9.0, 9.1], {})]
    assert compared(rows(steady))[1]["verdict"].tolist() == ["real"]
    single = rows([("a", [8.0], {}), ("b", [9.0], {})])
    row = compared(single)[1].iloc[0]
    assert row["verdict"] == "untold"
    assert np.isnan(row["detectable"])


def test_counts_whose_repeats_are_all_equal_tell_nothing():
    """Six takes of 4 steps do not say that 5 are a change: the next count may differ."""
    equal = rows([("a", [4.0] * 3, {}), ("b", [4.0] * 3, {}), ("c", [5.0], {})], measure="steps")
    changes = compared(equal)[1]
    assert changes["verdict"].tolist() == ["untold"] * 2
    assert changes["detectable"].isna().all()
    study = pd.DataFrame({"measure": ["steps"], "detectable": [0.0], "freedom": [12]})
    assert compared(equal, study)[1]["verdict"].tolist() == ["untold"] * 2
    study["detectable"] = 3.0
    assert compared(equal, study)[1]["verdict"].tolist() == ["within"] * 2


def test_a_study_of_repeats_stands_in_for_missing_ones():
    single = rows([("a", [8.0], {}), ("b", [9.0], {})])
    sem = 0.3
    known = pd.DataFrame(
        {
            "measure": ["neck_distance"],
            "detectable": [1.959964 * np.sqrt(2) * sem],
            "freedom": [100000],
        }
    )
    row = compared(single, known)[1].iloc[0]
    assert row["detectable"] == pytest.approx(1.96 * np.sqrt(2) * sem, rel=1e-3)
    assert row["verdict"] == "real"


@pytest.mark.parametrize(
    ("label", "found"),
    [
        ({"model": "cpm14"}, "expected one model over all sessions, found cpm14 in b; net in a"),
        (
            {"calibration": "known18"},
            "expected one calibration over all sessions, found known18 in b",
        ),
        (
            {"definition": "trained"},
            r"expected one definition of neck_distance, found \['', 'trained'\]",
        ),
    ],
)
def test_mixtures_are_refused_or_marked(label, found):
    table = rows([("a", [8.0, 8.1, 7.9], {}), ("b", [9.0, 9.1], {})])
    for name, value in label.items():
        table.loc[table["session"] == "b", name] = value
    with pytest.raises(InputError, match=found):
        compared(table)
    row = compared(table, allow_mixed=True)[1].iloc[0]
    assert row["verdict"] == "mixed"
    assert row["mixed"].startswith(next(iter(label)))


def test_unknown_subjects_and_measures_are_named():
    table = rows([("a", [8.0], {})])
    with pytest.raises(InputError, match=r"subject p9: expected one of \['p1'\]"):
        longitudinal.of_subject(table, "p9")
    with pytest.raises(
        InputError, match=r"expected values of \['mass_speed'\], found \['neck_dist"
    ):
        longitudinal.of_subject(table, "p1", ["mass_speed"])


LABEL = {"session": "s", "take": "t1", "model": "net", "calibration": "file"}


def summary(path, value=2.0):
    table = pd.DataFrame(
        {
            "person": ["p1", "p1"],
            "measure": ["neck_distance", "knee_max"],
            "value": [value, 90.0],
            "sigma": [0.1, np.nan],
            "unit": ["m", "degrees"],
            "n": [9, 9],
            "definition": ["mid-shoulders", np.nan],
        }
    )
    table.to_csv(path, index=False)
    return path


def test_rows_carry_their_labels(tmp_path):
    paths = [summary(tmp_path / "a.csv"), summary(tmp_path / "b.csv", 3.0)]
    labels = [LABEL, LABEL | {"take": "t2"}]
    rows = longitudinal.read(paths, labels)
    assert list(rows.columns) == longitudinal.COLUMNS
    assert rows["take"].tolist() == ["t1", "t1", "t2", "t2"]
    assert rows["value"].tolist() == [2.0, 90.0, 3.0, 90.0]
    assert rows["subject"].unique().tolist() == ["p1"]
    assert rows["definition"].tolist()[:2] == ["mid-shoulders", ""]


def test_what_tells_of_the_record_is_compared_only_if_it_is_named():
    parts = ["neck_distance_in_gaps", "neck_ground_distance_measured", "neck_noise_memory"]
    table = pd.concat(
        [rows([("a", [1.0, 2.0], {})], measure=name) for name in ("neck_distance", *parts)]
    )
    assert set(longitudinal.of_subject(table, "p1")["measure"]) == {"neck_distance"}
    assert set(longitudinal.of_subject(table, "p1", parts[:1])["measure"]) == {parts[0]}
    assert set(longitudinal.of_movement(table)["measure"]) == {"neck_distance"}


def test_a_take_named_twice_and_a_table_without_units_are_refused(tmp_path):
    path = summary(tmp_path / "a.csv")
    with pytest.raises(InputError, match="found two of session s, take t1"):
        longitudinal.read([path, path], [LABEL, LABEL])
    pd.read_csv(path).drop(columns="unit").to_csv(path, index=False)
    with pytest.raises(InputError, match=r"a\.csv: expected the columns .* missing: \['unit'\]"):
        longitudinal.read([path], [LABEL])


def test_takes_are_found_in_the_table_of_the_study_as_in_their_own(tmp_path):
    one = pd.read_csv(summary(tmp_path / "a.csv")).fillna({"definition": ""})
    ways = [LABEL | {"fusion": "all"}, LABEL | {"fusion": "all", "take": "t2"}]
    table = pd.concat([one.assign(**way) for way in [*ways, LABEL | {"fusion": "two"}]])
    rows = longitudinal.of_study(table, ways)
    expected = longitudinal.read([tmp_path / "a.csv"] * 2, [LABEL, LABEL | {"take": "t2"}])
    pd.testing.assert_frame_equal(rows, expected)
    with pytest.raises(InputError, match=r"expected measures of s t3 net file all, found none"):
        longitudinal.of_study(table, [ways[0] | {"take": "t3"}])
