"""Segments and stretches of a body of mocopi's build."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.inertial import segments
from courtside.records.devices.hierarchy import Hierarchy
from courtside.study.errors import InputError
from fixtures.people import moved_bodies

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
    assert SEGMENTS.kind("left_forearm") == "forearm"


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
