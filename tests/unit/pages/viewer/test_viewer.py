"""The viewer's page, read by a parser: its content, nothing outside, names are escaped."""

import json
import re
import runpy
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.figures.style import source_styles, style
from courtside.pages import page
from courtside.pages.viewer import layers as viewer_layers
from courtside.pages.viewer import viewer
from courtside.records.devices import clocks, device_motion
from courtside.records.keypoints import keypoints, missing_reason
from fixtures.cameras import scene
from fixtures.people import walker

CONFIG = Path(__file__).parents[4] / "config"
ROGUE = '</script><img src="https://example.invalid/x">"&'


class Stores(HTMLParser):
    """Collects JSON by element id, and every address in an attribute."""

    def __init__(self, source):
        super().__init__()
        self.held, self.addresses, self.title, self._into = {}, [], "", None
        self.feed(source)

    def handle_starttag(self, tag, attrs):
        has = dict(attrs)
        self.addresses += [value for key, value in attrs if key in ("src", "href", "action")]
        self._into = has.get("id", tag)

    def handle_endtag(self, tag):
        self._into = None

    def handle_data(self, data):
        if self._into in ("data-scene", "data-layers"):
            self.held[self._into] = json.loads(data)
        if self._into == "title":
            self.title += data


def layer(name="raw", n_frames=20, **more):
    return viewer_layers.of_points(name, walker.points(n_frames=n_frames), walker.SKELETON, **more)


def test_the_page_says_whose_axes_it_shows():
    ring, hall = scene.ring(4), court_files.read(CONFIG / "courts" / "badminton.yaml")
    alone = viewer.build("t", [layer("suit")])
    assert "Axes: those of suit, turned so that z points up. Heights count from its origin" in alone
    assert "Axes: those of the calibration of the cameras." in viewer.build("t", [layer()], ring)
    assert "Axes: those of the court." in viewer.build("t", [layer()], ring, hall)


def test_the_page_requests_nothing_and_escapes_names():
    cameras = scene.ring(3)
    source = viewer.build(ROGUE, [layer(ROGUE)], cameras, notes=[ROGUE])
    read = Stores(source)
    assert read.title == ROGUE
    assert read.held["data-layers"][0]["name"] == ROGUE
    assert read.held["data-scene"]["notes"] == [ROGUE]
    assert [at for at in read.addresses if not at.startswith("data:")] == []
    rest = source.replace("https:\\/\\/example", "").replace("https://example", "")
    assert re.findall(r"https?:|//[a-z]+\.[a-z]", rest) == []
    assert "<img" not in source
    assert len(source) < 200_000


def test_cameras_are_pyramids_that_project_onto_their_pictures_corners():
    for camera in scene.ring(4):
        drawn = viewer.frustum(camera, 0.7)
        xy = scene.opencv_projection(camera, np.array(drawn["corners"]))
        width, height = camera.size
        corners = np.array([[0, 0], [width, 0], [width, height], [0, height]]) - 0.5
        np.testing.assert_allclose(xy, corners, atol=1e-3)
        seen = np.array(drawn["corners"]) @ camera.cam_from_world[:, :3].T
        np.testing.assert_allclose(seen[:, 2] + camera.cam_from_world[2, 3], 0.7)
        np.testing.assert_allclose(np.linalg.norm(drawn["forward"]), 1)


def test_the_court_is_drawn_as_in_its_file():
    court = court_files.read(CONFIG / "courts" / "badminton.yaml")
    drawn = viewer.drawn_court(court)
    areas = [
        cv2.contourArea(np.array([place[:2] for place in line], np.float32))
        for line in drawn["lines"]
    ]
    widths = court.lines_m[:, 2:] - court.lines_m[:, :2]
    np.testing.assert_allclose(areas, widths.prod(axis=1), rtol=1e-5)
    top = drawn["net"][0]["points"]
    assert top == [[0.0, 6.7, 1.55], [3.05, 6.7, 1.524], [6.1, 6.7, 1.55]]
    heights = [part["points"][1][2] for part in drawn["net"][6:]]
    assert max(heights) < 1.55 and min(heights) >= 1.524


def test_without_a_court_a_grid_lies_around_the_movement():
    read = Stores(viewer.build("t", [layer()]))
    grid = np.array(read.held["data-scene"]["grid"])
    xyz = walker.points().xyz.reshape(-1, 3)
    low, high = np.nanmin(xyz, axis=0), np.nanmax(xyz, axis=0)
    assert (grid[..., :2].min(axis=(0, 1)) < low[:2]).all()
    assert (grid[..., :2].max(axis=(0, 1)) > high[:2]).all()
    assert not grid[..., 2].any()
    assert read.held["data-scene"]["court"] is None


