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
