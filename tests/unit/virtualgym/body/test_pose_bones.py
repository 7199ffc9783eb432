"""Bones in a stance: directions, twists, flat feet; fingers that close round a grip."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixtures.people import mannequin
from virtualgym.body import pose_bones, racket, rotations, stance
from virtualgym.body.stance import SIDES

BODY = "f2"
SEEDS = range(8)


def placed(seed=None, *, spread=0.35, **others):
    rng = None if seed is None else np.random.default_rng(seed)
    wanted = mannequin.stance(rng, spread=spread, **others)
    skeleton = pose_bones.Skeleton.of(mannequin.figure(BODY))
    return pose_bones.pose(skeleton, wanted), skeleton, wanted


def ways(posed, skeleton):
    """Return the direction of each segment from the posed bones."""
    found = {}
    for side in SIDES:
        suffix = pose_bones.SUFFIX[side]
        chains = [
            ("upper_arm", "upperarm01", "lowerarm01"),
            ("forearm", "lowerarm01", "wrist"),
            ("thigh", "upperleg01", "lowerleg01"),
            ("shank", "lowerleg01", "foot"),
        ]
        for part, start, end in chains:
            ends = [posed.at(b + suffix, skeleton.heads[b + suffix]) for b in (start, end)]
            found[f"{side}_{part}"] = rotations.unit_vector(ends[1] - ends[0])
        for part, bone, tips in (
            ("hand", "wrist", skeleton.knuckles),
            ("foot", "foot", skeleton.toes),
        ):
            start = posed.at(bone + suffix, skeleton.heads[bone + suffix])
            found[f"{side}_{part}"] = rotations.unit_vector(
                posed.at(bone + suffix, tips[side]) - start
            )
    return found


@pytest.mark.parametrize("seed", SEEDS)
def test_each_segment_points_as_the_stance_says(seed):
    posed, skeleton, wanted = placed(seed)
    found = ways(posed, skeleton)
    assert set(found) == set(stance.SEGMENTS)
    for segment, way in wanted.directions.items():
        angle = np.degrees(np.arccos(np.clip(found[segment] @ way, -1, 1)))
        assert angle < 0.01, segment


@pytest.mark.parametrize("seed", SEEDS)
def test_pelvis_thorax_and_head_turn_as_the_stance_says(seed):
    posed, skeleton, wanted = placed(seed)
    np.testing.assert_allclose(posed.at("root", skeleton.hips), wanted.pelvis, atol=1e-12)
    np.testing.assert_allclose(posed.rotation["root"], wanted.world_from_pelvis)
    np.testing.assert_allclose(posed.rotation["spine01"], wanted.world_from_thorax, atol=1e-9)
    np.testing.assert_allclose(posed.rotation["head"], wanted.world_from_head, atol=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_bones_turn_rigidly_and_hang_together(seed):
    posed, skeleton, _ = placed(seed)
    turned, _ = posed.stacked()
    np.testing.assert_allclose(
        turned @ turned.transpose(0, 2, 1), np.tile(np.eye(3), (len(turned), 1, 1)), atol=1e-9
    )
    np.testing.assert_allclose(np.linalg.det(turned), 1)
    chains = [("root", *pose_bones.SPINE, *pose_bones.NECK)]
    for suffix in pose_bones.SUFFIX.values():
        chains.append(("spine01", "clavicle" + suffix, "upperarm01" + suffix))
        for pair in (
            ("upperarm02", "lowerarm01"),
            ("lowerarm02", "wrist"),
            ("upperleg02", "lowerleg01"),
        ):
            chains.append(tuple(bone + suffix for bone in pair))
        chains.append(("lowerleg02" + suffix, "foot" + suffix))
        chains.append(("root", "upperleg01" + suffix))
    for chain in chains:
        for above, below in itertools.pairwise(chain):
            head = skeleton.heads[below]
            np.testing.assert_allclose(posed.at(above, head), posed.at(below, head), atol=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_image_of_a_stance_in_a_mirror_is_taken_as_the_mirror_image(seed):
    posed, skeleton, wanted = placed(seed)
    point, normal = np.array([1.0, 2, 0]), np.array([0.6, 0.8, 0])
    mirror = np.eye(3) - 2 * np.outer(normal, normal)
    other = pose_bones.pose(skeleton, stance.mirrored(wanted, point, normal))
    for bone in ("upperarm01", "lowerarm01", "wrist", "upperleg01", "lowerleg01", "foot"):
        here = posed.at(bone + ".L", skeleton.heads[bone + ".L"])
        there = other.at(bone + ".R", skeleton.heads[bone + ".R"])
        np.testing.assert_allclose(point + mirror @ (here - point), there, atol=2e-3)


def test_the_shoulders_rise_with_the_arms_but_stay_near():
    low, skeleton, wanted = placed()
    raised = {
        name: np.array([0.0, 0, 1]) if "arm" in name else way
        for name, way in wanted.directions.items()
    }
    high, _, _ = placed(directions=raised)
    for side, suffix in pose_bones.SUFFIX.items():
        head = skeleton.heads["upperarm01" + suffix]
        rise = high.at("upperarm01" + suffix, head) - low.at("upperarm01" + suffix, head)
        assert 0.03 < rise[2] < 0.12, side


def test_knees_bend_about_an_axis_to_the_left_and_soles_lie_flat():
    posed, skeleton, wanted = placed()
    flat = {}
    for side, sign in (("left", -1), ("right", 1)):
        fall = skeleton.toes[side] - skeleton.heads["foot" + pose_bones.SUFFIX[side]]
        out = np.radians(25) * sign
        way = [np.sin(out), np.cos(out), fall[1] / np.linalg.norm(fall[[0, 2]])]
        flat[f"{side}_foot"] = rotations.unit_vector(np.array(way))
        flat[f"{side}_shank"] = rotations.unit_vector(
            np.array([0.35 * sign, -0.3, -1])
        )  # leans out
    posed, skeleton, _ = placed(directions=wanted.directions | flat)
    for suffix in pose_bones.SUFFIX.values():
        up = posed.rotation["foot" + suffix] @ [0, 1, 0]
        assert np.degrees(np.arccos(up[2])) < 5


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("turn_deg", [-60, 0, 60])
def test_the_palm_faces_where_it_should_and_the_forearm_shares_the_twist(side, turn_deg):
    free, skeleton, wanted = placed()
    suffix = pose_bones.SUFFIX[side]
    hand = wanted.directions[f"{side}_hand"]
    turn = rotations.about_axis(hand, np.radians(turn_deg))
    palm = turn @ free.rotation["wrist" + suffix] @ skeleton.palms[side]
    posed, _, _ = placed(palms={side: palm})
    found = posed.rotation["wrist" + suffix] @ skeleton.palms[side]
    np.testing.assert_allclose(found, palm, atol=1e-9)
    fore = wanted.directions[f"{side}_forearm"]
    steps = [
        rotations.twist(posed.rotation[after + suffix] @ posed.rotation[before + suffix].T, fore)
        for before, after in zip(
            ("upperarm02", "lowerarm01", "lowerarm02"),
            ("lowerarm01", "lowerarm02", "wrist"),
            strict=True,
        )
    ]
    assert np.degrees(np.abs(steps)).max() < 45
    assert np.degrees(np.sum(steps)) == pytest.approx(turn_deg, abs=8)


@pytest.mark.parametrize("side", SIDES)
def test_a_racket_lies_across_the_palm_thumb_towards_its_head(side):
    hand = mannequin.stance().directions[f"{side}_hand"]
    sideways = rotations.unit_vector(np.cross(hand, [0.3, -0.2, 1.0]))
    free, skeleton, _ = placed()
    across = free.rotation["wrist" + pose_bones.SUFFIX[side]] @ skeleton.across[side]
    sideways *= np.sign(sideways @ across)
    posed, _, _ = placed(racket=sideways, racket_hand=side)
    found = posed.rotation["wrist" + pose_bones.SUFFIX[side]] @ skeleton.across[side]
    np.testing.assert_allclose(found, sideways, atol=1e-6)


def test_toes_stay_out_of_the_floor_when_the_heel_rises():
    _, skeleton, wanted = placed()
    tips = {}
    for pitch_deg in (20, 60):
        pitch = np.radians(pitch_deg)
        tiptoe = np.array([0, np.cos(pitch), -np.sin(pitch)])
        directions = wanted.directions | {f"{side}_foot": tiptoe for side in SIDES}
        posed, _, _ = placed(directions=directions)
        lift = posed.at("foot.L", skeleton.toes["left"])[2] - skeleton.toes["left"][1]
        pelvis = wanted.pelvis - [0, 0, lift]
        posed, _, _ = placed(directions=directions, pelvis=pelvis)
        tips[pitch_deg] = posed.at(pose_bones.TOES + ".L", skeleton.tips["left"])[2]
    rest = skeleton.tips["left"][1]
    assert tips[20] == pytest.approx(rest, abs=2e-3) and tips[60] == pytest.approx(rest, abs=2e-3)


def test_small_changes_of_a_stance_make_small_changes_of_the_pose():
    rng = np.random.default_rng(4)
    for seed in SEEDS:
        posed, skeleton, wanted = placed(seed)
        nudge = {
            name: rotations.unit_vector(Rotation.from_rotvec(rng.normal(0, 1e-4, 3)).apply(way))
            for name, way in wanted.directions.items()
        }
        other = pose_bones.pose(skeleton, stance.Stance(**{**vars(wanted), "directions": nudge}))
        for before, after in zip(posed.stacked(), other.stacked(), strict=True):
            assert np.abs(after - before).max() < 0.02


# Fingers close round a grip, and only fingers move.

FINGERTIPS = [f"finger{n}-3" for n in pose_bones.FINGERS]


@pytest.fixture(scope="module")
def figure():
    return mannequin.figure("m3")


@pytest.fixture(scope="module")
def skeleton(figure):
    return pose_bones.Skeleton.of(figure)


def from_axis(skeleton, side, point, grip):
    """Return how far a point is from the grip's axis, m."""
    away = point - grip
    return np.linalg.norm(away - (away @ skeleton.across[side]) * skeleton.across[side])


