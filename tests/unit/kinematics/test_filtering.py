"""Gaps and filters against functions whose answer is known."""

from dataclasses import replace

import numpy as np

from courtside.kinematics import filtering
from courtside.records.keypoints import missing_reason
from fixtures.people.waves import record, wave

MORE_ERRORS = "covariance_camera", "covariance_network", "offset", "outlier"


def test_short_gaps_are_filled_and_marked_long_ones_left():
    xyz = wave(1.0)
    holed = xyz.copy()
    holed[100:106], holed[200:230], holed[:4] = np.nan, np.nan, np.nan
    filled = filtering.fill_gaps(record(holed), max_gap_s=0.1)
    np.testing.assert_allclose(filled.xyz[0, 100:106], xyz[100:106], atol=0.03)
    assert (filled.reason[0, 100:106] == missing_reason.INTERPOLATED).all()
    assert np.isnan(filled.xyz[0, 200:230]).all()
    assert np.isnan(filled.xyz[0, :4]).all()
    np.testing.assert_array_equal(filled.xyz[0, 6:100], xyz[6:100])


def filled_error(rate_hz, noise_m):
    """Return the error (m) of frames in gaps of 0.2 s of a point that sways at 1.3 m/s at most."""
    time_s = np.arange(round(20 * rate_hz)) / rate_hz
    true = 0.4 * np.stack([np.sin(3.2 * time_s + k) for k in range(3)], axis=1)[:, None]
    seen = true + np.random.default_rng(0).normal(0, noise_m, true.shape)
    lost = (time_s % 0.8 >= 0.4) & (time_s % 0.8 < 0.6 - 1e-9)
    seen[lost] = np.nan
    filled = filtering.fill_gaps(replace(record(seen), time_s=time_s), max_gap_s=0.21).xyz[0]
    assert np.isfinite(filled[lost]).all()
    return np.sqrt(np.mean(np.sum((filled - true)[lost] ** 2, axis=-1)))


def test_more_frames_do_not_make_filled_gaps_worse():
    usual = filled_error(30, 0.01)
    assert usual < 0.04
    for rate_hz, share in ((50, 1.1), (60, 1.1), (120, 0.8), (240, 0.8), (1000, 0.8)):
        assert filled_error(rate_hz, 0.01) < share * usual
    for rate_hz in (10, 30, 240):
        assert filled_error(rate_hz, 0.0) < 0.02


def test_a_frame_between_two_gaps_is_enough_to_fill_both():
    xyz = wave(0.5)
    lost = np.r_[100:106, 107:113, 1:5]
    holed = xyz.copy()
    holed[lost] = np.nan
    filled = filtering.fill_gaps(record(holed), max_gap_s=0.1).xyz[0]
    np.testing.assert_allclose(filled[lost], xyz[lost], atol=0.02)


def test_frames_that_are_known_far_worse_than_the_rest_are_left_out():
    points = record(np.zeros((40, 3, 3)))
    points.covariance_2d[0, :5] *= 100  # two cameras from nearly one side: ten times the deviation
    points.covariance_2d[0, 20, 0] *= 10000  # one joint alone is no reason
    points.xyz[0, 2, 1] = np.nan
    points = replace(points, **{key: np.ones_like(getattr(points, key)) for key in MORE_ERRORS})
    found = filtering.leave_out_uncertain(points)
    assert np.isnan(found.xyz[0, :5]).all()
    for key in ("covariance_2d", *MORE_ERRORS):
        stated = getattr(found, key)[0]
        assert np.isnan(stated[:2]).all()
        np.testing.assert_array_equal(stated[5:], getattr(points, key)[0, 5:])
    assert np.isfinite(found.xyz[0, 5:]).all()
    assert (found.reason[0, :2] == missing_reason.UNCERTAIN).all()
    assert not found.n_views[0, :2].any() and not found.accepted[0, :2].any()
    assert np.isnan(found.reproj_error_px[0, :2]).all()
    np.testing.assert_array_equal(found.n_views[0, 5:], points.n_views[0, 5:])
    assert found.reason[0, 2, 1] == points.reason[0, 2, 1]  # missing for a reason of its own
    unknown = replace(points, covariance_2d=np.full_like(points.covariance_2d, np.nan))
    np.testing.assert_array_equal(filtering.leave_out_uncertain(unknown).xyz, points.xyz)
