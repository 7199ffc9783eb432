"""The size of a board: one remark where no board has it."""

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
