"""Whether z of a file's world is up: people who stand, lie and walk, and all kinds of cameras."""

import json
import runpy
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.calibration.file_check import upright
from courtside.geometry import camera as camera_files
from courtside.geometry.camera import project
from courtside.reconstruction import common_views
from courtside.records.keypoints import skeleton
from fixtures.cameras import corner_cameras as hall
from fixtures.cameras.scene import look_at

SCRIPT = Path(__file__).parents[4] / "workflow" / "scripts" / "check_cameras.py"
TRUE = hall.four_cameras()
HEIGHTS = {"shoulder": 1.4, "elbow": 1.1, "wrist": 0.9, "hip": 0.9, "knee": 0.5, "ankle": 0.08}
# How the axes of the file's world are turned: world_file = turn @ world.
WORLDS = {
    "x": Rotation.from_rotvec([0, np.pi / 2, 0]),
    "-x": Rotation.from_rotvec([0, -np.pi / 2, 0]),
    "y": Rotation.from_rotvec([-np.pi / 2, 0, 0]),
    "-y": Rotation.from_rotvec([np.pi / 2, 0, 0]),
    "-z": Rotation.from_rotvec([np.pi, 0, 0]),
}


def people(lying=0.0, walk_m=1.0, n=200, seed=1):
    """Return joints (N, J, 3) m of postures, of which a share lie, in random directions."""
    rng = np.random.default_rng(seed)
    places = rng.uniform(-walk_m, walk_m, (n, 1, 3)) * [1, 1, 0]
    side = [0.18 if name.startswith("left") else -0.18 for name in skeleton.JOINTS]
    up = [HEIGHTS[name.partition("_")[2]] for name in skeleton.JOINTS]
    body = np.column_stack([np.zeros(len(up)), side, up]) + rng.normal(0, 0.03, (n, len(up), 3))
    about = Rotation.from_rotvec(rng.uniform(-np.pi, np.pi, (n, 1)) * [0, 0, 1])
    flat = Rotation.from_rotvec([0, np.pi / 2, 0])
    turns = [turn * flat if at < lying * n else turn for at, turn in enumerate(about)]
    return places + np.stack([turn.apply(one) for turn, one in zip(turns, body, strict=True)])


def seen(cameras, xyz):
    xy = np.stack([project(camera, xyz.reshape(-1, 3)) for camera in cameras])
    noise = np.random.default_rng(2).normal(0, 3, xy.shape)
    return (xy + noise).reshape(len(cameras), *xyz.shape[:2], 2)


def turned(camera, turn):
    """Return a camera in a world that is turned."""
    pose = camera.cam_from_world.copy()
    pose[:, :3] = pose[:, :3] @ turn.as_matrix().T
    return replace(camera, cam_from_world=pose)


def warning(turn, true=TRUE, **more):
    return upright.warning([turned(one, turn) for one in true], seen(true, people(**more)))


@pytest.mark.parametrize("axis", WORLDS)
@pytest.mark.parametrize("lying", [0.0, 0.3])
def test_the_axis_that_is_up_is_named_and_how_it_becomes_z(axis, lying):
    line = warning(WORLDS[axis], lying=lying)
    assert line.startswith(f"the world of the file: expected z up, found {axis} up, by the bodies")
    becomes = line.rpartition("becomes ")[2]
    x, y, z = WORLDS[axis].apply([1.0, 2.0, 3.0])
    back = np.array(eval(becomes, {"x": x, "y": y, "z": z}))
    assert back[2] == pytest.approx(3.0)
    mended = np.stack(
        [eval(becomes, dict(zip("xyz", row, strict=True))) for row in np.eye(3)], axis=1
    )
    assert np.linalg.det(mended) == pytest.approx(1.0)


def test_nothing_is_said_of_a_right_world_or_one_that_is_a_little_tilted():
    for angle in (0.0, 0.2, 0.6):
        assert warning(Rotation.from_rotvec([angle, 0, 0])) == ""
    assert "found up tilted from z by 6" in warning(Rotation.from_rotvec([0.9, 0.6, 0]))


@pytest.mark.parametrize("lying", [0.4, 0.6, 1.0])
def test_nothing_is_said_of_people_who_lie(lying):
    assert warning(Rotation.identity(), lying=lying) == ""


def test_nothing_is_said_of_a_child_that_lies_below_cameras_that_look_down():
    places = [(-0.5, 0.0, 2.5), (0.5, 0.0, 2.5), (0.0, 0.1, 2.6)]
    above = [
        replace(one, cam_from_world=look_at(np.array(place), (place[0] / 2, 0.01, 0.0)))
        for one, place in zip(TRUE, places, strict=False)
    ]
    lying = people(walk_m=0.1) @ Rotation.from_rotvec([np.pi / 2, 0, 0]).as_matrix()
    for way in (lying, lying * [1, -1, 1] + [0, 0.2, 0]):
        assert upright.warning(above, seen(above, way)) == ""


def test_nothing_is_said_of_a_few_postures_or_of_a_picture_that_lies_on_its_side():
    assert warning(WORLDS["y"], n=50) == ""
    side = Rotation.from_rotvec([0, 0, np.pi / 2]).as_matrix()
    rolled = [replace(one, cam_from_world=side @ one.cam_from_world) for one in TRUE]
    assert upright.warning(rolled, seen(rolled, people())) == ""


def test_hips_stand_in_for_ankles_that_no_two_cameras_see():
    xy = seen(TRUE, people())
    ankles = [skeleton.JOINTS.index(f"{side}_ankle") for side in ("left", "right")]
    xy[1:, :, ankles] = np.nan
    cameras = [turned(one, WORLDS["y"]) for one in TRUE]
    assert "found y up" in upright.warning(cameras, xy)
    xy[:] = np.nan
    assert upright.warning(cameras, xy) == ""


def test_the_check_of_a_file_warns(tmp_path, monkeypatch):
    people_seen = seen(TRUE, people())
    in_pictures = SimpleNamespace(xy=people_seen, height_px=np.full(people_seen.shape[:2], 300.0))
    monkeypatch.setattr(common_views, "of_takes", lambda *given: in_pictures)
    written, paths = tmp_path / "check.json", SimpleNamespace(static_csv=None)
    paths.calibration_path = paths.cameras_toml = tmp_path / "cameras.toml"
    names = {camera.name: camera.name for camera in TRUE}
    for axis, found in ("y", 1), ("", 0):
        in_file = [turned(one, WORLDS[axis]) for one in TRUE] if axis else TRUE
        camera_files.write_toml(paths.cameras_toml, in_file, source="test")
        main = runpy.run_path(str(SCRIPT))["main"]
        main(paths, written, tmp_path / "check.csv", names=names, override={}, takes=[])
        content = json.loads(written.read_text())
        assert len(content["warnings"]) == len(content["shared"]) == found
