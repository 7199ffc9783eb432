"""Warnings: what is well gives none, what is not gives one that names it, as serious as it is."""

import math
import re

import numpy as np
import pytest

from courtside.pages.report import warnings as warned
from courtside.reconstruction import camera_shake
from courtside.records.devices import clocks
from courtside.records.devices.clocks import Clock
from fixtures.cameras import scene, shaken

STILL = {
    "camera": "left",
    "shift_x_px": 0.1,
    "shift_y_px": 0.0,
    "zoom_percent": 0.01,
    "n_matches": 300,
}
NOTHING = dict.fromkeys(("movement", "shake", "devices", "quality", "true_paths"), ())
NOTHING |= {"persons": {}, "clocks": {}, "joints": {}, "left_out": {}, "part": {}}
QUALITY = {"warnings": [], "left_out": {"p01": {"error_cm": 0.5}}, "expected_volume_rms_cm": 0.7}


def level(found):
    return None if found is None else found.level


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ({}, None),
        ({"shift_x_px": 0.6}, warned.DOUBTFUL),
        ({"shift_x_px": 0.8, "shift_y_px": -0.8}, warned.FAILED),
        ({"zoom_percent": -0.15}, warned.DOUBTFUL),
        (
            {"shift_x_px": math.nan, "shift_y_px": math.nan, "zoom_percent": math.nan},
            warned.DOUBTFUL,
        ),
    ],
)
def test_a_moved_camera_gives_a_warning_with_its_name(row, expected):
    found = warned.moved(STILL | row, max_shift_px=1.0, max_zoom_percent=0.2)
    assert level(found) == expected
    assert found is None or "left" in found.text


@pytest.mark.parametrize(
    ("clock", "expected"),
    [
        (Clock(status="reference"), None),
        (Clock(status="assumed"), warned.GOOD),
        (Clock(status="found", uncertainty_s=0.002), None),
        (Clock(status="found", uncertainty_s=0.006), warned.DOUBTFUL),
        (Clock(status="found", uncertainty_s=0.02), warned.FAILED),
        (Clock(status="found", uncertainty_s=math.nan), warned.DOUBTFUL),
        (Clock(status="ambiguous"), warned.FAILED),
        (Clock(status="unknown"), warned.FAILED),
    ],
)
def test_an_uncertain_clock_gives_a_warning(clock, expected):
    assert level(warned.clock("back", clock)) == expected


def test_an_unknown_uncertainty_of_a_clock_is_called_unknown():
    camera = warned.clock("back", Clock(status="found", uncertainty_s=math.nan))
    assert camera.text == "Camera back: the uncertainty of its clock is unknown."
    row = {"source": "mocopi", "status": "found", "uncertainty_s": math.nan}
    assert warned.device(row).text == "mocopi: the uncertainty of its clock is unknown."


@pytest.mark.parametrize(
    ("clock", "words"),
    [
        (Clock(status="assumed"), "is assumed to be that of the first camera"),
        (Clock(5.3, status="assumed"), "is as the session states it"),
        (Clock(drift_ppm=20.0, status="assumed"), "is as the session states it"),
    ],
)
def test_a_clock_that_was_not_checked_is_told_where_it_comes_from(clock, words):
    message = warned.clock("back", clock).text
    assert message == f"Camera back: its clock {words}; this was not checked."


def test_a_stated_clock_is_judged_by_its_stated_uncertainty():
    stated = clocks.stated({"back": {"offset_s": 1.2, "uncertainty_s": 0.05}})["back"]
    assert warned.clock("back", stated).level == warned.FAILED
    exact = clocks.stated({"back": {"offset_s": 1.2, "uncertainty_s": 0.001}})["back"]
    said = warned.clock("back", exact)
    assert said.level == warned.GOOD and "as the session states it" in said.text


def test_what_speaks_against_a_clock_makes_a_take_doubtful():
    doubt = "from 0 to 6 s of its video, it agrees better -133 ms beside this clock"
    found = {
        "left": Clock(status="reference", doubt=doubt),
        "back": Clock(1.3, uncertainty_s=0.001, status="found"),
    }
    devices = [
        {"source": "mocopi", "status": "found", "uncertainty_s": 0.001, "doubt": "sides exchanged"},
        {"source": "d415", "status": "found", "uncertainty_s": 0.001, "doubt": math.nan},
    ]
    said = warned.of_take(
        NOTHING | {"clocks": found, "devices": devices}, max_shift_px=1.0, max_zoom_percent=0.2
    )
    assert said == [
        (warned.DOUBTFUL, f"Camera left: its clock is in doubt: {doubt}."),
        (warned.DOUBTFUL, "mocopi: its clock is in doubt: sides exchanged."),
    ]


