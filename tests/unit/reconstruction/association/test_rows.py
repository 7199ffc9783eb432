"""Where a row of a camera may change its person."""

import numpy as np
import pytest

from courtside.reconstruction.association import rows
from courtside.records.keypoints import skeleton
from fixtures.cameras import scene
from fixtures.people import keypoints_made

JOINTS = np.array([[-10, 0], [10, 0], [-10, 100], [10, 100], [0, 50]], float)
TRUNK = [0, 1, 2, 3]


def row(x, y=300.0):
    """Return (T, 5, 2) a body 100 px tall at places x (T,)."""
    return JOINTS + np.stack([np.asarray(x, float), np.full(len(x), y)], axis=-1)[:, None]


def test_a_steady_walk_is_one_piece_with_exact_centres():
    x = 100 + 4.0 * np.arange(20)
    found = rows.describe(row(x)[None], TRUNK)
    assert len(set(found.piece[0])) == 1
    np.testing.assert_allclose(found.centre[0], np.stack([x, np.full(20, 350.0)], axis=1))
    np.testing.assert_allclose(found.height_px, 100)


def test_steadying_averages_five_frames():
    noise = np.random.default_rng(1).normal(0, 1, 4000)
    found = rows.describe(row(500 + noise)[None], TRUNK)
    assert len(set(found.piece[0])) == 1
    assert found.centre[0, 5:-5, 0].std() == pytest.approx(1 / np.sqrt(5), rel=0.08)


def test_a_gap_and_a_jump_cut():
    x = 100 + 4.0 * np.arange(20)
    x[12:] += 60
    xy = row(x)[None]
    xy[0, 5] = np.nan
    found = rows.describe(xy, TRUNK)
    assert found.piece[0, 5] == -1
    assert not found.present[0, 5]
    assert {0, 6, 12} <= set(np.flatnonzero(found.cut[0])) <= {0, 6, 12, 13}
    assert np.isnan(found.centre[0, 5]).all()


def test_rows_that_come_close_are_cut_there_and_numbers_differ():
    one, other = 100 + 4.0 * np.arange(60), 340 - 4.0 * np.arange(60)
    found = rows.describe(np.stack([row(one), row(other)]), TRUNK)
    near = np.abs(one - other) < rows.CLOSE * 100
    assert found.cut[:, near].all()
    clear = np.abs(one - other) > 2 * rows.CLOSE * 100
    assert not found.cut[:, clear][:, 1:].any()
    assert not set(found.piece[0]) & set(found.piece[1])
    assert found.piece[0, 0] != found.piece[0, -1]


def between(x, stride):
    """Return places at times between those of frames, `stride` to a frame."""
    own = np.arange(len(x))
    return np.interp(np.arange(stride * (len(x) - 1) + 1) / stride, own, x)


@pytest.mark.parametrize("stride", [1, 2, 4, 8])
@pytest.mark.parametrize("jump", [0.5, 0.8, 1.2])
def test_a_jump_between_two_frames_of_a_slow_camera_cuts(jump, stride):
    x = 100 + 4.0 * np.arange(30)
    x[15:] += 100 * jump
    cut = rows.describe(row(between(x, stride))[None], TRUNK, stride).cut[0]
    around = np.arange(len(cut))
    assert cut[(around > 14 * stride) & (around < 17 * stride)].any()
    assert not cut[1 : 14 * stride].any() and not cut[17 * stride :].any()
    steady = rows.describe(row(between(100 + 4.0 * np.arange(30), stride))[None], TRUNK, stride)
    assert not steady.cut[0, 1:].any()


