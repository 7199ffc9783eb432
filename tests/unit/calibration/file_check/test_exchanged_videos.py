"""Exchanged cameras are named from features of the hall; nothing is said of anything else."""

import json
import runpy
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pandas as pd
import pytest

from courtside.calibration.file_check import exchanged_videos
from courtside.geometry import camera as camera_models
from courtside.video import reader
from fixtures.cameras import floor_pictures, scene
from fixtures.recordings.real_data import REAL, needs_real

ROOT = Path(__file__).parents[4]
PAIRS = list(combinations(range(4), 2))


def made(n_true=12, n_false=80, seed=0, uneven=True):
    """Return four cameras far apart, and matches of which few are of the same place."""
    rng, rings = np.random.default_rng(seed), [(6, 2.0), (5, 3.0), (7, 2.5), (8, 4.0)]
    cameras = (
        [scene.ring(4, size[0], height_m=size[1])[at] for at, size in enumerate(rings)]
        if uneven
        else scene.ring(4)
    )
    matches = {}
    for one, other in PAIRS:
        xyz = rng.uniform([-3, -3, 0], [3, 3, 3], (n_true, 3))
        true = [camera_models.project(cameras[at], xyz) for at in (one, other)]
        false = rng.uniform(0, scene.SIZE, (2, n_false, 2))
        noise = rng.normal(0, 0.5, (2, n_true, 2))
        matches[one, other] = tuple(np.concatenate([np.add(true, noise), false], axis=1))
    return cameras, matches


def given(cameras, order):
    """Return the cameras in another order, under the names that they should have."""
    return [replace(cameras[k], name=own.name) for own, k in zip(cameras, order, strict=True)]


def exchanged(cameras, one, other):
    order = list(range(len(cameras)))
    order[one], order[other] = other, one
    return given(cameras, order)


def test_of_right_cameras_nothing_is_said():
    cameras, matches = made()
    found = exchanged_videos.judge(cameras, matches)
    assert found.warnings == [] and found.names == {name: name for name in found.names}
    assert (found.table.near >= 12).all() and (found.table.n == 92).all()
    assert found.unjudged == [] and found.remarks == []


@pytest.mark.parametrize(("one", "other"), PAIRS)
def test_two_exchanged_cameras_are_named(one, other):
    cameras, matches = made()
    found = exchanged_videos.judge(exchanged(cameras, one, other), matches)
    (line,) = found.warnings
    assert line.startswith(f"the videos of c{one} and c{other} are exchanged; correct the session")
    assert (found.table.near_after >= 12).all()
    assert found.table.near.sum() < 0.6 * found.table.near_after.sum()


def test_in_a_regular_ring_both_possible_exchanges_are_named():
    cameras, matches = made(uneven=False)
    (line,) = exchanged_videos.judge(exchanged(cameras, 0, 2), matches).warnings
    assert "c0 and c2" in line and "c1 and c3" in line and ", or of " in line


@pytest.mark.parametrize("order", [(1, 2, 0, 3), (3, 0, 1, 2), (0, 3, 1, 2)])
def test_cameras_named_off_by_one_are_told_whose_video_each_has(order):
    cameras, matches = made(n_true=30)
    found = exchanged_videos.judge(given(cameras, order), matches)
    assert [found.names[f"c{k}"] for k in order] == ["c0", "c1", "c2", "c3"]
    (line,) = found.warnings
    at = next(at for at, k in enumerate(order) if k != at)
    assert line.startswith(f"the video given for c{at} is of c{list(order).index(at)}, the video")


def test_of_many_cameras_two_exchanged_ones_are_named():
    rng = np.random.default_rng(0)
    cameras = [scene.ring(8, 5 + at % 3, height_m=2 + at % 4)[at] for at in range(8)]
    matches = {}
    for one, other in combinations(range(8), 2):
        xyz = rng.uniform([-3, -3, 0], [3, 3, 3], (20, 3))
        matches[one, other] = tuple(camera_models.project(cameras[at], xyz) for at in (one, other))
    assert exchanged_videos.judge(cameras, matches).warnings == []
    (line,) = exchanged_videos.judge(exchanged(cameras, 2, 5), matches).warnings
    assert line.startswith("the videos of c2 and c5 are exchanged;")


def test_two_exchanged_pairs_are_both_named():
    cameras, matches = made(n_true=30)
    (line,) = exchanged_videos.judge(given(cameras, (1, 0, 3, 2)), matches).warnings
    assert line.startswith("the videos of c0 and c1, and of c2 and c3 are exchanged; correct")


@pytest.mark.parametrize("what", ["turned", "moved", "focal length"])
def test_a_camera_that_is_wrong_otherwise_is_no_exchange(what):
    cameras, matches = made()
    one = cameras[1]
    shift = one.cam_from_world + np.array([[0, 0, 0, 1.0], [0, 0, 0, 0], [0, 0, 0, 2.0]])
    cameras[1] = {
        "turned": camera_models.turned(one, np.array([0, 0.2, 0])),
        "moved": replace(one, cam_from_world=shift),
        "focal length": replace(one, K=one.K * [[1.4, 1, 1], [1, 1.4, 1], [1, 1, 1]]),
    }[what]
    assert exchanged_videos.judge(cameras, matches).warnings == []


