"""Numbers of calibrations, from trials worked out by hand."""

import pandas as pd
import pytest

from courtside.evaluation.numbers import calibration


@pytest.fixture(scope="module")
def found(source):
    return calibration.calibrations(source)


def test_every_hall_has_its_median_and_its_difference_to_points_alone(found, value):
    assert value(found, "`plain-a`", "walk18").printed == "0.65"
    assert value(found, "`plain-a`", "walk18").n == 4
    assert value(found, "`plain-a`", "walk18_points").printed == "1.50"
    assert value(found, "`plain-a`", "walk18_less_known18").value == pytest.approx(-0.35)
    low, high = (value(found, "`plain-a`", f"walk18_less_known18_{end}") for end in ("from", "to"))
    assert low.value <= -0.35 <= high.value < 0


def test_choices_of_images_count_each_also_if_their_errors_are_the_same(found, value):
    assert value(found, "`plain-b`", "walk18").n == 4
    assert value(found, "`plain-b`", "walk18_less_known18").value == pytest.approx(0.1)


def test_failed_trials_are_counted(found, value):
    paper = value(found, "`plain-a`", "paper")
    assert (paper.printed, paper.n, paper.n_failed) == ("20.00", 1, 1)


def test_over_halls_the_worst_stands_beside_the_median(found, value):
    assert value(found, "all 2 halls", "walk18").value == pytest.approx((0.65 + 1.1) / 2)
    assert value(found, "all 2 halls", "walk18_worst").value == pytest.approx(1.1)
    assert value(found, "all 2 halls", "walk18_less_known18").value == pytest.approx(-0.125)
    assert value(found, "all 2 halls", "walk18").sessions == "plain-a plain-b"


def test_a_difference_is_the_median_of_halls_medians_as_the_errors_beside_it_are(
    source, value, monkeypatch
):
    """One hall, and one trial in each, gain much more than all others."""
    differences = {"a": (-0.2, -0.3, -9.0), "b": (-0.1, -0.2, -9.0), "c": (-5.0, -6.0, -9.0)}
    trials = [
        (hall, draw, part, known + difference)
        for hall, values in differences.items()
        for draw, difference in enumerate(values)
        for part, known, difference in (("known18", 20.0, 0.0), ("walk18", 20.0, difference))
    ]
    rows = pd.DataFrame(trials, columns=["session", "draw", "part", "value"])
    rows = rows.assign(hall=rows["session"], structure=rows["session"], points=1.0)
    rows = rows.assign(preset="plain", layout=rows["session"])
    monkeypatch.setattr(calibration, "sessions", lambda source: ["a", "b", "c"])
    monkeypatch.setattr(calibration, "trials", lambda source, names: rows)
    found = calibration.calibrations(source)
    assert value(found, "all 3 halls", "walk18_less_known18").value == pytest.approx(-0.3)
    assert value(found, "`a`", "walk18_less_known18").value == pytest.approx(-0.3)


def test_ways_growth_and_capture_take_all_sessions(source, value):
    ways = calibration.ways(source)
    assert {n.sessions for n in ways if n.row.startswith("walk of 40")} == {"plain-a", "plain-b"}
    assert value(ways, "18 known points, no walk; `plain-b`", "median").printed == "1.00"
    growth = calibration.growth(source)
    assert [n.printed for n in growth if n.part == "median"] == ["0.65", "1.10"]
    assert value(growth, "`plain-b`, 2 x 40", "p95").n == 4
    (row,) = {n.row for n in calibration.capture(source)}
    assert row == "baseline_deg 15: walk, 18 points without the two scored ones"


def test_the_scatter_of_clicks_has_its_errors_and_coverage(source, value):
    found = calibration.strengths(source)
    shown = [value(found, f"`plain-a`, scatter x{s}", "walk18_coverage").printed for s in (1, 3)]
    assert shown == ["85", "25"]
