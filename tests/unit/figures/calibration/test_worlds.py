"""Wrong worlds: errors by effect and strength, coverage, warnings, a figure that shows them."""

import pandas as pd
import pytest

from courtside.evaluation.tables import calibration
from courtside.figures.calibration import worlds
from fixtures.cameras import trials_made

SFM, THREE, OUT, KNOWN = (
    ("sfm", 18, True),
    ("sfm", 3, True),
    ("sfm", 18, False),
    ("known", 18, True),
)


def rows():
    parts = []
    for at, (effect, strength) in enumerate([("none", 0), ("lens", 1), ("lens", 2), ("court", 1)]):
        session = f"worlds-{at}"
        settings = {"session": session, "effect": effect, "strength": strength}
        found = {SFM: [1.0 + at, 3.0 + at], THREE: [4.0], OUT: [99.0, 99.0]}
        parts.append(trials_made.structure(2 if effect == "court" else found, **settings))
        parts.append(trials_made.known({KNOWN: [5.0, None]}, **settings))
    return calibration.tidy(pd.concat(parts)).assign(coverage90=0.8)


@pytest.fixture(scope="module")
def numbers():
    return worlds.table(rows(), {"worlds-0": 0, "worlds-1": 2})


def at(numbers, way, effect, strength):
    return calibration.pick(numbers, way=way, effect=effect, strength=strength).squeeze()


def test_errors_are_of_clicks_that_are_all_used(numbers):
    assert at(numbers, "walk, 18 clicks", "none", 0)["median"] == 2.0
    assert at(numbers, "walk, 18 clicks", "lens", 2)["median"] == 4.0
    assert at(numbers, "walk, 3 clicks", "lens", 1)["median"] == 4.0
    assert at(numbers, "walk, 3 clicks", "lens", 1)["coverage90"] == pytest.approx(80)


def test_the_points_of_another_court_have_its_ways():
    found = rows().replace({"n_clicks": {18: 9}})
    assert list(dict.fromkeys(worlds.table(found, {})["way"])) == [
        "walk, 9 clicks",
        "walk, 3 clicks",
        "9 clicks, no walk",
    ]


def test_failures_and_warnings_are_counted(numbers):
    lost = at(numbers, "walk, 18 clicks", "court", 1)
    assert (lost["n"], lost["n_failed"]) == (0, 2)
    assert at(numbers, "18 clicks, no walk", "lens", 1)["n_failed"] == 1
    assert at(numbers, "walk, 18 clicks", "lens", 1)["n_warnings"] == 2
    assert at(numbers, "walk, 18 clicks", "lens", 2)["n_warnings"] == 0
    assert pd.isna(at(numbers, "18 clicks, no walk", "lens", 1)["n_warnings"])


def test_the_figure_shows_every_effect_once_and_the_mark_where_the_median_is(numbers):
    drawing = worlds.draw(numbers)
    above, below = drawing.axes
    assert [text.get_text() for text in below.get_xticklabels()] == [
        "none", "court", "lens", "together"
    ]  # fmt: skip
    lines = {line.get_label(): line for line in above.get_lines()}
    assert sorted(lines["walk, 18 clicks"].get_ydata()) == [2.0, 3.0, 4.0]
    low, high = below.get_ylim()
    assert low <= 80.0 <= high