def test_a_clock_error_is_also_given_as_the_path_of_a_fast_wrist():
    found = warned.clock("back", Clock(status="found", uncertainty_s=0.01))
    assert "16 ms" in found.text and "20 cm" in found.text  # 12 m/s times 16.45 ms


def shake(knock_px=0.0, offset_px=0.0, unknown=0, zoom_percent=0.0):
    """Return the lines about a camera that stands off, is knocked, partly unknown and zoomed."""
    (camera,) = scene.ring(1)
    time_s = np.arange(240) / 30
    table = shaken.table(camera, shaken.knock(camera, 240, 120, knock_px, 0.1), time_s)
    table["shift_x_px"] += offset_px
    table["zoom_percent"] = zoom_percent
    table.loc[: unknown - 1, "shift_x_px"] = np.nan
    return camera_shake.say(camera, table, np.array([0.0, 0.0, 1.0]))


def test_a_bump_is_reported_without_advice_that_was_followed():
    tremor, off, bump = map(warned.shaken, shake(knock_px=15.0, offset_px=5.0))
    assert tremor.level == warned.GOOD and off.level == bump.level == warned.DOUBTFUL
    assert tremor.text.startswith("Camera c0: trembles by 0.")
    done = ". This was measured on the background and corrected."
    assert off.text.startswith("Camera c0: was 5.0 px off its static picture at the start")
    assert off.text.endswith(f" at the player{done}")
    assert bump.text.startswith("Camera c0: knocked at 4.0 s by 15 px (")
    assert bump.text.endswith(f" at the player){done}")


def test_a_zoom_is_reported_as_not_corrected():
    found = warned.shaken(shake(zoom_percent=0.5)[-1])
    assert found.level == warned.DOUBTFUL and "zoomed by +0.50 %" in found.text
    assert "corrected" not in found.text and "leave it out" in found.text


@pytest.mark.parametrize("unknown", [10, 240])
def test_frames_without_background_are_reported_as_unknown(unknown):
    found = warned.shaken(shake(unknown=unknown)[0])
    assert found.level == warned.DOUBTFUL
    assert "background to tell" in found.text and "corrected" not in found.text


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({}, []),
        ({"left_out": {"p01": {"error_cm": 2.5}}}, []),
        (
            {"left_out": {"p01": {"error_cm": 2.5}}, "expected_volume_rms_cm": None},
            [warned.DOUBTFUL],
        ),
        ({"left_out": {"p01": {"error_cm": 9.0}}, "expected_volume_rms_cm": 6.0}, [warned.FAILED]),
        ({"tie_residual_px": 1.5}, [warned.DOUBTFUL]),
        ({"warnings": ["the lines' middles were clicked"]}, [warned.DOUBTFUL]),
        ({"left_out": "too few points", "expected_volume_rms_cm": 0.7}, [warned.DOUBTFUL]),
        ({"left_out": {}, "expected_volume_rms_cm": None}, []),
    ],
)
def test_a_bad_calibration_gives_warnings(change, expected):
    assert [item.level for item in warned.calibration("sfm-n40", QUALITY | change)] == expected


@pytest.mark.parametrize(
    ("name", "unknown"),
    [("file", True), ("dlt8", True), ("known8", True)]
    + [(name, False) for name in ("board", "wand", "people", "known", "file-people", "sfm-n40")],
)
def test_without_a_court_only_cameras_without_a_covariance_are_of_unknown_accuracy(name, unknown):
    found = warned.calibration(name, {"warnings": []})
    assert len(found) == unknown
    assert not unknown or "the error bars do not include its error" in found[0].text


def test_cameras_of_a_file_with_a_covariance_are_judged_by_their_expected_error():
    known = {"covariance": "data/hall/covariance.npz"}
    assert warned.calibration("file", known) == []
    (found,) = warned.calibration("file", known | {"expected_volume_rms_cm": 2.5})
    assert found.level == warned.DOUBTFUL and "2.5 cm" in found.text
    (found,) = warned.calibration("file", {"covariance": "unknown: the file gives none"})
    assert "the error bars do not include its error" in found.text


def test_cameras_judged_by_points_alone_are_not_in_the_error_bars():
    (found,) = warned.calibration("known18", {"left_out": {"p01": {"error_cm": 0.5}}})
    assert found.level == warned.GOOD
    assert found.text == "Calibration known18: the error bars do not include its error."


