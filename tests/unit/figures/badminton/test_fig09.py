"""Each step's numbers against OpenCV's projections and the skeleton that was put in."""

import numpy as np
import pandas as pd

from courtside.figures.badminton import fig09
from courtside.figures.style import picture_crops
from fixtures.cameras import scene
from fixtures.people import takes_made, walker

FRAME = 8


def measured(record):
    columns = {"time_s": record.time_s, "person": "p1"}
    columns |= {f"{name}_ground_speed_m_s": 1.0 for name in ("neck", "mass")}
    columns |= {
        f"{name}_deg": 20.0 for name in ("left_knee_flexion", "right_knee_flexion", "trunk_lean")
    }
    return pd.DataFrame(columns)


def test_the_table_holds_every_step():
    record, seen = takes_made.take(n_persons=2, offset_px=(3.0, -4.0))
    rows = fig09.table(record, seen, FRAME, takes_made.STICK)
    assert list(rows.columns) == fig09.COLUMNS
    assert len(rows) == 3 * 2 * 14
    at = rows[(rows.camera == "c1") & (rows.person == "p2") & (rows.joint == "right_knee")].iloc[0]
    xyz = record.xyz[1, FRAME, list(record.joints).index("right_knee")]
    exact = scene.opencv_projection(takes_made.CAMERAS[1], xyz[None])[0]
    np.testing.assert_allclose([at.x_m, at.y_m, at.z_m], xyz)
    np.testing.assert_allclose([at.reprojected_x_px, at.reprojected_y_px], exact, atol=1e-6)
    np.testing.assert_allclose(
        [at.detected_x_px, at.detected_y_px], exact + np.array([3, -4]), atol=1e-6
    )
    assert rows.round_trip_mm.max() < 1e-6


def test_the_drawing_has_every_step_in_every_camera():
    record, seen = takes_made.take()
    rows = fig09.table(record, seen, FRAME, takes_made.STICK)
    drawing = fig09.draw(
        rows, takes_made.pictures(), record, takes_made.CAMERAS, takes_made.STICK, measured(record)
    )
    assert len(drawing.axes) == 3 + 3 + 4 + 3
    words = [part.get_suptitle() for part in drawing.subfigs]
    assert words[0].startswith("1") and "2" in words[1] and "identity" in words[3]
    moments = [
        line.get_xdata()[0]
        for axis in drawing.axes
        if "speed" in axis.get_ylabel() or "angle" in axis.get_ylabel()
        for line in axis.lines
        if len(line.get_xdata()) == 2
    ]
    np.testing.assert_allclose(moments, record.time_s[FRAME])
    drawing.draw_without_rendering()


def test_boxes_in_the_pictures_hold_the_person_that_is_enlarged():
    record, seen = takes_made.take()
    rows = fig09.table(record, seen, FRAME, takes_made.STICK)
    drawing = fig09.draw(
        rows, takes_made.pictures(), record, takes_made.CAMERAS, takes_made.STICK, measured(record)
    )
    for at, name in enumerate(("c0", "c1", "c2")):
        (box,) = drawing.axes[at].patches
        enlarged = drawing.axes[3 + at]
        np.testing.assert_allclose(
            [box.get_x(), box.get_x() + box.get_width()], enlarged.get_xlim()
        )
        own = rows[rows.camera == name]
        assert own.detected_x_px.between(*enlarged.get_xlim()).all()
        assert own.detected_y_px.between(*sorted(enlarged.get_ylim())).all()


def test_a_camera_that_does_not_film_then_says_so_in_place_of_a_picture():
    record, seen = takes_made.take()
    seen[1] = takes_made.stopped(seen[1], 5)
    rows = fig09.table(record, seen, FRAME, takes_made.STICK)
    empty = rows[["detected_x_px", "reprojected_x_px"]].isna().all(axis=1)
    assert set(rows[empty].camera) == {"c1"} and empty.sum() == 14
    assert rows.x_m.notna().all()
    images = takes_made.pictures()
    images["c1"], *_ = picture_crops.at_frame(seen[1], record, FRAME, walker.SKELETON, hidden=True)
    drawing = fig09.draw(
        rows, images, record, takes_made.CAMERAS, takes_made.STICK, measured(record)
    )
    panels = [*drawing.axes[:6], *drawing.axes[-3:]]
    words = [[text.get_text() for text in axis.texts] for axis in panels]
    assert words == [[], ["does not film then"], []] * 3
    assert [len(axis.patches) for axis in drawing.axes[:3]] == [1, 0, 1]
    drawing.draw_without_rendering()