def test_a_take_too_large_is_thinned_and_says_so(monkeypatch):
    monkeypatch.setattr(viewer, "LARGEST_BYTES", 8_000)
    whole = layer(n_frames=200)
    read = Stores(viewer.build("t", [whole]))
    kept = len(read.held["data-layers"][0]["time_s"])
    every = -(-200 // kept)
    assert 1 < every < 10
    rate = 1 / np.diff(whole.time_s)[0] / every
    note = read.held["data-scene"]["notes"][-1]
    assert f"one frame of {every} is in it, {rate:.2g} per second" in note
    sizes = []
    for denser in (every - 1, every):
        packed = viewer_layers.packed(whole, np.zeros(3), denser)
        sizes.append(sum(len(text) for text in packed.values() if isinstance(text, str)))
    assert sizes[0] > 8_000 >= sizes[1]
    assert "one frame of" not in str(
        Stores(viewer.build("t", [layer()])).held["data-scene"]["notes"]
    )


def test_colours_are_those_of_the_figures():
    assert (viewer.LEFT, viewer.RIGHT, viewer.MIDDLE) == (style.LEFT, style.RIGHT, style.MIDDLE)
    assert set(viewer.LAYER_COLOURS) <= {*style.CYCLE, source_styles.OTHER}


def test_seven_layers_have_seven_colours():
    names = ["corrected", "filtered", "raw", "mocopi", "mocopi-corrected", "d415-depth", "d415-rgb"]
    held = Stores(viewer.build("t", [layer(name) for name in names])).held
    colours = held["data-scene"]["colours"]["layers"]
    assert len({colours[at % len(colours)] for at in range(len(names))}) == len(names)


def test_the_page_is_written_whole(tmp_path):
    source = viewer.build("t", [layer()])
    page.write(tmp_path / "v.html", source)
    assert (tmp_path / "v.html").read_text(encoding="utf-8") == source


@pytest.mark.parametrize("layers", [[], [layer(), layer()]])
def test_layers_need_names_that_differ(layers):
    with pytest.raises(ValueError, match="differ"):
        viewer.build("t", layers)


def test_every_reason_for_a_missing_joint_has_words():
    script = (page.ASSETS / "viewer_panel.js").read_text()
    words = script.split("const WHY = {")[1].split("}")[0]
    told = {int(code) for code in re.findall(r"(\d+):", words)}
    assert set(missing_reason.WORDS) - {missing_reason.OK} <= told


def test_a_device_of_unknown_clock_is_left_out_and_the_page_says_so(tmp_path):
    record = walker.points()
    files = [tmp_path / "points.npz", tmp_path / "suit.npz", tmp_path / "depth.npz"]
    keypoints.write_3d(files[0], record)
    suit = device_motion.DeviceMotion(
        source="suit",
        kind="inertial",
        joints=record.joints,
        time_s=record.time_s + 50,  # on a clock of its own
        xyz=walker.body(20),
        reason=np.zeros((20, walker.N_JOINTS), np.uint8),
        performed=np.ones(20, bool),
    )
    device_motion.write(files[1], suit)
    device_motion.write(files[2], replace(suit, source="depth"))
    found = {
        "cameras": clocks.Clock(status="reference"),
        "suit": clocks.Clock(status="unknown", note="no clap"),
        "depth": clocks.Clock(50.0, status="found"),
    }
    clocks.write(tmp_path / "clocks.json", "cameras", found)
    paths = SimpleNamespace(
        skeletons=[CONFIG / "skeletons" / "blazepose33.yaml"],
        clocks=tmp_path / "clocks.json",
        court=None,
        cameras=None,
    )
    layers = [{"file": files[0], "name": "raw", "skeleton": 0, "shown": True}]
    device = {"skeleton": 0, "shown": False, "person": "p1", "placed": True}
    names = zip(files[1:], ("suit", "depth"), strict=True)
    layers += [{**device, "file": file, "name": name, "source": name} for file, name in names]
    script = runpy.run_path(str(CONFIG.parent / "workflow" / "scripts" / "build_viewer.py"))
    script["main"](paths, tmp_path / "page.html", title="t", layers=layers)
    held = Stores((tmp_path / "page.html").read_text()).held
    assert [layer["name"] for layer in held["data-layers"]] == ["raw", "depth"]
    assert held["data-scene"]["notes"] == ["suit is not shown: its clock is unknown (no clap)."]
