"""Association over views and time: stick figures cross, occlude one another and leave."""

import itertools
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from courtside.reconstruction.association import associate as association
from courtside.reconstruction.association import lengths
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


def associate(cameras, xy, time_s, court=None):
    bones = lengths.bones(stick_figures.NAMES)
    return association.associate(
        cameras, xy, time_s, trunk=stick_figures.TRUNK, court=court, bones=bones
    )


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


@pytest.mark.parametrize(("degrees", "away_m", "height_m"), [(10, 8, 2.0), (180, 6, 1.5)])
def test_two_people_pass_before_cameras_that_hardly_measure_depth(degrees, away_m, height_m):
    """Side by side or face to face, cameras place people with errors of decimetres along a line."""
    side = np.radians(degrees)
    places = [(away_m * np.cos(one), away_m * np.sin(one), height_m) for one in (0, side)]
    poses = [scene.look_at(place, (0, 0, 1.0)) for place in places]
    cameras = [replace(one, cam_from_world=p) for one, p in zip(scene.ring(2), poses, strict=True)]
    time_s, people = walkers(([-1.5, -1], [1.5, 1]), ([1.5, -1.2], [-1.5, 0.8]), seconds=8, seed=2)
    rng = np.random.default_rng(2)
    xy, truth = stick_figures.seen(cameras, people, rng, noise_px=4, dropout=0, gap_px=0)
    found = associate(cameras, xy, time_s)
    assert (found.placed >= association.COUNTS).sum() == 2
    assert stick_figures.right(found.index, truth, [0, 1]) > 0.95


def walkers(*lines, seconds=6, seed=1):
    rng = np.random.default_rng(seed)
    time_s = np.arange(int(seconds * 30)) / 30
    return time_s, np.stack(
        [
            stick_figures.body(stick_figures.path(rng, time_s, line, sway_m=0.2), time_s)
            for line in lines
        ]
    )


def test_everybody_is_found_with_exact_paths_the_most_often_seen_first():
    time_s, people = walkers(
        ([2, 10], [4, 11]), ([4, 2], [1, 4]), ([-3.5, 6.7], [-3.4, 6.8]), seconds=5
    )
    rng = np.random.default_rng(5)
    cameras = cameras_around(3, rng, target=(3.05, 6.7, 1.0))
    xy, truth = stick_figures.seen(cameras, people, rng)
    for view, who in zip(xy, truth, strict=True):
        gone = (who == 2) & (time_s > 3)
        view[gone], who[gone] = np.nan, -1
    found = associate(cameras, xy, time_s, court=COURT)
    assert (found.placed[:3] > [0.9, 0.9, 0.4]).all()
    assert (np.diff(found.placed) <= 0).all()
    assert stick_figures.right(found.index, truth, [0, 1, 2]) > 0.97
    middle = people[:, ::3, stick_figures.TRUNK].mean(axis=2)
    for person in range(3):
        off = [np.nanmedian(np.linalg.norm(path - middle[person], axis=1)) for path in found.path]
        assert min(off) < 0.05
    assert found.line().startswith("3 people found, placed from two views or more in ")


def test_who_is_far_from_the_court_is_left_out():
    time_s, people = walkers(([2, 10], [4, 11]), ([-9.5, 6.7], [-9.4, 6.8]), seconds=3)
    rng = np.random.default_rng(5)
    cameras = cameras_around(3, rng, target=(0, 6.7, 1.0))
    xy, _ = stick_figures.seen(cameras, people, rng)
    assert (associate(cameras, xy, time_s, court=COURT).placed > 0.5).sum() == 1
    assert (associate(cameras, xy, time_s).placed > 0.5).sum() == 2


def hall(rng, seconds=8):
    """Return three people, of whom two cross and one stands still, and two bystanders."""
    while True:
        time_s, two = crossing(rng, seconds)
        sway = 0.03 * np.stack([np.sin(0.5 * time_s), np.cos(0.4 * time_s)], axis=1)
        others = [
            stick_figures.body(rng.uniform(-2, 2, 2) + sway, time_s, 1.02, 0.1),
            stick_figures.body(np.add([5.0, rng.uniform(-2, 2)], sway), time_s, 0.97, 0.1),
            stick_figures.body(stick_figures.path(rng, time_s, ([-5, -3], [-5, 3])), time_s, 0.95),
        ]
        people = np.concatenate([two, others])
        place = people.mean(axis=2)[..., :2]
        pairs = itertools.combinations(range(5), 2)
        # Bodies do not go through one another.
        if min(np.linalg.norm(place[a] - place[b], axis=1).min() for a, b in pairs) > 0.5:
            return time_s, people


@pytest.mark.parametrize(
    ("noise_px", "dropout", "swaps"), [(0.5, 0.0, 0.0), (4.0, 0.03, 1.0)], ids=["exact", "noisy"]
)
def test_three_people_and_two_bystanders_keep_their_identities(noise_px, dropout, swaps):
    shares = []
    for seed in range(1000, 1006):
        rng = np.random.default_rng(seed)
        time_s, people = hall(rng)
        cameras = cameras_around(4, rng)
        faults = {"noise_px": noise_px, "dropout": dropout, "swaps": swaps}
        xy, truth = stick_figures.seen(cameras, people, rng, **faults)
        found = associate(cameras, xy, time_s)
        assert (found.placed >= association.COUNTS).sum() == 5
        shares.append(stick_figures.right([i[:5] for i in found.index], truth, range(5)))
    assert np.mean(shares) >= 0.99
    assert min(shares) >= 0.98


