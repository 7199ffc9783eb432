"""Views agree on the reading that shows the body that was filmed, and on its mirror image, and no other."""

import numpy as np
import pytest

from courtside.geometry import epipolar
from courtside.reconstruction import left_right
from fixtures.cameras import scene

LIMIT_PX = 15.0
PAIRS = np.array([[0, 1], [2, 3]])


def walking(n_frames=40):
    """Return (T, 4, 3): left and right hip, left and right ankle, in metres."""
    t = np.linspace(0, 2 * np.pi, n_frames)[:, None]
    hip = np.hstack([0 * t, 0.2 + 0 * t, 0.9 + 0 * t])
    ankle = np.hstack([0.3 * np.sin(t), 0.15 + 0 * t, 0.1 + 0 * t])
    other = np.hstack([-0.3 * np.sin(t), -0.15 + 0 * t, 0.1 + 0 * t])
    return np.stack([hip, hip * [1, -1, 1], ankle, other], axis=1)


def seen(n_cameras, dist=(0, 0, 0, 0, 0)):
    cameras = scene.ring(n_cameras, dist=dist)
    xyz = walking()
    xy = scene.views(cameras, xyz.reshape(-1, 3)).reshape(n_cameras, len(xyz), 4, 2)
    straight = [epipolar.straight_px(c, at) for c, at in zip(cameras, xy, strict=True)]
    return cameras, np.stack(straight)[:, :, PAIRS]


def disagreement(cameras, straight, swapped, weight=None):
    weight = np.ones(straight.shape[:3]) if weight is None else weight
    limit_px = np.full(len(cameras), LIMIT_PX)
    return left_right.disagreement(cameras, straight, weight, swapped, limit_px)


def every_reading(n_cameras, n_frames):
    bits = (np.arange(2**n_cameras)[:, None] >> np.arange(n_cameras)) & 1 == 1
    return bits, np.repeat(bits[..., None], n_frames, axis=2)


@pytest.mark.parametrize("dist", [(0, 0, 0, 0, 0), (-0.2, 0.05, 1e-3, -1e-3, 0)])
def test_the_true_reading_and_its_mirror_image_agree_and_no_other(dist):
    cameras, straight = seen(4, dist)
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
    cameras, straight = seen(3)
    readings = np.array([[True, False, False]])[..., None] & np.ones((1, 1, 40), bool)
    weight = np.full(straight.shape[:3], 0.25)
    all_off = disagreement(cameras, 1000 * straight, readings, weight)
    np.testing.assert_allclose(all_off, 0.25 * 3 * 2 * 2)  # views, pairs, joints


def test_errors_below_the_limit_count_by_their_square():
    cameras, straight = seen(2)
    none = np.zeros((1, 2, 40), bool)
    found = []
    for off_px in (3.0, 6.0):
        moved = straight.copy()
        moved[0, ..., 1] += off_px  # across the epipolar lines, which run level here or nearly so
        found.append(disagreement(cameras, moved, none))
    np.testing.assert_allclose(found[1] / found[0], 4.0, rtol=0.02)


def test_pairs_that_are_close_say_less():
    cameras, straight = seen(2)
    middle = straight.mean(axis=3, keepdims=True)
    close = middle + 1e-3 * (straight - middle)
    _, readings = every_reading(2, 40)
    assert disagreement(cameras, close, readings).max() < 1e-3


def test_unseen_pairs_and_lone_views_favour_no_reading():
    cameras, straight = seen(3)
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
    cameras, straight = seen(3)
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
