"""Limb joints of everybody in several takes, at common times, by camera."""

import numpy as np
import pytest

from courtside.calibration.people.views import joined
from courtside.geometry import camera as camera_models
from courtside.reconstruction import common_views
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import keypoints, people, skeleton
from fixtures.cameras import scene
from fixtures.people import found as people_found
from fixtures.people import view_offsets, walker

CAMERAS = scene.ring(3)


def written(folder, shown, off=False, second=1.0):
    """Write a take that some of the cameras film, and return its record and its files.

    If `off`, the cameras see limbs off as in `view_offsets`. `second` is the second's size.
    """
    folder.mkdir()
    record = walker.points(n_frames=12, n_persons=2)
    record.xyz[1] *= second
    paths = [folder / f"{camera.name}.npz" for camera in shown]
    views = walker.views(record, shown)
    if off:
        at = limbs_of(record)
        for view, xy in zip(views, view_offsets.seen(shown, record.xyz[:, :, at]), strict=True):
            view.xy[:, :, at] = xy
    for path, view in zip(paths, views, strict=True):
        keypoints.write_2d(path, view)
    index = {camera.name: np.tile([[0], [1]], (1, 12)) for camera in shown}
    people.write(
        folder / "people.npz", people_found.people(index, record.person_id, model=record.model)
    )
    everyone = {camera.name: sync.Clock() for camera in (*CAMERAS, *shown)}
    sync.write(folder / "sync.json", "c0", everyone)
    return record, {
        "pose2d": paths,
        "people": folder / "people.npz",
        "sync": folder / "sync.json",
    }


def test_all_takes_are_joined_and_cameras_that_do_not_film_one_see_nobody_there(tmp_path):
    camera_models.write_toml(tmp_path / "cameras.toml", CAMERAS, source="made")
    record, whole = written(tmp_path / "a", CAMERAS)
    _, part = written(tmp_path / "b", CAMERAS[:2])
    names = ["c2", "c0", "c1"]
    found = common_views.of_takes(tmp_path / "cameras.toml", names, [whole, part])
    assert found.xy.shape == (3, 48, 12, 2) and found.score.shape == (3, 48, 12)
    assert found.track.tolist() == [0] * 12 + [1] * 12 + [2] * 12 + [3] * 12
    at = [list(record.joints).index(name) for name in skeleton.JOINTS]
    expected = camera_models.project(CAMERAS[0], record.xyz[:, :, at]).reshape(24, 12, 2)
    known = np.isfinite(expected)
    np.testing.assert_allclose(found.xy[1, :24][known], expected[known], atol=1e-6)
    assert np.isnan(found.score[0, 24:]).all() and np.isfinite(found.height_px).all()
    assert np.isfinite(found.score[1:, 24:]).mean() > 0.9


def limbs_of(record):
    return [list(record.joints).index(name) for name in skeleton.JOINTS]


@pytest.mark.parametrize("second", [1.0, 0.6])
def test_offsets_of_a_network_are_taken_from_its_keypoints(tmp_path, second):
    """Of two adults; and of an adult and a child, whose offsets are smaller."""
    camera_models.write_toml(tmp_path / "cameras.toml", CAMERAS, source="made")
    record, files = written(tmp_path / "a", CAMERAS, off=True, second=second)
    names = [camera.name for camera in CAMERAS]
    exact = np.stack([
        camera_models.project(camera, record.xyz[:, :, limbs_of(record)]).reshape(24, 12, 2)
        for camera in CAMERAS
    ])  # fmt: skip
    seen, found = (
        common_views.of_take(tmp_path / "cameras.toml", names, files, offsets)
        for offsets in (None, view_offsets.table())
    )
    before, after = (np.linalg.norm(one.xy - exact, axis=-1) for one in (seen, found))
    assert np.nanmax(before) > 4
    assert np.nanmax(after) < 0.12 * np.nanmax(before)  # the axes of the trunk are off, too
    np.testing.assert_array_equal(found.score, seen.score)
    assert np.nanmax(np.abs(found.offset_px)) > 4
    some = joined([found.of(np.arange(5)), found.of(np.arange(5, 24))])
    np.testing.assert_allclose(some.detected_xy, seen.xy, atol=1e-9)
    np.testing.assert_array_equal(seen.detected_xy, seen.xy)
    with pytest.raises(ValueError, match="in all takes or in none"):
        joined([found, seen])


def test_a_view_that_contradicts_the_others_keeps_its_offsets(tmp_path):
    """By a camera that looks elsewhere, offsets would move keypoints anywhere."""
    cameras = scene.ring(4)
    _, files = written(tmp_path / "a", cameras, off=True)
    names = [camera.name for camera in cameras]
    cameras[1] = camera_models.turned(cameras[1], np.array([0.3, 0.0, 0.0]))
    camera_models.write_toml(tmp_path / "cameras.toml", cameras, source="made")
    found = common_views.of_take(tmp_path / "cameras.toml", names, files, view_offsets.table())
    of_camera = np.nanmedian(np.abs(found.offset_px), axis=(1, 2, 3))
    assert of_camera[1] == 0
    assert of_camera[[0, 2, 3]].min() > 1


def test_no_take_shows_nobody(tmp_path):
    assert common_views.of_takes(tmp_path / "cameras.toml", ["c0"], []) is None
