"""Errors of sources: medians joint by joint, parts that fill the bar."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.devices import source_errors
from courtside.figures.style import source_styles

MEDIANS = {"mocopi": 60.0, "d415-rgb": 40.0}
SHARES = {"origin": 10.0, "scale": 20.0, "rotation": 25.0, "time": 5.0, "remainder": 40.0}
VALUES = {"origin": 12.0, "scale": 1.05, "rotation": 3.0, "time": -0.02}


def errors():
    alignments = (*source_errors.SHOWN, "trunk_frame", "procrustes_take")
    return pd.DataFrame(
        [
            (source, alignment, joint, 100, factor * median, 2 * factor * median)
            for source, median in MEDIANS.items()
            for factor, alignment in zip((1, 0.8, 0.5, 0.7, 0.6), alignments, strict=True)
            for joint in ("right_knee", "left_wrist", "nose", "right_wrist", "all")
        ],
        columns=["source", "alignment", "joint", "n", "median_mm", "p95_mm"],
    )


def angles():
    rows = [
        (source, stage, angle, 100, factor * median / 10)
        for source, median in MEDIANS.items()
        for stage, factor in (("source", 1.0), ("model", 0.5))
        for angle in (*source_errors.ANGLES, "left_knee_flexion")
    ]
    return pd.DataFrame(rows, columns=["source", "stage", "angle", "n", "rmse_deg"])


def parts(total=10000.0):
    rows = [
        (source, form, part, total * share / 100, share, VALUES.get(part, np.nan))
        for source in MEDIANS
        for form in source_errors.FORMS
        for part, share in {**SHARES, "all": 100.0}.items()
    ]
    return pd.DataFrame(
        rows, columns=["source", "frame", "part", "mean_square_mm2", "percent", "value"]
    )


@pytest.fixture(scope="module")
def drawing():
    made = source_errors.draw(errors(), angles(), parts())
    made.draw_without_rendering()
    return made


def test_joints_run_from_the_hands_down_and_end_with_all(drawing):
    labels = [text.get_text() for text in drawing.subfigs[0].axes[0].get_yticklabels()]
    assert labels == ["left wrist", "right wrist", "right knee", "nose", "all"]


@pytest.mark.parametrize(("panel", "factor"), [(0, 1.0), (1, 0.8), (2, 0.5)])
def test_each_alignment_has_its_panel_and_its_own_medians(drawing, panel, factor):
    axis = drawing.subfigs[0].axes[panel]
    words = ("unaligned", "root-relative", "Procrustes")[panel]
    assert axis.get_title().startswith(words)
    for source, median in MEDIANS.items():
        colour = source_styles.looks([source])[source].colour
        (line,) = (a for a in axis.lines if a.get_color() == colour)
        np.testing.assert_allclose(line.get_xdata(), factor * median)
    ends = np.concatenate([np.array(c.get_segments())[:, :, 0] for c in axis.collections])
    np.testing.assert_allclose(ends[:, 1], 2 * ends[:, 0])


def test_angles_have_a_panel_each_hollow_as_given_and_filled_after_the_model(drawing):
    axes = drawing.subfigs[1].axes
    titles = [axis.get_title() for axis in axes]
    assert titles == [angle.replace("_", " ") for angle in source_errors.ANGLES]
    marks = [line for line in axes[0].lines if line.get_marker() not in ("None", "")]
    hollow = [line.get_xdata()[0] for line in marks if line.get_markerfacecolor() == "none"]
    filled = [line.get_xdata()[0] for line in marks if line.get_markerfacecolor() != "none"]
    np.testing.assert_allclose(sorted(hollow), [4.0, 6.0])
    np.testing.assert_allclose(sorted(filled), [2.0, 3.0])


def test_parts_are_stacked_in_order_and_fill_the_bar(drawing):
    axis = drawing.subfigs[2].axes[0]
    bars = [patch for patch in axis.patches if abs(patch.get_y() + 0.33) < 1e-6]
    np.testing.assert_allclose([bar.get_width() for bar in bars], list(SHARES.values()))
    np.testing.assert_allclose([bar.get_x() for bar in bars], [0, 10, 30, 55, 60])
    label = axis.texts[0].get_text()
    assert label == "100 mm rms; shift 12 mm, scale 1.050\nturn 3.0°, time −20 ms"


def test_numbers_stand_free_between_the_bars(drawing):
    axis = drawing.subfigs[2].axes[0]
    texts = [text.get_window_extent() for text in axis.texts]
    bars = [patch.get_window_extent() for patch in axis.patches]
    assert len(texts) == len(MEDIANS)
    assert not [1 for text in texts for bar in bars if text.overlaps(bar)]
    assert min(text.y0 for text in texts) > axis.get_window_extent().y0


def test_a_correction_of_nearly_nothing_has_no_sign_of_minus():
    values = parts().assign(value=lambda rows: rows["value"].replace(-0.02, -0.0003))
    drawing = source_errors.draw(errors(), angles(), values)
    assert drawing.subfigs[2].axes[0].texts[0].get_text().endswith("time +0 ms")


def test_parts_have_no_colour_of_a_source():
    of_sources = {*source_styles.COLOURS.values(), source_styles.OTHER}
    assert not of_sources.intersection(source_errors.PARTS.values())


def test_a_source_without_common_frames_has_no_bar():
    unknown = parts().assign(mean_square_mm2=np.nan, percent=np.nan, value=np.nan)
    drawing = source_errors.draw(errors(), angles(), unknown)
    drawing.draw_without_rendering()
    assert {text.get_text() for text in drawing.subfigs[2].axes[0].texts} == {"no error known"}


def test_the_table_holds_the_alignments_drawn_and_all_parts():
    rows = source_errors.table(errors(), angles(), parts())
    shown = rows[rows["table"] == "errors"]
    assert set(shown["alignment"]) == set(source_errors.SHOWN)
    assert (rows["table"] == "parts").sum() == len(parts())
    assert set(rows.loc[rows["table"] == "angles", "angle"]) == set(source_errors.ANGLES)
