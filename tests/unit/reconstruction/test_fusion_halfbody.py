"""Halves of a body from two records: which joint comes from which, and what is said of it."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.reconstruction import fusion
from courtside.records.keypoints import missing_reason
from fixtures.people import walker

CAMERAS = ["centre", "left", "right"]
UP = np.array([0, 0, 1.0])


def halves():
    points = walker.points(20, n_cameras=2)
    left = replace(points, cameras=np.array(["centre", "left"]))
    right = replace(
        points,
        cameras=np.array(["centre", "right"]),
        xyz=points.xyz + UP,
        reason=points.reason.copy(),
    )
    return left, right


def test_each_side_is_that_of_its_record_and_the_middle_the_mean():
    left, right = halves()
    merged = fusion.merge(left, right, CAMERAS)
    at = {name: list(merged.joints).index(name) for name in ("left_hip", "right_hip", "nose")}
    assert merged.cameras.tolist() == CAMERAS
    np.testing.assert_array_equal(merged.xyz[:, :, at["left_hip"]], left.xyz[:, :, at["left_hip"]])
    np.testing.assert_array_equal(
        merged.xyz[:, :, at["right_hip"]], right.xyz[:, :, at["right_hip"]]
    )
    lifted = merged.xyz[:, :, at["nose"]] - left.xyz[:, :, at["nose"]]
    np.testing.assert_allclose(lifted, np.broadcast_to([0, 0, 0.5], lifted.shape), atol=1e-12)


def test_views_are_those_of_the_half():
    left, right = halves()
    merged = fusion.merge(left, right, CAMERAS)
    at = {name: list(merged.joints).index(name) for name in ("left_knee", "right_knee", "nose")}
    assert merged.accepted[0, 0, at["left_knee"]].tolist() == [True, True, False]
    assert merged.accepted[0, 0, at["right_knee"]].tolist() == [True, False, True]
    assert merged.accepted[0, 0, at["nose"]].tolist() == [True, True, True]
    assert merged.n_views[0, 0, [at["left_knee"], at["nose"]]].tolist() == [2, 3]
    error = merged.reproj_error_px[0, 0, at["left_knee"]]
    np.testing.assert_array_equal(error[:2], left.reproj_error_px[0, 0, at["left_knee"]])
    assert np.isnan(error[2]) and np.isfinite(merged.reproj_error_px[0, 0, at["nose"]]).all()


def test_a_joint_of_the_middle_that_one_half_lacks_is_that_of_the_other():
    left, right = halves()
    nose = list(left.joints).index("nose")
    left.xyz[0, 2, nose], left.reason[0, 2, nose] = np.nan, missing_reason.REJECTED
    left.accepted[0, 2, nose] = False
    merged = fusion.merge(left, right, CAMERAS)
    np.testing.assert_array_equal(merged.xyz[0, 2, nose], right.xyz[0, 2, nose])
    assert merged.reason[0, 2, nose] == missing_reason.OK
    assert (merged.reason[:, 3, 4], merged.n_views[0, 3, 4]) == (missing_reason.REJECTED, 0)
    assert np.isnan(merged.xyz[0, 3, 4]).all()


def test_halves_of_different_takes_are_a_fault():
    left, right = halves()
    with pytest.raises(ValueError, match="expected halves of the same time_s"):
        fusion.merge(left, replace(right, time_s=right.time_s + 1), CAMERAS)
