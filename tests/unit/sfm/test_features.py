"""Features: ids that do not depend on threads, SIFT's own places, and pictures that do not fit."""

from contextlib import closing

import numpy as np
import pycolmap
import pytest
from scipy.spatial import cKDTree

from courtside.sfm import database, features
from courtside.study.errors import InputError
from fixtures.cameras import sfm_made
from fixtures.recordings.real_data import REAL, needs_real

DOOR = REAL / "sfm-door" / "images"


def content(path):
    """Return image ids by name, camera of each, and all keypoints and descriptors."""
    ids = database.image_ids(path)
    with closing(pycolmap.Database.open(path)) as opened:
        cameras = {image.name: image.camera_id for image in opened.read_all_images()}
        places = {name: opened.read_keypoints(k) for name, k in ids.items()}
        looks = {name: opened.read_descriptors(k).data for name, k in ids.items()}
    return ids, cameras, places, looks


def extract(path, root, groups, **changes):
    return features.extract(path, root, groups, **{**sfm_made.EXTRACTION, **changes})


def test_ids_count_through_the_groups_whatever_the_threads(tmp_path):
    groups = sfm_made.wall(tmp_path / "images", 6)
    found = []
    for at, threads in enumerate((1, 2, 2)):
        extract(tmp_path / f"{at}.db", tmp_path / "images", groups, threads=threads)
        found.append(content(tmp_path / f"{at}.db"))
    names = [name for group in groups for name in group.images]
    for ids, cameras, places, looks in found:
        assert ids == {name: at + 1 for at, name in enumerate(names)}
        assert cameras == {"static/side.png": 1, "static/other.png": 2} | dict.fromkeys(
            names[2:], 3
        )
        for name in names:
            np.testing.assert_array_equal(places[name], found[0][2][name])
            np.testing.assert_array_equal(looks[name], found[0][3][name])
    assert sorted(p.name for p in tmp_path.iterdir()) == ["0.db", "1.db", "2.db", "images"]


def test_the_order_of_groups_is_the_one_given(tmp_path):
    names = ("walk/000.png", "walk/001.png", "walk/002.png")
    sfm_made.write(tmp_path, {name: sfm_made.view(at) for at, name in enumerate(names)})
    sfm_made.write(tmp_path, {"a.png": sfm_made.view(4)})
    groups = [features.Group("walk", names), features.Group("a", ("a.png",))]
    extract(tmp_path / "f.db", tmp_path, groups)
    assert list(database.image_ids(tmp_path / "f.db")) == [*names, "a.png"]


def test_places_are_those_of_drawn_blobs(tmp_path):
    """A blob's middle, with the first pixel's centre at (0, 0), is 0.5 less than COLMAP's place."""
    rng = np.random.default_rng(0)
    grid = np.stack(np.meshgrid(np.arange(30, 300, 40), np.arange(30, 220, 40)), axis=-1).reshape(
        -1, 2
    )
    middles = grid + rng.uniform(-1, 1, grid.shape)
    y, x = np.mgrid[0:240, 0:320]
    square = (x - middles[:, 0, None, None]) ** 2 + (y - middles[:, 1, None, None]) ** 2
    picture = 60 + 150 * np.exp(-square / (2 * 3.5**2)).sum(axis=0)
    sfm_made.write(tmp_path, {"blobs.png": picture.round().astype(np.uint8)})
    counts, _ = extract(tmp_path / "f.db", tmp_path, [features.Group("blobs", ("blobs.png",))])
    places = content(tmp_path / "f.db")[2]["blobs.png"][:, :2] - 0.5
    assert counts == {"blobs.png": len(places)}
    distance, nearest = cKDTree(places).query(middles)
    assert distance.max() < 0.1
    assert np.abs(np.mean(places[nearest] - middles, axis=0)).max() < 0.02


