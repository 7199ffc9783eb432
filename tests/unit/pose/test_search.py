"""Search for people in tiles, in the foreground and by a second look: made poses, a real skier."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from courtside.pose import blazepose, foreground, search
from courtside.pose.detector import Pose, Region
from fixtures.recordings import networks
from fixtures.recordings.real_data import REAL, needs_real

CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, 0]], float)


def pose(x, y, side=100.0, presence=0.9):
    xy = CORNERS * side / 2 + [x, y]
    return Pose(xy, np.ones(5), np.full((5, 3), np.nan), presence, Region(x, y, 1.4 * side))


def test_a_pose_explains_what_is_close_to_it():
    assert search.around(pose(200, 300)) == pytest.approx((135, 235, 130, 130))
    assert search.surroundings(pose(200, 300)) == Region(200, 300, 200)


def test_the_same_body_is_told_by_its_joints():
    assert search.are_twins(pose(200, 300), pose(208, 300))
    assert not search.are_twins(pose(200, 300), pose(220, 300))
    assert search.inside(Region(210, 300, 100), pose(200, 300))
    assert not search.inside(Region(210, 300, 100), pose(200, 300), reach=0.05)


def test_one_person_found_does_not_confirm_two_poses():
    body, ghost = pose(200, 300), pose(212, 300)
    region = Region(203, 300, 140)
    assert search.inside(region, body) and search.inside(region, ghost)
    assert search.confirms(region, body, [ghost])
    assert not search.confirms(region, ghost, [body])
    assert search.confirms(Region(211, 300, 140), ghost, [body])


def test_close_bodies_are_told_by_their_size():
    assert search.are_close(pose(200, 300), pose(230, 300))
    assert not search.are_close(pose(200, 300), pose(240, 300))
    assert search.are_close(pose(200, 300), pose(240, 300, side=150))


def skiers():
    """Return a real skier twice: whole, and another time half as large beside it."""
    skier = cv2.imread(str(REAL / "people" / "000000000785.jpg"))
    half = cv2.resize(cv2.flip(skier, 1), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    empty = np.full((720, 1280, 3), 225, np.uint8)
    one, two = empty.copy(), empty.copy()
    one[100 : 100 + skier.shape[0], 40 : 40 + skier.shape[1]] = skier
    two[:] = one
    two[300 : 300 + half.shape[0], 850 : 850 + half.shape[1]] = half
    return empty, one, two


@pytest.fixture(scope="module")
def pair(run_folder):
    return (
        blazepose.BlazePoseDetector(networks.detector_onnx(run_folder)),
        blazepose.BlazePoseLandmarks(networks.landmarks_onnx(run_folder)),
    )


@needs_real
def test_tiles_find_people_whom_the_background_shows_and_no_one_twice(pair):
    empty, one, two = skiers()
    looking = search.Search(*pair, foreground.Foreground(two, 30), 0.5)
    found = looking.everywhere(two, [])
    assert len(found) == 2
    assert looking.everywhere(two, found) == []
    unchanged = looking.foreground.boxes(two)  # nothing differs from this background
    assert looking.changed(two, [], 0.0, unchanged) == []
    assert looking.everywhere(empty, []) == []
    assert len(looking.everywhere(one, [])) == 1


@needs_real
def test_the_turns_of_a_search_cover_the_picture(pair):
    _, one, two = skiers()
    looking = search.Search(*pair, foreground.Foreground(two, 30), 0.5)
    known = looking.everywhere(one, [])
    later = [new for _ in range(6) for new in looking.part(two, known)]
    assert later
    assert all(np.median(new.xy[:, 0]) > 800 for new in later)


@needs_real
def test_a_vain_look_at_the_foreground_is_not_repeated_for_a_second(pair):
    empty, one, _ = skiers()
    detector, landmarks = pair
    looking = search.Search(detector, landmarks, foreground.Foreground(empty, 30), 0.5)
    known = looking.everywhere(one, [])
    image = one.copy()
    image[200:500, 1000:1200] = 20  # a dark box: no person
    boxes = looking.foreground.boxes(image)
    asked = []

    class Counting:
        side_px = detector.side_px

        def detect(self, image):
            asked.append(image.shape)
            return detector.detect(image)

    looking.detector = Counting()
    assert looking.changed(image, known, 0.0, boxes) == []
    once = len(asked)
    assert once
    for time_s in (0.1, 0.9):
        assert looking.changed(image, known, time_s, boxes) == []
    assert len(asked) == once
    assert looking.changed(image, known, 1.1, boxes) == []
    assert len(asked) == 2 * once


@needs_real
def test_the_detector_confirms_a_person_and_no_furniture(pair):
    _, one, _ = skiers()
    looking = search.Search(*pair, foreground.Foreground(one, 30), 0.5)
    skier = looking.everywhere(one, [])[0]
    assert looking.look_at(one, skier, [skier]) == (True, [])
    size = skier.size_px
    region = replace(skier.region, y=skier.region.y + 0.1 * size)
    ghost = replace(skier, xy=np.add(skier.xy, (0, 0.2 * size)), region=region)
    assert looking.look_at(one, ghost, [ghost])[0] is True
    assert looking.look_at(one, ghost, [skier, ghost])[0] is False
    moved = replace(skier, xy=np.add(skier.xy, (600, 0)), region=Region(900, 300, 400))
    assert looking.look_at(one, moved, [skier, moved])[0] is False


@needs_real
def test_people_in_the_background_are_recognised_there_or_gone(pair):
    empty, one, two = skiers()
    held = search.Search(*pair, foreground.Foreground(two, 30), 0.5)
    known = held.everywhere(one, [])
    found = held.behind(two, one, np.stack([p.xy for p in known]))  # one stays, the other has left
    assert sorted(np.median(p.xy[:, 0]) > 800 for p in found) == [False, True]
    clean = search.Search(*pair, foreground.Foreground(empty, 30), 0.5)
    assert clean.behind(empty, one, np.stack([p.xy for p in known])) == []
