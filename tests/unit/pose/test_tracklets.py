"""Following several people: a stand-in network that sees squares, two skiers in a real picture."""

import itertools
import json

import cv2
import numpy as np
import pytest

from courtside.pose import blazepose, foreground, tracklets
from courtside.pose.detector import LandmarkNetwork, Pose, Region
from courtside.records.keypoints import missing_reason
from fixtures.recordings import networks
from fixtures.recordings.real_data import REAL, needs_real

EMPTY = np.zeros((240, 640, 3), np.uint8)
SIDE = 40
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, 0]]) * (SIDE / 2)


def picture(places, lower=0):
    """Draw each person in a channel; the second hides the first, but not when so many px lower."""
    image = EMPTY.copy()
    for person, x in enumerate(places):
        if x is not None:
            square = image[100 + person * lower :, x:][:SIDE, :SIDE]
            square[..., person] = 200
            if person and not lower:
                square[..., 0] = 0
    return image


def blobs(image):
    """Return the centres of the squares of which a quarter is to be seen."""
    found = []
    for person in range(2):
        rows, columns = np.nonzero(image[..., person])
        if len(rows) > SIDE * SIDE / 4:
            found.append(np.array([columns.mean() + 0.5, rows.mean() + 0.5]))
    return found


class Finder:
    side_px = 224

    def __init__(self):
        self.asked = 0

    def detect(self, image):
        self.asked += 1
        return [Region(*centre, 80.0) for centre in blobs(image)]


class Placer(LandmarkNetwork):
    """Sees the square nearest to the region's middle, as a real network takes what is there."""

    n_joints = 5

    def estimate(self, image, region):
        found = blobs(image)
        off = [np.hypot(*(centre - [region.x, region.y])) for centre in found]
        near = bool(off) and min(off) < 35
        centre = found[int(np.argmin(off))] if near else np.zeros(2)
        nothing = np.full((5, 3), np.nan)
        return Pose(CORNERS + centre, np.full(5, 0.9), nothing, float(near), Region(*centre, 80.0))


def follow(places, max_people=2, redetect=False, lower=0, background=EMPTY, finder=None):
    finder = finder or Finder()
    frames = [(at / 30, picture(row, lower)) for at, row in enumerate(places)]
    track = tracklets.track_people(
        frames,
        finder,
        Placer(),
        foreground.Foreground(background, 30),
        max_people=max_people,
        min_presence=0.5,
        redetect=redetect,
    )
    return track, getattr(finder, "asked", 0)


def runs(track):
    """Yield (row, frames) of each tracklet."""
    for row, xy in enumerate(track.xy):
        seen = np.flatnonzero(np.isfinite(xy[:, 0, 0]))
        if len(seen):
            for part in np.split(seen, np.flatnonzero(np.diff(seen) > 1) + 1):
                yield row, part


@pytest.mark.parametrize("redetect", [False, True])
def test_two_people_apart_stay_in_two_rows(redetect):
    places = [(50 + 3 * t, 500 - 3 * t) for t in range(30)]
    track, asked = follow(places, redetect=redetect)
    assert track.xy.shape == (2, 30, 5, 2)
    middles = np.sort(track.xy[:, :, 4, 0], axis=0)
    np.testing.assert_allclose(middles, np.array(places).T + SIDE / 2, atol=1)
    assert redetect or asked < 12


def test_one_person_keeps_one_row_through_jumps_of_its_own():
    places = [(50 + 5 * t + (20 if t >= 15 else 0), None) for t in range(30)]
    track, _ = follow(places)
    assert track.xy.shape == (1, 30, 5, 2)
    np.testing.assert_allclose(track.xy[0, :, 4, 0], [x + SIDE / 2 for x, _ in places], atol=1)


def test_who_stands_still_in_the_background_is_found_and_kept():
    places = [(50, 300 + 3 * t) for t in range(60)]
    track, _ = follow(places, background=picture((50, None)))
    assert len(track.xy) == 2
    seen = np.isfinite(track.xy[:, :, 4, 0])
    assert seen.all()
    np.testing.assert_allclose(np.sort(track.xy[:, :, 4, 0], axis=0)[0], 50 + SIDE / 2, atol=1)


def test_everybody_is_found_where_the_background_is_the_picture_itself():
    track, _ = follow([(50, 500)] * 40, background=picture((50, 500)))
    assert len(track.xy) == 2
    assert np.isfinite(track.xy).all()


def test_a_track_that_leaves_the_foreground_and_is_no_person_ends():
    """The landmark network holds on to a thing at x = 50; the person walks away from it."""
    thing = picture((50, None))
    places = [(50, 300 + 3 * t) for t in range(40)]

    class Knows(Finder):
        def detect(self, image):
            found = super().detect(image)
            return [r for r in found if image[..., 1].any()] if len(found) == 1 else found[1:]

    track, _ = follow(places, background=thing, finder=Knows())
    assert np.isfinite(track.xy[:, -1, 4, 0]).sum() == 1
    assert np.nanmax(track.xy[:, -1, 4, 0]) > 400


