"""Left and right exchanged in known places must be found there and nowhere else."""

import numpy as np

import scene
from courtside.geometry import sides

MIRROR = np.array([1, 0, 3, 2, 4])
GROUPS = [[4], [0, 1, 2, 3]]
LIMIT_PX = 15


def walking(n_frames=40):
    """Return (T, 5, 3): left and right hip, left and right ankle, nose, in metres."""
    t = np.linspace(0, 2 * np.pi, n_frames)[:, None]
    hip = np.hstack([0 * t, 0.2 + 0 * t, 0.9 + 0 * t])
    ankle = np.hstack([0.3 * np.sin(t), 0.1 + 0 * t, 0.1 + 0 * t])
    flip = np.array([1, -1, 1])
    other = np.hstack([-0.3 * np.sin(t), -0.1 + 0 * t, 0.1 + 0 * t])
    nose = np.hstack([0.1 + 0 * t, 0 * t, 1.6 + 0 * t])
    return np.stack([hip, hip * flip, ankle, other, nose], axis=1)


def seen(n_cameras=4):
    cameras = scene.ring(n_cameras)
    xyz = walking()
    xy = scene.views(cameras, xyz.reshape(-1, 3)).reshape(n_cameras, len(xyz), 5, 2)
    return cameras, xy + np.random.default_rng(0).normal(0, 2, xy.shape)


def check(cameras, xy, truth):
    """Swaps are found wherever a pair lies apart in the picture, and none where there is none."""
    mixed = sides.apply_swaps(xy, truth, MIRROR)
    score = np.ones(truth.shape)
    found = sides.swapped_views(cameras, mixed, score, MIRROR, GROUPS, max_error_px=LIMIT_PX)
    apart = np.linalg.norm(xy - xy[:, :, MIRROR], axis=-1) > 2 * LIMIT_PX + 8  # 8 px: noise
    sure = truth & apart[:, :, :4].all(axis=2, keepdims=True)
    assert sure.sum() > 0.5 * truth.sum()
    assert found[sure].all()
    assert not found[~truth].any()
    fixed = sides.apply_swaps(mixed, found, MIRROR)
    np.testing.assert_allclose(fixed[sure], xy[sure])


def test_exchanged_legs_of_one_camera_are_found():
    cameras, xy = seen()
    truth = np.zeros(xy.shape[:-1], dtype=bool)
    truth[2, 10:25, :4] = True
    check(cameras, xy, truth)


def test_two_wrong_cameras_of_five_are_found():
    cameras, xy = seen(5)
    truth = np.zeros(xy.shape[:-1], dtype=bool)
    truth[0, 5:20, :4] = truth[3, 12:30, :4] = True
    check(cameras, xy, truth)


def test_consistent_views_are_left_alone():
    cameras, xy = seen()
    found = sides.swapped_views(
        cameras, xy, np.ones(xy.shape[:-1]), MIRROR, GROUPS, max_error_px=LIMIT_PX
    )
    assert not found.any()


def test_missing_keypoints_do_no_harm():
    cameras, xy = seen()
    xy[2], xy[:, 7] = np.nan, np.nan
    score = np.where(np.isfinite(xy[..., 0]), 0.9, np.nan)
    found = sides.swapped_views(cameras, xy, score, MIRROR, GROUPS, max_error_px=LIMIT_PX)
    assert not found[:, 7].any()
    assert not found[0].any()
