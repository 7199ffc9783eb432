"""A fixed rotation and a drifting heading, put in and found again."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.inertial import heading as heading_drift
from courtside.records.keypoints.skeleton import JOINTS as LIMB_JOINTS
from fixtures.people import moved_bodies

TRUE = moved_bodies.moving(2, seconds=20.0)
TIME_S = TRUE.time_s[::2]
HEADING = np.radians(75) * (TIME_S / 20) ** 2


def estimated(device, vision):
    return heading_drift.estimate(TIME_S, device, vision, moved_bodies.UP, window_s=1.0)


@pytest.mark.parametrize("missing", [0.0, 0.3])
def test_rotation_and_heading_are_found(missing):
    rng = np.random.default_rng(0)
    true = moved_bodies.limbs(TRUE)[::2]
    vision = true @ moved_bodies.VISION_FROM_WORLD.T + rng.normal(size=true.shape) * 0.03
    vision[rng.uniform(size=vision.shape[:2]) < missing] = np.nan
    wild = rng.uniform(size=vision.shape[:2]) < 0.03
    vision[wild] += 0.5
    turn = moved_bodies.about_up(-HEADING)
    device = np.einsum("tij,tdj->tdi", turn, true) + rng.normal(size=3)
    found = estimated(device, vision)
    assert found.heading[0] == 0
    off = found.heading - HEADING
    assert (
        np.degrees(np.abs(off - np.median(off))).max() < 6
    )  # at the end, where the window sees one side
    off = Rotation.from_matrix(found.vision_from_device @ moved_bodies.VISION_FROM_WORLD.T)
    assert np.degrees(off.magnitude()) < 3


def test_beyond_its_ends_the_heading_stays():
    found = heading_drift.Alignment(np.eye(3), np.array([1.0, 2.0]), np.array([0.0, 0.5]))
    assert found.heading_at(np.array([0.0, 1.5, 9.0])) == pytest.approx([0, 0.25, 0.5])


def test_a_path_is_turned_step_by_step():
    n = 2000
    heading = np.linspace(0, np.pi, n)
    straight = np.zeros((n, 3))
    straight[:, 2] = np.linspace(0, np.pi, n)  # at unit speed forward
    found = heading_drift.turn_path(straight + np.array([5, 1, 7]), heading, moved_bodies.UP)
    wanted = np.column_stack([6 - np.cos(heading), np.ones(n), 7 + np.sin(heading)])
    assert found == pytest.approx(wanted, abs=1e-5)


def test_joints_in_common_are_the_limbs():
    assert moved_bodies.limbs(TRUE).shape[1] == len(LIMB_JOINTS) == 12
