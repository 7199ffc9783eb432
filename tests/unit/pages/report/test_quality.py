"""The quality page: cameras, residuals, clocks, joints, each with the numbers of its file."""

import json
import math
import re

import pytest

from courtside.pages import page as pages
from courtside.pages.report import facts as report_facts
from courtside.pages.report import quality, warnings
from courtside.records.devices.clocks import Clock
from fixtures.study import report_made


def page(tmp_path, **changes):
    study = report_made.study(tmp_path)
    session = study["sessions"][0] | {"id": "quality-hall"}
    take = session["takes"][0]
    known = report_facts.of_take(take["files"]) | changes
    facts = report_facts.of_session(session["files"])
    found = [warnings.Warned(warnings.DOUBTFUL, "Calibration: odd.")]
    return quality.session(session, facts, found, [(take, known, [])])


def cells(html, first):
    row = re.search(rf"<tr><td[^>]*>{first}</td>(.*?)</tr>", html).group(1)
    return re.findall(r"<td[^>]*>(.*?)</td>", row)


def test_the_page_states_calibrations_and_residuals(tmp_path):
    html = page(tmp_path)
    assert "42 of 42 pictures registered, 2416 points" in re.sub(r"\s+", " ", html)
    assert cells(html, r"sfm-n40 \(takes\)") == ["2.00", "3.00", "0.70", "0.30", "0"]
    assert "Calibration: odd." in html


def test_the_page_says_which_calibration_was_used_and_why(tmp_path):
    html = re.sub(r"\s+", " ", page(tmp_path))
    assert "Takes are measured with the cameras <b>sfm-n40</b>: calibrated by one bundle" in html
    assert "Expected error over the playing volume: 0.70 cm." in html and "Refined from" not in html


def test_of_cameras_refined_by_people_both_qualities_and_the_verdict_are_said(tmp_path):
    study = report_made.study(tmp_path)
    refined = {"calibration": "sfm-n40-people", "taken": "refined", "expected_before_cm": 0.7}
    refined["wrong"] = ["f_px of camera c1: <odd>"]
    refined |= {"line": "cameras refined by people were taken", "warnings": ["c2 is lost"]}
    refined["remarks"] = [refined["line"], f"put right here: {refined['wrong'][0]}"]
    refined["remarks"].append("camera c1: moved at 3 s")
    (tmp_path / "refined.json").write_text(json.dumps(refined | {"expected_volume_rms_cm": 0.43}))
    session = study["sessions"][0] | {"id": "quality-hall", "calibration": "sfm-n40-people"}
    session["files"]["quality"]["sfm-n40-people"] = str(tmp_path / "refined.json")
    facts = report_facts.of_session(session["files"])
    take = session["takes"][0]
    takes = [(take, report_facts.of_take(take["files"]), [])]
    html = re.sub(r"\s+", " ", quality.session(session, facts, [], takes))
    assert "playing volume: 0.43 cm." in html
    assert "Refined from <b>sfm-n40</b> (calibrated by one bundle" in html
    assert "expected error there: 0.70 cm; the map of expected errors shows both." in html
    assert html.count("Cameras refined by people were taken.") == 1
    assert "<p>C2 is lost.</p>" in html and "ut right here" not in html
    assert "Contradicted by people: f_px of camera c1: &lt;odd&gt;." in html
    assert "<p>Camera c1: moved at 3 s.</p>" in html
    unknown = facts["quality"]["sfm-n40-people"] | {"expected_before_cm": None}
    facts["quality"]["sfm-n40-people"] = unknown | {"expected_volume_rms_cm": None}
    html = re.sub(r"\s+", " ", quality.session(session, facts, [], takes))
    assert "playing volume: not known, because neither a court nor points" in html
    assert "map of expected errors" not in html


def test_the_page_states_clocks_and_movement(tmp_path):
    html = page(tmp_path)
    assert cells(html, "c1")[:3] == ["found", "0.2000", "1.65"]
    assert cells(html, "c0") == ["0.10", "0.0010", "300"]
    assert "trembles by 0.01 px" in html


def test_the_page_states_what_speaks_against_a_clock(tmp_path):
    clocks = {"c1": Clock(0.2, status="found", note="offset adjusted", doubt="frames are missing")}
    rows = [
        {"source": "mocopi", "status": "found", "offset_s": 1.0, "uncertainty_s": 0.001} | more
        for more in ({"doubt": "sides exchanged"}, {"source": "d415", "doubt": math.nan})
    ]
    html = page(tmp_path, clocks=clocks, devices=rows, movement=[])
    assert cells(html, "c1")[-1] == "offset adjusted; frames are missing"
    assert cells(html, "mocopi")[-1] == "sides exchanged" and cells(html, "d415")[-1] == ""


def test_the_page_states_bumps_without_advice_that_was_followed(tmp_path):
    line = "camera c0: was 5.0 px off its static picture at the start of the take: steady its "
    html = page(tmp_path, shake=[f"{line}keypoints, or film the static picture again"])
    sentence = "Camera c0: was 5.0 px off its static picture at the start of the take. This was"
    assert sentence in html and "steady" not in html


def test_the_page_states_missing_joints_with_their_reasons(tmp_path):
    joints = {
        "left_wrist": {"missing": 0.25, "reasons": {"unseen": 0.2, "rejected": 0.05}, "few": None}
    }
    html = page(tmp_path, joints=joints)
    assert cells(html, "left wrist") == ["25.0 %", "20.0 %", "5.0 %", "–"]


