"""Left and right exchanged in known places must be found there and nowhere else."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry import epipolar
from courtside.reconstruction import left_right
from fixtures.cameras import scene, sync_takes
from fixtures.people import stick_figures

MIRROR = np.arange(12) ^ 1
UPPER, LEGS = list(range(6)), list(range(6, 12))
GROUPS = [UPPER, LEGS]
LIMIT_PX = 15
TIME_S = np.arange(90) / 30
STRETCH = slice(40, 55)


def straight_on(time_s=TIME_S):
    """Return a walk (T, 2) along x at 1.2 m/s, seen from the side by a camera along y."""
    return np.stack([1.2 * (time_s - time_s[-1] / 2), 0 * time_s], axis=1)


def in_a_circle(time_s=TIME_S):
    angle = 2 * np.pi * time_s / time_s[-1]
    return 0.8 * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def hall(count):
    """Return cameras around the walk of which the first sees it from the side, left over right."""
    places = [(0, -7, 1.6), (6, -4, 2.4), (5, 5, 2.2), (-6, 3, 2.0), (-5, -6, 2.5), (1, 8, 3)]
    matrix = np.array([[1400, 0, 959.5], [0, 1400, 539.5], [0, 0, 1.0]])
    return [
        scene.Camera(f"c{at}", scene.SIZE, matrix, np.zeros(5), scene.look_at(place, (0, 0, 1.0)))
        for at, place in enumerate(places[:count])
    ]


def seen(cameras, place, noise_px=3.0, seed=0):
    """Return keypoints (C, T, 12, 2) of a person who walks along places."""
    xyz = stick_figures.body(place, np.arange(len(place)) / 30)
    xy = scene.views(cameras, xyz.reshape(-1, 3)).reshape(len(cameras), len(place), 12, 2)
    return xy + np.random.default_rng(seed).normal(0, noise_px, xy.shape)


def find(cameras, xy, truth=None, score=0.9):
    """Return what is found in keypoints with given exchanges, (C, T, 12)."""
    truth = np.zeros(xy.shape[:-1], bool) if truth is None else truth
    mixed = left_right.apply_swaps(xy, truth, MIRROR)
    score = np.where(np.isfinite(mixed[..., 0]), score, np.nan)
    return left_right.swapped_views(cameras, mixed, score, MIRROR, GROUPS, max_error_px=LIMIT_PX)


def stretch(xy, camera, group, at=STRETCH):
    truth = np.zeros(xy.shape[:-1], bool)
    truth[camera, at, min(group) : max(group) + 1] = True
    return truth


@pytest.mark.parametrize("walk", [straight_on, in_a_circle])
@pytest.mark.parametrize("group", [UPPER, LEGS, UPPER + LEGS])
@pytest.mark.parametrize("count", [2, 3, 4])
def test_exchanges_in_one_view_for_half_a_second_are_found(count, group, walk):
    cameras = hall(count)
    xy = seen(cameras, walk())
    for camera in range(count):
        truth = stretch(xy, camera, group)
        np.testing.assert_array_equal(find(cameras, xy, truth), truth)


def test_two_views_that_flicker_at_different_times_are_told_apart():
    cameras = hall(2)
    xy = seen(cameras, in_a_circle())
    truth = stretch(xy, 0, LEGS, [20, 22, 23]) | stretch(xy, 1, LEGS, [50, 52, 53, 54, 56])
    np.testing.assert_array_equal(find(cameras, xy, truth), truth)


@pytest.mark.parametrize("walk", [straight_on, in_a_circle])
@pytest.mark.parametrize("count", [2, 3, 4, 6])
def test_sides_that_truly_cross_in_the_picture_are_left_alone(count, walk):
    cameras = hall(count)
    for seed in range(3):
        xy = seen(cameras, walk(), seed=seed)
        apart = xy[0, :, 10, 0] - xy[0, :, 11, 0]  # ankles, from the side
        assert (np.diff(np.sign(apart)) != 0).sum() >= 2
        assert not find(cameras, xy).any()


@pytest.mark.parametrize("count", [2, 4])
def test_a_lively_athlete_is_left_alone(count):
    cameras = sync_takes.rig(count)
    for seed in range(3):
        rng = np.random.default_rng(seed)
        xyz = sync_takes.athlete(rng, 5)(np.arange(0, 5, 1 / 30))
        xy = scene.views(cameras, xyz.reshape(-1, 3)).reshape(count, -1, 12, 2)
        xy = xy + rng.normal(0, 2, xy.shape)
        assert find(cameras, xy).mean() < 0.01


@pytest.mark.parametrize("count", [5, 6])
def test_two_wrong_views_of_many_are_found(count):
    cameras = hall(count)
    xy = seen(cameras, in_a_circle())
    for one, other in itertools.combinations(range(count), 2):
        truth = stretch(xy, one, LEGS) | stretch(xy, other, LEGS, slice(45, 70))
        np.testing.assert_array_equal(find(cameras, xy, truth), truth)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_missing_keypoints_do_no_harm(count):
    cameras = hall(count)
    xy = seen(cameras, straight_on())
    rng = np.random.default_rng(1)
    xy[rng.random(xy.shape[:-1]) < 0.1] = np.nan
    xy[0, 47:50], xy[1, 42], xy[:, 60] = np.nan, np.nan, np.nan
    truth = stretch(xy, 0, LEGS)
    seen_at_all = np.isfinite(xy[..., 0]) | np.isfinite(xy[:, :, MIRROR, 0])
    np.testing.assert_array_equal(find(cameras, xy, truth), truth & seen_at_all)


@pytest.mark.parametrize("count", [3, 4])
def test_a_view_that_was_away_for_long_is_judged_anew(count):
    cameras = hall(count)
    xy = seen(cameras, in_a_circle())
    xy[1, 15:60] = np.nan
    truth = stretch(xy, 1, LEGS, slice(60, 75))
    np.testing.assert_array_equal(find(cameras, xy, truth), truth)


@pytest.mark.parametrize("count", [3, 4, 5])
def test_a_view_whose_changes_nobody_saw_is_judged_by_the_others(count):
    cameras = hall(count)
    xy = seen(cameras, in_a_circle())
    xy[0, 10:30], xy[0, 55:75] = np.nan, np.nan
    truth = stretch(xy, 0, LEGS, slice(30, 55))
    score = np.full(count, 0.4)
    score[0] = 0.9  # confident, seen first, and wrong
    found = find(cameras, xy, truth, score[:, None, None])
    np.testing.assert_array_equal(found, truth)


@pytest.mark.parametrize("count", [2, 3, 4])
@pytest.mark.parametrize("at", [slice(0, 15), slice(75, 90)])
def test_of_two_readings_alike_the_one_of_fewer_exchanges_is_kept(count, at):
    cameras = hall(count)
    xy = seen(cameras, straight_on())
    for camera in range(count):
        truth = stretch(xy, camera, LEGS, at)
        np.testing.assert_array_equal(find(cameras, xy, truth), truth)


@pytest.mark.parametrize("n_views", [2, 3])
def test_a_person_between_the_only_two_views_keeps_the_sides(n_views):
    """Both readings fit such a person alike; errors that last for frames must not decide."""
    places = [(-5.7, 5.7, 1.5), (5.7, 5.7, 1.5), (0, -8, 2)][:n_views]
    cameras = [replace(hall(1)[0], cam_from_world=scene.look_at(p, (0, 0, 1))) for p in places]
    time_s = np.arange(150) / 30
    towards = np.stack([0 * time_s, 1e-3 * time_s], axis=1)
    xyz = stick_figures.body(towards, time_s, stride_hz=0.0)
    clean = scene.views(cameras, xyz.reshape(-1, 3)).reshape(n_views, -1, 12, 2)
    for seed in range(6):
        noise = np.random.default_rng(seed).normal(0, 1, (n_views, len(time_s) + 2, 12, 2))
        xy = clean + 6.0 * (noise[:, :-2] + noise[:, 1:-1] + noise[:, 2:]) / np.sqrt(3)
        xy[2:] = np.nan  # a third camera that sees nobody decides nothing
        assert find(cameras, xy).mean() < 0.01


@pytest.mark.parametrize("count", [2, 4, 5])
def test_of_a_person_and_the_mirror_image_the_networks_word_decides(count):
    cameras = hall(count)
    xy = seen(cameras, straight_on())
    assert not find(cameras, xy[:, :, MIRROR]).any()


def test_nothing_seen_and_single_frames_change_nothing():
    cameras = hall(3)
    xy = seen(cameras, straight_on())
    assert not find(cameras, np.full_like(xy, np.nan)).any()
    assert not find(cameras, xy[:, :1]).any()
    xy[2] = np.nan
    truth = stretch(xy, 0, LEGS)
    np.testing.assert_array_equal(find(cameras, xy, truth), truth)


def test_the_cheapest_path_is_the_cheapest_of_all_paths():
    rng = np.random.default_rng(0)
    for _ in range(20):
        cost, change = rng.normal(size=(5, 4)), rng.normal(size=(5, 4))
        change[:, 0] = 0
        price = {
            path: sum(cost[at, state] for at, state in enumerate(path))
            + sum(change[at, path[at] ^ path[at - 1]] for at in range(1, 5))
            for path in itertools.product(range(4), repeat=5)
        }
        assert tuple(left_right.cheapest_path(cost, change)) == min(price, key=price.get)


def test_jumps_tell_an_exchange_from_a_crossing():
    size_px = np.full((1, 6), 100.0)
    weight = np.ones((1, 6, 1))

    def further(apart_px):
        apart = np.stack([np.array(apart_px, float), np.zeros(6)], axis=-1) / 2
        xy = np.stack([apart, -apart], axis=-2)[None, :, None]
        return left_right.jumps(xy, weight, size_px)[0]

    # A resting pair 80 px apart: a change is a jump by 1.6 sizes, more than counts.
    np.testing.assert_allclose(further([80] * 6), [0, 1, 1, 1, 1, 1])
    np.testing.assert_allclose(further([80, 80, 80, -80, -80, -80]), [0, 1, 1, -1, 1, 1])
    # 10 px apart: (20 px / 50 px)^2.
    np.testing.assert_allclose(further([10] * 6), [0, 0.16, 0.16, 0.16, 0.16, 0.16])
    assert further([25, 15, 5, -5, -15, -25])[3] == pytest.approx(0)


def test_movements_over_gaps_count_less_and_then_not_at_all():
    apart = np.full((1, 60, 1, 1), 20.0) * np.array([1, 0])
    xy = np.stack([apart / 2, -apart / 2], axis=-2)
    weight = np.ones((1, 60, 1))
    weight[:, 10:13], weight[:, 30:50] = 0, 0
    found = left_right.jumps(xy, weight, np.full((1, 60), 100.0))[0]
    assert found[9] == pytest.approx(0.64)  # (40 px / 50 px)^2
    assert found[13] == pytest.approx(0.64 / 4)
    assert not found[10:13].any()
    assert found[50] == 0


def test_the_size_is_the_spread_of_the_joints_seen():
    square = np.array([[-30.0, -40], [30, -40], [-30, 40], [30, 40]]) + 500
    xy = np.stack([square, 2 * square, 3 * square])[None].copy()
    np.testing.assert_allclose(left_right.sizes(xy), [[50, 100, 150]])
    xy[0, 1, 1:] = np.nan  # one joint of four: its neighbours tell
    np.testing.assert_allclose(left_right.sizes(xy), [[50, 100, 150]])
    xy[0, 2, 0] = np.nan  # three corners: variances of 800 and 12800 / 9 about their middle
    assert left_right.sizes(xy)[0, 2] == pytest.approx(3 * np.sqrt(800 + 12800 / 9))


LIMIT_PX_SIDES = 15.0
PAIRS = np.array([[0, 1], [2, 3]])


def walking(n_frames=40):
    """Return (T, 4, 3): left and right hip, left and right ankle, in metres."""
    t = np.linspace(0, 2 * np.pi, n_frames)[:, None]
    hip = np.hstack([0 * t, 0.2 + 0 * t, 0.9 + 0 * t])
    ankle = np.hstack([0.3 * np.sin(t), 0.15 + 0 * t, 0.1 + 0 * t])
    other = np.hstack([-0.3 * np.sin(t), -0.15 + 0 * t, 0.1 + 0 * t])
    return np.stack([hip, hip * [1, -1, 1], ankle, other], axis=1)


def seen_sides(n_cameras, dist=(0, 0, 0, 0, 0)):
    cameras = scene.ring(n_cameras, dist=dist)
    xyz = walking()
    xy = scene.views(cameras, xyz.reshape(-1, 3)).reshape(n_cameras, len(xyz), 4, 2)
    straight = [epipolar.straight_px(c, at) for c, at in zip(cameras, xy, strict=True)]
    return cameras, np.stack(straight)[:, :, PAIRS]


def disagreement(cameras, straight, swapped, weight=None):
    weight = np.ones(straight.shape[:3]) if weight is None else weight
    limit_px = np.full(len(cameras), LIMIT_PX_SIDES)
    return left_right.disagreement(cameras, straight, weight, swapped, limit_px)


def every_reading(n_cameras, n_frames):
    bits = (np.arange(2**n_cameras)[:, None] >> np.arange(n_cameras)) & 1 == 1
    return bits, np.repeat(bits[..., None], n_frames, axis=2)


@pytest.mark.parametrize("dist", [(0, 0, 0, 0, 0), (-0.2, 0.05, 1e-3, -1e-3, 0)])
def test_the_true_reading_and_its_mirror_image_agree_and_no_other(dist):
    cameras, straight = seen_sides(4, dist)
    wrong = np.array([False, True, False, True])
    straight[wrong] = straight[wrong][:, :, :, ::-1]
    bits, readings = every_reading(4, straight.shape[1])
    found = disagreement(cameras, straight, readings)
    agree = (bits == wrong).all(axis=1) | (bits == ~wrong).all(axis=1)
    assert agree.sum() == 2
    assert found[agree].max() < 1e-12
    assert found[~agree].min() > 1.0
    np.testing.assert_allclose(found, found[::-1], rtol=1e-9, atol=1e-12)


def test_a_keypoint_counts_once_at_most_times_its_weight():
    cameras, straight = seen_sides(3)
    readings = np.array([[True, False, False]])[..., None] & np.ones((1, 1, 40), bool)
    weight = np.full(straight.shape[:3], 0.25)
    all_off = disagreement(cameras, 1000 * straight, readings, weight)
    np.testing.assert_allclose(all_off, 0.25 * 3 * 2 * 2)  # views, pairs, joints


def test_errors_below_the_limit_count_by_their_square():
    cameras, straight = seen_sides(2)
    none = np.zeros((1, 2, 40), bool)
    found = []
    for off_px in (3.0, 6.0):
        moved = straight.copy()
        moved[0, ..., 1] += off_px  # across the epipolar lines, which run level here or nearly so
        found.append(disagreement(cameras, moved, none))
    np.testing.assert_allclose(found[1] / found[0], 4.0, rtol=0.02)


def test_pairs_that_are_close_say_less():
    cameras, straight = seen_sides(2)
    middle = straight.mean(axis=3, keepdims=True)
    close = middle + 1e-3 * (straight - middle)
    _, readings = every_reading(2, 40)
    assert disagreement(cameras, close, readings).max() < 1e-3


def test_unseen_pairs_and_lone_views_favour_no_reading():
    cameras, straight = seen_sides(3)
    weight = np.ones(straight.shape[:3])
    weight[1, 20:, 0], weight[0, 5], weight[:2, 9] = 0, 0, 0
    straight[weight == 0] = np.nan
    _, readings = every_reading(3, 40)
    found = disagreement(cameras, straight, readings, weight)
    assert np.isfinite(found).all()
    np.testing.assert_allclose(found[0], np.where(np.arange(40) == 9, found[0, 9], 0), atol=1e-12)
    np.testing.assert_allclose(found[:, 9], found[0, 9])
    np.testing.assert_allclose(found[0, 5], found[1, 5], atol=1e-12)  # of the view that saw nothing
    assert found[2, 5] > 1


def test_long_takes_are_counted_in_pieces(monkeypatch):
    cameras, straight = seen_sides(3)
    _, readings = every_reading(3, 40)
    whole = disagreement(cameras, straight, readings)
    monkeypatch.setattr(left_right, "BATCH", 14)
    np.testing.assert_allclose(disagreement(cameras, straight, readings), whole, atol=1e-12)


def test_exchanging_twice_changes_nothing():
    values = np.random.default_rng(0).normal(size=(2, 5, 4, 2))
    swapped = np.zeros((2, 5, 4), bool)
    swapped[1, 2:4] = True
    mirror = [1, 0, 3, 2]
    once = left_right.apply_swaps(values, swapped, mirror)
    np.testing.assert_array_equal(once[1, 2], values[1, 2, [1, 0, 3, 2]])
    np.testing.assert_array_equal(once[0], values[0])
    np.testing.assert_array_equal(left_right.apply_swaps(once, swapped, mirror), values)
