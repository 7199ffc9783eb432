"""Poses of the upper body and smooth courses through them."""

import numpy as np
import pytest

from virtualgym.movement import upper_body

NAMED = {name: pose for name, pose in vars(upper_body).items() if isinstance(pose, upper_body.Pose)}
KEYS = [
    (0.0, upper_body.READY),
    (0.5, upper_body.PREPARE),
    (0.9, upper_body.PREPARE),
    (1.1, upper_body.IMPACT),
]


@pytest.mark.parametrize("name", NAMED)
def test_scripted_elbows_and_wrists_bend_as_human_ones(name):
    for arm in (NAMED[name].left, NAMED[name].right):
        upper, fore, hand, _ = arm.rows()
        assert 0 <= np.degrees(np.arccos(upper @ fore)) < 145
        assert np.degrees(np.arccos(np.clip(fore @ hand, -1, 1))) < 60


def test_at_least_ten_poses_are_checked():
    assert len(NAMED) >= 10


def test_an_unscattered_course_passes_through_its_poses():
    course = upper_body.course(KEYS, np.random.default_rng(0), scatter=0.0)
    for time_s, pose in KEYS:
        moment = course.at(time_s)
        np.testing.assert_allclose(moment.right, pose.right.rows(), atol=1e-12)
        np.testing.assert_allclose(moment.left, pose.left.rows(), atol=1e-12)
        assert np.degrees([moment.twist, moment.lean, moment.roll]) == pytest.approx(
            [pose.twist, pose.lean, pose.roll]
        )
        assert moment.height == pytest.approx(pose.height)


def test_a_held_pose_is_held_and_ends_stay():
    course = upper_body.course(KEYS, np.random.default_rng(0))
    held = [course.at(time_s).right for time_s in (0.5, 0.63, 0.9)]
    np.testing.assert_allclose(held[1:], held[:1] * 2, atol=1e-12)
    np.testing.assert_array_equal(course.at(-1).right, course.at(0).right)
    np.testing.assert_array_equal(course.at(9).right, course.at(1.1).right)


def test_performances_differ_by_degrees():
    scripted, first, second = (
        upper_body.course(KEYS, np.random.default_rng(seed), scatter=scatter).at(0.5).right[:3]
        for seed, scatter in ((0, 0.0), (1, 1.0), (2, 1.0))
    )
    for one, other in ((first, scripted), (second, scripted), (first, second)):
        off = np.degrees(np.arccos(np.clip(np.sum(one * other, axis=1), -1, 1)))
        assert off.max() > 0.3
        assert off.max() < 20


def test_a_course_of_equal_times_is_refused():
    with pytest.raises(ValueError, match="increasing times"):
        upper_body.course(
            [(0.0, upper_body.READY), (0.0, upper_body.RUN)], np.random.default_rng(0)
        )
