"""The timeline of a rally draws the strokes of the table, also where there are none."""

import pytest

from courtside.figures.take import rally
from courtside.strokes import detect
from fixtures.people import strokes_made


@pytest.fixture(scope="module")
def made():
    points, _ = strokes_made.take(seed=1)
    return points, detect.table(points, {})


def test_each_stroke_is_a_line_at_its_time_in_a_bar_of_its_interval(made):
    points, strokes = made
    drawing = rally.draw(strokes, points)
    drawing.draw_without_rendering()
    (axis,) = drawing.axes
    upright = [line.get_xdata()[0] for line in axis.lines if len(line.get_xdata()) == 2]
    assert upright == pytest.approx(strokes.time_s.tolist())
    first = axis.patches[0]
    assert first.get_width() == pytest.approx(2 * 1.645 * strokes.sigma_s[0])
    assert axis.get_title(loc="left") == f"p1: {len(strokes)} strokes, right hand (found)"
    assert list(rally.table(strokes).columns) == rally.DRAWN


def test_a_player_without_strokes_is_drawn_with_the_trunk_alone(made):
    points, strokes = made
    (axis,) = rally.draw(strokes[:0], points).axes
    assert len(axis.lines) == 1
    assert axis.get_title(loc="left") == "p1: 0 strokes"
