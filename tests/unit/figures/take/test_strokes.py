"""Strokes over one another: lines are the signals around each stroke, bands need three."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.take import strokes as phases
from courtside.strokes import detect, signals
from fixtures.people import strokes_made


@pytest.fixture(scope="module")
def made():
    points, _ = strokes_made.take(seed=1)
    strokes = detect.table(points, {})
    return points, strokes, phases.table(strokes, points)


def test_at_phase_0_stands_what_was_measured_at_the_stroke(made):
    points, strokes, rows = made
    found = signals.of_person(points, 0)
    now = rows[np.isclose(rows.phase_s, 0)]
    assert len(now) == len(strokes)
    speed = np.interp(strokes.time_s.astype(float), found.time_s, found.trunk.speed)
    np.testing.assert_allclose(now.trunk_m_s, speed)


def test_each_kind_has_its_column_and_a_band_from_three_strokes_on(made):
    _, strokes, rows = made
    drawing = phases.draw(rows)
    drawing.draw_without_rendering()
    for column, overhead in enumerate((True, False)):
        n_strokes = int((strokes.overhead == overhead).sum())
        axis = drawing.axes[column]
        assert axis.get_title(loc="left").endswith(f"n = {n_strokes}")
        assert len(axis.collections) == (n_strokes >= phases.FEWEST)
        assert len(axis.lines) == 1 + n_strokes + (n_strokes > 1)


def _strokes(values):
    """Return rows of overhead strokes: one list of the wrist's speeds each."""
    phase = phases.STEP_S * np.arange(len(values[0]))
    parts = [
        pd.DataFrame({"stroke": n, "phase_s": phase, "wrist_m_s": line, "trunk_m_s": line})
        for n, line in enumerate(values, 1)
    ]
    rows = pd.concat(parts, ignore_index=True)
    return rows.assign(person="p1", overhead=True, reach_m=rows.trunk_m_s)


def _means(axis):
    return [line.get_ydata() for line in axis.lines if line.get_label() == "p1: mean of all"]


def test_the_mean_and_its_band_are_drawn_where_all_strokes_are_known():
    nan = np.nan
    rows = _strokes([[1.0, 1, 1, 1], [3.0, 3, 3, nan], [nan, 5, 5, 5]])
    axis = phases.draw(rows).axes[2]
    (mean,) = _means(axis)
    np.testing.assert_array_equal(mean, [nan, 3, 3, nan])
    (band,) = axis.collections
    x = band.get_paths()[0].vertices[:, 0]
    assert x.min() == pytest.approx(phases.STEP_S) and x.max() == pytest.approx(2 * phases.STEP_S)


def test_the_band_holds_nine_of_ten_further_strokes():
    rng = np.random.default_rng(0)
    for n_strokes in (3, 10):
        lines = rng.normal(10, 1, (n_strokes, 4000))
        (band,) = phases.draw(_strokes(lines)).axes[2].collections
        x, y = band.get_paths()[0].vertices.T
        at = np.rint(x / phases.STEP_S).astype(int)
        ends = pd.Series(y).groupby(at)
        further = rng.normal(10, 1, 4000)
        held = (further > ends.min()) & (further < ends.max())
        assert held.mean() == pytest.approx(0.9, abs=0.015)


def test_strokes_never_known_together_have_no_mean():
    rows = _strokes([[1.0, np.nan], [np.nan, 3.0]])
    drawing = phases.draw(rows)
    drawing.draw_without_rendering()
    assert not _means(drawing.axes[2])


def test_a_single_stroke_has_no_mean():
    drawing = phases.draw(_strokes([[1.0, 2, 3, 4]]))
    assert not _means(drawing.axes[0])
    words = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert words == ["p1: each stroke"]


def test_the_legend_names_every_person_of_either_kind(made):
    *_, rows = made
    low = rows[~rows.overhead].assign(person="p2")
    drawing = phases.draw(pd.concat([rows[rows.overhead], low], ignore_index=True))
    words = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert words == ["p1: each stroke", "p2: each stroke", "p2: mean of all"]


def test_without_strokes_a_sentence_stands_in_place_of_panels(made):
    points, strokes, _ = made
    rows = phases.table(strokes[:0], points)
    assert list(rows.columns) == ["person", "stroke", "overhead", "phase_s", *phases.LINES]
    drawing = phases.draw(rows)
    drawing.draw_without_rendering()
    assert not drawing.axes
    assert [text.get_text() for text in drawing.texts] == ["No stroke was found in this take."]
