"""Forward kinematics, mirrors and moves of a stance."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixtures.people.performers import BODY
from virtualgym.body import stance
from virtualgym.body.stance import SEGMENTS, SIDES, Proportions, Stance

DOWN, ALONG_Y = np.array([0.0, 0, -1]), np.array([0.0, 1, 0])
UPRIGHT = np.array([[-1.0, 0, 0], [0, 0, 1], [0, 1, 0]])  # facing y


def standing(rng=None, spread=0.0):
    """Return one who stands upright, facing y, arms hanging; scattered by an rng."""
    ways = {segment: ALONG_Y if segment.endswith("foot") else DOWN for segment in SEGMENTS}
    turns = [np.eye(3)] * 3
    if rng is not None:
        ways = {name: way + spread * rng.standard_normal(3) for name, way in ways.items()}
        ways = {name: way / np.linalg.norm(way) for name, way in ways.items()}
        turns = Rotation.from_rotvec(spread * rng.standard_normal((3, 3))).as_matrix()
    return Stance(
        pelvis=np.array([2.0, 3.0, 0.93]),
        world_from_pelvis=turns[0] @ UPRIGHT,
        world_from_thorax=turns[1] @ UPRIGHT,
        world_from_head=turns[2] @ UPRIGHT,
        directions=ways,
        palms={"left": np.array([1.0, 0, 0]), "right": np.array([-1.0, 0, 0])},
        racket=ALONG_Y,
    )


def test_joints_of_one_who_stands_are_where_lengths_say():
    placed = stance.joints(standing(), BODY)
    shoulder = np.array([2 - BODY.shoulder_width / 2, 3, 0.93 + BODY.trunk])
    np.testing.assert_allclose(placed["left_shoulder"], shoulder, atol=1e-12)
    wrist = shoulder - [0, 0, BODY.upper_arm + BODY.forearm]
    np.testing.assert_allclose(placed["left_wrist"], wrist, atol=1e-12)
    ankle = [2 + BODY.hip_width / 2, 3, 0.93 - BODY.thigh - BODY.shank]
    np.testing.assert_allclose(placed["right_ankle"], ankle, atol=1e-12)
    np.testing.assert_allclose(placed["right_toe"], ankle + BODY.foot * ALONG_Y, atol=1e-12)
    assert placed["head"][2] > placed["left_shoulder"][2] + 0.1


def test_a_body_of_mean_height_stands_as_high_as_measured():
    # Winter 2009, fig. 4.1: hip 0.530, shoulder 0.818 of the body's height above the floor.
    body = Proportions.of_height(2.0)
    hip = body.ankle_height + body.shank + body.thigh
    assert hip == pytest.approx(1.06, abs=0.001)
    assert hip + body.trunk == pytest.approx(1.636, abs=0.001)


def test_lengths_hold_in_any_stance():
    placed = stance.joints(standing(np.random.default_rng(1), 0.5), BODY)
    for side in SIDES:
        for start, end, length in (
            ("shoulder", "elbow", BODY.upper_arm),
            ("elbow", "wrist", BODY.forearm),
            ("hip", "knee", BODY.thigh),
            ("knee", "ankle", BODY.shank),
        ):
            apart = np.linalg.norm(placed[f"{side}_{end}"] - placed[f"{side}_{start}"])
            assert apart == pytest.approx(length)


def test_a_mirror_reflects_every_joint_to_the_other_side():
    rng = np.random.default_rng(2)
    before = standing(rng, 0.4)
    point, normal = np.array([3.05, 0, 0]), np.array([1.0, 0, 0])
    after = stance.mirrored(before, point, normal)
    seen, image = stance.joints(before, BODY), stance.joints(after, BODY)
    for side, other in (("left", "right"), ("right", "left")):
        for joint in ("shoulder", "wrist", "hip", "ankle"):
            expected = seen[f"{side}_{joint}"] * [-1, 1, 1] + [6.1, 0, 0]
            np.testing.assert_allclose(image[f"{other}_{joint}"], expected, atol=1e-12)
    np.testing.assert_allclose(image["head"], seen["head"] * [-1, 1, 1] + [6.1, 0, 0], atol=1e-12)
    assert np.linalg.det(after.world_from_thorax) == pytest.approx(1)
    assert (before.racket_hand, after.racket_hand) == ("right", "left")
    np.testing.assert_array_equal(after.palms["left"], [1, 0, 0])


def test_a_stance_moves_as_a_whole():
    rotation, shift = Rotation.from_rotvec([0.3, -0.2, 1.0]).as_matrix(), np.array([1.0, 2, 3])
    before = standing(np.random.default_rng(3), 0.3)
    after = stance.moved(before, rotation, shift)
    seen, image = stance.joints(before, BODY), stance.joints(after, BODY)
    for joint, place in seen.items():
        np.testing.assert_allclose(image[joint], rotation @ place + shift, atol=1e-12)
    np.testing.assert_allclose(after.racket, rotation @ before.racket)
