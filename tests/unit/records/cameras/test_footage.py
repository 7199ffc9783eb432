"""What cameras gave, by their own clocks."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry import camera as camera_models
from courtside.records.cameras import footage
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import keypoints, people
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import found as people_found
from fixtures.people import walker

CAMERAS = scene.ring(3)


def written(folder, offset_s=0.25):
    """Write a take whose second camera has its own clock, and return the arguments of `read`."""
    record = walker.points(n_frames=12, n_persons=2)
    views = walker.views(record, CAMERAS)
    views[1] = replace(views[1], time_s=views[1].time_s + offset_s)
    camera_models.write_toml(folder / "cameras.toml", CAMERAS, source="made")
    paths = [folder / f"{view.camera}.npz" for view in views]
    for path, view in zip(paths, views, strict=True):
        keypoints.write_2d(path, view)
    index = np.tile([[1], [0]], (1, 12))  # the first person is the second row
    by_camera = {camera.name: index for camera in CAMERAS}
    people.write(
        folder / "people.npz",
        people_found.people(by_camera, record.person_id, model=record.model),
    )
    clocks = {c.name: sync.Clock(offset_s=offset_s * (c.name == "c1")) for c in CAMERAS}
    sync.write(folder / "sync.json", "c0", clocks)
    videos = ["a", "b", "c"]
    return record, (
        folder / "cameras.toml",
        paths,
        folder / "people.npz",
        folder / "sync.json",
        videos,
    )


def test_views_are_by_person_and_in_the_order_asked_for(tmp_path):
    record, files = written(tmp_path)
    found = footage.read(*files, wanted=["c2", "c1"])
    assert [one.camera.name for one in found] == ["c2", "c1"]
    assert [one.video for one in found] == ["c", "b"]
    exact = scene.opencv_projection(CAMERAS[2], record.xyz[1, 6])
    np.testing.assert_allclose(found[0].view.xy[0, 6], exact, atol=1e-6)
    assert len(footage.read(*files)) == 3


def test_all_tracklets_stay_beside_the_persons(tmp_path):
    _, files = written(tmp_path)
    one = footage.read(*files)[0]
    np.testing.assert_array_equal(one.view.xy, one.tracklets.xy[::-1])
    before = footage.read(*files[:2], None, files[3])[0]
    assert before.people is before.video is None
    np.testing.assert_array_equal(before.view.xy, one.tracklets.xy)


def test_changed_tracklets_are_those_of_the_persons(tmp_path):
    _, files = written(tmp_path)
    one = footage.read(*files)[0]
    moved = replace(one, tracklets=replace(one.tracklets, xy=one.tracklets.xy + 2))
    np.testing.assert_array_equal(moved.view.xy, one.view.xy + 2)


def test_a_doubtful_clock_is_refused_where_it_matters(tmp_path):
    _, files = written(tmp_path)
    doubtful = {c.name: sync.Clock(status="unknown", note="too dark") for c in CAMERAS}
    sync.write(files[3], "c0", doubtful)
    assert len(footage.read(*files)) == 3
    with pytest.raises(InputError, match=r"camera c0: .*too dark"):
        footage.read(*files, sure_clocks=True)


def test_keypoints_of_another_picture_size_are_refused(tmp_path):
    _, files = written(tmp_path)
    small = [replace(c, size=(c.size[0] // 2, c.size[1])) for c in CAMERAS]
    camera_models.write_toml(files[0], small, source="made")
    with pytest.raises(InputError, match="size"):
        footage.read(*files)


def test_frames_are_found_by_the_reference_clock(tmp_path):
    record, files = written(tmp_path)
    for one in footage.read(*files):
        assert one.frame_at(record.time_s[7] + 0.004) == 7
        assert one.reference_s(7) == pytest.approx(record.time_s[7])


def test_a_camera_that_does_not_film_has_no_frame(tmp_path):
    record, files = written(tmp_path)
    first, last = record.time_s[[0, -1]]
    for one in footage.read(*files):
        assert one.frame_at(first - 0.015) == 0
        assert one.frame_at(last + 0.015) == 11
        assert one.frame_at(first - 0.025) is None
        assert one.frame_at(last + 0.025) is None
        times_s = np.array([first - 1, first, last, last + 1])
        np.testing.assert_array_equal(one.frames_at(times_s), [-1, 0, 11, -1])


def test_reprojections_lie_where_opencv_projects(tmp_path):
    record, files = written(tmp_path)
    one = footage.read(*files)[1]
    found = one.reprojected(record, 6)
    np.testing.assert_allclose(
        found[1], scene.opencv_projection(CAMERAS[1], record.xyz[1, 6]), atol=1e-6
    )


def test_between_two_frames_the_middle_is_in_the_middle():
    record = walker.points(n_frames=12)
    middle = (record.xyz[:, 6] + record.xyz[:, 7]) / 2
    found = footage.between(record, (record.time_s[6] + record.time_s[7]) / 2)
    np.testing.assert_allclose(found, middle, atol=1e-9)


def test_on_a_frame_a_missing_neighbour_does_not_matter():
    record = walker.points(n_frames=12)  # joint 4 is missing in frame 3
    for frame in (2, 4):
        assert np.isfinite(footage.between(record, record.time_s[frame])).all()
    assert np.isnan(footage.between(record, record.time_s[3] - 0.005)[0, 4]).all()


def test_beyond_the_take_all_points_are_nan():
    record = walker.points(n_frames=12)
    assert np.isnan(footage.between(record, record.time_s[-1] + 0.1)).all()
    assert np.isfinite(footage.between(record, record.time_s[-1])).all()


def test_a_camera_without_keypoints_or_calibration_is_refused(tmp_path):
    _, (toml, paths, who, clocks, videos) = written(tmp_path)
    with pytest.raises(InputError, match="c2"):
        footage.read(toml, paths[:2], who, clocks, videos[:2], wanted=["c0", "c2"])
    camera_models.write_toml(toml, CAMERAS[:2], source="made")
    with pytest.raises(InputError, match="camera c2"):
        footage.read(toml, paths, who, clocks, videos)
