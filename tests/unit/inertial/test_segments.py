"""The corrected skeleton, against forward kinematics, and its derivatives, against differences."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry import rotations
from courtside.inertial import segments
from courtside.records.devices.hierarchy import Hierarchy, forward
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
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
    turn = rotations.rotation_from_rodrigues(0.4 * moved_bodies.UP)
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


BODY = moved_bodies.hierarchy()
SEGMENTS = segments.segments_of(BODY)


def members(segment):
    column = SEGMENTS.share[:, SEGMENTS.names.index(segment)]
    return {BODY.joints[at]: column[at] for at in np.flatnonzero(column)}


def test_the_spine_shares_pelvis_and_thorax():
    pelvis, thorax = members("pelvis"), members("thorax")
    assert pelvis == pytest.approx({"root": 1, "torso_1": 2 / 3, "torso_2": 1 / 3})
    assert thorax == pytest.approx({"torso_1": 1 / 3, "torso_2": 2 / 3, "torso_3": 1})


def test_limbs_turn_by_themselves_and_the_rest_is_carried():
    assert members("left_forearm") == {"left_elbow": 1}
    assert members("right_shank") == {"right_knee": 1}
    assert members("left_clavicle") == {"left_clavicle": 1}
    carried = {joint for joint, own in zip(BODY.joints, SEGMENTS.turned, strict=True) if not own}
    sides = {
        f"{side}_{joint}" for side in ("left", "right") for joint in ("wrist", "ankle", "toes")
    }
    assert carried == sides | {"head"}


def test_a_difference_is_left_over_right():
    at = SEGMENTS.stretches.index("thigh difference")
    column = dict(zip(BODY.joints, SEGMENTS.stretch[:, at], strict=True))
    assert column["left_knee"] - column["right_knee"] == 1.0
    assert sum(abs(value) for value in column.values()) == 1.0
    trunk = SEGMENTS.stretch[:, SEGMENTS.stretches.index("trunk")]
    assert {BODY.joints[at] for at in np.flatnonzero(trunk)} == {"torso_1", "torso_2", "torso_3"}


def test_a_missing_joint_is_named():
    names = tuple("l_hand" if joint == "left_wrist" else joint for joint in BODY.joints)
    with pytest.raises(InputError, match=r"walk\.bvh: expected a joint left_wrist"):
        segments.segments_of(replace(BODY, joints=names), "walk.bvh")


def test_a_limb_hung_elsewhere_is_named():
    names = list(BODY.joints)
    a, b = names.index("left_elbow"), names.index("right_elbow")
    names[a], names[b] = names[b], names[a]
    body = Hierarchy(tuple(names), BODY.parents, BODY.offsets)
    with pytest.raises(InputError, match="expected left_elbow below left_shoulder"):
        segments.segments_of(body)
