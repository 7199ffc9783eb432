"""The corrected skeleton, against forward kinematics, and its derivatives, against differences."""

import numpy as np
import pytest

from courtside.geometry import rotations
from courtside.inertial import segments
from courtside.records.devices.hierarchy import forward
from courtside.records.keypoints import skeleton
from fixtures.people import moved_bodies

POSED = moved_bodies.moving(1, seconds=0.1)
N = len(POSED.time_s)
OBSERVED = [POSED.hierarchy.joints.index(joint) for joint in skeleton.JOINTS]
MODEL = segments.Model(
    POSED.hierarchy, segments.segments_of(POSED.hierarchy), OBSERVED, moved_bodies.UP
)
FACING = moved_bodies.about_up(np.linspace(0, 1, N))
XYZ, WORLD = forward(POSED)


def frames(velocity=0.0):
    local = FACING.swapaxes(1, 2)[:, None] @ WORLD
    return segments.Frames(
        FACING, local, POSED.translation, np.full((N, len(OBSERVED), 3), velocity)
    )


def parameters(seed, size):
    rng = np.random.default_rng(seed)
    slow, fixed = rng.normal(size=(N, MODEL.n_slow)), rng.normal(size=MODEL.n_fixed)
    fixed[MODEL.fixed["lag"]] = 0
    return size * slow, size * fixed


def test_without_correction_it_is_forward_kinematics():
    slow, fixed = parameters(0, 0.0)
    assert MODEL.places(frames(), slow, fixed) == pytest.approx(XYZ[:, OBSERVED], abs=1e-12)
    assert MODEL.orient(frames(), slow, fixed) == pytest.approx(WORLD, abs=1e-12)


def test_heading_turns_all_about_the_root():
    slow, fixed = parameters(0, 0.0)
    slow[:, MODEL.slow["heading"]] = 0.4
    turn = rotations.matrices_from_vectors(0.4 * moved_bodies.UP)
    wanted = XYZ[:, :1] + (XYZ[:, OBSERVED] - XYZ[:, :1]) @ turn.T
    assert MODEL.places(frames(), slow, fixed) == pytest.approx(wanted, abs=1e-12)


def test_a_segment_turns_alone():
    slow, fixed = parameters(0, 0.0)
    at = MODEL.segments.names.index("left_upper_arm")
    slow[:, 3 * at : 3 * at + 3] = [0.1, -0.2, 0.3]
    moved = MODEL.places(frames(), slow, fixed) - XYZ[:, OBSERVED]
    elbow, wrist = (skeleton.JOINTS.index(f"left_{p}") for p in ("elbow", "wrist"))
    assert np.linalg.norm(moved[:, elbow], axis=1).min() > 0.01
    assert moved[:, wrist] == pytest.approx(moved[:, elbow], abs=1e-12)
    rest = np.delete(moved, [elbow, wrist], axis=1)
    assert np.abs(rest).max() < 1e-12


def test_a_hand_keeps_its_turn_against_the_forearm():
    slow, fixed = parameters(3, 0.2)
    found = MODEL.orient(frames(), slow, fixed)
    elbow, wrist = (POSED.hierarchy.joints.index(f"left_{part}") for part in ("elbow", "wrist"))
    before, after = (r[:, elbow].swapaxes(1, 2) @ r[:, wrist] for r in (WORLD, found))
    assert after == pytest.approx(before, abs=1e-12)


def test_derivatives_are_differences():
    slow, fixed = parameters(4, 0.2)
    xyz, by_slow, by_fixed = MODEL.linear(frames(), slow, fixed)
    assert xyz == pytest.approx(MODEL.places(frames(), slow, fixed), abs=1e-12)
    step = 1e-5  # the differences are off by 1e-8 there, with and without AVX2; at 1e-6 by 1e-7
    for at in range(MODEL.n_slow):
        ends = [
            MODEL.places(frames(), slow + s * step * np.eye(MODEL.n_slow)[at], fixed)
            for s in (1, -1)
        ]
        assert by_slow[..., at] == pytest.approx((ends[0] - ends[1]) / (2 * step), abs=1e-7)
    for at in range(MODEL.n_fixed):
        ends = [
            MODEL.places(frames(), slow, fixed + s * step * np.eye(MODEL.n_fixed)[at])
            for s in (1, -1)
        ]
        assert by_fixed[..., at] == pytest.approx((ends[0] - ends[1]) / (2 * step), abs=1e-7)


def test_the_clock_moves_joints_by_their_speed():
    slow, fixed = parameters(0, 0.0)
    _, _, by_fixed = MODEL.linear(frames(velocity=1.5), slow, fixed)
    assert by_fixed[..., MODEL.fixed["lag"]] == pytest.approx(1.5)