def test_pictures_without_a_common_place_say_nothing():
    cameras, matches = made(n_true=0)
    for one, other in PAIRS:
        assert exchanged_videos.judge(exchanged(cameras, one, other), matches).warnings == []
    nothing = {pair: (np.zeros((0, 2)), np.zeros((0, 2))) for pair in PAIRS}
    assert exchanged_videos.judge(cameras, nothing).warnings == []


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (0, 1, 3, 2)])
def test_cameras_that_share_no_place_with_others_are_said_not_to_be_judged(order):
    cameras, matches = made(n_true=30)
    _, chance = made(n_true=0, n_false=110)
    alone = {pair: chance[pair] if {2, 3} & set(pair) else matches[pair] for pair in PAIRS}
    found = exchanged_videos.judge(given(cameras, order), alone)
    (line,) = found.remarks
    assert found.warnings == [] and found.unjudged == ["c2", "c3"]
    assert line.startswith("whether the videos of c2 and c3 are exchanged could not be judged:")
    assert "of 550 features that look alike there, " in line
    one = {pair: chance[pair] if 3 in pair else matches[pair] for pair in PAIRS}
    assert exchanged_videos.judge(cameras, one).remarks == []  # c3 is seen in another's place


def test_features_are_matched_where_they_are_the_same_place():
    cameras = floor_pictures.cameras(2)
    matches = exchanged_videos.match(floor_pictures.pictures(cameras))
    places = [floor_pictures.on_floor(*each) for each in zip(cameras, matches[0, 1], strict=True)]
    away_m = np.linalg.norm(places[0] - places[1], axis=1)
    assert len(away_m) > 50
    assert np.mean(away_m < 0.03) > 0.9  # a px is 7 to 20 mm there


def test_large_pictures_are_made_smaller_and_matched_in_their_own_px():
    cameras = floor_pictures.cameras(2)
    pictures = floor_pictures.pictures(cameras)
    larger = [cv2.resize(picture, None, fx=4, fy=4) for picture in pictures]
    xy = exchanged_videos.match(larger)[0, 1]
    places = [
        floor_pictures.on_floor(camera, (px + 0.5) / 4 - 0.5)
        for camera, px in zip(cameras, xy, strict=True)
    ]
    away_m = np.linalg.norm(places[0] - places[1], axis=1)
    assert len(away_m) > 50 and np.mean(away_m < 0.03) > 0.9


def test_plain_pictures_have_no_matches():
    plain = np.full((54, 96), 128, np.uint8)
    for pictures in (
        [plain, plain],
        [plain, floor_pictures.pictures(floor_pictures.cameras(1))[0]],
    ):
        xy_one, xy_other = exchanged_videos.match(pictures)[0, 1]
        assert xy_one.shape == xy_other.shape == (0, 2)


def test_the_step_names_the_take_of_exchanged_videos(tmp_path, capfd):
    cameras = floor_pictures.cameras(3)
    camera_models.write_toml(tmp_path / "cameras.toml", cameras, source="test")
    files = {}
    for camera, picture in zip(cameras, floor_pictures.pictures(cameras), strict=True):
        files[camera.name] = str(tmp_path / f"{camera.name}.png")
        cv2.imwrite(files[camera.name], picture)
    halls = [
        {"take": "", "pictures": files},
        {"take": "shot", "pictures": files | {"c0": files["c2"], "c2": files["c0"]}},
        {"take": "serve", "pictures": {name: files[name] for name in ("c0", "c1")}},
        {"take": "fog", "pictures": dict.fromkeys(("c0", "c1"), str(tmp_path / "fog.png"))},
    ]
    cv2.imwrite(halls[-1]["pictures"]["c0"], np.full((54, 96), 128, np.uint8))
    script = runpy.run_path(str(ROOT / "workflow" / "scripts" / "check_videos.py"))
    told, table = tmp_path / "videos.json", tmp_path / "videos.csv"
    paths = SimpleNamespace(cameras_toml=tmp_path / "cameras.toml")
    script["main"](paths, told, table, halls=halls)
    content = json.loads(told.read_text())
    (line,), (remark,) = content["warnings"], content["remarks"]
    assert remark.startswith("take fog: whether the videos of c0 and c1 are exchanged could not be")
    assert line.startswith("take shot: the videos of c0 and c2 are exchanged; correct the session")
    assert capfd.readouterr().err == f"Warning: {line}; see {told}\n"
    rows = pd.read_csv(table, keep_default_na=False)
    assert rows["take"].tolist() == [""] * 3 + ["shot"] * 3 + ["serve", "fog"]
    assert (rows.near_after / rows.n > 0.6)[:-1].all() and rows.n.iloc[-1] == 0


@pytest.fixture(scope="module")
def hall():
    """Return the cameras of a real hall, and matches of their right videos."""
    folder = REAL / "hall-markers"
    cameras = camera_models.read_toml(folder / "calibration_refined.toml")
    cameras = [camera for camera in cameras if (folder / f"{camera.name}.mp4").is_file()]
    first = {c.name: next(reader.frames(folder / f"{c.name}.mp4")) for c in cameras}
    pictures = [cv2.cvtColor(first[c.name][-1], cv2.COLOR_BGR2GRAY) for c in cameras]
    matches = exchanged_videos.match(pictures)
    assert exchanged_videos.judge(cameras, matches).warnings == []
    return cameras, matches


@needs_real
@pytest.mark.parametrize(("one", "other"), [("cam08", "cam13"), ("cam02", "cam08")])
def test_exchanged_videos_of_a_real_hall_are_named(hall, one, other):
    cameras, matches = hall
    names = [camera.name for camera in cameras]
    wrong = exchanged(cameras, names.index(one), names.index(other))
    (line,) = exchanged_videos.judge(wrong, matches).warnings
    assert line.startswith(f"the videos of {one} and {other} are exchanged")
