"""Files of a wand's markers: the study's format, and those of DLTdv, Argus and easyWand."""

import numpy as np
import pytest

from courtside.calibration.wand import points
from courtside.calibration.wand.points import Wand
from courtside.study.errors import InputError

NAMES = {"left": "cam_a", "right": "cam_b"}
SIZES = {"left": (1280, 720), "right": (1920, 1080)}
GIVEN = {"length_m": 0.5}
# One marker at (0, 0), the first pixel's centre at the upper left, and one at (99, 9): as each
# program writes them.
OURS = """camera,frame,marker,x_px,y_px
cam_a,3,tip,0,0
cam_a,3,end,99,9
cam_b,3,tip,0,0
cam_b,3,end,99,9
cam_b,4,tip,1,2
other,3,tip,7,7
cam_b,4,floor,7,7
"""
HEADER = "pt1_cam1_X,pt1_cam1_Y,pt1_cam2_X,pt1_cam2_Y,pt2_cam1_X,pt2_cam1_Y,pt2_cam2_X,pt2_cam2_Y"
ARGUS = HEADER.replace("pt", "Track ").replace("_cam", "_cam_").replace("X", "x").replace("Y", "y")
DLTDV8 = f"{HEADER}\nNaN,NaN,NaN,NaN,,,NaN,NaN\n1,1,1,1,100,10,100,10\n"
DLTDV = f"{HEADER}\nNaN,NaN,NaN,NaN,,,NaN,NaN\n1,720,1,1080,100,711,100,1071\n"


def read(tmp_path, text, **given):
    path = tmp_path / "wand.csv"
    path.write_text(text)
    given = GIVEN | {"points": str(path)} | given
    return points.read(given, Wand.of(given), NAMES, SIZES)


def refused(tmp_path, text, **given):
    with pytest.raises(InputError) as error:
        read(tmp_path, text, **given)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_our_table_by_frames(tmp_path):
    found = read(tmp_path, OURS, markers=["tip", "end"])
    assert found.cameras == ("left", "right")
    assert found.frames.tolist() == [3, 4]
    assert found.xy[0, 0].tolist() == found.xy[1, 0].tolist() == [[0, 0], [99, 9]]
    assert np.isnan(found.xy[0, 1]).all()
    assert found.xy[1, 1, 0].tolist() == [1, 2]


def test_our_table_by_times_is_read_at_the_times_of_one_camera(tmp_path):
    rows = [f"cam_a,{k / 10},{m},{10 * k},{5 * n}" for k in range(20) for n, m in enumerate("ab")]
    late = [f"cam_b,{k / 10 + 0.04},{m},{10 * k + 4},{5 * n}"
            for k in range(19) if k not in (8, 9, 10) for n, m in enumerate("ab")]  # fmt: skip
    found = read(tmp_path, "\n".join(["camera,time_s,marker,x_px,y_px", *rows, *late]))
    np.testing.assert_allclose(found.frames, np.arange(20) / 10)
    np.testing.assert_allclose(found.xy[0, :, 0, 0], 10 * np.arange(20))
    seen = np.isfinite(found.xy[1, :, 0, 0])
    assert seen.tolist() == [k not in (0, 8, 9, 10, 11, 19) for k in range(20)]
    np.testing.assert_allclose(found.xy[1, seen, 0, 0], 10 * np.arange(20)[seen])


def test_arcs_between_the_times_of_a_camera_are_not_shortened(tmp_path):
    """Marker a goes round a circle of 300 px once in 1.5 s; a line between frames misses by 1 px.

    At both ends, and beside a frame that is missing, three times remain: the line is kept.
    """

    def place(t):
        return 500 + 300 * np.cos(2 * np.pi * t / 1.5), 350 + 300 * np.sin(2 * np.pi * t / 1.5)

    rows = ["camera,time_s,marker,x_px,y_px"]
    for name, phase, count in (("cam_a", 0.0, 60), ("cam_b", 1 / 60, 59)):
        for k in range(count):
            if (name, k) != ("cam_b", 30):
                t = k / 30 + phase
                x, y = place(t)
                rows += [f"{name},{t!r},a,{x},{y}", f"{name},{t!r},b,10,10"]
    found = read(tmp_path, "\n".join(rows))
    off = np.linalg.norm(found.xy[1, :, 0] - np.stack(place(found.frames), axis=1), axis=1)
    seen = np.isfinite(off)
    assert seen.tolist() == [0 < k < 59 for k in range(60)]
    line = np.isin(np.arange(60), [1, 58])
    assert off[seen & ~line & (np.abs(np.arange(60) - 30.5) > 2)].max() < 0.05
    assert 0.5 < off[line].min() < off[line].max() < 1.5
    assert off[30:32].max() < 5


