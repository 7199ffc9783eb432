"""Clicked points before any job: their file, their pictures, their number."""

import numpy as np
import pytest

PLACES = [(x, y) for x in (-9, 0, 9) for y in (-4.5, 0, 4.5)]
HEADER = "camera,x_px,y_px,x_m,y_m,z_m"


@pytest.fixture
def placed(hall):
    """Return the session with points of its own, which a function writes, and no calibration."""
    hall.path = hall.root / "points.csv"
    hall.content["court_points"] = str(hall.path)
    del hall.content["calibration"]

    def write(
        change=lambda camera, x, y: (x, y),
        cameras=hall.content["cameras"],
        header=HEADER,
        moved_m=0.0,
        times=1,
    ):
        rows = [
            (camera, *change(camera, 290 - 30 * k, 20 + 15 * k), x, y + moved_m * (not at), 0)
            for at, camera in enumerate(cameras)
            for k, (x, y) in enumerate(times * np.array(PLACES))
        ]
        text = "\n".join([header, *(",".join(map(str, row)) for row in rows), ""])
        hall.path.write_text(text.replace(",", ";") if ";" in header else text)
        return hall

    return write


def test_points_as_they_should_be_say_nothing(placed):
    assert placed().said() == ([], [])


@pytest.mark.parametrize(
    ("header", "said"),
    [
        (HEADER.replace(",z_m", ""), "expected the columns camera,x_px,y_px,x_m,y_m,z_m and"),
        (HEADER.replace(",", ";"), "save it with commas between the cells, and points in numbers"),
    ],
)
def test_a_file_that_is_no_such_table_is_told(placed, header, said):
    fault = placed(header=header).fault()
    assert fault.startswith(f"{placed().path}: expected the columns") and said in fault


def test_clicks_outside_of_a_picture_are_told(placed):
    hall = placed(lambda camera, x, y: (x + 40 * (camera == "left"), y))
    assert hall.fault() == (
        f"{hall.path}: camera left: expected clicks in its picture of 320 x 180 px, found "
        "(330, 20); they are px of the videos' own size"
    )
    hall = placed(lambda camera, x, y: (x + 31 + (camera == "left"), y))
    assert hall.said() == ([], [])


def test_exchanged_columns_are_told(placed):
    faults, _ = placed(lambda camera, x, y: (y, x)).said()
    assert len(faults) == 3
    assert (
        "camera right: expected clicks in its picture of 320 x 180 px, found (20, 290)"
        in (faults[1])
    )
    assert faults[1].endswith(
        " and 3 more; x_px and y_px seem to be exchanged: exchange the names of these two columns"
    )


def test_places_of_a_camera_that_are_shifted_are_told(placed):
    hall = placed(moved_m=0.5)
    said = hall.fault()
    assert said.startswith(f"{hall.path}: camera left: expected its 9 points")
    assert "y_m is 0.50 m too large" in said


def test_places_that_are_small_in_another_unit_give_a_remark(placed):
    hall = placed(times=20)
    faults, (remark,) = hall.said()
    assert faults == []
    assert remark.startswith(f"{hall.path}: camera left: its points are 402 m apart: right on a ")
    assert "likely in cm (4.02 m apart" in remark


def test_other_cameras_are_left_out_with_a_remark(placed):
    hall = placed(cameras=["left", "right", "back", "cam5", "cam6"])
    assert hall.said() == (
        [],
        [f"{hall.path}: rows of cam5, cam6 are left out: the session has no such cameras"],
    )


def test_too_few_points_are_told_with_cameras_that_nobody_asked_for(placed):
    hall = placed(cameras=["left", "right", "Back"])
    assert hall.fault() == (
        f"{hall.path}: camera back: expected 8 points or more, found 0; add some; the file has "
        "points of Back"
    )
    hall.content["calibration"] = {"file": str(hall.root / "cameras.toml")}
    assert hall.said()[0] == []


def test_clicks_of_a_smaller_copy_are_doubted(placed):
    hall = placed(lambda camera, x, y: (x / 2, y / 2))
    assert hall.said() == (
        [],
        [
            f"{hall.path}: all clicks lie in the upper left quarter of the pictures (camera left: "
            "up to 145, 70 of 320 x 180 px): right if they are px of the videos' own size, not of "
            "a smaller copy"
        ],
    )


def test_clicked_points_of_a_court_are_read_too(hall):
    path = hall.root / "points.csv"
    hall.content |= {"court": "badminton", "court_points": str(path)}
    rows = ["camera,point,frame_idx,x_px,y_px", *(f"{c},p01,0,300,9" for c in ("left", "back"))]
    path.write_text("\n".join(rows))
    assert hall.said() == ([], [])
    path.write_text("\n".join([*rows, "right,p99,0,3,9"]))
    assert f"{path}: line 4: expected a point of p01, " in hall.fault()
    path.write_text("\n".join([*rows, "right,p02,0,3,300"]))
    assert f"{path}: camera right: expected clicks in its picture" in hall.fault()
    path.unlink()
    assert hall.said() == ([], [])
