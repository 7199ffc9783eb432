"""Remarks on boards: a size that no board has, lenses from a chessboard that nothing uses."""

import pytest

from courtside.validation import boards


@pytest.mark.parametrize(
    ("square_m", "size"),
    [(0.054, None), (0.4, None), (0.54, "2.16 x 2.7 m"), (0.0054, "0.0216 x 0.027 m")],
)
def test_a_board_of_an_impossible_size_is_told(square_m, size):
    said = list(boards.remarks({"squares": [4, 5], "square_m": square_m}))
    if size is None:
        assert said == []
    else:
        (line,) = said
        assert f"found a board of {size} (4 x 5 times {square_m:g} m): check square_m" in line


def test_sessions_without_a_board_say_nothing():
    assert list(boards.remarks(None)) == []


def test_it_is_told_with_the_session(hall):
    hall.content["board"] = {"squares": [4, 5], "square_m": 0.54}
    _, (line,) = hall.said()
    assert line.startswith("config/sessions/hall.yaml: board: expected a longer side")


def chessboards(hall, *names):
    """Give cameras of the hall pictures of a chessboard, as a draft writes them."""
    pictures = {"images": str(hall.root), "inner_corners": [7, 4]}
    hall.content["cameras"] |= {name: {"chessboard": pictures} for name in names}


def test_lenses_from_chessboards_that_no_calibration_uses_are_told(hall):
    chessboards(hall, "left", "back")
    assert hall.said() == (
        [],
        [
            "config/sessions/hall.yaml: cameras: the lenses from `chessboard` of left, back are "
            "not used by file; `board` and `wand` (without `lenses`), `people` and "
            "`known18-board` use them"
        ],
    )


def test_lenses_that_a_wand_or_people_use_are_not_told(hall):
    chessboards(hall, "left", "right", "back")
    hall.content["subjects"]["p1"]["height_m"] = 1.74
    hall.content["override"] = {"calibrations": ["people"], "take_calibrations": ["people"]}
    assert hall.said() == ([], [])
    ways = ["file", "people", "file-people"]
    hall.content["override"] = {"calibrations": ways, "take_calibrations": ways[2:]}
    (line,) = hall.said()[1]
    assert "are not used by file-people;" in line
    hall.content["override"] = {"calibrations": ["wand"], "take_calibrations": ["wand"]}
    wand = {"points": str(hall.root / "w.csv"), "length_m": 0.5}
    hall.content["wand"] = wand
    assert hall.said() == ([], [])
    hall.content["wand"] = wand | {"lenses": str(hall.root / "cameras.toml")}
    (line,) = hall.said()[1]
    assert "are not used by wand;" in line
