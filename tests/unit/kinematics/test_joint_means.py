"""Means of joints do not depend on where somebody stands or looks."""

import numpy as np
import pytest

from courtside.kinematics import joint_means
from fixtures.people import walker


def test_joints_are_measured_wherever_somebody_stands():
    points = walker.points(n_persons=1)
    left, wrist = (list(points.joints).index(f"left_{what}") for what in ("hip", "wrist"))
    right = list(points.joints).index("right_hip")
    time_s = points.time_s
    points.xyz[0, :, [left, right]] = np.stack(
        [0.3 * time_s, 0 * time_s, 0 * time_s + 0.9], axis=-1
    )
    points.xyz[0, :, wrist] = points.xyz[0, :, left] + [0.3, 0.0, 0.4]
    points.xyz[0, 7, wrist] = np.nan
    rows = joint_means.table(points, {"session": "s", "take": "t", "calibration": "file"})
    found = rows.set_index("measure")["value"]
    assert found["left_wrist_height_mean"] == pytest.approx(1300.0)
    assert found["left_wrist_reach_mean"] == pytest.approx(500.0)
    assert found["left_wrist_speed_mean"] == pytest.approx(0.3)
    assert set(rows["model"]) == {"blazepose-full"}
    turned = points.xyz @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + [5.0, -3.0, 0.0]
    points.xyz[:] = turned
    again = joint_means.table(points, {"session": "s", "take": "t", "calibration": "file"})
    np.testing.assert_allclose(again["value"], rows["value"])
