"""The table of the study: every measure with its way, verdict and origin, read back exactly."""

import hashlib

import pandas as pd
import pytest

from courtside.footwork import measures
from courtside.records import study_table, tables
from courtside.study.errors import InputError
from fixtures.study import report_made

LABELS = {"session": "hall", "take": "smash", **report_made.WAY}
PERSON = ["sfm-n40,all-robust,blazepose-full,all,p1,whole,,,,doubtful,,p1: few joints."]
PERSON += ["file,all-robust,blazepose-full,all,p1,whole,,,,failed,,p1: none."]


@pytest.fixture
def take(tmp_path):
    (tmp_path / "a.summary.csv").write_text(report_made.SUMMARY)
    (tmp_path / "quality.csv").write_text(report_made.VERDICTS + "\n".join(PERSON) + "\n")
    names = [tmp_path / name for name in ("a.summary.csv", "quality.csv")]
    return dict(zip(("measures_csv", "quality_csv"), names, strict=True))


def test_each_measure_has_way_verdict_and_origin(take):
    rows = study_table.of_take(**take, labels=LABELS, provenance="run/a.json")
    assert list(rows.columns) == list(study_table.COLUMNS)
    assert rows["measure"].tolist()[:2] == ["neck_distance", "neck_speed_mean"]
    assert rows["value"].tolist()[0] == 29.3274
    assert rows["sigma_camera"].isna().tolist() == [False, True, True, True, True]
    assert set(rows["quality"]) == {"doubtful"}
    assert rows.loc[0, list(LABELS)].to_dict() == LABELS
    assert set(rows["provenance"]) == {"run/a.json"}
    whole = hashlib.sha256(report_made.SUMMARY.encode()).hexdigest()
    assert set(rows["sha256"]) == {whole[:12]}
    other = study_table.of_take(
        **take, labels={**LABELS, "calibration": "file"}, provenance="run/a.json"
    )
    assert set(other["quality"]) == {"failed"}


def test_a_wrong_camera_makes_every_person_of_the_take_doubtful(take):
    quality_csv = take["quality_csv"]
    text = quality_csv.read_text().replace("p1,whole,,,,doubtful", "p1,whole,,,,good")
    way = ",".join(report_made.WAY.values())
    others = [line for line in text.splitlines() if not line.startswith(f"{way},all,all,whole")]
    wrong = ("calibration", "clock", "exchanged")
    expected = dict.fromkeys(wrong, "doubtful") | dict.fromkeys(("detection", "identity"), "good")
    for cause, quality in expected.items():
        for verdict in ("doubtful", "failed"):  # failed: for another person
            row = f"{way},all,all,whole,,,,{verdict},{cause},Look."
            quality_csv.write_text("\n".join([*others, row]) + "\n")
            rows = study_table.of_take(**take, labels=LABELS, provenance="run/a.json")
            assert set(rows["quality"]) == {quality}


def test_what_nobody_judged_has_no_verdict_and_is_read_back_as_it_was(take, tmp_path):
    rows = study_table.of_take(
        take["measures_csv"], {**LABELS, "take": "007"}, None, provenance="run/a.json"
    )
    tables.write(tmp_path / "study.csv", rows)
    back = study_table.read(tmp_path / "study.csv")
    assert set(back["quality"]) == {""}
    assert set(back["take"]) == {"007"}
    pd.testing.assert_frame_equal(back, rows.assign(quality=""), check_dtype=False)


def test_measures_of_the_feet_stand_beside_those_of_the_motion(take, tmp_path):
    stance = ("p1", "stance_time", 0.43, 0.005, "s", 65, "stance of a foot")
    tables.write(tmp_path / "feet.csv", pd.DataFrame([stance], columns=list(measures.COLUMNS)))
    both = {"labels": LABELS, "provenance": "run/b.json", "quality_csv": take["quality_csv"]}
    rows = study_table.of_take(tmp_path / "feet.csv", **both, camera_errors=False)
    tables.write(tmp_path / "study.csv", pd.concat([study_table.of_take(**{**both, **take}), rows]))
    (row,) = study_table.read(tmp_path / "study.csv").query("measure == 'stance_time'").itertuples()
    assert (row.value, row.sigma, row.unit, row.n) == (0.43, 0.005, "s", 65)
    assert (row.quality, row.provenance) == ("doubtful", "run/b.json")
    assert pd.isna(row.sigma_camera)
    with pytest.raises(InputError, match=r"feet\.csv: .* found no column sigma_camera"):
        study_table.of_take(tmp_path / "feet.csv", **both)


def test_another_table_is_refused(take):
    with pytest.raises(InputError, match=r"quality\.csv: expected a table of the study, found no"):
        study_table.read(take["quality_csv"])
