"""The racket's figure: medians, floor and published values are drawn at their values."""

import itertools

import pandas as pd
import pytest

from courtside.evaluation.tables import racket
from courtside.figures.badminton import fig12
from fixtures.cameras import racket_runs

ERRORS = {way: [(10.0 + at, 12.0, 9.0 + at)] * 3 for at, way in enumerate(racket_runs.WAYS)}


def numbers(tmp_path, errors, sessions=("hall", "yard")):
    parts = [
        racket_runs.made(errors, session=session, again=again, sigma_px=sigma_px)
        for session in sessions
        for again in (False, True)
        for sigma_px in (0.7, 1.8)
    ]
    pd.concat(parts).to_csv(tmp_path / "runs.csv", index=False)
    return racket.table(racket.read([tmp_path / "runs.csv"]))


def medians(axis):
    """Return the heights of the white strokes: medians of filled boxes."""
    return [line.get_ydata()[0] for line in axis.lines if line.get_color() == "white"]


def stars(axis):
    return [line.get_ydata()[0] for line in axis.lines if line.get_marker() == "*"]


def test_medians_floor_and_published_values_are_drawn(tmp_path):
    drawing = fig12.draw(numbers(tmp_path, ERRORS), 0.674)
    assert len(drawing.axes) == 5 * 2
    for axis in drawing.axes[:4]:
        expected = [10, 11, 12, 13, 14, 15, *[12] * 6, 9, 10, 11, 12, 13, 14]
        assert medians(axis) == expected
        dashed = [line.get_ydata()[0] for line in axis.lines if line.get_linestyle() == "--"]
        assert dashed == [15, 12, 14]
        assert sorted(stars(axis)) == [6.21, 6.27, 8.47, 11.86, 12.30, 12.69]
    # SfM is way 4: its errors are 3 mm more than those of way 1 and 4 more than those of way 0.
    assert medians(drawing.axes[4]) == [3, 4, 0, 0, 3, 4]
    assert sorted(stars(drawing.axes[4])) == pytest.approx([-3.83, -0.83, 0.06])


def shown_ticks(drawing, axis):
    """Return the labels of the ticks within the y axis from below, and their boxes in pixels."""
    low, high = axis.get_ylim()
    ticks = zip(axis.get_yticks(), axis.get_yticklabels(), strict=True)
    shown = [
        label for value, label in sorted(ticks, key=lambda one: one[0]) if low <= value <= high
    ]
    return [one.get_text() for one in shown], [one.get_window_extent() for one in shown]


def test_numbers_of_the_axes_stand_apart_and_reach_as_far_as_the_errors(tmp_path):
    far = [(500.0, 200.0, 150.0), (900.0, 400.0, 260.0), (19000.0, 27000.0, 3400.0)]
    for errors, largest in ((ERRORS | {"dlt8": far}, "10000"), (ERRORS, "20")):
        drawing = fig12.draw(numbers(tmp_path, errors, ("hall",)), 0.674)
        drawing.draw_without_rendering()
        for axis in drawing.axes[:3]:
            words, boxes = shown_ticks(drawing, axis)
            assert len(words) >= 3
            assert all(a.y1 < b.y0 for a, b in itertools.pairwise(boxes))
        assert largest in shown_ticks(drawing, drawing.axes[0])[0]


def test_ways_without_a_result_leave_a_gap(tmp_path):
    drawing = fig12.draw(numbers(tmp_path, ERRORS | {"dlt8": [None] * 3}, ("hall",)), 0.674)
    drawing.savefig(tmp_path / "figure.png")
    found = medians(drawing.axes[0])
    assert found[1:6] == [11, 12, 13, 14, 15]
    assert found[0] != found[0]


def test_the_run_is_drawn_about_the_length_of_the_racket(tmp_path):
    axis = fig12.draw(numbers(tmp_path, ERRORS, ("hall",)), 0.68).axes[-2]
    (level,) = (line for line in axis.lines if line.get_linestyle() == ":")
    assert set(level.get_ydata()) == {680.0} and axis.get_ylim() == (610, 750)


def test_groups_of_published_values_span_ways_of_their_kind():
    names = [way.name for way in fig12.WAYS]
    first, last = fig12.PUBLISHED["8-point"]
    assert names[first : last + 1] == ["dlt8", "known8"]
    first, last = fig12.PUBLISHED["SfM"]
    assert names[first : last + 1] == ["paper3", "sfm8", "sfm18"]
    assert set(names) == set(racket_runs.WAYS)
