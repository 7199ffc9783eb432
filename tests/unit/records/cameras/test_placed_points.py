"""Points with places of their own: what a table means, and every fault in one line."""

import numpy as np
import pytest

from courtside.records.cameras import placed_points
from courtside.study.errors import InputError

HEADER = "camera,x_px,y_px,x_m,y_m,z_m\n"
CAMERAS = ["left", "right"]


def read(tmp_path, text):
    path = tmp_path / "points.csv"
    path.write_text(text, encoding="utf-8")
    return placed_points.read(path, CAMERAS)


def test_rows_of_one_place_are_one_point(tmp_path):
    text = HEADER + "left,10,20,9,4.5,0\nright,30,40,9.0,4.5004,0\nright,5,6,0,0,2.43\n"
    found = read(tmp_path, text)
    assert found.points == ("(9, 4.5, 0)", "(0, 0, 2.43)")
    np.testing.assert_array_equal(found.xyz, [[9, 4.5, 0], [0, 0, 2.43]])
    np.testing.assert_array_equal(found.clicks["left"], [[10, 20], [np.nan, np.nan]])
    np.testing.assert_array_equal(found.clicks["right"], [[30, 40], [5, 6]])
    assert found.of("left").tolist() == [0] and found.of("right").tolist() == [0, 1]


def test_survey_coordinates_keep_their_millimetres(tmp_path):
    text = HEADER + "left,1,2,452130.10,5411200.251,0\nleft,3,4,452130.40,5411200.251,-0.0001\n"
    found = read(tmp_path, text + "right,5,6,452130.1,5411200.2513,-0.0\n")
    assert found.points == ("(452130.1, 5411200.251, 0)", "(452130.4, 5411200.251, 0)")
    assert found.of("right").tolist() == [0]


def test_rows_of_other_cameras_are_left_out(tmp_path):
    text = HEADER + "middle,1,2,7,8,0\nleft,1,2,3,4,0\nmiddle,,,3,4,\nend,1,2,3,4,0\n"
    found = read(tmp_path, text)
    assert found.points == ("(3, 4, 0)",) and found.left_out == ("middle", "end")
    assert set(found.clicks) == set(CAMERAS) and read(tmp_path, HEADER).left_out == ()


def test_points_may_have_names(tmp_path):
    text = "point,x_m,y_m,z_m,camera,x_px,y_px\npost,1,2,1.5,left,7,8\n"
    found = read(tmp_path, text)
    assert found.points == ("post",) and found.clicks["left"].tolist() == [[7, 8]]


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("camera,x_px,y_px,x_m,y_m\nleft,1,2,3,4\n", ["expected the columns", "z_m"]),
        ("", ["expected the columns", "an empty file"]),
        (HEADER + "left,1,2,3,four,0\n", ["line 2", "y_m as a finite number, found 'four'"]),
        (HEADER + "left,1,2,3,4,0\nleft,5,6,3,4,0\n", ["line 3", "one click for point (3, 4, 0)"]),
        (
            "point," + HEADER + "a,left,1,2,3,4,0\na,right,1,2,3,5,0\n",
            ["line 3", "point a at (3, 4, 0) m", "(3, 5, 0) m", "correct its place or its name"],
        ),
    ],
)
def test_a_fault_is_one_line(tmp_path, text, parts):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)
    assert all(part in str(caught.value) for part in ["points.csv", *parts]), str(caught.value)
