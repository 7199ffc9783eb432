"""Body axes and the bend of a limb."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from virtualgym.movement import two_bone_ik


@pytest.mark.parametrize(
    ("heading_deg", "forward"), [(0, (0, 1, 0)), (90, (-1, 0, 0)), (-90, (1, 0, 0))]
)
def test_a_heading_turns_anticlockwise_from_y(heading_deg, forward):
    axes = two_bone_ik.facing(np.radians(heading_deg))
    np.testing.assert_allclose(axes[:, 2], forward, atol=1e-12)
    np.testing.assert_allclose(axes[:, 1], [0, 0, 1])
    np.testing.assert_allclose(np.cross(axes[:, 0], axes[:, 1]), axes[:, 2], atol=1e-12)


def test_turns_are_to_the_left_forward_and_to_the_right():
    assert two_bone_ik.turn(twist=0.3)[0, 2] > 0  # forward turns to the left
    assert two_bone_ik.turn(pitch=0.3)[2, 1] > 0  # up leans forward
    assert two_bone_ik.turn(roll=0.3)[0, 1] < 0  # up leans to the right
    expected = Rotation.from_euler("YXZ", [0.3, -0.2, 0.5]).as_matrix()
    np.testing.assert_allclose(two_bone_ik.turn(0.3, -0.2, 0.5), expected, atol=1e-12)


def test_a_bent_limb_spans_its_ends_and_bends_to_the_pole():
    rng = np.random.default_rng(0)
    for _ in range(50):
        start, pole = rng.normal(size=3), rng.normal(size=3)
        end = start + two_bone_ik.unit(rng.normal(size=3)) * rng.uniform(0.15, 0.84)
        first, second = two_bone_ik.bend(start, end, (0.45, 0.4), pole)
        np.testing.assert_allclose(start + 0.45 * first + 0.4 * second, end, atol=1e-9)
        assert np.linalg.norm(first) == pytest.approx(1)
        along = two_bone_ik.unit(end - start)
        assert (first - (first @ along) * along) @ pole >= 0


def test_a_limb_too_short_points_straight_at_its_end():
    first, second = two_bone_ik.bend(
        np.zeros(3), np.array([0, 0, -2.0]), (0.5, 0.5), np.array([0, 1.0, 0])
    )
    np.testing.assert_allclose([first, second], [[0, 0, -1]] * 2, atol=1e-4)


def test_across_is_orthogonal():
    axis = two_bone_ik.unit([1.0, 2, 3])
    found = two_bone_ik.across(np.array([1.0, 0, 0]), axis)
    assert found @ axis == pytest.approx(0, abs=1e-12)
    assert found[0] > 0