def test_two_teams_of_six_and_two_officials_are_each_followed_from_the_first_instant():
    starts = [(x, y) for x in (-3, 0, 3) for y in (-5.5, -2, 2, 5.5)] + [(-5.5, 0), (5.5, 0)]
    lines = [(np.array(at), np.add(at, (0.8, -0.6))) for at in starts]
    time_s, people = walkers(*lines, seconds=4)
    rng = np.random.default_rng(12)
    cameras = cameras_around(4, rng)
    xy, _ = stick_figures.seen(cameras, people, rng, noise_px=1.5)
    found = associate(cameras, xy, time_s)
    middle = people[:, ::3, stick_figures.TRUNK].mean(axis=2)
    near = np.linalg.norm(found.path[:, None] - middle, axis=-1) < 0.3  # found, true, instants
    assert near.mean(axis=2).max(axis=0).min() > 0.9  # by one found person each


def test_more_people_than_can_be_followed_are_told(monkeypatch, caplog):
    time_s, people = walkers(*(([x, 0], [x, 1]) for x in (-3, 0, 3)), seconds=2)
    rng = np.random.default_rng(3)
    cameras = cameras_around(3, rng)
    xy, _ = stick_figures.seen(cameras, people, rng, noise_px=1.0, dropout=0)
    assert associate(cameras, xy, time_s).placed.size == 3
    assert not caplog.records
    monkeypatch.setattr(association, "MOST_PEOPLE", 2)
    assert associate(cameras, xy, time_s).placed.size == 2
    (told,) = caplog.messages
    line = r"camera c\d: expected at most 0 people at once, found 3; only 2 are followed"
    assert re.match(line, told)


def test_a_camera_that_shows_another_person_in_its_only_row_is_left_out():
    time_s, people = walkers(([2, 1], [2, -1]), ([-1, -1], [-1, 1]), seconds=3)
    rng = np.random.default_rng(8)
    cameras = cameras_around(4, rng)
    xy, truth = stick_figures.seen(cameras, people, rng)
    rows = [1 if c == 3 else 0 for c in range(4)]  # the last camera follows the bystander
    one = []
    for view, who, wanted in zip(xy, truth, rows, strict=True):
        row = np.where((who == wanted).any(axis=0), np.argmax(who == wanted, axis=0), 0)
        keep = (who == wanted).any(axis=0)[:, None, None]
        one.append(np.where(keep, view[row, np.arange(len(time_s))], np.nan)[None])
    found = associate(cameras, one, time_s)
    assert found.placed[0] > 0.95
    assert [(index[0] >= 0).mean() > 0.9 for index in found.index] == [True, True, True, False]


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
    # Both were away when they could have been exchanged: this is said, with a probability.
    about = found.doubts[found.doubts[:, 0] < 2]
    assert len(about) and (about[:, 4] < 1).all()


def test_views_that_never_meet_are_refused_in_one_line():
    time_s, people = walkers(([2, 1], [2, -1]), ([-1, -1], [-1, 1]), seconds=2)
    rng = np.random.default_rng(9)
    cameras = cameras_around(2, rng)
    xy, _ = stick_figures.seen(cameras, people, rng)
    with pytest.raises(InputError, match=r"^c0, c1: expected people .* found none; check [^\n]*$"):
        associate(cameras, [xy[0], xy[1] + [0, 400]], time_s)


def test_single_rows_that_never_meet_are_one_person_who_is_never_placed():
    time_s, people = walkers(([2, 1], [2, -1]), seconds=1)
    rng = np.random.default_rng(9)
    cameras = cameras_around(2, rng)
    xy, _ = stick_figures.seen(cameras, people, rng, dropout=0)
    found = associate(cameras, [xy[0], xy[1] + [0, 400]], time_s)
    assert found.placed.tolist() == [0]
    assert found.line() == "nobody placed from two views or more"
    assert [index.tolist() for index in found.index] == [[[0] * len(time_s)]] * 2
    assert np.isnan(found.path).all()


def test_rows_go_over_to_frames_of_another_rate():
    index = np.array([[0, 0, -1, 1, 1]])
    own_s = np.array([-1, 0, 1, 2, 3.1, 4.9, 6, 7, 8, 9]) / 60
    frames = association.on_frames(index, np.arange(5) / 30, own_s)
    # Next to the gap, what the gap's other side says; beyond the ends, what the ends say.
    assert frames.tolist() == [[0, 0, 0, 0, 0, 1, 1, 1, 1, 1]]


@pytest.mark.parametrize("count", [2, 3])
def test_one_person_is_found_in_the_shortest_takes(count):
    for n_frames in (5, 7, 10, 13, 16, 30):
        rng = np.random.default_rng(n_frames)
        time_s = np.arange(n_frames) / 30
        person = stick_figures.body(np.column_stack([0.5 * time_s, 0.2 * time_s]), time_s)[None]
        cameras = cameras_around(count, rng)
        xy, _ = stick_figures.seen(cameras, person, rng, noise_px=2.0, dropout=0, swaps=0)
        assert associate(cameras, xy, time_s).placed.tolist() == [1.0]


def test_a_row_is_not_followed_beyond_the_common_times():
    frames = association.on_frames(np.zeros((1, 4), int), np.arange(4) / 30, np.arange(-9, 13) / 30)
    assert np.flatnonzero(frames[0] == 0).tolist() == list(range(6, 16))  # 0.1 s to either side
    assert set(frames[0].tolist()) == {0, -1}


def test_a_row_that_went_over_is_not_kept_at_the_gap():
    index = np.array([[0, -1, -1], [1, 0, 0]])
    frames = association.on_frames(index, np.arange(3) / 30, np.array([0, 0.9, 2]) / 30)
    assert frames.tolist() == [[0, -1, -1], [1, 0, 0]]
