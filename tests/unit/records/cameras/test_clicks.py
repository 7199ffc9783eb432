"""Clicked court points: round trip and every fault in one line."""

import numpy as np
import pytest

from courtside.records.cameras import clicks
from courtside.study.errors import InputError

HEADER = "camera,point,frame_idx,x_px,y_px\n"
CAMERAS, POINTS = ["left", "centre"], ("p01", "p02", "p03")


def saved(tmp_path, text):
    path = tmp_path / "court_points.csv"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_a_written_file_is_read_exactly(tmp_path):
    rng = np.random.default_rng(0)
    given = {camera: rng.uniform(0, 4000, (3, 2)) for camera in CAMERAS}
    given["left"][1] = np.nan
    path = tmp_path / "new" / "court_points.csv"
    clicks.write(path, given, POINTS)
    found = clicks.read(path, CAMERAS, POINTS)
    assert list(found) == CAMERAS
    for camera in CAMERAS:
        np.testing.assert_array_equal(found[camera], given[camera])
    assert len(path.read_text().splitlines()) == 6  # the missing click has no row
    assert [p.name for p in path.parent.iterdir()] == ["court_points.csv"]


def test_a_table_from_a_spreadsheet_is_read(tmp_path):
    text = (
        "﻿point, camera,x_px,y_px,frame_idx\r\np02,left, 12.5,-3e-1,0\r\n"
        ",,,,\r\n\r\np01,centre,7,8,0\r\n"
    )
    found = clicks.read(saved(tmp_path, text), CAMERAS, POINTS)
    np.testing.assert_array_equal(found["left"], [[np.nan] * 2, [12.5, -0.3], [np.nan] * 2])
    np.testing.assert_array_equal(found["centre"], [[7, 8], [np.nan] * 2, [np.nan] * 2])


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("", ["an empty file", "columns"]),
        ("camera;point;frame_idx;x_px;y_px\n", ["commas", "camera;point"]),
        ("camera,point,x_px,y_px\n", ["frame_idx"]),
        (HEADER + "right,p01,0,1,2\n", ["line 2", "'right'", "left, centre"]),
        (HEADER + "left,p01,0,1,2\nleft,p19,0,1,2\n", ["line 3", "'p19'", "p01, p02, p03"]),
        (HEADER + "left,p01,0,1,2\nleft,p02,0,1,2\nleft,p01,0,1,3\n", ["line 4", "line 2", "p01"]),
        (HEADER + "left,p01,0,1,\n", ["line 2", "y_px", "''"]),
        (HEADER + "left,p01,0,nan,2\n", ["line 2", "x_px", "'nan'"]),
        (HEADER + "left,p01,0,1,inf\n", ["line 2", "y_px", "'inf'"]),
        (HEADER + "left,p01,7,1,2\n", ["line 2", "frame_idx", "static picture", "'7'"]),
        (HEADER + "left,p01,0,1\n", ["line 2", "5 cells", "found 4"]),
        (HEADER + "left,p01,0,1,2,3\n", ["line 2", "5 cells", "found 6"]),
        (HEADER + 'left,"p01,0,1,2\n', ["CSV"]),
        (b"\xff\xfe\x00camera", ["UTF-8"]),
    ],
)  # fmt: skip
def test_a_fault_is_one_line_that_names_it(tmp_path, text, named):
    path = saved(tmp_path, text)
    with pytest.raises(InputError) as caught:
        clicks.read(path, CAMERAS, POINTS)
    message = str(caught.value)
    assert "\n" not in message
    assert [word for word in [str(path), *named] if word not in message] == []


def test_a_missing_file_and_a_wrong_shape_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"none\.csv: expected a readable"):
        clicks.read(tmp_path / "none.csv", CAMERAS, POINTS)
    with pytest.raises(ValueError, match="left"):
        clicks.write(tmp_path / "x.csv", {"left": np.zeros((2, 2))}, POINTS)
    assert list(tmp_path.iterdir()) == []


def test_points_at_rest_have_names_of_their_own(tmp_path):
    text = HEADER + "left,bolt,0,1,2\ncentre,mark,0,5,6\ncentre,bolt,0,3,4\nleft,mark,0,7,8\n"
    points, xy = clicks.read_static(saved(tmp_path, text), [*CAMERAS, "right"])
    assert points == ["bolt", "mark"]
    np.testing.assert_array_equal(xy[:2], [[[1, 2], [7, 8]], [[3, 4], [5, 6]]])
    assert np.isnan(xy[2]).all()


def test_a_point_at_rest_that_one_camera_shows_is_refused(tmp_path):
    text = HEADER + "left,bolt,0,1,2\ncentre,bolt,0,3,4\nleft,mark,0,7,8\n"
    with pytest.raises(InputError, match="point mark: expected clicks in two cameras or more"):
        clicks.read_static(saved(tmp_path, text), CAMERAS)
    with pytest.raises(InputError, match="camera of left, centre, found 'side'"):
        clicks.read_static(saved(tmp_path, HEADER + "side,bolt,0,1,2\n"), CAMERAS)
