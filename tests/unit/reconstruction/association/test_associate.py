"""Association over views and time: stick figures cross, occlude one another and leave."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from courtside.reconstruction.association import associate as association
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import stick_figures

COURT = SimpleNamespace(size_m=np.array([6.1, 13.4]), net={"y_m": 6.7})


def cameras_around(count, rng, target=(0, 0, 1.0)):
    """Return cameras 20 m away; two stand 70 degrees apart."""
    angles = np.arange(count) * (2 * np.pi / count if count > 2 else 1.2) + rng.uniform(0, 6)
    return [
        replace(
            scene.ring(1)[0],
            name=f"c{at}",
            cam_from_world=scene.look_at(
                np.add(target, [20 * np.cos(a), 20 * np.sin(a), rng.uniform(1, 5)]), target
            ),
        )
        for at, a in enumerate(angles)
    ]


def crossing(rng, seconds):
    """Return times and two people who pass each other at 0.5 to 1.2 m."""
    time_s = np.arange(int(seconds * 30)) / 30
    while True:
        ends = rng.uniform(-3, 3, (2, 2))
        places = [
            stick_figures.path(rng, time_s, (end, -end + rng.normal(0, 0.3, 2))) for end in ends
        ]
        if 0.5 < np.linalg.norm(places[0] - places[1], axis=1).min() < 1.2:
            break
    bodies = [
        stick_figures.body(place, time_s, size, stride, rng.random())
        for place, size, stride in zip(places, (1.0, 1.05), (1.0, 0.9), strict=True)
    ]
    return time_s, np.stack(bodies)


def associate(cameras, xy, time_s, count=2, court=None):
    return association.associate(cameras, xy, time_s, count, trunk=stick_figures.TRUNK, court=court)


# The constants of the method were chosen on seeds below 100.
@pytest.mark.parametrize("count", [3, 4])
def test_two_people_who_cross_keep_their_identities(count):
    shares = []
    for seed in range(1000, 1010):
        rng = np.random.default_rng(seed)
        time_s, people = crossing(rng, 8)
        cameras = cameras_around(count, rng)
        xy, truth = stick_figures.seen(cameras, people, rng, noise_px=3 + 2 * (seed % 2))
        found = associate(cameras, xy, time_s)
        shares.append(stick_figures.right(found.index, truth, [0, 1]))
    assert np.mean(shares) >= 0.99
    assert min(shares) >= 0.97


def test_two_views_are_enough_when_people_pass_at_speed():
    shares = []
    for seed in range(1000, 1010):
        rng = np.random.default_rng(seed)
        time_s, people = crossing(rng, 3)
        cameras = cameras_around(2, rng)
        xy, truth = stick_figures.seen(cameras, people, rng, noise_px=3)
        shares.append(stick_figures.right(associate(cameras, xy, time_s).index, truth, [0, 1]))
    assert np.mean(shares) >= 0.99


def walkers(*lines, seconds=6, seed=1):
    rng = np.random.default_rng(seed)
    time_s = np.arange(int(seconds * 30)) / 30
    return time_s, np.stack(
        [
            stick_figures.body(stick_figures.path(rng, time_s, line, sway_m=0.2), time_s)
            for line in lines
        ]
    )


def test_persons_are_ordered_by_their_half_of_the_court_and_others_dropped():
    time_s, people = walkers(
        ([2, 10], [4, 11]), ([4, 2], [1, 4]), ([-4.5, 6.7], [-4.4, 6.8]), seconds=5
    )
    rng = np.random.default_rng(5)
    cameras = cameras_around(3, rng, target=(3.05, 6.7, 1.0))
    xy, truth = stick_figures.seen(cameras, people, rng)
    found = associate(cameras, xy, time_s, court=COURT)
    for person, true in enumerate((1, 0)):
        own = [
            (who[index[person], np.arange(len(time_s))] == true)[index[person] >= 0].mean()
            for index, who in zip(found.index, truth, strict=True)
        ]
        assert min(own) > 0.99
        middle = people[true][:, stick_figures.TRUNK].mean(axis=1)
        assert np.median(np.linalg.norm(found.path[person] - middle, axis=1)) < 0.05
    assert (found.placed > 0.9).all()


def test_without_a_net_the_first_seen_come_first_by_x():
    time_s, people = walkers(([2, 1], [2, -1]), ([-1, -1], [-1, 1]), seconds=3)
    rng = np.random.default_rng(6)
    cameras = cameras_around(3, rng)
    xy, _ = stick_figures.seen(cameras, people, rng)
    found = associate(cameras, xy, time_s)
    assert found.path[0, 0, 0] == pytest.approx(-1, abs=0.5)
    assert found.path[1, 0, 0] == pytest.approx(2, abs=0.5)


def test_a_person_who_leaves_comes_back_as_the_same():
    time_s, people = walkers(([2, 1], [2, -1]), ([-1, -1], [-1, 1]), seconds=8)
    rng = np.random.default_rng(7)
    cameras = cameras_around(4, rng)
    xy, truth = stick_figures.seen(cameras, people, rng)
    for view, who in zip(xy, truth, strict=True):
        gone = (who == 0) & (np.abs(time_s - 4) < 1.5)
        view[gone], who[gone] = np.nan, -1
    found = associate(cameras, xy, time_s)
    assert stick_figures.right(found.index, truth, [0, 1]) >= 0.99


def test_a_missing_person_is_reported_and_has_no_rows():
    time_s, people = walkers(([2, 1], [2, -1]), seconds=3)
    rng = np.random.default_rng(8)
    cameras = cameras_around(3, rng)
    xy, truth = stick_figures.seen(cameras, people, rng)
    found = associate(cameras, xy, time_s)
    assert found.placed[1] == 0
    assert all((index[1] == -1).all() for index in found.index)
    assert stick_figures.right([index[:1] for index in found.index], truth, [0]) > 0.99
    assert "p2 not found" in found.line(["p1", "p2"])


def test_views_that_never_meet_are_refused_in_one_line():
    time_s, people = walkers(([2, 1], [2, -1]), ([-1, -1], [-1, 1]), seconds=2)
    rng = np.random.default_rng(9)
    cameras = cameras_around(2, rng)
    xy, _ = stick_figures.seen(cameras, people, rng)
    with pytest.raises(InputError, match=r"^c0, c1: expected people .* found none; check [^\n]*$"):
        associate(cameras, [xy[0], xy[1] + [0, 400]], time_s)


def test_one_tracklet_each_is_one_person_without_any_camera():
    xy = [np.zeros((1, 10, 12, 2)), np.zeros((1, 10, 12, 2))]
    found = associate([], xy, np.arange(10) / 30, count=1)
    assert [index.tolist() for index in found.index] == [[[0] * 10]] * 2


def test_rows_go_over_to_frames_of_another_rate():
    index = np.array([[0, 0, -1, 1, 1]])
    own_s = np.array([-1, 0, 1, 2, 3.1, 4.9, 6, 7, 8, 9]) / 60
    frames = association.on_frames(index, np.arange(5) / 30, own_s)
    # Next to the gap, what the gap's other side says; beyond the ends, what the ends say.
    assert frames.tolist() == [[0, 0, 0, 0, 0, 1, 1, 1, 1, 1]]


def test_a_row_that_went_over_is_not_kept_at_the_gap():
    index = np.array([[0, -1, -1], [1, 0, 0]])
    frames = association.on_frames(index, np.arange(3) / 30, np.array([0, 0.9, 2]) / 30)
    assert frames.tolist() == [[0, -1, -1], [1, 0, 0]]
