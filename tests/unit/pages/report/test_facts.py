"""What the report reads: numbers as they stand in the files, and one line where a file is none."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.kinematics import cutoffs
from courtside.pages.report import facts as report_facts
from courtside.records.keypoints import missing_reason
from courtside.study.errors import InputError
from fixtures.people import walker
from fixtures.study import report_made


def test_measures_come_with_half_of_their_90_percent_interval(tmp_path):
    facts = report_facts.of_take(report_made.files_of_take(tmp_path))
    value, half, unit = facts["persons"]["p1"]["neck_distance"]
    assert (value, unit) == (29.3274, "m")
    assert half == pytest.approx(1.645 * np.hypot(0.2, 0.05))
    assert np.isnan(facts["persons"]["p1"]["neck_speed_max"][1])


def test_frames_that_are_left_out_are_counted(tmp_path):
    facts = report_facts.of_take(report_made.files_of_take(tmp_path, n_frames=20))
    assert facts["left_out"] == {"p1": (1, 20, {"uncertain": 1}, "")}
    assert facts["seconds"] == {"p1": (pytest.approx(18 / 50), "")}


def test_who_comes_later_or_leaves_earlier_is_counted_while_there(tmp_path):
    files = report_made.files_of_take(tmp_path, n_frames=20)
    words = ["unseen"] * 4 + ["ok", "ok", "unseen", "one_view", "ok", "ok"] + ["unseen"] * 10
    lines = [f"{at},{at / 10},p1,{word}" for at, word in enumerate(words)]
    lines += [f"{at},{at / 10},p2,unseen" for at in range(20)]
    Path(files["frames"]).write_text("\n".join(["frame_idx,time_s,person,neck_reason", *lines]))
    facts = report_facts.of_take(files)
    when = "from 0.4 to 0.9 s of the take"
    assert facts["left_out"]["p1"] == (2, 6, {"unseen": 1, "one_view": 1}, when)
    assert facts["left_out"]["p2"] == (20, 20, {"unseen": 20}, "")
    assert facts["seconds"]["p1"] == (pytest.approx(0.5), when)
    assert facts["part"] == {"p1": when}


@pytest.mark.parametrize(("n_seen", "told"), [(2, True), (12, False), (20, False)])
def test_who_is_lost_for_most_of_a_take_is_told(tmp_path, n_seen, told):
    files = report_made.files_of_take(tmp_path, n_frames=20)
    words = ["ok"] * n_seen + ["unseen"] * (20 - n_seen)
    lines = [f"{at},{at / 10},p1,{word}" for at, word in enumerate(words)]
    Path(files["frames"]).write_text("\n".join(["frame_idx,time_s,person,neck_reason", *lines]))
    part = report_facts.of_take(files)["part"]
    assert part == ({"p1": "from 0.0 to 0.1 s of the take"} if told else {})


def test_cut_offs_are_those_that_were_used(tmp_path):
    table = cutoffs.table({"arms": cutoffs.Choice(5.39, np.zeros(0), np.zeros(0), np.nan)}, 4)
    table.to_csv(tmp_path / "cutoffs.csv", index=False)
    facts = report_facts.of_take({"cutoffs": str(tmp_path / "cutoffs.csv")})
    assert facts["cutoffs"] == {"arms": 5.39}


def test_persons_called_by_digits_keep_their_names(tmp_path):
    files = report_made.files_of_take(tmp_path)
    for key in ("summary", "frames"):
        path = Path(files[key])
        path.write_text(path.read_text().replace("p1,", "01,"))
    facts = report_facts.of_take(files)
    assert list(facts["persons"]) == list(facts["left_out"]) == ["01"]


@pytest.mark.parametrize(("persons", "shown"), [(["p1"], ["p1"]), (["p1", "p2", "all"], ["all"])])
def test_errors_are_of_all_persons_together_or_of_the_only_one(tmp_path, persons, shown):
    row = {"stage": "pose3d", "fusion": "all-robust", "joint": "limbs", "median_mm": 40.0}
    table = pd.DataFrame([row | {"person": person} for person in persons])
    table.to_csv(tmp_path / "errors.csv", index=False)
    facts = report_facts.of_take({"errors": str(tmp_path / "errors.csv")})
    assert [row["person"] for row in facts["truth"]] == shown


def test_a_take_without_files_is_empty():
    facts = report_facts.of_take({})
    assert not any(facts.values())


def test_missing_joints_are_counted_by_reason():
    made = walker.points(n_frames=10, n_cameras=3)
    wrist = list(made.joints).index("left_wrist")
    made.xyz[:, :4, wrist] = np.nan
    made.reason[:, :3, wrist], made.reason[:, 3, wrist] = (
        missing_reason.UNSEEN,
        missing_reason.REJECTED,
    )
    made.n_views[:, 4:, wrist] = 2
    facts = report_facts.of_skeleton(made)
    assert facts["joints"]["left_wrist"] == {
        "missing": pytest.approx(0.4),
        "reasons": {"unseen": pytest.approx(0.3), "rejected": pytest.approx(0.1)},
        "few": 1.0,
    }
    assert facts["joints"]["right_ankle"] == {"missing": 0.0, "reasons": {}, "few": 0.0}
    assert len(facts["joints"]) == 12
    assert sum(facts["views"].values()) == pytest.approx(1.0)


def test_joints_are_missing_only_while_their_person_is_there():
    made = walker.points(n_frames=10, n_persons=2)
    for lost in (np.s_[1, 5:], np.s_[1, :2], np.s_[1, 3, list(made.joints).index("left_wrist")]):
        made.xyz[lost], made.reason[lost], made.n_views[lost] = np.nan, missing_reason.UNSEEN, 0
    joints = report_facts.of_skeleton(made)["joints"]
    assert joints["right_ankle"] == {"missing": 0.0, "reasons": {}, "few": 0.0}
    assert joints["left_wrist"]["missing"] == pytest.approx(1 / 13)
    made.xyz[1], made.reason[1] = np.nan, missing_reason.UNSEEN
    joints = report_facts.of_skeleton(made)["joints"]
    assert joints["right_ankle"]["missing"] == pytest.approx(0.5)


def test_a_contradicted_camera_has_a_low_accepted_share():
    made = walker.points(n_frames=10, n_cameras=3)
    made.accepted[..., 1] = False
    made.accepted[:, ::2, :, 1] = True
    made.reproj_error_px[..., 1] = 30.0
    made.reproj_error_px[:, ::2, :, 1] = 4.0
    facts = report_facts.of_skeleton(made)["cameras"]
    assert facts["c1"] == {"accepted": pytest.approx(0.5, abs=0.02), "median_px": 4.0}
    assert facts["c0"]["accepted"] == 1.0


def test_a_session_gives_quality_model_and_movement(tmp_path):
    files = report_made.study(tmp_path)["sessions"][0]["files"]
    facts = report_facts.of_session(files)
    assert facts["quality"]["sfm-n40"]["expected_volume_rms_cm"] == 0.7
    assert facts["model"]["n_registered"] == 42
    assert facts["static"][0]["camera"] == "c0"


@pytest.mark.parametrize("key", ["summary", "frames"])
def test_a_file_that_is_not_a_table_is_named(tmp_path, key):
    files = report_made.files_of_take(tmp_path)
    files[key] = str(tmp_path / "c0.csv")
    with pytest.raises(InputError, match=r"c0\.csv: expected a table"):
        report_facts.of_take(files)


def test_a_quality_file_that_is_not_json_is_named(tmp_path):
    (tmp_path / "quality.json").write_text("{")
    with pytest.raises(InputError, match=r"quality\.json: expected JSON"):
        report_facts.of_session({"quality": {"file": tmp_path / "quality.json"}})
    (tmp_path / "quality.json").write_text(json.dumps({"warnings": []}))
    assert report_facts.of_session({"quality": {"file": tmp_path / "quality.json"}})["model"] == {}


def test_warnings_of_a_check_join_those_of_the_calibration_file(tmp_path):
    (tmp_path / "quality.json").write_text(json.dumps({"covariance": "unknown"}))
    (tmp_path / "check.json").write_text(json.dumps({"warnings": ["cam02 is mirrored"]}))
    (tmp_path / "court.json").write_text(json.dumps({"warnings": ["cam05 was turned"]}))
    videos = {"warnings": [], "remarks": ["cam04 was not judged"]}
    (tmp_path / "videos.json").write_text(json.dumps(videos))
    checks = [tmp_path / f"{name}.json" for name in ("videos", "court", "check")]
    files = {"quality": {"file": tmp_path / "quality.json"}, "checks": checks}
    facts = report_facts.of_session(files)
    assert facts["quality"]["file"] == {
        "covariance": "unknown",
        "warnings": ["cam05 was turned", "cam02 is mirrored"],
        "remarks": ["cam04 was not judged"],
    }


def test_a_check_without_a_fault_says_what_agrees(tmp_path):
    (tmp_path / "quality.json").write_text(json.dumps({}))
    check = {"warnings": [], "disagree_px": {"static": 1.68, "people": 4.91}}
    (tmp_path / "check.json").write_text(json.dumps(check))
    (tmp_path / "court.json").write_text(json.dumps({"warnings": [], "n_agreeing": 3}))
    checks = [tmp_path / f"{name}.json" for name in ("check", "court")]
    files = {"quality": {"file": tmp_path / "quality.json"}, "checks": checks}
    found = "the check found no fault: "
    assert report_facts.of_session(files)["quality"]["file"]["remarks"] == [
        f"{found}views of points at rest disagree by 1.7 px per axis, "
        "views of people disagree by 4.9 px per axis",
        f"{found}3 cameras see the court's lines at the same place",
    ]
    (tmp_path / "check.json").write_text(json.dumps(check | {"warnings": ["x"]}))
    (tmp_path / "court.json").write_text(json.dumps({"warnings": [], "n_agreeing": 1}))
    assert report_facts.of_session(files)["quality"]["file"]["remarks"] == []


def test_verdicts_are_those_of_the_way_that_is_reported(tmp_path):
    rows = report_facts.of_take(report_made.files_of_take(tmp_path))["quality"]
    assert {row["calibration"] for row in rows} == {"sfm-n40"} and len(rows) == 3
    assert rows[2]["value"] == 0.064 and np.isnan(rows[0]["value"])