def test_a_slow_camera_is_steadied_and_kept_apart_by_its_own_frames():
    noise = np.random.default_rng(1).normal(0, 1, 1000)
    each = [
        rows.describe(row(between(500 + noise, stride))[None], TRUNK, stride) for stride in (1, 8)
    ]
    own = slice(5, -5)
    np.testing.assert_allclose(each[1].centre[0, ::8][own], each[0].centre[0][own], atol=1e-9)
    one, other = 100 + 4.0 * np.arange(60), 340 - 4.0 * np.arange(60)
    close = [
        rows.describe(np.stack([row(between(one, n)), row(between(other, n))]), TRUNK, n).close
        for n in (1, 8)
    ]
    assert close[1][:, ::8][close[0]].all()


def test_a_body_seen_in_part_still_has_its_trunk_as_centre():
    xy = row(np.full(9, 200.0))[None]
    xy[0, :, [0, 4]] = np.nan
    found = rows.describe(xy, TRUNK)
    assert found.present.all()
    np.testing.assert_allclose(
        found.centre[0, 4], np.add(np.mean(JOINTS[[1, 2, 3]], axis=0), (200, 300))
    )


def test_an_empty_row_has_nothing():
    found = rows.describe(np.full((1, 3, 5, 2), np.nan), TRUNK)
    assert not found.present.any()
    assert (found.piece == -1).all()


# Left shoulder, elbow, wrist, hip, knee, ankle, then the right ones: 100 px tall.
LIMBS = np.array([(x, y) for x in (10, -10) for y in (0, 20, 40, 45, 70, 100)], float)


def seen(*places):
    """Return what a camera sees of bodies, each at places x (T,) px, NaN where it is missing."""
    xy = np.stack([
        LIMBS + np.stack([np.asarray(x, float), np.full(len(x), 300.0)], axis=-1)[:, None]
        for x in places
    ])  # fmt: skip
    xy[np.isnan(xy[..., 0])] = np.nan
    time_s = np.arange(xy.shape[1]) / 30
    return keypoints_made.view(scene.ring(1)[0], skeleton.JOINTS, time_s, xy)


def test_pieces_show_one_body_each_whatever_a_tracker_exchanges():
    """Two people cross; the tracker follows the wrong one afterwards."""
    one, other = 100 + 4.0 * np.arange(60), 340 - 4.0 * np.arange(60)
    after = np.arange(60) >= 30
    view = seen(np.where(after, other, one), np.where(after, one, other))
    found = rows.separate(view)
    assert len(found) == 4
    shown = [frozenset(after[own >= 0]) for own in found]
    assert set(shown) == {frozenset({False}), frozenset({True})}
    close = np.abs(one - other) < rows.CLOSE * 100
    assert (found[:, close] == -1).all()
    assert sorted(own.max() for own in found) == [0, 0, 1, 1]


def test_a_row_that_resumes_after_a_gap_is_another_piece():
    x = 100 + 0.5 * np.arange(60)
    x[20] = np.nan
    first, second = (np.flatnonzero(own >= 0) for own in rows.separate(seen(x)))
    np.testing.assert_array_equal(first, np.arange(21, 60))
    np.testing.assert_array_equal(second, np.arange(20))


@pytest.mark.parametrize("jump", [0.5, 0.8, 1.2])
def test_a_row_that_jumps_to_another_body_is_another_piece(jump):
    x = 100 + 0.5 * np.arange(60)
    x[30:] += 100 * jump
    found = rows.separate(seen(x))
    after = np.arange(60) >= 30
    assert all(len(set(after[own >= 0])) == 1 for own in found)
    assert (found >= 0).any(axis=0).all()
    assert sorted((found >= 0).sum(axis=1))[-2:] == [29, 30]


def test_the_longest_pieces_are_kept():
    x = np.full(1000, 200.0)
    for gap in range(20):
        x[20 + 45 * gap : 30 + 45 * gap - gap // 4] = np.nan
    found = rows.separate(seen(x))
    lengths = (found >= 0).sum(axis=1)
    assert len(found) == rows.MOST_PIECES
    assert (np.diff(lengths) <= 0).all()
    assert lengths[0] == 119  # after the last gap


def test_nobody_is_in_no_piece():
    assert rows.separate(seen(np.full(9, np.nan))).shape == (0, 9)
