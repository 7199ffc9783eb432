"""Corners of a board: from folders of pictures, and from tables of our own and Caliscope's form."""

import re

import cv2
import numpy as np
import pytest

from courtside.calibration.boards import corners
from courtside.calibration.boards.board import Board
from courtside.study.errors import InputError
from fixtures.cameras import boards_made
from fixtures.recordings.charuco import XY
from fixtures.recordings.real_data import needs_real

BOARD = Board.of(boards_made.CHARUCO)
CHESS = {"kind": "chessboard", "squares": [8, 5], "square_m": 0.1}
NAMES = {"left": "left", "right": "cam_1"}
TABLE = "picture,camera,corner,x_px,y_px\n7,left,0,10.5,20.5\n7,cam_1,3,30,40\n8,other,0,1,2\n"


def test_pictures_of_one_name_are_one_place(tmp_path):
    rig = boards_made.hall()[:2]
    at = boards_made.places(1, 1)[0]
    for camera in rig:
        (tmp_path / camera.name).mkdir()
        image = boards_made.picture(BOARD, camera, at)
        cv2.imwrite(
            str(tmp_path / camera.name / f"floor.{'jpg' if camera is rig[0] else 'png'}"), image
        )
    folders = {camera.name: tmp_path / camera.name for camera in rig}
    found = corners.of_pictures(folders, BOARD)
    assert (found.cameras, found.pictures) == (("c0", "c1"), ("floor",))
    assert found.sizes == {"c0": (1280, 720), "c1": (1280, 720)}
    assert set(found.camera) == {0, 1}
    with pytest.raises(
        InputError,
        match=r"camera c0: expected a charuco of 5x4 squares in DICT_6X6_5"
        r"0, found none in 1 pictures but \d+ markers of DICT_4X4_",
    ) as caught:
        corners.of_pictures(folders, Board.of(boards_made.CHARUCO | {"dictionary": "DICT_6X6_50"}))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("shown", "stated", "advice"),
    [
        (boards_made.CHARUCO | {"inverted": True}, boards_made.CHARUCO, "inverted: true"),
        (boards_made.CHARUCO, boards_made.CHARUCO | {"inverted": True}, "inverted: false"),
        (CHESS, CHESS | {"squares": [7, 4]}, r"squares: \[8, 5\]"),
    ],
)
def test_a_board_of_another_form_is_recognised(tmp_path, shown, stated, advice):
    camera = boards_made.hall()[0]
    (tmp_path / "c0").mkdir()
    image = boards_made.picture(Board.of(shown), camera, boards_made.places(1, 1)[0])
    cv2.imwrite(str(tmp_path / "c0" / "1.png"), 255 - image if "inverted" in shown else image)
    with pytest.raises(InputError) as caught:
        corners.of_pictures({"c0": tmp_path / "c0"}, Board.of(stated))
    assert re.search(f"found none in 1 pictures but one with `{advice}` in 1 of", str(caught.value))


def test_a_table_of_our_own(tmp_path):
    (tmp_path / "a.csv").write_text(TABLE)
    found = corners.of_table(tmp_path / "a.csv", NAMES, BOARD)
    assert (found.cameras, found.pictures, found.sizes) == (("left", "right"), ("7",), {})
    np.testing.assert_array_equal(found.corner, [0, 3])
    np.testing.assert_array_equal(found.xy, [[10.5, 20.5], [30, 40]])


def test_pictures_of_two_sizes_are_refused(tmp_path):
    for name, size in (("a", (90, 120)), ("b", (90, 100))):
        cv2.imwrite(str(tmp_path / f"{name}.png"), np.zeros(size, np.uint8))
    with pytest.raises(InputError, match=r"b\.png: expected 120x90 px as of the pictures before"):
        corners.of_pictures({"left": tmp_path, "right": tmp_path}, BOARD)


def test_two_pictures_of_one_name_are_refused(tmp_path):
    image = boards_made.picture(BOARD, boards_made.hall()[0], boards_made.places(1, 1)[0])
    for name in ("a.png", "a.jpg"):
        cv2.imwrite(str(tmp_path / name), image)
    with pytest.raises(
        InputError, match=r"a\.png: expected one picture of each name, found a\.jpg"
    ):
        corners.of_pictures({"c0": tmp_path}, BOARD)


@needs_real
def test_frames_of_real_videos_show_what_the_table_says():
    board = Board.of({"kind": "charuco", "squares": [4, 5], "square_m": 0.054,
                      "dictionary": "DICT_4X4_1000", "inverted": True})  # fmt: skip
    videos = {f"cam_{k}": XY.parent / f"cam_{k}.mp4" for k in (0, 1)}
    found = corners.of_videos(videos, board, every_s=1.5)
    table = corners.of_table(XY, {name: name for name in videos}, board)
    assert found.sizes == dict.fromkeys(videos, (1280, 720))
    for c in (0, 1):
        theirs = table.xy[table.camera == c]
        # A few corners are found by one program only.
        near = [np.abs(theirs - xy).max(axis=1).min() < 1.5 for xy in found.xy[found.camera == c]]
        assert np.mean(near) > 0.8
        assert len(near) > 40


@needs_real
def test_a_real_table_of_caliscope():
    board = Board.of({"kind": "charuco", "squares": [4, 5], "square_m": 0.054,
                      "dictionary": "DICT_4X4_1000"})  # fmt: skip
    names = {f"cam_{k}": f"cam_{k}" for k in range(4)}
    found = corners.of_table(XY, names, board)
    assert (len(found.xy), len(found.pictures)) == (2199, 57)
    with pytest.raises(InputError, match=r"line 2: expected corner 2 at .*correct board.square_m"):
        corners.of_table(
            XY,
            names,
            Board.of(
                {
                    "kind": "charuco",
                    "squares": [4, 5],
                    "square_m": 0.05,
                    "dictionary": "DICT_4X4_50",
                }
            ),
        )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (TABLE.replace("cam_1,3", "cam_1,12"), "line 3: expected corner from 0 to 11, found 12"),
        (TABLE.replace("10.5", "wide"), "line 2: expected x_px as a finite number, found 'wide'"),
        (TABLE.replace("cam_1", "cam_2"), r"camera right \(cam_1\), found none.*name_in_calib"),
        (
            TABLE + "7,cam_1,3,30,41\n",
            "line 5: expected one row for corner 3 of picture 7 in camera cam_1, found a second",
        ),
        (
            "sync_index,cam_id,keypoint_id,img_loc_x,img_loc_y,object_id\n"
            "7,left,0,1,2,0\n7,1,0,1,2,0\n7,1,0,3,4,1\n",
            "expected corners of one board, found object_id 0, 1; delete the rows of the others",
        ),
        (TABLE.split("\n")[0], "expected corners of a board, found none"),
        ("a,b\n1,2\n", "expected the columns picture,camera,corner"),
        ("sync_index,cam_id\n1,2\n", "expected the columns sync_index,cam_id,keypoint_id"),
    ],
)
def test_wrong_tables_are_one_line(tmp_path, text, message):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        corners.of_table(tmp_path / "a.csv", NAMES, BOARD)
    assert "\n" not in str(caught.value)