@pytest.mark.parametrize(("name", "fitted"), [("known8", True), ("sim3-n40", False)])
def test_an_error_of_points_that_the_cameras_were_fitted_to_says_so(name, fitted):
    (found,) = (
        each
        for each in warned.calibration(name, {"left_out": {"p01": {"error_cm": 3.0}}})
        if each.level == warned.DOUBTFUL
    )
    words = f"Calibration {name}: the median error of clicked points, each aligned to the others, "
    hidden = "; the cameras were fitted to these points, which hides a part of the error"
    assert found.text == words + "is 3.0 cm" + hidden * fitted + "."


def test_the_median_of_points_that_were_left_out():
    errors = dict(zip("abcd", (1.0, 9.0, 3.0, None), strict=True))
    quality = {"left_out": {name: {"error_cm": error} for name, error in errors.items()}}
    assert warned.left_out_cm(quality) == 3.0
    assert warned.left_out_cm({"left_out": "why not"}) is None


@pytest.mark.parametrize(
    ("lost", "expected"), [(0, None), (6, warned.DOUBTFUL), (20, warned.FAILED)]
)
def test_pictures_that_were_not_registered_are_counted(lost, expected):
    found = warned.registered({"n_images": 42, "n_registered": 42 - lost})
    assert level(found) == expected
    assert not lost or f"{lost} of 42" in found.text


def verdict(word, camera="c1", person="all", measure="whole"):
    warning = "Camera c1: its clock is off."
    row = {"camera": camera, "person": person, "measure": measure, "verdict": word}
    return row | {"cause": "clock", "sentence": warning}


def test_a_camera_that_is_not_good_is_told_with_its_cause():
    assert warned.judged([verdict("good")]) == []
    told = warned.judged([verdict("doubtful")])
    assert told == [(warned.DOUBTFUL, "Camera c1: its clock is off.")]
    assert level(*warned.judged([verdict("failed")])) == warned.FAILED
    assert level(*warned.judged([verdict("failed", camera="all", person="p1")])) == warned.FAILED


def test_the_take_and_single_measures_are_not_told_twice():
    take, camera = verdict("failed", camera="all"), verdict("doubtful")
    assert warned.judged([take, camera]) == warned.judged([camera])
    assert warned.judged([verdict("failed", measure="found")]) == []


def test_a_take_that_is_doubtful_though_its_cameras_agree_is_told():
    take = verdict("doubtful", camera="all")
    assert warned.judged([take, verdict("good")]) == [(warned.DOUBTFUL, take["sentence"])]


def test_remarks_of_a_calibration_are_for_information():
    told = warned.calibration("sfm-n40", QUALITY | {"remarks": ["cameras were refined"]})
    assert told == [(warned.GOOD, "Calibration: cameras were refined.")]


def joint(missing=0.0, few=0.0):
    return {"missing": missing, "reasons": {}, "few": few}


def test_the_joint_that_is_missing_most_often_is_named():
    assert warned.joints({"left_knee": joint(), "left_hip": joint()}) == []
    (found,) = warned.joints({"left_knee": joint(0.3), "left_hip": joint(0.1)})
    assert found.level == warned.FAILED
    assert "20%" in found.text and "left knee (30%)" in found.text
    (alone,) = warned.joints({"left_knee": joint(few=0.9)})
    assert alone.level == warned.DOUBTFUL and "only two cameras" in alone.text
    assert warned.joints({}) == []


def test_frames_left_out_give_a_warning_with_the_reason():
    assert warned.frames("p1", 1, 100, {"uncertain": 1}) is None
    found = warned.frames("p1", 30, 100, {"uncertain": 20, "one_view": 10})
    assert found.level == warned.FAILED
    assert "30 of 100" in found.text and "too uncertain" in found.text
    assert "one view" in warned.frames("p1", 10, 100, {"one_view": 10}).text
    when = "from 0.0 to 3.0 s of the take"
    assert f"10 of 100 frames {when};" in warned.frames("p1", 10, 100, {"unseen": 10}, when).text


def test_who_is_there_for_a_small_part_of_a_take_is_told():
    facts = NOTHING | {"part": {"p1": "from 0.0 to 2.0 s of the take"}}
    (found,) = warned.of_take(facts, max_shift_px=1.0, max_zoom_percent=0.2)
    assert found.level == warned.GOOD
    assert found.text == "p1: two cameras see this person only from 0.0 to 2.0 s of the take."