def test_times_of_the_floor_may_be_those_of_any_camera(tmp_path):
    """The camera with most times has no row while the wand lies on the floor, at 0.95 s."""
    rows = [f"cam_a,{k / 20},{m},{10 * k},{5 * n}"
            for k in range(60) if k not in range(15, 25) for n, m in enumerate("ab")]  # fmt: skip
    late = [f"cam_b,{k / 10 + 0.05},{m},{20 * k + 10},{5 * n}"
            for k in range(29) for n, m in enumerate("ab")]  # fmt: skip
    text = "\n".join(["camera,time_s,marker,x_px,y_px", *rows, *late])
    assert 0.95 not in read(tmp_path, text).frames
    found = read(tmp_path, text, floor=[0.95, 2.02])
    assert len(found.frames) == 52 and (np.diff(found.frames) > 0).all()
    (at,), (between,) = (np.flatnonzero(found.frames == time) for time in (0.95, 2.02))
    assert np.isnan(found.xy[0, at]).all()
    np.testing.assert_allclose(found.xy[1, at, :, 0], 190)
    np.testing.assert_allclose(found.xy[:, between, :, 0], 404)


@pytest.mark.parametrize(
    ("program", "text"),
    [
        ("dltdv8", DLTDV8),
        ("dltdv", DLTDV),
        ("argus", DLTDV.replace(HEADER, ARGUS).replace("1,7", "0,7").replace("1,1080", "0,1080")
         .replace("100,", "99,")),
        ("dltdv", DLTDV.split("\n", 1)[1]),  # as easyWand reads it, without a header
    ],
)  # fmt: skip
def test_other_programs_place_the_same_markers(tmp_path, program, text):
    found = read(tmp_path, text, program=program)
    assert np.isnan(found.xy[:, 0]).all()
    np.testing.assert_allclose(found.xy[:, 1], [[[0, 0], [99, 9]]] * 2)


def test_numbers_in_scientific_notation_are_no_header(tmp_path):
    found = read(tmp_path, "1.0e+00,1e0,1E0,1,1.00e+02,NaN,,1.0e+01\n", program="dltdv8")
    np.testing.assert_array_equal(found.xy[0, 0], [[0, 0], [np.nan, np.nan]])


def test_a_frame_of_empty_cells_is_a_frame_and_an_empty_line_is_none(tmp_path):
    found = read(tmp_path, f"{HEADER}\n1,1,2,2,3,3,4,4\n,,,,,,,\n\n9,1,2,2,3,3,4,4\n\n",
                 program="dltdv8")  # fmt: skip
    np.testing.assert_array_equal(found.xy[0, :, 0, 0], [0, np.nan, 8])


def test_a_measured_marker_beside_a_gap_is_kept(tmp_path):
    rows = [f"{camera},{k / 10},{m},{10 * k},{5 * n}" for camera in ("cam_a", "cam_b")
            for k in (0, 1, 2, 8, 9) for n, m in enumerate("ab")]  # fmt: skip
    found = read(tmp_path, "\n".join(["camera,time_s,marker,x_px,y_px", *rows]))
    np.testing.assert_allclose(found.frames, [0, 0.1, 0.2, 0.8, 0.9])
    np.testing.assert_allclose(found.xy[:, :, 0, 0], [[0, 10, 20, 80, 90]] * 2)


def test_numbered_cameras_have_the_order_of_the_session(tmp_path):
    found = read(
        tmp_path, f"{HEADER}\n1,1,2,2,3,3,4,4\n", program="dltdv8", cameras=["right", "left"]
    )
    assert found.cameras == ("left", "right")
    assert found.xy[:, 0, 0, 0].tolist() == [1, 0]


