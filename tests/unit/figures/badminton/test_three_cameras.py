"""Two, three and four cameras: numbers of the library's own evaluation, drawn in place."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation import joints
from courtside.figures.badminton import three_cameras
from fixtures.people import walker

OFFSET_M = {"two-robust": 0.06, "halfbody": 0.04, "three-robust": 0.02, "all-robust": 0.01}
CAMERAS = {way: [f"c{at}" for at in range(2)] for way in three_cameras.WAYS}


def evaluation(fusion, stage, offset_m, n_persons=1, take="footwork"):
    """Return what `evaluate_take` writes for a walk; the left side has twice the errors."""
    points = walker.points(40, n_persons)
    true = np.nan_to_num(points.xyz, nan=1.0)
    left = np.char.startswith(points.joints.astype(str), "left_")
    xyz = true + np.where(left, 2 * offset_m, offset_m)[:, None] * [0.6, 0.0, 0.8]
    found = joints.errors(replace(points, xyz=xyz), points.joints.tolist(), true)
    labels = {"session": "players-b", "take": take, "stage": stage, "calibration": "sfm-n40"}
    rows = joints.table(points.person_id, *found)
    return rows.assign(**labels, fusion=fusion, model="net", identity_percent=100.0)


def path(fusion, point, person="p1", median_mm=8.0, take="footwork"):
    labels = {"session": "players-b", "take": take, "calibration": "sfm-n40", "fusion": fusion}
    numbers = {"n": 40, "position_median_mm": median_mm, "position_p95_mm": 3 * median_mm}
    return {**labels, "model": "net", "person": person, "point": point, **numbers}


def made(takes=("footwork",), stages=("pose3d", "pose3d_corrected"), n_persons=1):
    errors = [
        evaluation(fusion, stage, offset_m / (at + 1), n_persons, take)
        for take in takes
        for fusion, offset_m in OFFSET_M.items()
        for at, stage in enumerate(stages)
    ]
    points = [
        path(way, p, take=take) for take in takes for way in OFFSET_M for p in ("neck", "centre")
    ]
    return three_cameras.table(pd.concat(errors), pd.DataFrame(points))


def test_no_two_fusions_have_the_same_words_although_they_have_the_same_cameras():
    three = {way: ["c0", "c1", "c2"] for way in ("halfbody", "three-robust", "all-robust")}
    drawing = three_cameras.draw(made(), CAMERAS | three)
    words = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert len(set(words)) == len(words) == len(OFFSET_M)


def test_the_legend_of_six_cameras_lies_on_the_page():
    names = ["oblique", "back", "mirror", "front", "left", "right"]
    drawing = three_cameras.draw(made(), dict.fromkeys(three_cameras.WAYS, names))
    drawing.draw_without_rendering()
    (legend,) = drawing.legends
    box, page = legend.get_window_extent(), drawing.bbox
    assert page.x0 <= box.x0 and box.x1 <= page.x1
    assert page.y0 <= box.y0 and box.y1 < drawing.axes[0].get_tightbbox().y0


def test_numbers_are_those_of_the_evaluation():
    rows = made()
    assert set(rows["joint"]) == set(three_cameras.ROWS)
    raw = rows[rows["stage"] == "pose3d"].set_index(["fusion", "joint"])
    assert raw.loc["halfbody"].index.tolist() == [*three_cameras.SETS, *three_cameras.JOINTS]
    assert raw.loc[("halfbody", "right_wrist"), "median_mm"] == pytest.approx(40)
    assert raw.loc[("halfbody", "left half"), "median_mm"] == pytest.approx(80)
    assert raw.loc[("halfbody", "limbs"), "n"] == 480
    whole = rows.set_index(["stage", "fusion", "joint"])
    assert whole.loc[("pose3d_corrected", "all-robust", "right_hip"), "median_mm"] == pytest.approx(
        5
    )
    assert whole.loc[("kinematics", "all-robust", "neck"), "p95_mm"] == 24


def test_what_the_paper_calls_stable_is_the_right_half_neck_and_centre():
    rows = made()
    claimed = set(rows.loc[rows["claimed"], "joint"])
    assert claimed == {"right half", "neck", "centre"} | {
        joint for joint in three_cameras.JOINTS if joint.startswith("right")
    }


def test_of_two_persons_the_worse_neck_counts_and_joints_are_together():
    errors = evaluation("two-robust", "pose3d", 0.05, n_persons=2)
    points = [path("two-robust", "neck", "p1", 8.0), path("two-robust", "neck", "p2", 11.0)]
    rows = three_cameras.table(errors, pd.DataFrame(points)).set_index("joint")
    assert (rows.loc["neck", "median_mm"], rows.loc["neck", "person"]) == (11, "p2")
    assert (rows.loc["limbs", "n"], rows.loc["limbs", "person"]) == (960, "all")


def marks(axis):
    return [line for line in axis.lines if line.get_marker() not in ("", "None", "|")]


def test_marks_stand_at_the_medians_of_raw_and_corrected():
    rows = made()
    raw, corrected, missing = three_cameras.draw(rows, CAMERAS).axes
    ways = [way for way in three_cameras.WAYS if way in OFFSET_M]
    at = three_cameras.ROWS.index("right_knee")
    for axis, share in ((raw, 1), (corrected, 2)):
        drawn = dict(zip(ways, marks(axis), strict=True))
        for way, offset_m in OFFSET_M.items():
            x, y = drawn[way].get_xydata()[at]
            assert x == pytest.approx(1000 * offset_m / share) and round(y) == at
    assert raw.get_xlim() == corrected.get_xlim()
    neck = three_cameras.ROWS.index("neck")
    assert np.isnan(marks(raw)[0].get_xdata()[neck])
    assert marks(corrected)[0].get_xdata()[neck] == 8
    assert marks(missing)[0].get_xdata()[at] == 0


def test_the_title_states_the_errors_of_two_cameras():
    drawing = three_cameras.draw(made(), CAMERAS)
    title = drawing.subfigs[0].get_suptitle()
    assert "2 cameras, fused with weights, filtered, joint offsets removed" in title
    assert "right half 30 (30), left half 60 (60), neck 8 (24), centre of gravity 8 (24)" in title


def test_takes_have_panels_of_their_own_and_no_offsets_are_said_to_be_none():
    drawing = three_cameras.draw(made(("footwork", "shot"), ("pose3d",)), CAMERAS)
    assert len(drawing.axes) == 6
    assert ["take shot" in part.get_suptitle() for part in drawing.subfigs] == [False, True]
    assert "no estimate" in drawing.axes[1].texts[0].get_text()


def test_without_kinematics_the_joints_are_drawn():
    errors = evaluation("all-robust", "pose3d", 0.02)
    rows = three_cameras.table(errors, pd.DataFrame())
    drawing = three_cameras.draw(rows, CAMERAS)
    assert "2 cameras" not in drawing.subfigs[0].get_suptitle()
    assert np.isfinite(marks(drawing.axes[0])[0].get_xdata()).sum() == 15
