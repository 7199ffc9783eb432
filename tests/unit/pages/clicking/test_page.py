"""Content of the clicking page: pictures, court, earlier clicks (browser tests click on it)."""

import json
import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.geometry import camera as cameras
from courtside.pages.clicking import page
from courtside.study.errors import InputError
from fixtures import scripts

COURT = Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml"


@pytest.fixture(scope="module")
def court():
    return court_files.read(COURT)


@pytest.fixture
def picture(tmp_path):
    image = np.random.default_rng(0).integers(0, 255, (60, 80, 3)).astype(np.uint8)
    path = tmp_path / "static.png"
    cv2.imwrite(str(path), image)
    return path, image


def given(built):
    (held,) = re.findall(r'id="data-clicking">(.*?)</script>', built)
    return json.loads(held)


def test_a_picture_is_taken_as_it_is(picture):
    path, image = picture
    exact = page.frame("left", path)
    assert (exact.size, exact.mime, exact.image) == ((80, 60), "image/png", path.read_bytes())
    cv2.imwrite(str(path.with_suffix(".jpg")), image)
    assert page.frame("left", path.with_suffix(".jpg")).mime == "image/jpeg"


@pytest.mark.parametrize("content", [b"", b"no picture", None])
def test_a_file_that_is_not_a_picture_is_named(tmp_path, content):
    path = tmp_path / "odd.png"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=r"odd\.png: expected a .*picture") as fault:
        page.frame("left", path)
    assert "\n" not in str(fault.value)


def test_the_page_holds_points_clicks_and_targets(court, picture):
    path, _ = picture
    clicks = page.by_point(np.array([[1.25, 2.0]] + [[np.nan, 3.0]] * 17), court.points)
    assert clicks == {"p01": [1.25, 2.0]}
    assert page.by_point(None, court.points) == {}
    frames = [
        page.frame("left", path, clicks=clicks),
        page.frame("left", path, take="smash", frame_idx=7),
    ]
    targets = {"court_points.csv": "data/hall/court_points.csv"}
    held = given(page.build("<hall>", court, frames, targets=targets))
    assert held["session"] == "<hall>"
    assert [point["name"] for point in held["court"]["points"]] == list(court.points)
    assert held["court"]["points"][4]["marks"] == [
        {"axis": 0, "at_m": 6.1, "side": 1}, {"axis": 1, "at_m": 4.72, "side": 1},
    ]  # fmt: skip
    assert held["frames"][0]["clicks"] == {"p01": [1.25, 2.0]}
    assert [frame["take"] for frame in held["frames"]] == [None, "smash"]
    assert held["targets"] == {**targets, "racket.csv": "racket.csv"}


def test_kept_work_belongs_to_one_session_its_pictures_and_its_clicks(court, picture):
    path, _ = picture

    def stamp(session="hall", camera="left", clicks=None, proposals=None):
        frame = page.frame(camera, path, clicks=clicks, proposals=proposals)
        return given(page.build(session, court, [frame], targets={}))["stamp"]

    assert stamp() == stamp(proposals={"p01": {"x": 1, "y": 2, "sigma_px": 0.1}})
    different = [
        stamp(),
        stamp(session="gym"),
        stamp(camera="right"),
        stamp(clicks={"p01": [1, 2]}),
    ]
    assert len(set(different)) == 4


@pytest.mark.parametrize("names", [[], ["left", "left"]])
def test_pictures_are_of_different_cameras(court, picture, names):
    frames = [page.frame(name, picture[0]) for name in names]
    with pytest.raises(ValueError, match="expected pictures of different cameras"):
        page.build("hall", court, frames, targets={})


@pytest.mark.parametrize(("place", "aim"), [((3, -6, 3), (3, 8, 0)), ((-1, 5, 2.5), (4, 10, 0))])
def test_the_page_fits_a_camera_with_the_origin_before_or_behind_it(court, place, aim):
    ahead = np.subtract(aim, place) / np.linalg.norm(np.subtract(aim, place))
    right = np.cross(ahead, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    turn = np.stack([right, np.cross(ahead, right), ahead])
    matrix = np.array([[900, 0, 959.5], [0, 900, 539.5], [0, 0, 1]])
    pose = np.column_stack([turn, -turn @ place])
    camera = cameras.Camera("left", (1920, 1080), matrix, np.zeros(5), pose)
    floor = court.xyz[court.xyz[:, 2] == 0]
    xy = cameras.project(camera, floor)
    shown = cameras.in_picture(camera, xy)
    points = [
        {"name": str(at), "xyz": floor[at].tolist(), "xy": xy[at].tolist()}
        for at in np.flatnonzero(shown)
    ]
    found = scripts.call("clicking_fit.js", f"clickFit.fit({json.dumps(points)}, [1920, 1080])")
    assert found["kind"] == "camera" and found["rms"] < 1.0
