"""Boards in rendered pictures: every corner where the camera sees it, under its own number."""

import numpy as np
import pytest

from courtside.calibration.boards.board import Board
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import boards_made

BOARDS = {
    "charuco": boards_made.CHARUCO,
    "inverted": boards_made.CHARUCO | {"inverted": True},
    "chessboard": {"kind": "chessboard", "squares": [8, 5], "square_m": 0.06},
    "tags": {
        "kind": "tags", "squares": [4, 3], "square_m": 0.13, "marker_m": 0.1,
        "dictionary": "DICT_APRILTAG_36h11",
    },
    "aprilgrid": {"kind": "aprilgrid", "squares": [4, 3], "square_m": 0.13, "marker_m": 0.1},
}  # fmt: skip


@pytest.mark.parametrize("name", BOARDS)
@pytest.mark.parametrize("upside_down", [False, True])
def test_corners_are_found_under_their_numbers(name, upside_down):
    board = Board.of(BOARDS[name])
    K = [[900, 0, 639.5], [0, 900, 359.5], [0, 0, 1]]
    pose = boards_made.look_at((0.3, -0.9, 1.1), (0, 0, 0))
    camera = cameras.Camera("c", boards_made.SIZE, K, np.zeros(5), pose)
    turn = np.diag([-1.0, -1, 1] if upside_down else [1.0, 1, 1])
    middle = board.corners.mean(axis=0)
    at = np.column_stack([turn, -turn @ middle])
    image = boards_made.picture(board, camera, at)
    ids, xy = board.find(255 - image if board.inverted else image)
    there = cameras.project(camera, board.corners @ at[:, :3].T + at[:, 3])
    assert len(ids) == len(board.corners)
    # Corners of tags are where two edges end, those of chessboards where four squares meet.
    assert np.abs(xy - there[ids]).max() < (1.0 if board.kind == "tags" else 0.5)


def test_an_april_grid_is_numbered_as_by_kalibr():
    """As the comment of `GridCalibrationTargetAprilgrid::createGridPoints` draws it, 2 x 2 tags."""
    board = Board.of({"kind": "aprilgrid", "squares": [2, 2], "square_m": 1.0, "marker_m": 0.75})
    assert board.dictionary == "DICT_APRILTAG_36h11" and len(board.corners) == 16
    row = [[0, 0, 0], [0.75, 0, 0], [1, 0, 0], [1.75, 0, 0]]
    np.testing.assert_allclose(board.corners[:4], row)
    np.testing.assert_allclose(board.corners[4:8], np.add(row, [0, 0.75, 0]))
    np.testing.assert_allclose(board.corners[8:12], np.add(row, [0, 1, 0]))
    apart = np.diff(board.corners[board.neighbours], axis=1)
    np.testing.assert_allclose(np.linalg.norm(apart, axis=-1), 0.75)
    assert len(board.neighbours) == 4 * 4


def test_neighbours_are_one_square_apart():
    board = Board.of(boards_made.CHARUCO)
    assert len(board.corners) == 12
    assert len(board.neighbours) == 3 * 3 + 2 * 4
    apart = np.diff(board.corners[board.neighbours], axis=1)
    np.testing.assert_allclose(np.linalg.norm(apart, axis=-1), 0.1)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"dictionary": "DICT_4X4_51"}, "board.dictionary: expected one of .*found DICT_4X4_51"),
        ({"kind": "chessboard", "squares": [8, 6]}, "board.squares: .*turned round: use another"),
        ({"kind": "chessboard", "squares": [4, 3]}, "4 or more along both sides, found 4 and 3"),
        ({"marker_m": 0.1}, r"board.marker_m: expected less than square_m \(0.1\), found 0.1"),
    ],
)
def test_impossible_boards_are_one_line(given, message):
    with pytest.raises(InputError, match=message) as caught:
        Board.of(boards_made.CHARUCO | given)
    assert "\n" not in str(caught.value)
