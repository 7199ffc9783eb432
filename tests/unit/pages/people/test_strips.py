"""Small pictures of persons: when, where, and nobody to be recognised."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from courtside.pages.people import strips
from courtside.records.keypoints.skeleton import Skeleton
from courtside.video import writer
from fixtures.people import named_takes

SKELETON = Skeleton(
    "made", ("a", "b", "c", "d", "e"), (("a", "c"), ("b", "d")), {}, {"face": ("a", "b")}
)


def test_times_are_spread_over_where_the_person_is_seen():
    take = named_takes.take(2)
    every = strips.times(take.found, take.seen, 0)
    assert len(every) == strips.COLUMNS
    assert np.diff(every).min() >= 8
    for rows in take.found.index.values():
        rows[0, 30:] = -1
    early = strips.times(take.found, take.seen, 0)
    assert len(early) == strips.COLUMNS // 2
    assert take.found.time_s[early].max() < 3.0


def test_a_time_is_one_at_which_most_cameras_see_the_person():
    take = named_takes.take(1)
    take.found.index["c1"][0] = -1
    take.found.index["c1"][0, [3, 50]] = 0
    at = strips.times(take.found, take.seen, 0)
    assert {3, 50} <= set(at.tolist())


def test_frames_are_those_of_the_cameras_own_clock():
    take = named_takes.take(1)
    assert strips.frames_at(take.seen[0], np.array([0.0, 1.04, 99])).tolist() == [0, 10, 60]
    slow = replace(take.seen[1], clock=replace(take.seen[1].clock, offset_s=1.5))
    assert strips.frames_at(slow, np.array([0.0])).tolist() == [10]


@pytest.fixture
def video(tmp_path):
    """Return a video of fine stripes, in which every detail shows."""
    width, height = named_takes.SIZE
    image = np.zeros((height, width, 3), np.uint8)
    image[:, ::4] = image[:, 1::4] = 255
    path = tmp_path / "c0.mp4"
    frames = [image] * len(named_takes.TIMES)
    writer.write_video(path, frames, named_takes.RATE_HZ, crf=10, effort="ultrafast")
    return path


def test_pictures_show_the_person_and_hide_face_and_surroundings(video):
    take = named_takes.take(2)
    columns = {0: np.array([0, 30]), 1: np.array([10])}
    shots = list(strips.pictures(take.seen[0], video, take.found, columns, SKELETON))
    assert [(s.person, s.column, s.time_s) for s in shots] == [(0, 0, 0), (1, 0, 1.0), (0, 1, 3.0)]
    x, y = named_takes.place_px(0)
    assert shots[0].at_px == (x, y)
    assert shots[0].size_px == 120
    picture = cv2.imdecode(np.frombuffer(shots[0].picture, np.uint8), cv2.IMREAD_GRAYSCALE)
    assert picture.shape[0] == strips.HEIGHT_PX
    detail = np.abs(np.diff(picture.astype(float), axis=1))
    rows = picture.shape[0]
    assert detail[:, :3].mean() < 15  # surroundings
    assert detail[: rows // 5].mean() < 25  # the face at the top
    assert detail[rows // 2 - 8 : rows // 2 + 8].max() > 60  # the body


def test_a_frame_without_joints_has_no_picture(video):
    take = named_takes.take(1)
    take.seen[0].tracklets.xy[take.found.index["c0"][0, 30], 30] = np.nan
    columns = {0: np.array([0, 30])}
    shots = list(strips.pictures(take.seen[0], video, take.found, columns, SKELETON))
    assert [shot.column for shot in shots] == [0]


def test_a_person_at_the_border_is_cut_there():
    image = np.zeros((50, 40, 3), np.uint8)
    for xy in ([[-5, -5], [3, 60]], [[38, 48], [45, 90]], [[80, 80], [90, 95]]):
        part = strips.cut(image, np.array(xy, float))
        assert max(part.shape[:2]) <= strips.HEIGHT_PX * strips.WIDEST and min(part.shape[:2]) >= 1
