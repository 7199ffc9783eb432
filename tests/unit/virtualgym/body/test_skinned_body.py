"""A body in a stance: joints, lengths, skin."""

import numpy as np
import pytest

from fixtures.people import mannequin
from virtualgym.body import pose_bones, shapes, skinned_body, stance
from virtualgym.body.stance import SIDES

NAMES = ("m1", "f1", "m4")
LENGTHS = {
    "upper_arm": ("shoulder", "elbow"),
    "forearm": ("elbow", "wrist"),
    "thigh": ("hip", "knee"),
    "shank": ("knee", "ankle"),
}


def random(seed, **others):
    return mannequin.stance(np.random.default_rng(seed), spread=0.35, **others)


def joints(body, wanted):
    placed = body.joints(pose_bones.pose(body.skeleton, wanted))
    return dict(zip(skinned_body.JOINTS, placed, strict=True))


def test_a_body_is_read_from_the_files():
    found = skinned_body.Body.read(mannequin.folder(), shapes.BODIES["m1"])
    np.testing.assert_allclose(found.rest, mannequin.dressed("m1").rest, atol=1e-12)
    assert found.triangles.shape == found.colours.shape and found.colours.dtype == np.uint8


@pytest.mark.parametrize("name", NAMES)
def test_weights_sum_to_one(name):
    dressed = mannequin.dressed(name)
    np.testing.assert_allclose(dressed.blend.toarray().sum(axis=1), 1, atol=1e-6)
    assert dressed.blend.toarray().min() >= 0


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", range(4))
def test_lengths_stay_and_are_the_stated_proportions(name, seed):
    dressed = mannequin.dressed(name)
    found = joints(dressed, random(seed))
    for part, ends in LENGTHS.items():
        for side in SIDES:
            first, second = (found[f"{side}_{end}"] for end in ends)
            expected = getattr(dressed.proportions, part)
            assert np.linalg.norm(second - first) == pytest.approx(expected, abs=1e-3)
    hips = found["left_hip"], found["right_hip"]
    assert np.linalg.norm(hips[0] - hips[1]) == pytest.approx(
        dressed.proportions.hip_width, abs=1e-6
    )


@pytest.mark.parametrize("seed", range(4))
def test_joints_are_where_the_stance_puts_them(seed):
    wanted = random(seed)
    found = joints(mannequin.dressed(), wanted)
    hips = (found["left_hip"] + found["right_hip"]) / 2
    np.testing.assert_allclose(hips, wanted.pelvis, atol=1e-9)
    np.testing.assert_allclose(found["rig_pelvis"], wanted.pelvis, atol=1e-9)
    for part, ends in LENGTHS.items():
        for side in SIDES:
            way = found[f"{side}_{ends[1]}"] - found[f"{side}_{ends[0]}"]
            cosine = way @ wanted.directions[f"{side}_{part}"] / np.linalg.norm(way)
            assert np.degrees(np.arccos(min(1, cosine))) < 0.5
    eyes = (found["left_eye"] + found["right_eye"]) / 2 - found["rig_head"]
    assert eyes @ wanted.world_from_head[:, 2] > 0.05, "eyes look forward"
    assert (found["left_eye"] - found["right_eye"]) @ wanted.world_from_head[:, 0] > 0.05


@pytest.mark.parametrize("name", NAMES)
def test_joints_agree_with_the_stick_figure_of_the_same_proportions(name):
    """Motions are planned on `stance.joints`; only the shoulder girdle may differ from it."""
    dressed = mannequin.dressed(name)
    wanted = random(1)
    planned = stance.joints(wanted, dressed.proportions)
    found = joints(dressed, wanted)
    for joint in skinned_body.JOINTS[:12]:
        limit = 1e-6 if joint.split("_")[1] in ("hip", "knee", "ankle") else 0.08
        assert np.linalg.norm(found[joint] - planned[joint]) < limit + 1e-3, joint


