"""Conditions of filming: the settings in order, the spread as made, failures in words."""

import pandas as pd
import pytest

from courtside.evaluation.tables import calibration
from courtside.figures.calibration import conditions
from fixtures.cameras import trials_made

OUT, SFM, PAPER = ("sfm", 18, False), ("sfm", 18, True), ("paper", 3, True)


def rows():
    parts = []
    for speed in (1, 4):
        for stabiliser in (True, False):
            settings = {"condition": "speed", "speed_kmh": speed, "stabiliser": stabiliser}
            settings |= {"session": f"speed-{speed}-{stabiliser}", "n_bridging": 20}
            found = {OUT: [speed + 0.0, speed + 2.0], SFM: [0.1, 0.1], PAPER: [8.0, 10.0]}
            lost = speed == 4 and not stabiliser
            parts.append(trials_made.structure(2 if lost else found, **settings))
            other = trials_made.structure({PAPER: [3.0]}, mapper="incremental", **settings)
            parts.append(other)
    other = trials_made.structure(
        {OUT: [99.0]}, session="x", speed_kmh=1, stabiliser=True, n_bridging=40
    )
    return calibration.tidy(pd.concat([*parts, other]))


@pytest.fixture(scope="module")
def numbers():
    return conditions.table(rows(), "speed_kmh", "stabiliser", 20)


def at(numbers, way, speed, stabiliser):
    return calibration.pick(numbers, way=way, speed_kmh=speed, stabiliser=stabiliser).squeeze()


def test_the_scored_points_are_left_out_where_they_can_be(numbers):
    ours, paper = conditions.METHODS
    assert at(numbers, ours, 4, True)["median"] == 5.0
    assert not at(numbers, ours, 4, True)["in_sample"]
    assert at(numbers, paper, 1, False)["median"] == 9.0
    assert at(numbers, paper, 1, False)["in_sample"]


def test_points_of_any_court_are_control_points():
    settings = {"condition": "speed", "speed_kmh": 1, "session": "s", "n_bridging": 20}
    of = trials_made.structure({("sfm", 9, False): [4.0], PAPER: [9.0]}, **settings)
    numbers = conditions.table(calibration.tidy(of), "speed_kmh")
    assert numbers[["way", "median"]].to_numpy().tolist() == [
        ["control points", 4.0],
        ["paper's eq 2-5", 9.0],
    ]


def test_failures_are_counted_and_written(numbers):
    paper = list(conditions.METHODS)[1]
    lost = at(numbers, paper, 4, False)
    assert (lost["n"], lost["n_failed"]) == (0, 2)
    drawing = conditions.draw(numbers, "speed_kmh", "stabiliser")
    texts = [text.get_text() for axis in drawing.axes for text in axis.texts]
    assert texts == ["2 of 2 failed"] * 2  # what finds no cameras fails both ways


def test_every_second_setting_has_a_line(numbers):
    axis = conditions.draw(numbers, "speed_kmh", "stabiliser").axes[0]
    assert axis.get_legend_handles_labels()[1] == ["stabiliser off", "stabiliser on"]
    assert [text.get_text() for text in axis.get_xticklabels()] == ["1", "4"]


def test_sizes_are_ordered_by_their_width():
    parts = [
        trials_made.structure({OUT: [1.0], PAPER: [2.0]}, session=f"s{n}", size_px=size)
        for n, size in enumerate(("1280x720", "640x360", "960x540"))
    ]
    numbers = conditions.table(calibration.tidy(pd.concat(parts)), "size_px")
    axis = conditions.draw(numbers, "size_px").axes[0]
    ticks = [text.get_text() for text in axis.get_xticklabels()]
    assert ticks == ["640x360", "960x540", "1280x720"]


def test_any_number_of_second_settings_has_lines_that_differ():
    parts = [
        trials_made.structure({OUT: [1.0], PAPER: [2.0]}, session=f"s{n}", speed_kmh=1, frames=n)
        for n in range(9)
    ]
    numbers = conditions.table(calibration.tidy(pd.concat(parts)), "speed_kmh", "frames")
    axis = conditions.draw(numbers, "speed_kmh", "frames").axes[0]
    lines = [line for line in axis.lines if len(line.get_xdata())]
    assert len({(line.get_color(), line.get_marker()) for line in lines}) == 9