def test_errors_of_simulated_takes_are_those_of_their_fusion(tmp_path):
    row = {"stage": "pose3d", "fusion": "all-robust", "person": "all", "joint": "limbs", "n": 9}
    row |= {"median_mm": 46.3, "p95_mm": 107.0, "coverage_90_percent": 34.1}
    others = [
        row | {"fusion": "all-dlt", "median_mm": 52.2},
        row | {"joint": "nose", "median_mm": 1.1},
    ]
    html = page(tmp_path, truth=[row, *others])
    assert cells(html, "raw") == ["46", "107", "34.1 %", "9"]
    assert ">52<" not in html and ">1<" not in html


def test_verdicts_are_stated_with_their_limits(tmp_path):
    html = page(tmp_path)
    assert "<td>It is 0.064 off.</td>" in html and "of another calibration" not in html
    assert "<td>above 0.035</td><td>above 0.1</td><td>doubtful</td>" in html
    assert "Agreement of the cameras: <b>doubtful</b>, likelier cause: clock. " in html


@pytest.mark.parametrize(
    ("measure", "doubtful", "failed", "stated"),
    [
        ("found", 0.9, 0.5, ("below 90%", "below 50%")),
        ("views_3", 0.5, 0.0, ("below 50%", "–")),
        ("limb_length", 0.09, 0.25, ("above 9%", "above 25%")),
        ("reprojection", 0.035, 0.1, ("above 0.035", "above 0.1")),
        ("found", math.nan, math.nan, ("–", "–")),
    ],
)
def test_limits_have_the_unit_of_their_sentence(measure, doubtful, failed, stated):
    row = {"measure": measure, "doubtful_from": doubtful, "failed_from": failed}
    assert (quality.limit(row, "doubtful_from"), quality.limit(row, "failed_from")) == stated


def test_sentences_are_no_numbers():
    html = pages.macro("report_parts.html", "cells")("90% of the joints rest on two.", "9.0 %", "–")
    assert html.count('class="number"') == 2 and "<td>90% of" in html


def test_cameras_without_a_static_recording_have_a_row_of_movement_too(tmp_path):
    names = {name: {"accepted": 1.0, "median_px": 1.0} for name in ("c0", "c9")}
    assert cells(page(tmp_path, cameras=names), "c9")[:3] == ["–", "–", "–"]
    assert "Movement since" not in page(tmp_path, cameras=names, movement=[])


def test_unknown_numbers_are_a_dash():
    assert quality.number(None) == quality.number(math.nan) == "–"
    assert quality.percent(None) == "–"
    assert quality.percent(0.123) == "12.3 %"


def test_tables_scroll_by_themselves_and_escape():
    table = pages.macro("report_parts.html", "table")
    html = table(("a",), [(report_made.ROGUE,)], report_made.ROGUE)
    assert html.startswith('<div class="scroll" tabindex="0" role="region"')
    assert "<img" not in html
    assert table(("a",), [], "nothing") == ""


def test_all_limits_of_the_marks_are_stated():
    html = quality.limits()
    assert html.count("<tr>") == len(warnings.LIMITS) + 1


def test_cameras_without_left_out_points_rest_on_no_clicks(tmp_path):
    quality_of = report_made.QUALITY
    free = {key: value for key, value in quality_of.items() if key != "left_out"}
    assert quality.clicked({"sfm-n40": quality_of}) and quality.clicked({})
    assert quality.clicked({"file": free}) and not quality.clicked({"sfm-n40": free})
    study = report_made.study(tmp_path)
    session = study["sessions"][0] | {"id": "quality-hall"}
    facts = report_facts.of_session(session["files"]) | {"quality": {"sfm-n40": free}}
    take = session["takes"][0]
    takes = [(take, report_facts.of_take(take["files"]), [])]
    html = re.sub(r"\s+", " ", quality.session(session, facts, [], takes))
    assert "pictures of a walk alone, without a court" in html and "clicked" not in html


def test_a_static_photo_has_no_count_of_matches(tmp_path):
    study = report_made.study(tmp_path)
    session = study["sessions"][0] | {"id": "quality-hall"}
    facts = report_facts.of_session(session["files"])
    unknown = {"shift_x_px": math.nan, "shift_y_px": math.nan, "zoom_percent": math.nan}
    facts["static"] = [{"camera": "photographed", **unknown, "n_matches": 0}]
    html = quality.session(session, facts, [], [])
    assert cells(html, "photographed") == ["–", "–", "–"]


@pytest.mark.parametrize("places", [{}, {"expected_extent_percent": 0.124}])
def test_cameras_without_a_court_have_expected_errors_without_a_scale(tmp_path, places):
    free = {"warnings": [], "tie_residual_px": 0.19, "expected_angle_deg": 0.2176, **places}
    session = report_made.study(tmp_path)["sessions"][0] | {"id": "quality-hall"}
    facts = report_facts.of_session(session["files"])
    page_of = {
        one: facts | {"quality": {"sfm-n40": one_of}}
        for one, one_of in (("free", free), ("court", report_made.QUALITY))
    }
    html = re.sub(r"\s+", " ", quality.session(session, page_of["free"], [], []))
    assert "from the tie points alone: 0.22 degrees in the rotation between two of them" in html
    assert ("0.12 % of their largest distance in their places" in html) == bool(places)
    assert "arbitrary" not in quality.session(session, page_of["court"], [], [])
