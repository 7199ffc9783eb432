"""The timeline of a rally draws the strokes of the table, also where there are none."""

from dataclasses import replace

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


def test_a_take_of_minutes_has_strokes_a_minute_and_its_liveliest_part(made):
    points, strokes, events = made
    n_frames = 30 * 150
    bare = points.frames(np.arange(n_frames) % len(points.time_s))
    long = replace(bare, time_s=np.arange(n_frames) / 30)
    rare, dense = np.arange(2.5, 150, 10), 92 + np.arange(0.5, 25, 2)
    at_s = np.sort(np.concatenate([rare, dense]))
    hits = strokes.iloc[np.zeros(len(at_s), int)].reset_index(drop=True)
    drawing = rally.draw(hits.assign(time_s=at_s, overhead=True), events, long)
    drawing.draw_without_rendering()
    strip, part = drawing.axes
    high = [bar for bar in strip.patches if bar.get_height() > 20]
    assert {bar.get_x() + bar.get_width() / 2 for bar in high} == {92.5, 97.5, 102.5, 107.5, 112.5}
    start_s, stop_s = part.get_xlim()
    assert start_s <= dense[0] and dense[-1] <= stop_s <= start_s + 30
    shown = [line.get_xdata()[0] for line in part.lines if len(line.get_xdata()) == 2]
    assert shown == pytest.approx([at for at in at_s if start_s <= at <= stop_s])
    assert strip.get_title(loc="left") == f"p1: {len(at_s)} strokes"


@pytest.mark.parametrize(
    ("unseen_s", "hatched", "rates"), [((50, 53), [50], [24]), ((0, 150), range(0, 150, 5), [])]
)
def test_windows_in_which_the_player_is_hardly_seen_are_hatched(made, unseen_s, hatched, rates):
    points, strokes, events = made
    bare = points.frames(np.arange(30 * 150) % len(points.time_s))
    time_s = np.arange(30 * 150) / 30
    unseen = (time_s >= unseen_s[0]) & (time_s < unseen_s[1])
    xyz = np.where(unseen[:, None, None], np.nan, bare.xyz)
    at_s = np.array([53.5, 54.0, 54.6, 100.5, 101.0])
    hits = strokes.iloc[np.zeros(len(at_s), int)].assign(time_s=at_s, overhead=True)
    drawing = rally.draw(
        hits.reset_index(drop=True), events[:0], replace(bare, xyz=xyz, time_s=time_s)
    )
    drawing.draw_without_rendering()
    strip = drawing.axes[0]
    found = [(at.get_x(), at.get_x() + at.get_width()) for at in strip.patches if at.get_hatch()]
    assert found == [(at, at + 5) for at in hatched]
    bars = [bar for bar in strip.patches if not bar.get_hatch() and bar.get_height() > 1]
    assert [bar.get_height() for bar in bars] == pytest.approx(rates)
    assert "hatched" in strip.get_xlabel()


@pytest.mark.parametrize(("at_s", "start_s"), [([], 0), ([1.0], 0), ([80, 149], 79), ([149], 120)])
def test_the_liveliest_part_lies_within_the_take(at_s, start_s):
    assert rally.liveliest(np.array(at_s, float), np.arange(151.0)) == start_s