def test_markers_are_put_in_their_order_along_the_wand(tmp_path):
    row = f"{HEADER}\n1,1,2,2,3,3,4,4\n"
    found = read(tmp_path, row, program="dltdv8", markers=["pt2", "pt1"])
    assert found.xy[0, 0, :, 0].tolist() == [2, 0]


def test_a_wand_has_two_or_three_markers():
    assert Wand.of(GIVEN).along_m.tolist() == [0, 0.5]
    assert Wand.of(GIVEN | {"middle_m": 0.2}).along_m.tolist() == [0, 0.2, 0.5]


@pytest.mark.parametrize(
    ("text", "given", "message"),
    [
        (OURS, {}, "expected 2 markers, found tip, end, floor; list the wand's markers"),
        (OURS.split("\n")[0], {}, "expected rows of a wand's markers, found none"),
        (OURS.replace("x_px", "u"), {}, "expected the columns camera,marker,x_px,y_px"),
        (OURS.replace(",9\n", ",x\n", 1), {"markers": ["tip", "end"]}, "line 3: expected y_px"),
        (OURS.replace("cam_b", "cam_c"), {"markers": ["tip", "end"]}, "for camera right (cam_b), "
         "found markers of cam_c, other; correct the name in the file"),
        (OURS.replace("cam_", "no_"), {"markers": ["tip", "end"]}, "for camera left (cam_a), "
         "found markers of no_a, no_b, other; correct"),
        ("camera,frame,marker,x_px,y_px\ncam_a,1,a,1,1\ncam_a,1,b,2,2\n", {},
         "for camera right (cam_b), found none; correct the name"),
        (OURS + "cam_a,3,tip,1,1\n", {"markers": ["tip", "end"]}, "expected one row for marker"),
        (OURS, {"markers": ["tip", "End"]}, "of tip, end, floor, found End; correct `wand.mark"),
        (OURS, {"markers": ["Tip", "End"]}, "found Tip, End; correct `wand.markers`"),
        (DLTDV8, {}, "expected the columns camera"),
        (OURS, {"program": "argus"}, "expected columns such as pt1_cam1_X or Track_1_cam_1_x"),
        (DLTDV8.replace("pt2_cam2_Y", "pt2_cam2_X"), {"program": "dltdv8"}, "each once"),
        (DLTDV8.replace(",", ";"), {"program": "dltdv8"}, "with commas between the cells"),
        (DLTDV8.replace(",", "\t"), {"program": "dltdv8"}, "with commas between the cells"),
        (DLTDV8.replace("cam2", "cam3"), {"program": "dltdv8"}, "expected columns of 2 cameras"),
        (DLTDV8 + "1,2\n", {"program": "dltdv8"}, "line 4: expected 8 cells, found 2"),
        (f"{HEADER}\n\n1,1,1,1,1,1,1,1\n\n1,2\n", {"program": "dltdv8"}, "line 5: expected 8"),
        (DLTDV8 + "1,2,3,4,5,six,7,8\n", {"program": "dltdv8"}, "line 4: expected column 6 as a"),
        (DLTDV8, {"program": "dltdv8", "markers": ["pt1", "pt7"]}, "found pt7; correct `wand.mark"),
        (DLTDV8, {"program": "dltdv8", "middle_m": 0.2}, "expected 3 markers, found pt1, pt2"),
        (HEADER, {"program": "dltdv8"}, "expected rows of a wand's markers, found none"),
        ("", {"program": "dltdv8"}, "found an empty file"),
    ],
)  # fmt: skip
def test_faults_are_one_line(tmp_path, text, given, message):
    assert message in refused(tmp_path, text, **given)


def test_markers_outside_the_picture_are_refused(tmp_path):
    message = refused(tmp_path, OURS.replace("99,9", "1500,9"), markers=["tip", "end"])
    assert (
        "camera left: expected markers inside its picture of 1280 x 720 px, found 1 of" in message
    )


def test_neither_frame_nor_time_or_both_is_refused(tmp_path):
    neither = OURS.replace("frame,", "").replace(",3,", ",").replace(",4,", ",")
    assert "expected one column frame or time_s, found none" in refused(tmp_path, neither)
    both = "camera,frame,time_s,marker,x_px,y_px\ncam_a,1,1,a,1,1\n"
    assert "found frame and time_s" in refused(tmp_path, both)