def test_fewer_features_when_fewer_are_asked_for(tmp_path):
    """The limit is rough: COLMAP keeps whole scales, and a place may have two orientations."""
    groups = sfm_made.wall(tmp_path)
    many, _ = extract(tmp_path / "many.db", tmp_path, groups, max_features=2000)
    few, _ = extract(tmp_path / "few.db", tmp_path, groups, max_features=50)
    for name in many:
        assert 50 <= few[name] <= 150 < many[name]


def test_the_start_of_the_focal_length_is_in_picture_widths(tmp_path):
    _, guessed = extract(tmp_path / "f.db", tmp_path, sfm_made.wall(tmp_path), focal_factor=0.9)
    with closing(pycolmap.Database.open(tmp_path / "f.db")) as opened:
        cameras = opened.read_all_cameras()
    assert [camera.model.name for camera in cameras] == ["OPENCV"] * 3
    for camera in cameras:
        np.testing.assert_allclose(camera.params, [288, 288, 160, 120, 0, 0, 0, 0])
    assert guessed == ["side", "other", "walk"]


def test_a_picture_of_another_size_is_named(tmp_path):
    groups = sfm_made.wall(tmp_path)
    sfm_made.write(tmp_path, {"walk/002.png": sfm_made.view(2, size=(240, 320))})
    with pytest.raises(
        InputError, match=r"walk/002.png: expected .* others of walk, found 1 of 4 "
    ):
        extract(tmp_path / "f.db", tmp_path, groups)
    assert not list(tmp_path.glob("f.db*"))


def test_an_unreadable_picture_is_named(tmp_path):
    groups = sfm_made.wall(tmp_path)
    (tmp_path / "static" / "other.png").write_text("no picture")
    with pytest.raises(InputError, match=r"static/other.png: .* cannot be read"):
        extract(tmp_path / "f.db", tmp_path, groups)
    (tmp_path / "static" / "side.png").unlink()
    with pytest.raises(InputError, match=r"static/side.png: .* cannot be read"):
        extract(tmp_path / "f.db", tmp_path, groups)


def test_pictures_of_two_groups_may_differ_in_size(tmp_path):
    groups = sfm_made.wall(tmp_path)
    sfm_made.write(tmp_path, {"static/side.png": sfm_made.view(2, size=(400, 300))})
    extract(tmp_path / "f.db", tmp_path, groups)
    with closing(pycolmap.Database.open(tmp_path / "f.db")) as opened:
        assert [(c.width, c.height) for c in opened.read_all_cameras()] == [(400, 300)] + [
            (320, 240)
        ] * 2


def test_a_flat_picture_has_no_features(tmp_path):
    sfm_made.write(tmp_path, {"flat.png": np.full((240, 320), 128, np.uint8)})
    counts, _ = extract(tmp_path / "f.db", tmp_path, [features.Group("flat", ("flat.png",))])
    assert counts == {"flat.png": 0}


@needs_real
def test_a_stated_focal_length_is_used(tmp_path):
    """The door's photos state 43 mm for a film of 36 mm by 24 mm; others measured 2394 px."""
    group = features.Group("door", ("DSC_0001.JPG",))
    _, guessed = extract(tmp_path / "f.db", DOOR, [group], max_features=100)
    assert guessed == []
    with closing(pycolmap.Database.open(tmp_path / "f.db")) as opened:
        (camera,) = opened.read_all_cameras()
    assert (camera.width, camera.height) == (1296, 1936)
    expected = 43 / np.hypot(36, 24) * np.hypot(1296, 1936)
    assert camera.params[0] == pytest.approx(expected, rel=1e-3)
    assert expected == pytest.approx(2394, rel=0.04)


def test_a_group_without_images_is_a_fault_of_the_caller(tmp_path):
    groups = [*sfm_made.wall(tmp_path), features.Group("walk2", ())]
    with pytest.raises(ValueError, match=r"groups without images: \['walk2'\]"):
        extract(tmp_path / "f.db", tmp_path, groups)
