"""Figures 3.1 and 3.2: paths, circle and own arcs are where the swing of straight arms says."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.devices import thesis_fig3
from courtside.figures.style import source_styles
from fixtures import drawings
from fixtures.people import swung_arms

FLAT = "d415-rgb"
BODIES = [swung_arms.body(), swung_arms.body(FLAT, "rgb", depth=0.6, rate_hz=30)]
PATHS, DISTORTION = swung_arms.tables(BODIES)


def lines(axis, style, colour):
    return [
        line for line in axis.lines if line.get_linestyle() == style and line.get_color() == colour
    ]


def test_the_path_is_drawn_with_a_circle_it_cannot_follow_and_an_arc_it_does():
    drawing = thesis_fig3.draw(PATHS, DISTORTION, "mocopi")
    drawing.draw_without_rendering()
    (axis,) = drawing.axes
    assert axis.get_aspect() == 1
    circle = next(a for a in axis.lines if a.get_color() == thesis_fig3.CIRCLE)
    np.testing.assert_allclose(np.hypot(*circle.get_data()), 1)
    colour = source_styles.COLOURS["inertial"]
    drawn = np.concatenate([line.get_xydata() for line in lines(axis, "-", colour)])
    own = PATHS[PATHS["source"] == "mocopi"]
    np.testing.assert_array_equal(drawn, own[["x", "z"]])
    dashed = lines(axis, "--", thesis_fig3.ARC)
    assert len(dashed) == 2
    for sign, line in zip((1, -1), dashed, strict=True):
        x, z = line.get_data()
        np.testing.assert_allclose(np.hypot(x - sign * 0.3, z), 0.7, atol=1e-9)
        assert (sign * x).max() > 0.99 and (
            sign * x
        ).min() < 0  # from beside the body past the middle


def test_squares_mark_the_tpose_and_circles_the_clap():
    (axis,) = thesis_fig3.draw(PATHS, DISTORTION, "mocopi").axes
    ends = {
        mark: [a.get_xydata()[0] for a in axis.lines if a.get_marker() == mark] for mark in "so"
    }
    np.testing.assert_allclose(ends["s"], [[1, 0], [-1, 0]], atol=1e-9)
    np.testing.assert_allclose(ends["o"], [[0, np.sqrt(0.4)]] * 2, atol=1e-9)  # 0.7^2 - 0.3^2
    named = {text.get_text(): text.xy[0] for text in axis.texts}
    assert named == {"left wrist": pytest.approx(1), "right wrist": pytest.approx(-1)}


def test_a_wrist_that_is_lost_at_the_clap_has_no_mark_of_it():
    odd = PATHS.copy()
    right = odd.index[(odd["source"] == "mocopi") & (odd["side"] == "right")]
    odd.loc[right[-2:], ["x", "z"]] = np.nan
    odd.loc[odd.index[(odd["source"] == "mocopi") & (odd["side"] == "left")][0], ["x", "z"]] = (
        np.nan
    )
    (axis,) = thesis_fig3.draw(odd, DISTORTION, "mocopi").axes
    marks = {m: [a.get_xydata()[0] for a in axis.lines if a.get_marker() == m] for m in "so"}
    shown = {m: [at for at in found if np.isfinite(at).all()] for m, found in marks.items()}
    np.testing.assert_allclose(shown["s"], [[-1, 0]], atol=1e-9)
    np.testing.assert_allclose(shown["o"], [[0, np.sqrt(0.4)]], atol=1e-9)


def test_the_title_says_how_far_the_path_is_from_its_arc():
    title = thesis_fig3.draw(PATHS, DISTORTION, "mocopi").axes[0].get_title()
    assert title.startswith("mocopi: 61 frames in 1.00 s")
    assert "left 0.000 (0 mm), right 0.000 (0 mm)" in title
    # Depth shortened to 0.6: the mean of |hypot(cos, 0.6 sin) - 1| of the arm over the swing.
    turn = np.linspace(0, np.arccos(-3 / 7), 31)
    off = 0.7 * np.mean(1 - np.hypot(np.cos(turn), 0.6 * np.sin(turn)))
    title = thesis_fig3.draw(PATHS, DISTORTION, FLAT).axes[0].get_title()
    assert f"left {off:.3f} ({750 * off:.0f} mm)" in title


def test_all_sources_stand_side_by_side_on_equal_axes_with_the_truth():
    truth = PATHS[PATHS["source"] == "mocopi"].assign(source=FLAT)
    drawing = thesis_fig3.draw_all(PATHS, DISTORTION, truth=truth)
    drawing.draw_without_rendering()
    first, second = drawing.axes
    assert first.get_title().startswith("mocopi") and second.get_title().startswith(FLAT)
    assert first.get_xlim() == second.get_xlim() and first.get_ylim() == second.get_ylim()
    black = [len(lines(axis, "-", thesis_fig3.TRUE)) for axis in (first, second)]
    assert black == [0, 2]
    labels = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert "truth" in labels


@pytest.mark.parametrize("count", [1, 3, 4])
def test_any_number_of_sources_is_drawn(count):
    bodies = [swung_arms.body(f"c{at}-rgb", "rgb") for at in range(count)]
    drawing = thesis_fig3.draw_all(*swung_arms.tables(bodies))
    drawing.draw_without_rendering()
    shown = [axis for axis in drawing.axes if axis.axison]
    assert len(shown) == count
    assert all(axis.get_xlabel() for axis in shown[-min(3, count) :])


def test_the_legend_of_one_source_is_not_cut_off():
    own, off = (rows[rows["source"] == "mocopi"] for rows in (PATHS, DISTORTION))
    assert drawings.cut(thesis_fig3.draw_all(own, off)) == []
    assert drawings.cut(thesis_fig3.draw(own, off, "cameras")) == []


def test_a_source_without_arcs_says_so_in_its_panel():
    none = DISTORTION.assign(source="suit", n=0, mean_distance=np.nan, mean_off_circle=np.nan)
    none = none.drop_duplicates(["source", "side"])
    none[["shoulder_x", "shoulder_z", "radius"]] = np.nan
    for paths, distortion in (
        (PATHS.iloc[:0], none),
        (PATHS, pd.concat([DISTORTION, none], ignore_index=True)),
    ):
        drawing = thesis_fig3.draw_all(paths, distortion)
        drawing.draw_without_rendering()
        titles = [axis.get_title() for axis in drawing.axes if axis.axison]
        assert titles[-1] == f"suit\n{thesis_fig3.NO_ARCS}"
        assert len(titles) == distortion["source"].nunique()
    drawing = thesis_fig3.draw(PATHS.iloc[:0], none, "suit")
    assert drawing.axes[0].get_title() == f"suit: {thesis_fig3.NO_ARCS}"


def test_a_path_outside_the_usual_is_not_cut_off_and_missing_frames_do_no_harm():
    odd = PATHS.copy()
    odd.loc[0, ["x", "z"]] = np.nan
    odd.loc[5, "z"] = -0.9
    (axis,) = thesis_fig3.draw(odd, DISTORTION, "mocopi").axes
    assert axis.get_ylim()[0] < -0.9


def test_the_table_puts_each_points_arc_beside_it():
    rows = thesis_fig3.table(PATHS, DISTORTION, [FLAT])
    assert set(rows["source"]) == {FLAT} and len(rows) == 62
    np.testing.assert_allclose(rows["shoulder_x"].abs(), 0.3)
    off = np.hypot(rows["x"] - rows["shoulder_x"], rows["z"] - rows["shoulder_z"]) - rows["radius"]
    np.testing.assert_allclose(off, rows["off_arc"], atol=1e-9)
