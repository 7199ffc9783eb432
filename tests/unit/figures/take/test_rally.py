"""The timeline of a rally draws the strokes of the table, also where there are none."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.take import rally
from courtside.records import footwork
from courtside.strokes import detect
from fixtures.people import strokes_made


@pytest.fixture(scope="module")
def made():
    points, _ = strokes_made.take(seed=1)
    feet = [("p1", "step", 1.2), ("p1", "split_step", 2.4), ("p1", "jump", 3.0)]
    events = pd.DataFrame(feet, columns=["person", "event", "stop_s"])
    return points, detect.table(points, {}), events.reindex(columns=footwork.EVENT_COLUMNS)


def test_each_stroke_is_a_line_at_its_time_in_a_bar_of_its_interval(made):
    points, strokes, events = made
    drawing = rally.draw(strokes, events, points)
    drawing.draw_without_rendering()
    (axis,) = drawing.axes
    upright = [line.get_xdata()[0] for line in axis.lines if len(line.get_xdata()) == 2]
    assert upright == pytest.approx(strokes.time_s.tolist())
    first = axis.patches[0]
    assert first.get_width() == pytest.approx(2 * 1.645 * strokes.sigma_s[0])
    assert axis.get_title(loc="left") == f"p1: {len(strokes)} strokes, right hand (found)"


def test_steps_and_split_steps_are_marked_where_they_land_and_listed(made):
    points, strokes, events = made
    (axis,) = rally.draw(strokes, events, points).axes
    marks = {line.get_label(): line.get_xdata().tolist() for line in axis.lines[-2:]}
    assert marks == {"split step": [2.4], "step": [1.2]}
    rows = rally.table(strokes, events)
    assert rows.what.value_counts().to_dict() == {
        "stroke": len(strokes),
        "split_step": 1,
        "step": 1,
    }
    assert rows.time_s.is_monotonic_increasing


def test_a_take_of_one_frame_is_drawn(made):
    points, strokes, events = made
    drawing = rally.draw(strokes[:0], events[:0], points.frames(slice(1)))
    drawing.draw_without_rendering()
    assert np.isnan(drawing.axes[0].lines[0].get_ydata()).all()


def test_a_player_without_strokes_is_drawn_with_the_trunk_alone(made):
    points, strokes, events = made
    (axis,) = rally.draw(strokes[:0], events[:0], points).axes
    assert len(axis.lines) == 1
    assert axis.get_title(loc="left") == "p1: 0 strokes"