@pytest.mark.parametrize("seed", range(4))
def test_a_mirrored_stance_gives_mirrored_joints(seed):
    wanted, dressed = random(seed), mannequin.dressed()
    point, normal = np.array([3.05, 0, 0]), np.array([1.0, 0, 0])
    found = joints(dressed, wanted)
    other = joints(dressed, stance.mirrored(wanted, point, normal))
    for joint in skinned_body.JOINTS[:14]:
        side, name = joint.split("_")
        image = other[f"{stance.OTHER[side]}_{name}"] * [-1, 1, 1] + [6.1, 0, 0]
        np.testing.assert_allclose(found[joint], image, atol=3e-3)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(
    ("first", "second", "end"),
    [
        ("upperarm01", "upperarm02", "lowerarm01"),
        ("lowerarm01", "lowerarm02", "wrist"),
        ("upperleg01", "upperleg02", "lowerleg01"),
        ("lowerleg01", "lowerleg02", "foot"),
    ],
)
def test_skin_round_the_middle_of_a_limb_stays_on_its_bone(first, second, end, side, seed):
    """It may turn about the bone, but neither slides along it nor leaves it."""
    dressed = mannequin.dressed()
    bones = pose_bones.pose(dressed.skeleton, random(seed))
    suffix, heads = pose_bones.SUFFIX[side], dressed.skeleton.heads
    rest = [heads[bone + suffix] for bone in (first, end)]
    there = [bones.at(bone + suffix, heads[bone + suffix]) for bone in (first, end)]
    columns = [pose_bones.BONES.index(bone + suffix) for bone in (first, second)]
    held = dressed.blend.toarray()[:, columns].sum(axis=1) > 0.98
    before = cylindrical(dressed.rest[held, :3], *rest)
    after = cylindrical(dressed.skinned(bones)[held], *there)
    middle = np.abs(before[:, 0] / np.linalg.norm(rest[1] - rest[0]) - 0.5) < 0.2
    assert middle.sum() > 20
    np.testing.assert_allclose(after[middle], before[middle], atol=6e-3)


def cylindrical(points, start, end):
    """Return how far points are along a line, and from it, (n, 2) m."""
    axis = (end - start) / np.linalg.norm(end - start)
    along = (points - start) @ axis
    return np.stack([along, np.linalg.norm(points - start - along[:, None] * axis, axis=1)], axis=1)


def test_the_shank_and_the_skull_move_rigidly():
    dressed, wanted = mannequin.dressed(), random(3)
    bones = pose_bones.pose(dressed.skeleton, wanted)
    for names in (("lowerleg01.R", "lowerleg02.R"), ("head",)):
        columns = [pose_bones.BONES.index(name) for name in names]
        held = dressed.blend.toarray()[:, columns].sum(axis=1) > 0.999
        assert held.sum() > 20
        expected = dressed.rest[held, :3] @ bones.rotation[names[0]].T + bones.shift[names[0]]
        np.testing.assert_allclose(dressed.skinned(bones)[held], expected, atol=1e-3)


@pytest.mark.parametrize("side", SIDES)
def test_a_turned_hand_does_not_wring_the_forearm(side):
    """Linear blending pinches where a joint twists: the girth of forearm and wrist must survive."""
    dressed, suffix = mannequin.dressed(), pose_bones.SUFFIX[side]
    wanted = mannequin.stance()
    free = pose_bones.pose(dressed.skeleton, wanted)
    held = free.rotation["wrist" + suffix] @ dressed.skeleton.palms[side]
    hand = wanted.directions[f"{side}_hand"]
    turned = np.cross(hand, held)  # by 90 degrees
    posed = pose_bones.pose(dressed.skeleton, mannequin.stance(palms={side: turned}))
    heads = dressed.skeleton.heads
    elbow, wrist = heads["lowerarm01" + suffix], heads["wrist" + suffix]
    axis = (wrist - elbow) / np.linalg.norm(wrist - elbow)
    along = (dressed.rest[:, :3] - elbow) @ axis / np.linalg.norm(wrist - elbow)
    near = np.linalg.norm(dressed.rest[:, :3] - elbow - axis * along[:, None] * 0.25, axis=1) < 0.08
    girths = []
    for bones in (free, posed):
        start = bones.at("lowerarm01" + suffix, elbow)
        way = wanted.directions[f"{side}_forearm"]
        away = dressed.skinned(bones) - start
        away = np.linalg.norm(away - (away @ way)[:, None] * way, axis=1)
        girths.append([away[near & (np.abs(along - at) < 0.06)].mean() for at in (0.3, 0.6, 0.9)])
    assert (np.array(girths[1]) / girths[0]).min() > 0.8


def test_gripping_closes_one_hand_only():
    dressed = mannequin.dressed()
    gripping = dressed.gripping("right")
    moved = np.linalg.norm(gripping.rest - dressed.rest, axis=1) > 1e-4
    assert moved.any() and (dressed.rest[moved, 0] < 0).all()
    assert gripping.gripping("right") is gripping and dressed.gripping(None) is dressed
    grip = pose_bones.grip(dressed.figure, dressed.skeleton, "right")
    before, after = (
        np.linalg.norm(each.rest[moved, :3] - grip, axis=1).mean() for each in (dressed, gripping)
    )
    assert after < before - 0.005
