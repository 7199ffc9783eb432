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
        assert len(axis.lines) == 1 + n_strokes + (n_strokes > 0)


def test_the_legend_names_every_person_of_either_kind(made):
    *_, rows = made
    low = rows[~rows.overhead].assign(person="p2")
    drawing = phases.draw(pd.concat([rows[rows.overhead], low], ignore_index=True))
    words = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert words == ["p1: mean", "p2: mean"]


def test_without_strokes_the_axes_are_empty(made):
    points, strokes, _ = made
    rows = phases.table(strokes[:0], points)
    assert list(rows.columns) == ["person", "stroke", "overhead", "phase_s", *phases.LINES]
    drawing = phases.draw(rows)
    drawing.draw_without_rendering()
    assert drawing.axes[0].get_xlim() == (-phases.BEFORE_S, phases.AFTER_S)
    assert drawing.get_suptitle() == "no stroke found"
