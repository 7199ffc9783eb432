"""Signals: lengths of the body, and what a still arm and a moving trunk give."""

import numpy as np
import pytest

from courtside.strokes import signals
from fixtures.people import strokes_made


def carried(speed_m_s):
    """Return a person whose joints all keep their places about a hip that moves along x."""
    time_s = np.arange(45) / 30
    places = {"shoulder": 1.4, "elbow": 1.1, "wrist": 0.85, "hip": 0.9, "knee": 0.5, "ankle": 0.1}
    xyz = np.array([[0, 0, places[name.split("_")[1]]] for name in strokes_made.JOINTS])
    return strokes_made.record(time_s, xyz + np.outer(speed_m_s * time_s, [1, 0, 0])[:, None])


def test_lengths_are_shares_of_arm_and_trunk():
    found = signals.of_person(carried(2.0), 0)
    assert found.size_m == pytest.approx(0.55 + 0.5)
    arm = found.arms["right"]
    np.testing.assert_allclose(arm.reach * found.size_m, 0.05, atol=1e-6)
    np.testing.assert_allclose(arm.above * found.size_m, -0.55, atol=1e-6)
    np.testing.assert_allclose(arm.wrist.speed, 2.0, atol=1e-5)
    np.testing.assert_allclose(arm.from_waist.speed, 0.0, atol=1e-5)
    np.testing.assert_allclose(found.trunk.speed, 2.0, atol=1e-5)
    assert found.rate_hz == pytest.approx(30)


@pytest.mark.parametrize(
    ("lost", "size_m"),
    [(["left_elbow"], 1.05), (["left_wrist"], 1.05), (["left_wrist", "right_wrist"], np.nan)],
)
def test_one_arm_is_enough_for_the_length_of_arms(lost, size_m):
    points = carried(2.0)
    points.xyz[:, :, [strokes_made.JOINTS.index(joint) for joint in lost]] = np.nan
    assert signals.of_person(points, 0).size_m == pytest.approx(size_m, nan_ok=True)


def test_at_the_edge_of_a_gap_a_wrist_has_no_speed():
    points = carried(1.0)
    at = strokes_made.JOINTS.index("left_wrist")
    points.reason[0, 20:24, at] = 1
    points.xyz[0, 20:24, at] = np.nan
    points.xyz[0, [18, 19], at, 2] += [0.05, -0.05]  # the parabola through them bends
    arm = signals.of_person(points, 0).arms["left"]
    speed = arm.speed(30.0)
    assert np.nanmax(arm.wrist.speed) > 2
    assert np.flatnonzero(np.isnan(speed)).tolist() == [0, 1, *range(18, 26), 43, 44]
    np.testing.assert_allclose(speed[[5, 10, 30, 40]], 1.0, atol=1e-5)


def test_a_wrist_that_was_not_seen_is_not_measured():
    points = carried(1.0)
    at = strokes_made.JOINTS.index("left_wrist")
    points.reason[0, 3:6, at] = 1
    measured = signals.of_person(points, 0).arms["left"].measured
    assert not measured[3:6].any()
    assert measured.sum() == 42
