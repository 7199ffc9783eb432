"""Following one person: a stand-in network that answers from the picture itself."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.pose import tracking
from courtside.pose.detector import LandmarkNetwork, Pose, Region
from courtside.records.keypoints import missing_reason

EMPTY = np.zeros((240, 320, 3), np.uint8)


class Finder:
    """Finds the white square; counts how often it is asked."""

    def __init__(self):
        self.asked = 0

    def detect(self, image):
        self.asked += 1
        rows, columns = np.nonzero(image[..., 0])
        return [Region(columns.mean(), rows.mean(), 80.0)] if len(rows) else []


class Placer(LandmarkNetwork):
    """Sees the square when the region holds it."""

    n_joints = 3

    def estimate(self, image, region):
        rows, columns = np.nonzero(image[..., 0])
        near = len(rows) and np.hypot(columns.mean() - region.x, rows.mean() - region.y) < 40
        centre = np.array([columns.mean(), rows.mean()]) if near else np.zeros(2)
        xy = np.stack([centre, centre, centre + np.array([400, 0])])
        nothing = np.full((3, 3), np.nan)
        return Pose(
            xy, np.array([0.9, 0.9, 0.8]), nothing, float(bool(near)), Region(*centre, 80.0)
        )


class Anybody(LandmarkNetwork):
    """Sees a person in every region but the largest."""

    n_joints = 3

    def estimate(self, image, region):
        xy = np.full((3, 2), [region.x, region.y])
        nothing = np.full((3, 3), np.nan)
        return Pose(xy, np.full(3, 0.9), nothing, float(region.side < 100), region)


def picture(x):
    image = EMPTY.copy()
    if x is not None:
        image[100:140, x : x + 40] = 255
    return image


def follow(places, redetect=False):
    finder = Finder()
    frames = [(at / 30, picture(x)) for at, x in enumerate(places)]
    track = tracking.track_person(
        frames,
        finder,
        Placer(),
        min_presence=0.5,
        redetect=redetect,
    )
    return track, finder.asked


def test_the_detector_is_asked_once_while_the_track_holds():
    track, asked = follow([20, 30, 40, 50, 60])
    np.testing.assert_allclose(track.xy[0, :, 0, 0], [39.5, 49.5, 59.5, 69.5, 79.5])
    np.testing.assert_allclose(track.time_s, np.arange(5) / 30)
    assert asked == 1


def test_a_lost_person_is_searched_again():
    track, asked = follow([20, 30, 200, 210, None, None, 100])
    assert asked == 5
    assert (track.reason[0, 4:6] == missing_reason.UNSEEN).all()
    assert np.isnan(track.xy[0, 4:6]).all()
    np.testing.assert_allclose(track.xy[0, [2, 3, 6], 0, 0], [219.5, 229.5, 119.5])


def test_the_largest_person_is_followed():
    """The detector is surer of a bystander than of the player."""
    image = EMPTY.copy()
    image[100:140, 200:240] = 255
    player, bystander = Region(219.5, 119.5, 80.0), Region(20.0, 120.0, 30.0)
    poster = Region(100.0, 120.0, 200.0)  # in which the landmark network sees nobody

    class Several:
        def detect(self, image):
            return [bystander, player, poster]

    track = tracking.track_person(
        [(0.0, image)], Several(), Anybody(), min_presence=0.5, redetect=True
    )
    np.testing.assert_allclose(track.xy[0, 0, 0], [player.x, player.y])


class Scene(LandmarkNetwork):
    """Sees persons at places (x, size) px; the picture says which list of them is there."""

    n_joints = 3

    def __init__(self, people):
        self.people = people

    def detect(self, image):
        return [Region(x, 120.0, 1.2 * size) for x, size in self.people[image[0, 0, 0]]]

    def estimate(self, image, region):
        there = self.people[image[0, 0, 0]]
        x, size = min(there, key=lambda one: abs(one[0] - region.x), default=(0, 1))
        seen = abs(x - region.x) < 0.3 * size and 0.5 < 1.2 * size / region.side < 2
        xy = np.array([[x, 120 - size / 2], [x, 120.0], [x, 120 + size / 2]])
        place = Region(x, 120.0, 1.2 * size)
        return Pose(xy, np.full(3, 0.9), np.full((3, 3), np.nan), float(seen), place)


def followed_sizes(people):
    """Return the size in px of who is followed, ten pictures a second; `people` by second."""
    scene, frames = Scene(people), []
    for at in range(10 * len(people)):
        image = EMPTY.copy()
        image[0, 0] = at // 10
        frames.append((at / 10, image))
    track = tracking.track_person(frames, scene, scene, min_presence=0.5, redetect=False)
    return np.ptp(track.xy[0, ..., 1], axis=-1)


BYSTANDER, PLAYER = (250, 60), (100, 160)


def test_a_larger_person_who_comes_back_is_followed_instead_of_a_bystander():
    both = [BYSTANDER, PLAYER]
    sizes = followed_sizes([both, both, [BYSTANDER], both, both])
    assert (sizes[:20] == 160).all() and (sizes[20:30] == 60).all()
    assert (sizes[40:] == 160).all()  # at the latest after a second


def test_a_larger_person_who_comes_late_is_followed():
    sizes = followed_sizes([[BYSTANDER], [BYSTANDER, PLAYER], [BYSTANDER, PLAYER]])
    assert (sizes[:10] == 60).all() and (sizes[20:] == 160).all()


def test_who_squats_stays_followed_beside_a_bystander():
    beside = (250, 140)
    sizes = followed_sizes([[beside, PLAYER], [beside, (100, 110)], [beside, (100, 90)]])
    np.testing.assert_allclose(sizes, np.repeat([160, 110, 90], 10))


def test_redetection_asks_in_every_frame():
    _, asked = follow([20, 30, 40], redetect=True)
    assert asked == 3


def test_joints_outside_the_picture_say_so():
    track, _ = follow([20])
    assert track.reason[0, 0].tolist() == [
        missing_reason.OK,
        missing_reason.OK,
        missing_reason.OUT_OF_IMAGE,
    ]
    assert np.isnan(track.xy[0, 0, 2]).all()
    assert np.isnan(track.score[0, 0, 2])


def test_scores_up_to_one_stay_and_missing_ones_are_not_counted():
    track, _ = follow([20, None])
    same, doubt = tracking.limited(track, "any", 1)
    np.testing.assert_array_equal(same.score, track.score)
    high = replace(track, score=track.score * 4)
    cut, doubt = tracking.limited(high, "any", 1)
    assert "5 % of its scores exceed 3.6" in doubt
    np.testing.assert_array_equal(cut.score[0], [[1, 1, np.nan], [np.nan] * 3])


def test_scores_divided_by_too_much_are_told_where_nobody_is_found():
    row = tracking.as_row(None, 3, None)
    nobody = tracking.Track(
        np.zeros(1), *(part[None, None] for part in row), np.zeros((1, 1, 2, 3))
    )
    assert (
        "nobody was found, with scores divided by `full_score: 40`"
        in tracking.limited(nobody, "any", 40)[1]
    )
    assert tracking.limited(nobody, "any", 1)[1] == ""  # an empty hall


@pytest.mark.parametrize("finds", [True, False])
def test_the_search_looks_near_the_foreground(finds):
    image = picture(200)
    finder = Finder()
    if not finds:
        finder.detect = lambda _: []
    region = tracking.regions_near(image, (200, 100, 40, 40), finder)[0]
    assert (region.x, region.y) == pytest.approx((219.5, 119.5), abs=1)
    without = tracking.regions_near(image, (200, 100, 40, 40), finder, fallback=False)
    assert len(without) == finds


def test_straying_is_told_by_the_boxes():
    xy = np.array([[90.0, 90.0], [110.0, 110.0]])
    assert not tracking.strayed(xy, [(80, 80, 40, 40)])
    assert not tracking.strayed(xy, [(300, 300, 40, 40), (105, 105, 40, 40)])
    assert tracking.strayed(xy, [(300, 300, 40, 40)])
    assert not tracking.strayed(xy, [])
