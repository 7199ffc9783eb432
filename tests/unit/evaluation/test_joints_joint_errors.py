"""Errors of joints against truth made by hand: constant shifts, interpolation, gaps, views left out."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from courtside.evaluation import joints as joint_errors
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import derived_joints
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import walker

DERIVED = derived_joints.read(Path(__file__).parents[3] / "config" / "derived_joints.yaml")


@dataclass(frozen=True)
class Truth:
    joints: np.ndarray
    person_id: np.ndarray
    time_s: np.ndarray
    xyz: np.ndarray


def moving(time_s, joints):
    """Return (T, J, 3): joints that move at constant speed, so that interpolation is exact."""
    base = np.arange(len(joints))[:, None] * [0.01, 0.02, 0.03]
    return base + np.array([0.5, -0.2, 0.1]) * np.asarray(time_s)[:, None, None]


def take(shift_m):
    points = walker.points(n_persons=2, n_frames=40)
    points.xyz[0] = moving(points.time_s, points.joints) + shift_m
    return points


def truth(points, first_s=-0.1, last_s=1.0):
    """Return a truth at 100 Hz of both persons, joints and persons in another order."""
    time_s = np.arange(first_s, last_s, 0.01)
    real = moving(time_s, points.joints)[:, ::-1]
    return Truth(points.joints[::-1], points.person_id[::-1], time_s, np.stack([real + 7.0, real]))


def test_a_constant_shift_is_found_at_any_time():
    points = take([0.03, 0.0, 0.04])
    points.xyz[0, 20, 3] = np.nan
    error = joint_errors.true(points, truth(points))
    assert np.isnan(error[0, 20, 3])
    known = np.isfinite(points.xyz[0, ..., 0])
    assert known.sum() == known.size - 1
    np.testing.assert_allclose(error[0][known], 50.0, atol=1e-9)
    assert np.nanmin(error[1]) > 1000.0


def test_nothing_is_said_beyond_the_truths_ends_nor_of_joints_it_has_not():
    points = take(0.0)
    real = truth(points, 0.2, 0.5)
    real = Truth(real.joints[:-2], real.person_id, real.time_s, real.xyz[:, :, :-2])
    error = joint_errors.true(points, real)
    inside = (points.time_s >= 0.2) & (points.time_s <= real.time_s[-1])
    assert np.isfinite(error[0, inside, 2:]).all()
    assert np.isnan(error[:, ~inside]).all()
    assert np.isnan(error[:, :, :2]).all()


def test_a_truth_of_other_persons_is_refused():
    points = take(0.0)
    real = truth(points)
    real = Truth(real.joints, np.array(["x", "y"]), real.time_s, real.xyz)
    with pytest.raises(InputError, match=r"found \['x', 'y'\]"):
        joint_errors.true(points, real)


def test_joints_are_derived_of_the_truth_only_where_defined_alike():
    points = take(0.0)
    real = truth(points)
    longer = joint_errors.derive_truth(real, DERIVED, "blazepose33", ["neck", "head_centre"])
    shoulders = [list(real.joints).index(f"{side}_shoulder") for side in ("left", "right")]
    neck = longer.xyz[:, :, list(longer.joints).index("neck")]
    np.testing.assert_allclose(neck, real.xyz[:, :, shoulders].mean(axis=2))
    assert len(longer.joints) == len(real.joints) + 2
    assert joint_errors.derive_truth(real, DERIVED, "cpm14", ["neck", "head_centre"]) is real


def test_a_view_that_was_left_out_is_compared_with_its_own_tracklets():
    """The second tracklet is the first person 3 px off, the first one the second person 40 px off."""
    points, cameras = walker.points(n_persons=2, n_frames=40), scene.ring(4)
    points.xyz[1] += [0.8, 0.0, 0.0]
    xy = np.stack(
        [
            scene.opencv_projection(cameras[3], xyz.reshape(-1, 3)).reshape(40, -1, 2)
            for xyz in points.xyz
        ]
    )
    xy = np.stack([xy[1] + [40.0, 0.0], xy[0] + [0.0, 3.0]])
    view = Keypoints2D(
        camera="c3",
        model="m",
        joints=points.joints,
        size=np.array([1920, 1080]),
        time_s=points.time_s + 0.25,
        xy=xy,
        score=np.ones(xy.shape[:-1]),
        reason=np.zeros(xy.shape[:-1], np.uint8),
        xyz_in_body=np.full((*xy.shape[:-1], 3), np.nan),
    )
    error = joint_errors.left_out(points, cameras[3], view, Clock(offset_s=0.25))
    known = np.isfinite(points.xyz[..., 0])
    np.testing.assert_allclose(error[0][known[0]], 3.0, atol=1e-6)
    np.testing.assert_allclose(error[1][known[1]], 40.0, atol=1e-6)