def test_a_truth_outside_the_error_bar_gives_a_warning():
    row = {"person": "m3", "point": "neck", "distance_sigma_percent": 1.0}
    assert warned.true_path(row | {"distance_error_percent": -1.6}) is None
    found = warned.true_path(row | {"distance_error_percent": -2.3})
    assert found.level == warned.DOUBTFUL and "the distance is 2.3 % too short;" in found.text
    measured, true = 15.0, 10.0
    found = warned.true_path(row | {"distance_error_percent": 100 * (measured / true - 1)})
    assert "the distance is 50.0 % too long;" in found.text
    assert warned.true_path(row | {"distance_error_percent": math.nan}) is None
    assert warned.true_path(row | {"point": "mass", "distance_error_percent": 9.0}) is None


@pytest.mark.parametrize(
    ("value", "half", "expected"),
    [
        (2.0, 0.05, None),
        (2.0, 0.2, warned.DOUBTFUL),
        (2.0, 0.5, warned.FAILED),
        (2.0, math.nan, warned.DOUBTFUL),
        (math.nan, math.nan, warned.FAILED),
    ],
)
def test_an_uncertain_distance_gives_a_warning(value, half, expected):
    measures = {"neck_distance": (value, half, "m")}
    assert level(warned.distance("p1", measures)) == expected


@pytest.mark.parametrize(
    ("bias", "measured", "gaps", "why"),
    [
        (0.1, 8.0, math.nan, "a gap in its path is too long to bridge; cut the take .*`trim_s`"),
        (math.nan, 8.0, math.nan, "the errors of the joints are not known, .* measure with videos"),
        (math.nan, 8.0, 0.0, "the errors of the joints are not known, .* measure with videos"),
        (math.nan, 0.0, math.nan, "its path is known in no frame; see which joints"),
    ],
)
def test_an_unknown_distance_has_its_cause_and_remedy(bias, measured, gaps, why):
    values = {"": math.nan, "_noise_bias": bias, "_measured": measured, "_in_gaps": gaps}
    measures = {f"neck_distance{what}": (each, 0.0, "m") for what, each in values.items()}
    found = warned.distance("p1", measures)
    assert found.level == warned.FAILED
    assert re.fullmatch(f"p1: the distance of the neck is unknown: {why}.*\\.", found.text)


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ({"status": "reference", "uncertainty_s": 0.0}, None),
        ({"status": "found", "uncertainty_s": 0.017}, warned.DOUBTFUL),
        ({"status": "unknown", "uncertainty_s": math.nan}, warned.FAILED),
    ],
)
def test_an_uncertain_clock_of_a_device_gives_a_warning(row, expected):
    assert level(warned.device({"source": "mocopi"} | row)) == expected


def test_a_device_without_a_tpose_gives_a_warning():
    warning = warned.no_tpose({"source": "mocopi", "n_tposes": 0})
    assert warning.level == warned.DOUBTFUL
    assert warning.text.startswith("mocopi: it shows no T-pose")
    assert warned.no_tpose({"source": "mocopi", "n_tposes": 1}) is None


def test_warnings_are_sorted_by_level():
    facts = {
        "persons": {},
        "movement": [STILL | {"shift_x_px": 0.6}],
        "shake": [],
        "clocks": {"back": Clock(status="unknown"), "left": Clock(status="assumed")},
        "devices": [],
        "quality": [verdict("good")],
        "joints": {},
        "left_out": {},
        "part": {},
        "true_paths": [],
    }
    found = warned.of_take(facts, max_shift_px=1.0, max_zoom_percent=0.2)
    assert [item.level for item in found] == [warned.FAILED, warned.DOUBTFUL, warned.GOOD]
    assert warned.worst(found) == warned.FAILED
    assert warned.worst([]) == warned.GOOD


def test_a_session_is_judged_by_the_calibration_of_its_takes():
    facts = {
        "static": [STILL],
        "quality": {"file": QUALITY | {"warnings": ["x"]}, "known8": QUALITY},
        "model": {},
    }
    limits = {"max_shift_px": 1.0, "max_zoom_percent": 0.2}
    assert warned.of_session(facts, "known8", **limits) == []
    assert len(warned.of_session(facts, "file", **limits)) == 1
    assert warned.of_session(facts, None, **limits) == []


def test_a_static_photo_is_no_fault():
    unknown = dict.fromkeys(("shift_x_px", "shift_y_px", "zoom_percent"), math.nan)
    facts = {"static": [STILL | unknown | {"n_matches": 0}], "quality": {}, "model": {}}
    (found,) = warned.of_session(facts, None, max_shift_px=1.0, max_zoom_percent=0.2)
    assert found.level == warned.GOOD
    assert "left: its static recording is a photo" in found.text
    moved = facts | {"static": [STILL | {"shift_x_px": 3.0}]}
    (found,) = warned.of_session(moved, None, max_shift_px=1.0, max_zoom_percent=0.2)
    assert found.level == warned.FAILED
