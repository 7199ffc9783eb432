"""Bars reach from the 5 to the 95 % quantile; hollow marks are hollow."""

import numpy as np
import pandas as pd

from courtside.figures.style import bars, style

ROWS = pd.DataFrame({"p05": [1.0, 2.0], "median": [3.0, 4.0], "p95": [5.0, 9.0]})


def test_bars_and_marks_show_the_rows():
    axis = style.figure(60).subplots()
    bars.draw(axis, np.array([10, 20]), ROWS, colour=style.LEFT, filled=False)
    ends = np.array(axis.collections[0].get_segments())
    np.testing.assert_allclose(ends, [[[10, 1], [10, 5]], [[20, 2], [20, 9]]])
    (line,) = axis.lines
    np.testing.assert_allclose(line.get_xydata(), [[10, 3], [20, 4]])
    assert line.get_markerfacecolor() == "white"


def test_a_level_is_a_band_about_its_median():
    axis = style.figure(60).subplots()
    bars.draw_level(axis, ROWS.iloc[1], colour=style.RIGHT)
    low, high = axis.patches[0].get_bbox().intervaly
    assert (low, axis.lines[0].get_ydata()[0], high) == (2.0, 4.0, 9.0)


def test_ticks_are_at_the_given_values_only():
    drawing = style.figure(60)
    axis = drawing.subplots()
    axis.plot([5, 300], [0.1, 100])
    bars.ticks_at(axis, [5, 75, 300])
    bars.plain_log(axis)
    drawing.draw_without_rendering()
    assert [text.get_text() for text in axis.get_xticklabels()] == ["5", "75", "300"]
    assert "0.1" in [text.get_text() for text in axis.get_yticklabels()]


def test_the_legend_shows_what_is_drawn():
    mark = bars.mark(style.LEFT, marker="s", filled=False, line="--", label="a")
    look = (mark.get_marker(), mark.get_linestyle(), mark.get_markerfacecolor(), mark.get_label())
    assert look == ("s", "--", "white", "a")


def test_labels_of_several_axes_are_named_once():
    axes = style.figure(60).subplots(1, 2)
    for axis in axes:
        for label in ("b", "a"):
            axis.plot([0, 1], label=label)
    axes[1].plot([0, 1], label="c")
    assert list(bars.named(axes)) == ["b", "a", "c"]
