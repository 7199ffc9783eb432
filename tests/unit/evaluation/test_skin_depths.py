"""Depths of joints behind the skin: known depths along known rays are found."""

from itertools import product

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.depth.lifting import SKIN_TO_JOINT_M
from courtside.evaluation import skin_depths
from courtside.records.keypoints import skeleton
from courtside.records.truth.take_truth import DeviceTruth, TakeTruth

JOINTS = list(skeleton.JOINTS)
TRUE_M = {"shoulder": 0.07, "elbow": 0.03, "wrist": 0.02, "hip": 0.115, "knee": 0.04, "ankle": 0.05}
SPREAD_M, ASIDE_M = 0.01, 0.03


def clip(n, seed, lifted_with):
    """Return lifted and true joints (n, 12, 3) from the origin; the lift also errs sideways."""
    rng = np.random.default_rng(seed)
    skin = rng.uniform([-1, -1, 2], [1, 1, 4], (n, len(JOINTS), 3))
    ray = skin / np.linalg.norm(skin, axis=-1, keepdims=True)
    aside = np.cross(ray, rng.normal(size=skin.shape))
    aside *= ASIDE_M / np.linalg.norm(aside, axis=-1, keepdims=True)
    limb = [name.split("_")[1] for name in JOINTS]
    used = np.array([lifted_with[name] for name in limb])[:, np.newaxis]
    real = np.array([TRUE_M[name] for name in limb])[:, np.newaxis]
    deep = real + rng.normal(0, SPREAD_M, (*skin.shape[:2], 1))
    return skin + used * ray, skin + deep * ray + aside


@pytest.mark.parametrize("lifted_with", [SKIN_TO_JOINT_M, dict.fromkeys(skeleton.LIMBS, 0.0)])
def test_depths_are_found_whatever_the_joints_were_lifted_with(lifted_with):
    pairs = [clip(400, seed, lifted_with) for seed in (1, 2)]
    pairs[0][0][:40, 3] = np.nan
    pairs[1][1][:7, 3] = np.nan
    pairs[1][0][:100, 5, 2] += 1.5  # a wall behind an eighth of the left ankles
    given = None if lifted_with is SKIN_TO_JOINT_M else lifted_with
    table = skin_depths.estimate(pairs, JOINTS, JOINTS, given).set_index("joint")
    assert table.loc["hip", "n"] == 4 * 400 - 47
    for joint, depth_m in TRUE_M.items():
        tolerance_m = 0.003 if joint == "ankle" else 0.001
        assert table.loc[joint, "skin_m"] == pytest.approx(depth_m, abs=tolerance_m)
        assert table.loc[joint, "sd_m"] == pytest.approx(SPREAD_M, rel=0.15)


def test_how_far_joints_are_placed_beyond_their_limbs_is_found():
    """Limbs lie across the view, so that depth does not count; the lift corrected part of it."""
    rng = np.random.default_rng(6)
    true, found = (np.zeros((300, len(JOINTS), 3)) for _ in range(2))
    beyond_m = {"elbow": 0.02, "wrist": 0.012, "knee": -0.015, "ankle": 0.03}
    for side, (chain, start) in product(
        ("left", "right"), zip(skeleton.CHAINS, (0.0, 0.4), strict=True)
    ):
        places = np.cumsum([[0, start, 3], [0.3, 0.0, 0], [0.25, 0.1, 0]], axis=0)
        for at, joint in enumerate(chain):
            name = JOINTS.index(f"{side}_{joint}")
            true[:, name] = places[at]
            along = places[at] - places[max(at - 1, 0)]
            along /= max(np.linalg.norm(along), 1e-9)
            off = beyond_m.get(joint, 0.0) + rng.normal(0, 0.004, (300, 1))
            found[:, name] = places[at] + off * along
    lifted_with = {"wrist": 0.05, "knee": -0.01}
    table = skin_depths.estimate([(found, true)], JOINTS, JOINTS, None, lifted_with).set_index(
        "joint"
    )
    for joint, beyond in beyond_m.items():
        expected = beyond + lifted_with.get(joint, 0.0)
        assert table.loc[joint, "beyond_m"] == pytest.approx(expected, abs=0.001)
        assert table.loc[joint, "beyond_sd_m"] == pytest.approx(0.004, rel=0.3)
    assert table.loc[["shoulder", "hip"], ["beyond_m", "beyond_sd_m"]].isna().all(axis=None)


def test_joints_are_taken_by_name():
    found, true = clip(50, 3, SKIN_TO_JOINT_M)
    order = np.random.default_rng(4).permutation(len(JOINTS))
    shuffled = [JOINTS[at] for at in order]
    straight = skin_depths.estimate([(found, true)], JOINTS, JOINTS)
    assert skin_depths.estimate([(found, true[:, order])], JOINTS, shuffled).equals(straight)


def test_a_joint_that_is_never_seen_is_refused():
    found, true = clip(5, 5, SKIN_TO_JOINT_M)
    found[:, [2, 8]] = np.nan
    with pytest.raises(ValueError, match=r"expected wrist in a clip, found it in none of 1"):
        skin_depths.estimate([(found, true)], JOINTS, JOINTS)


def test_truth_is_interpolated_at_the_time_of_the_cameras_picture():
    """A point that moves along a parabola, which a cubic spline follows exactly."""
    time_s = np.linspace(-1, 3, 81)

    def place(when):
        return np.stack([0.3 * when, 1 - 0.2 * when**2, 0 * when], axis=-1)

    turn = Rotation.from_euler("xyz", [0.3, -1.0, 2.0]).as_matrix()
    shift = np.array([0.1, 0.2, 3.0])
    camera = DeviceTruth("rgbd", "b", 0.5, 200.0, 0.03, np.column_stack([turn, shift]))
    xyz = np.stack([np.full((len(time_s), 1, 3), 9.0), place(time_s)[:, np.newaxis]])
    truth = TakeTruth(
        time_s, np.array(["left_hip"]), np.array(["a", "b"]), xyz, np.zeros((2, 81, 2, 3)), {}, {},
        devices={"d415": camera},
    )  # fmt: skip
    happened_s = np.array([0.0, 0.777, 2.9, 3.5])
    shown_s = happened_s * (1 + 200e-6) + 0.5 + 0.03
    seen = skin_depths.in_camera(truth, "d415", "b", shown_s)
    np.testing.assert_allclose(seen[:3, 0], place(happened_s[:3]) @ turn.T + shift, atol=1e-9)
    assert np.isnan(seen[3]).all()
