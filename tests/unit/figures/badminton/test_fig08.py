"""Errors by N: ours as made, the published as published, and the two never joined."""

import matplotlib.colors
import numpy as np
import pandas as pd
import pytest

from courtside.evaluation.tables import calibration
from courtside.figures.badminton import fig08
from fixtures.cameras import trials_made

SFM, OUT, FEW, PAPER = ("sfm", 18, True), ("sfm", 18, False), ("sfm", 3, True), ("paper", 3, True)


@pytest.fixture(scope="module")
def rows():
    errors = {SFM: [1.0, 2.0], OUT: [2.0, 4.0], FEW: [0.1, 0.1], PAPER: [5.0, 7.0]}
    known = {("known", 18, True): [0.5, 0.7], ("known", 18, False): [0.9, 1.1]}
    known |= {("known", 8, True): [1.0, 1.0], ("known", 8, False): [None, None]}
    parts = [
        trials_made.structure(errors, mapper=mapper, n_bridging=count)
        for mapper in ("global", "incremental")
        for count in (20, 40)
    ]
    parts += [trials_made.structure(2, mapper="incremental", n_bridging=20, offset=1)]
    parts += [trials_made.structure(2, n_bridging=5), trials_made.known(known)]
    return calibration.tidy(pd.concat(parts))


@pytest.fixture(scope="module")
def numbers(rows):
    return fig08.table(rows, "a")


def value(numbers, column="median", **wanted):
    return calibration.pick(numbers, **wanted)[column].squeeze()


def test_the_numbers_are_medians_of_draws_and_offsets(numbers):
    paper = {"method": "paper", "mapper": "incremental", "n_bridging": 20}
    assert value(numbers, quantity="volume_rms_cm", **paper) == 6.0
    assert value(numbers, quantity="xy_cm", **paper) == 12.0
    assert value(numbers, "n_failed", quantity="xy_cm", **paper) == 2


def test_structures_are_counted(numbers):
    of = {"mapper": "incremental", "n_bridging": 20}
    assert value(numbers, quantity="solved_share", **of) == 0.5
    assert value(numbers, quantity="registered_share", **of) == 0.75
    assert value(numbers, quantity="neighbour_deg_max", **of) == pytest.approx(120 / 21)


def test_published_values_are_the_papers(numbers):
    of = numbers[numbers["method"] == "published"].set_index(["quantity", "n_bridging"])["median"]
    assert of["xy_cm"].to_dict() == {300: 4.3, 20: 229.5}
    assert of["xy_cm_strong"].tolist() == [2.2]
    assert of["neighbour_deg_median"].to_dict() == {40: 6.0, 20: 12.0}


def test_published_values_stand_beside_their_own_layout_only(rows, numbers):
    other, ours = fig08.table(rows, "b"), numbers["method"] != "published"
    assert not (other["method"] == "published").any()
    pd.testing.assert_frame_equal(other, numbers.drop(ours[~ours].index), check_dtype=False)
    words = [
        {text.get_text() for text in fig08.draw(shown, "made up").legends[0].get_texts()}
        for shown in (numbers, other)
    ]
    assert words[0] - words[1] == {"published", "published: below"}


def lines(axis):
    return [
        line
        for line in axis.lines
        if len(line.get_xdata()) and line.get_marker() not in ("", "None")
    ]


def test_published_values_stand_alone(numbers):
    drawing = fig08.draw(numbers, "made up", "a")
    stars = [line for axis in drawing.axes for line in lines(axis) if line.get_marker() == "*"]
    assert sorted(y for line in stars for y in line.get_ydata()) == [2.2, 4.3, 6.0, 12.0, 229.5]
    assert {line.get_linestyle() for line in stars} == {"None"}


def test_in_sample_marks_are_hollow(numbers):
    axis = fig08.draw(numbers, "made up").axes[0]
    face = {}
    for line in lines(axis):
        if line.get_marker() in "os^v" and len(line.get_xdata()) == 2:
            face[tuple(line.get_ydata())] = matplotlib.colors.to_hex(line.get_markerfacecolor())
    assert face[(6.0, 6.0)] == fig08.BY_CLICKS[0][0].lower()
    assert face[(3.0, 3.0)] == face[(12.0, 12.0)] == face[(0.2, 0.2)] == "#ffffff"


def test_what_has_no_result_is_marked(numbers):
    axis = fig08.draw(numbers, "made up").axes[0]
    crosses = [line for line in axis.lines if line.get_marker() == "x" and len(line.get_xdata())]
    # All four series but the paper's, which was not tried with the global mapper.
    assert len(crosses) == 3
    assert all(4 < line.get_xdata()[0] < 6 for line in crosses)


def test_marks_of_both_errors_lie_within_their_common_axis(numbers):
    shown = numbers.copy()
    of = (shown["quantity"] == "volume_rms_cm") & (shown["method"] == "known")
    shown.loc[of, ["p05", "median", "p95"]] *= 1000
    axes = fig08.draw(shown, "made up").axes[:2]
    assert axes[0].get_ylim() == axes[1].get_ylim()
    low, high = axes[1].get_ylim()
    for axis in axes:
        drawn = [y for line in lines(axis) if line.get_marker() != "x" for y in line.get_ydata()]
        assert all(low < y < high for y in drawn)
    assert max(drawn) > 500


def test_strong_calibrations_prefer_points_left_out(numbers):
    found = {label: rows for label, rows, _ in fig08.levels(numbers, "volume_rms_cm")}
    assert list(found) == ["known points, 18 clicks", "known points, 8 clicks"]
    assert found["known points, 18 clicks"]["median"].tolist() == [1.0, 0.6]
    np.testing.assert_array_equal(found["known points, 8 clicks"]["in_sample"], [True])
