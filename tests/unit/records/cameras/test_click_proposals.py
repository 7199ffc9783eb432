"""Tables of proposals: round trip, and faults in one line."""

from types import SimpleNamespace

import numpy as np
import pytest

from courtside.records.cameras import click_proposals, clicks
from courtside.study.errors import InputError

POINTS = ("p01", "p02", "p03")


def some():
    found = SimpleNamespace(
        xy=np.array([[12.34567, 8.0], [np.nan, np.nan], [-0.25, 1e3]]),
        sigma_px=np.array([0.2, np.nan, 0.5]),
        confidence=np.array([0.9, 0.0, 0.4]),
        reason=("", "a line it names, or two, is not seen", ""),
    )
    return {"left": found, "right": found}


def test_what_is_written_is_read(tmp_path):
    path = tmp_path / "new" / "proposals.csv"
    click_proposals.write(path, some(), POINTS)
    read = click_proposals.read(path, ["left", "right", "third"], POINTS)
    assert read["third"] == {}
    assert read["left"] == read["right"]
    assert set(read["left"]) == {"p01", "p03"}
    assert read["left"]["p01"] == pytest.approx({"x": 12.3457, "y": 8.0, "sigma_px": 0.2})
    assert len(path.read_text().splitlines()) == 7


def test_a_proposal_may_be_of_either_end(tmp_path):
    given = some()
    given["left"].reason = (click_proposals.EITHER, "not seen", click_proposals.EITHER)
    click_proposals.write(tmp_path / "either.csv", {"left": given["left"]}, POINTS)
    read = click_proposals.read(tmp_path / "either.csv", ["left"], POINTS)
    assert [place["either"] for place in read["left"].values()] == [True, True]


def test_proposals_are_not_clicks(tmp_path):
    path = tmp_path / "proposals.csv"
    click_proposals.write(path, some(), POINTS)
    with pytest.raises(InputError, match="expected the columns"):
        clicks.read(path, ["left", "right"], POINTS)


@pytest.mark.parametrize(
    ("cameras", "points", "words"),
    [
        (["left"], POINTS, "unknown cameras or points: right"),
        (["left", "right"], POINTS[:2], "unknown cameras or points: p03"),
    ],
)
def test_other_cameras_and_points_are_named(tmp_path, cameras, points, words):
    path = tmp_path / "proposals.csv"
    click_proposals.write(path, some(), POINTS)
    with pytest.raises(InputError, match=words) as fault:
        click_proposals.read(path, cameras, points)
    assert str(path) in str(fault.value) and "\n" not in str(fault.value)


def test_a_file_of_another_kind_is_refused(tmp_path):
    path = tmp_path / "odd.csv"
    path.write_text("a,b\n1,2\n")
    with pytest.raises(
        InputError, match="expected a table of proposed court points, found the columns a, b"
    ):
        click_proposals.read(path, ["left"], POINTS)


def test_a_place_that_is_no_number_is_one_line(tmp_path):
    path = tmp_path / "odd.csv"
    click_proposals.write(path, some(), POINTS)
    first, row, *rest = path.read_text().splitlines()
    cells = row.split(",")
    cells[3] = "far"
    path.write_text("\n".join([first, ",".join(cells), *rest]))
    with pytest.raises(
        InputError, match=r"odd\.csv: expected a table of proposed court points.*far"
    ):
        click_proposals.read(path, ["left", "right"], POINTS)