@pytest.mark.parametrize("side", SIDES)
def test_closed_fingers_lie_round_the_grip(figure, skeleton, side):
    grip = pose_bones.grip(figure, skeleton, side)
    closed = pose_bones.bent(figure, skeleton, side, closed=True)
    for finger in FINGERTIPS:
        before, after = (each.tail(finger + pose_bones.SUFFIX[side]) for each in (figure, closed))
        assert from_axis(skeleton, side, before, grip) > 0.05
        assert from_axis(skeleton, side, after, grip) < 0.04


@pytest.mark.parametrize("side", SIDES)
def test_loose_fingers_bend_towards_the_palm(figure, skeleton, side):
    loose = pose_bones.bent(figure, skeleton, side, closed=False)
    for finger in FINGERTIPS:
        moved = loose.tail(finger + pose_bones.SUFFIX[side]) - figure.tail(
            finger + pose_bones.SUFFIX[side]
        )
        assert 0.005 < moved @ skeleton.palms[side] < 0.06


@pytest.mark.parametrize("side", SIDES)
def test_nothing_but_fingers_moves(figure, skeleton, side):
    closed = pose_bones.bent(figure, skeleton, side, closed=True)
    moved = np.linalg.norm(closed.vertices - figure.vertices, axis=1) > 1e-6
    wrist = skeleton.heads["wrist" + pose_bones.SUFFIX[side]]
    assert np.linalg.norm(figure.vertices[moved] - wrist, axis=1).max() < 0.25
    for bone in pose_bones.BONES:
        np.testing.assert_allclose(closed.head(bone), figure.head(bone), atol=1e-12)


@pytest.mark.parametrize("side", SIDES)
def test_the_grip_lies_on_the_palm_not_in_it(figure, skeleton, side):
    wrist = skeleton.heads["wrist" + pose_bones.SUFFIX[side]]
    out = (pose_bones.grip(figure, skeleton, side) - wrist) @ skeleton.palms[side]
    knuckle = (skeleton.knuckles[side] - wrist) @ skeleton.palms[side]
    assert out - knuckle > max(racket.GRIP_RADII_M)
    assert out - knuckle < 0.05
