"""Boards in rendered pictures: every corner where the camera sees it, under its own number."""

import cv2
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
    assert np.abs(xy - there[ids]).max() < 0.5


def printed_tags(board):
    """Return a sheet, 3000 px to the metre, and where its corners are on it, px."""
    tag_px = round(3000 * board.marker_m)
    sheet = np.full((1100, 1400), 230, np.uint8)
    words = board._printed.getDictionary()
    for tag, (x, y) in enumerate(np.round(board.corners[::4, :2] * [3000, -3000] + 100)):
        rows, columns = (slice(int(start), int(start) + tag_px) for start in (y, x))
        drawn = cv2.aruco.generateImageMarker(words, tag, tag_px)
        sheet[rows, columns] = np.where(drawn > 0, 230, 25)
    return sheet, board.corners[:, :2] * [3000, -3000] + 99.5


@pytest.mark.parametrize("blur_px", [0.6, 1.2])
@pytest.mark.parametrize("tag_px", [30, 48, 72])
@pytest.mark.parametrize("noise", [0.0, 4.0])
def test_tags_look_as_large_as_they_are(tag_px, blur_px, noise):
    """By their corners, tags looked 0.3 to 0.7 px too small: boards up to 0.3 % too far away."""
    board = Board.of(BOARDS["tags"] | {"square_m": 0.1, "marker_m": 0.08})
    sheet, corners = printed_tags(board)
    scale, four = tag_px / 240, np.array([[4.0, 0, 1.5], [0, 4, 1.5], [0, 0, 1]])
    shrunk, off_px, random = [], [], np.random.default_rng(3)
    for turn in np.radians([-22, 3, 14]):
        along, across = scale * np.cos(turn), scale * np.sin(turn)
        seen = [[along, -across, 150 + random.random()], [across, along, 250 + random.random()]]
        seen = np.array([*seen, [*random.uniform(-1e-5, 1e-5, 2), 1]])
        large = cv2.warpPerspective(sheet, four @ seen, (2560, 2880), borderValue=230)
        image = cv2.resize(large, (640, 720), interpolation=cv2.INTER_AREA).astype(float)
        image = cv2.GaussianBlur(image, (0, 0), blur_px) + random.normal(0, noise, image.shape)
        ids, xy = board.find(np.clip(np.round(image), 0, 255).astype(np.uint8))
        assert len(ids) >= 40
        there = cv2.perspectiveTransform(corners[None], seen)[0][ids]
        arms = there - there.mean(axis=0)
        shrunk.append((arms * (there - xy)).sum() / (arms**2).sum())
        off_px.append(np.sqrt(np.mean((xy - there) ** 2)))
    assert abs(np.mean(shrunk)) < 3e-4
    assert np.mean(off_px) < 0.12


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
