"""Mocopi's joints in a virtual body: names, rest pose, and places of the body's own joints."""

from pathlib import Path

import numpy as np
import pytest

from courtside.records.devices.hierarchy import PosedHierarchy, forward
from courtside.records.keypoints import skeleton
from fixtures.people import mannequin
from virtualgym.body import pose_bones, skinned_body
from virtualgym.devices import mocopi_skeleton

APP = skeleton.read(Path(__file__).parents[4] / "config" / "skeletons" / "mocopi27.yaml")


@pytest.fixture(scope="module")
def rig():
    return mocopi_skeleton.Rig.of(mannequin.dressed().skeleton)


def test_names_and_order_are_the_apps(rig):
    assert list(rig.hierarchy.joints) == list(APP.device_names())
    names = dict(zip(APP.device_names(), APP.joints, strict=True))
    bones = {
        (names[rig.hierarchy.joints[parent]], names[joint])
        for joint, parent in zip(rig.hierarchy.joints, rig.hierarchy.parents, strict=True)
        if parent >= 0
    }
    assert bones == {tuple(bone) for bone in APP.bones}


def test_at_rest_arms_are_straight_out_and_the_body_stands(rig):
    posed = PosedHierarchy(
        rig.hierarchy, np.zeros(1), rig.hierarchy.offsets[None], np.tile(np.eye(3), (1, 27, 1, 1))
    )
    at = dict(zip(rig.hierarchy.joints, forward(posed)[0][0], strict=True))
    for side, sign in (("l", 1), ("r", -1)):
        arm = at[f"{side}_hand"] - at[f"{side}_up_arm"]
        np.testing.assert_allclose(arm / np.linalg.norm(arm), [sign, 0, 0], atol=1e-9)
        assert 0.05 < at[f"{side}_foot"][1] < 0.12, "ankles above the floor"
        assert at[f"{side}_toes"][2] > at[f"{side}_foot"][2] + 0.1, "toes point along z"
    assert at["root"][1] < at["torso_7"][1] < at["neck_1"][1] < at["head"][1]


def test_the_joints_are_where_the_bodys_own_are(rig):
    rng = np.random.default_rng(5)
    figure = mannequin.dressed()
    for _ in range(10):
        stance = mannequin.stance(rng, spread=0.5)
        bones = pose_bones.pose(figure.skeleton, stance)
        true = dict(zip(skinned_body.JOINTS, figure.joints(bones), strict=True))
        world = rig.turns(bones)
        local = world.copy()
        local[1:] = np.swapaxes(world[rig.hierarchy.parents[1:]], -1, -2) @ world[1:]
        shifts = rig.hierarchy.offsets.copy()
        shifts[0] = rig.place(bones)
        posed = PosedHierarchy(rig.hierarchy, np.zeros(1), shifts[None], local[None])
        found = dict(zip(rig.hierarchy.joints, forward(posed)[0][0], strict=True))
        for ours, theirs in mocopi_skeleton.SHARED.items():
            np.testing.assert_allclose(found[ours], true[theirs], atol=1e-6, err_msg=ours)
        np.testing.assert_allclose(found["head"], true["rig_head"], atol=0.02)