def test_a_track_in_the_background_that_the_detector_finds_no_more_ends_within_seconds():
    class Forgets(Finder):
        def detect(self, image):
            return super().detect(image) if self.asked < 12 else []

    track, _ = follow([(50, None)] * 240, background=picture((50, None)), finder=Forgets())
    seen = np.flatnonzero(np.isfinite(track.xy[:, :, 4, 0]).any(axis=0))
    assert seen[0] == 0
    assert 90 <= len(seen) <= 180
    np.testing.assert_array_equal(seen, np.arange(len(seen)))


@pytest.mark.parametrize("lower", [0, 10])
def test_no_tracklet_changes_its_person_where_two_pass(lower):
    places = [(50 + 5 * t, 450 - 5 * t) for t in range(80)]
    track, _ = follow(places, lower=lower)
    true = np.array(places) + SIDE / 2
    clear = np.abs(true[:, 0] - true[:, 1]) > 1.2 * SIDE
    owners, frames = set(), np.zeros((2, len(places)), bool)
    for row, part in runs(track):
        assert not (clear[part[0]] and clear[part[-1]] and not clear[part].all()), "it went through"
        part = part[clear[part]]
        if len(part):
            who = np.abs(track.xy[row, part, 4, 0][:, None] - true[part]).argmin(axis=1)
            assert len(set(who)) == 1, (row, part)
            owners.add(int(who[0]))
            frames[who[0], part] = True
    assert owners == {0, 1}
    assert frames[:, clear].mean() > 0.9  # both are found again after the meeting
    assert len(track.xy) <= 6


def test_rows_rest_between_tracklets():
    """Somebody who is gone for one frame and comes back elsewhere gets another row."""
    places = [(x if at else None, None) for x in (50, 400) * 3 for at in range(16)]
    track, _ = follow(places)
    rests_s = []
    for row in range(len(track.xy)):
        parts = [part for own, part in runs(track) if own == row]
        pairs = itertools.pairwise(parts)
        rests_s += [(after[0] - before[-1]) / 30 for before, after in pairs]
    assert rests_s and min(rests_s) >= tracklets.REST_S


def test_a_person_who_comes_late_is_found_and_one_who_leaves_is_gone():
    places = [(50, None)] * 11 + [(50, 400)] * 10 + [(None, 400)] * 10
    track, _ = follow(places)
    seen = np.isfinite(track.xy[:, :, 4, 0])
    by_place = {
        x: (seen & (np.abs(track.xy[:, :, 4, 0] - x - SIDE / 2) < 2)).any(axis=0) for x in (50, 400)
    }
    np.testing.assert_array_equal(np.flatnonzero(by_place[50]), np.arange(21))
    np.testing.assert_array_equal(np.flatnonzero(by_place[400]), np.arange(12, 31))
    assert (track.reason[~seen] == missing_reason.UNSEEN).all()


def test_nobody_at_all_is_one_empty_row():
    track, _ = follow([(None, None)] * 4)
    assert track.xy.shape == (1, 4, 5, 2)
    assert np.isnan(track.xy).all()


@needs_real
def test_blazepose_finds_every_copy_of_a_real_skier(run_folder):
    skier = cv2.imread(str(REAL / "people" / "000000000785.jpg"))
    smaller = cv2.resize(cv2.flip(skier, 1), None, fx=0.7, fy=0.7, interpolation=cv2.INTER_AREA)
    image = np.full((480, 1300, 3), 225, np.uint8)
    room = image.copy()
    image[20 : 20 + 425, 30 : 30 + 640] = skier
    image[100 : 100 + smaller.shape[0], 800 : 800 + smaller.shape[1]] = smaller
    place = blazepose.BlazePoseLandmarks(networks.landmarks_onnx(run_folder))
    track = tracklets.track_people(
        [(0.0, image), (1 / 30, image)],
        blazepose.BlazePoseDetector(networks.detector_onnx(run_folder)),
        place,
        foreground.Foreground(room, 30),
        max_people=3,
        min_presence=0.5,
    )
    # COCO's own marks of shoulders, hips, knees and ankles, left then right, px.
    marked = json.loads((REAL / "people" / "coco_785.json").read_text())["annotations"][0]
    marks = np.array(marked["keypoints"], float).reshape(17, 3)[[5, 6, 11, 12, 13, 14, 15, 16], :2]
    mirrored = np.stack([639 - marks[:, 0], marks[:, 1]], axis=1)[[1, 0, 3, 2, 5, 4, 7, 6]] * 0.7
    ours = track.xy[:, -1][:, [11, 12, 23, 24, 25, 26, 27, 28]]
    assert len(ours) == 2
    off = [
        np.nanmedian(np.linalg.norm(ours - at, axis=-1), axis=1).min() / height
        for at, height in ((np.add(marks, (30, 20)), 300), (np.add(mirrored, (800, 100)), 210))
    ]
    assert max(off) < 0.05
