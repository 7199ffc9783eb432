"""From keypoints of several clocks to skeletons: exact scenes, reasons, and real footage."""

from pathlib import Path

import numpy as np
import pytest

from courtside.reconstruction import fusion, resampling
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import missing_reason, skeleton
from courtside.records.keypoints.keypoints import Keypoints2D
from fixtures.cameras import scene

SKELETON = skeleton.read(Path(__file__).parents[3] / "config" / "skeletons" / "cpm14.yaml")
OPTIONS = {"min_score": 0.3, "min_views": 2, "max_error_px": 15, "fade_px": 20, "fix_sides": True}


def body(time_s):
    """Return (T, 14, 3): joints on a line that sways, metres."""
    at = np.arange(14)
    sway = 0.2 * np.sin(2 * np.pi * time_s)[:, None]
    return np.stack(
        [sway + 0 * at, 0.05 * at * np.cos(0 * sway) + 0 * sway, 0.1 * at + 0 * sway], axis=-1
    )


def view(camera, time_s, own_time_s=None):
    xyz = body(time_s)
    xy = scene.opencv_projection(camera, xyz.reshape(-1, 3)).reshape(1, len(time_s), 14, 2)
    shape = xy.shape[:-1]
    own = time_s if own_time_s is None else own_time_s
    return Keypoints2D(
        camera=camera.name,
        model="m",
        joints=np.array(SKELETON.joints),
        size=np.array(camera.size),
        time_s=own,
        xy=xy,
        score=np.ones(shape),
        reason=np.zeros(shape, np.uint8),
        xyz_in_body=np.full((*shape, 3), np.nan),
    )


def test_cameras_of_other_rates_meet_on_common_times():
    cameras = scene.ring(3)
    times = [np.arange(120) / 60, np.arange(100) / 50, np.arange(60) / 30 + 0.004]
    views = [view(c, t) for c, t in zip(cameras, times, strict=True)]
    points, _ = fusion.triangulate_take(cameras, views, SKELETON, ["p1"], **OPTIONS)
    assert points.rate_hz == pytest.approx(60)
    seen = np.isfinite(points.xyz[0, :, 0, 0])
    assert seen.mean() > 0.95
    np.testing.assert_allclose(points.xyz[0, seen], body(points.time_s[seen]), atol=2e-3)


def test_equal_clocks_pass_through_unchanged():
    cameras = scene.ring(2)
    time_s = np.arange(30) / 60
    xy, _ = resampling.resample(
        view(cameras[0], time_s), resampling.common_times([view(c, time_s) for c in cameras])
    )
    np.testing.assert_array_equal(xy, view(cameras[0], time_s).xy)


def test_clocks_of_their_own_are_brought_together():
    cameras = scene.ring(3)
    clocks = [Clock(), Clock(0.7, 150.0), Clock(-0.3, -90.0)]
    own = np.arange(300) / 60
    views = [
        view(c, clock.to_reference(own), own) for c, clock in zip(cameras, clocks, strict=True)
    ]
    points, _ = fusion.triangulate_take(cameras, views, SKELETON, ["p1"], **OPTIONS, clocks=clocks)
    seen = np.isfinite(points.xyz[0, :, 0, 0])
    assert seen.mean() > 0.95
    np.testing.assert_allclose(points.xyz[0, seen], body(points.time_s[seen]), atol=2e-3)


def test_every_missing_point_says_why():
    nan = np.nan
    score = np.array([[nan, 0.1, 0.9, 0.9, 0.9], [nan, 0.9, nan, 0.9, 0.9]])
    xyz = np.full((5, 3), nan)
    xyz[4] = 1.0
    codes = fusion.why_missing(score, xyz, 0.3, 2).tolist()
    assert codes == [
        missing_reason.UNSEEN,
        missing_reason.LOW_SCORE,
        missing_reason.ONE_VIEW,
        missing_reason.REJECTED,
        missing_reason.OK,
    ]


def test_the_measured_noise_gives_honest_ellipsoids():
    cameras = scene.ring(4)
    time_s = np.arange(600) / 60
    views = [view(c, time_s) for c in cameras]
    rng = np.random.default_rng(0)
    sigma_px = np.linspace(1, 4, 14)  # each joint has its own noise, unknown to the method
    for keypoints in views:
        keypoints.xy[...] += rng.normal(0, 1, keypoints.xy.shape) * sigma_px[:, None]
    points, _ = fusion.triangulate_take(
        cameras, views, SKELETON, ["p1"], **{**OPTIONS, "max_error_px": 30, "fade_px": 40}
    )
    error = points.xyz[0] - body(points.time_s)
    squared = np.einsum("tji,tjik,tjk->tj", error, np.linalg.inv(points.covariance_2d[0]), error)
    # 90 % of a chi-squared variable with 3 degrees of freedom lie below 6.251.
    inside = np.mean(squared < 6.251, axis=0)
    assert (inside > 0.85).all()
    assert (inside < 0.95).all()
