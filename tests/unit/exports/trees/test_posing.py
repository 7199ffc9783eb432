"""Motion turned upright and made even: nothing else changes."""

import bvhio
import numpy as np
from scipy.spatial.transform import Rotation

from courtside.body_model import segments
from courtside.exports import bvh
from courtside.exports.trees import posing
from courtside.records.devices.hierarchy import (
    NO_PARENT,
    Hierarchy,
    PosedHierarchy,
    at_rest,
    forward,
)
from courtside.records.keypoints.skeleton import Skeleton
from fixtures.people import moving_model

SHAPE = Hierarchy(("hip", "knee"), np.array([NO_PARENT, 0]), np.array([[0, 0, 0], [0, -0.4, 0.0]]))


def spinning(time_s, rate=2.0):
    """Return a leg that turns evenly and moves straight on."""
    turns = Rotation.from_rotvec(np.outer(rate * time_s, [0.0, 0, 1])).as_matrix()
    both = np.stack([turns, np.swapaxes(turns, 1, 2)], axis=1)
    places = np.repeat(SHAPE.offsets[None], len(time_s), axis=0)
    places[:, 0] = np.outer(time_s, [1.0, 2, 3])
    return PosedHierarchy(SHAPE, time_s, places, both)


def test_z_up_becomes_y_up():
    posed = spinning(np.arange(5) / 10)
    xyz = forward(posing.turned(posed))[0]
    x, y, z = np.moveaxis(forward(posed)[0], -1, 0)
    np.testing.assert_allclose(xyz, np.stack([x, z, -y], axis=-1), atol=1e-12)


def of_model(turns):
    """Return rotations (T, S, 3, 3) of the skeletal model's segments as a motion, with tips."""
    names, offsets = segments.model().names, moving_model.body().offsets
    ends = {f"{side}_foot": np.array([0.15, -0.07, 0]) for side in segments.SIDES}
    shape = Hierarchy(names, segments.model().parents, offsets, ends)
    places = np.repeat(offsets[None], len(turns), axis=0)
    places[:, 0] = np.arange(len(turns))[:, None] * [1.0, 2, 0] + [0, 0, 0.95]
    return PosedHierarchy(shape, np.arange(len(turns)) / 60, places, turns)


def test_a_skeletal_model_is_at_rest_in_a_t_pose_that_faces_z():
    """Wu et al. 2005: axes forwards, up, right. BVH, glTF and mocopi: left, up, forwards."""
    turns = np.repeat(segments.model().rest[None], 2, axis=0)
    turns[:, 0] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # stands, faces the world's x
    found = posing.turned(posing.rested(of_model(turns), segments.model().rest))
    quarter = Rotation.from_euler("Y", 90, degrees=True).as_matrix()  # from z to x
    expected = np.tile(np.eye(3), (len(segments.model().names), 1, 1))
    expected[0] = quarter
    np.testing.assert_allclose(found.parent_from_joint[1], expected, atol=1e-12)
    at = found.hierarchy.joints.index
    places, (xyz, _) = at_rest(found.hierarchy), forward(found)
    np.testing.assert_allclose(xyz[0], [0, 0.95, 0] + (places - places[0]) @ quarter.T, atol=1e-9)
    arm = places[at("left_hand")] - places[at("left_humerus")]
    np.testing.assert_allclose(arm, [np.linalg.norm(arm), 0, 0], atol=1e-9)
    np.testing.assert_allclose(
        places[at("right_hand")], places[at("left_hand")] * [-1, 1, 1], atol=1e-9
    )
    np.testing.assert_allclose(found.hierarchy.ends["left_foot"], [0, -0.07, 0.15], atol=1e-12)
    lowest = places[at("left_foot"), 1] - 0.07
    assert abs(lowest) < 1e-9 and (places[:, 1] > 0).all()


def test_another_pose_at_rest_moves_nothing():
    n_joints = len(segments.model().names)
    turns = Rotation.random(12 * n_joints, rng=4).as_matrix().reshape(12, n_joints, 3, 3)
    posed = of_model(turns)
    found = posing.rested(posed, segments.model().rest)
    (xyz, turned), (wanted, before) = forward(found), forward(posed)
    np.testing.assert_allclose(xyz, wanted, atol=1e-12)
    for name, tip in posed.hierarchy.ends.items():
        at = posed.hierarchy.joints.index(name)
        moved = turned[:, at] @ found.hierarchy.ends[name]
        np.testing.assert_allclose(moved, before[:, at] @ tip, atol=1e-12)


def test_joints_are_at_rest_upright_on_the_floor():
    time_s, xyz = moving()
    found = posing.turned(posing.of_joints(time_s, xyz, BODY)).hierarchy
    own = [at for at, name in enumerate(found.joints) if name in BODY.joints]
    x, y, z = np.moveaxis(xyz[0], -1, 0)  # all frames have all joints: the first is the pose
    wanted = np.stack([x, z, -y], axis=-1)[[BODY.joints.index(found.joints[at]) for at in own]]
    wanted -= [*wanted[0, :1], wanted[:, 1].min(), wanted[0, 2]]
    np.testing.assert_allclose(at_rest(found)[own], wanted, atol=1e-6)


def test_missing_frames_are_interpolated_and_others_kept():
    time_s = 3 + np.arange(20) / 10
    kept = np.delete(np.arange(20), [4, 5, 6, 11])
    found = posing.even(spinning(time_s[kept]))
    whole = spinning(time_s)
    np.testing.assert_allclose(found.time_s, time_s, atol=1e-12)
    np.testing.assert_allclose(forward(found)[0], forward(whole)[0], atol=1e-9)
    np.testing.assert_allclose(found.parent_from_joint, whole.parent_from_joint, atol=1e-9)
    assert posing.even(whole) is whole
    jittered = spinning(time_s + 0.01 * (-1.0) ** np.arange(20))
    found = posing.even(jittered)
    assert np.ptp(np.diff(found.time_s)) < 1e-12
    np.testing.assert_allclose(found.translation[:, 0, 1], 2 * found.time_s, atol=1e-9)


def test_times_in_milliseconds_keep_their_frames():
    time_s = np.round(np.arange(600) / 60, 3)
    assert len(posing.even(spinning(time_s)).time_s) == 600


BODY = Skeleton(
    "made",
    ("face", "ankle", "knee", "left_hip", "chest", "hand", "head"),
    (
        *(("left_hip", "knee"), ("knee", "ankle"), ("left_hip", "chest")),
        *(("chest", "hand"), ("head", "chest")),
    ),
    {},
    {},
)


def moving(n_frames=25, seed=2):
    """Return joints (T, J, 3) with constant bones between them."""
    rng = np.random.default_rng(seed)
    names = ("left_hip", "knee", "ankle", "chest", "hand", "head")
    offsets = np.array(
        [[0, 0, 0], [0, 0, -0.4], [0, 0, -0.4], [0, 0, 0.5], [0.6, 0, 0], [0, 0, 0.3]]
    )
    shape = Hierarchy(names, np.array([NO_PARENT, 0, 1, 0, 3, 3]), offsets)
    turns = Rotation.from_rotvec(rng.normal(0, 0.4, (n_frames * 6, 3))).as_matrix()
    places = np.repeat(offsets[None], n_frames, axis=0)
    places[:, 0] = rng.normal(0, 1, (n_frames, 3))
    time_s = np.arange(n_frames) / 30
    posed = PosedHierarchy(shape, time_s, places, turns.reshape(n_frames, 6, 3, 3))
    xyz = forward(posed)[0]
    order = [names.index(name) if name in names else 0 for name in BODY.joints]
    return time_s, xyz[:, order]


def test_joints_of_constant_bones_are_met_and_bones_keep_their_length():
    time_s, xyz = moving()
    found = posing.of_joints(time_s, xyz, BODY)
    names = found.hierarchy.joints
    assert "face" not in names
    assert {"left_hip_to_knee", "left_hip_to_chest", "chest_to_head"} <= set(names)
    own = [at for at, name in enumerate(names) if name in BODY.joints]
    made = forward(found)[0]
    joints = [BODY.joints.index(names[at]) for at in own]
    np.testing.assert_allclose(made[:, own], xyz[:, joints], atol=3e-6)
    np.testing.assert_allclose(np.linalg.det(found.parent_from_joint), 1, atol=1e-9)
    longer = xyz.copy()
    longer[3, BODY.joints.index("ankle")] += [0.0, 0.1, 0.2]
    made = forward(posing.of_joints(time_s, longer, BODY))[0]
    bones = np.linalg.norm(made - made[:, np.maximum(found.hierarchy.parents, 0)], axis=2)
    assert np.ptp(bones, axis=0).max() < 1e-9


def test_what_hangs_on_one_joint_turns_it_together():
    time_s, xyz = moving()
    found = posing.of_joints(time_s, xyz, BODY)
    chest = found.hierarchy.joints.index("chest")
    for name in ("chest_to_hand", "chest_to_head"):  # at a constant angle: one turn meets both
        node = found.hierarchy.joints.index(name)
        assert found.hierarchy.parents[node] == chest
        np.testing.assert_allclose(
            found.parent_from_joint[:, node], np.tile(np.eye(3), (25, 1, 1)), atol=1e-5
        )


def test_a_missing_joint_is_bridged_and_a_missing_root_leaves_the_frame_out():
    time_s, xyz = moving()
    column = BODY.joints.index
    whole = xyz.copy()
    xyz[4:6, column("ankle")] = np.nan
    xyz[7, column("left_hip")] = np.nan
    xyz[:2, column("hand")] = np.nan
    found = posing.of_joints(time_s, xyz, BODY)
    assert found.time_s.tolist() == np.delete(time_s, 7).tolist()
    made, node = forward(found)[0], found.hierarchy.joints.index
    about = whole - whole[:, column("left_hip"), None]
    ankle = (2 * about[3, column("ankle")] + about[6, column("ankle")]) / 3
    for frame, name, place in (
        (4, "ankle", ankle - about[4, column("knee")]),
        (0, "hand", about[2, column("hand")] - about[0, column("chest")]),
    ):
        parent = {"ankle": "knee", "hand": "chest"}[name]
        bone = made[frame, node(name)] - made[frame, node(parent)]
        length = np.linalg.norm(whole[0, column(name)] - whole[0, column(parent)])
        np.testing.assert_allclose(bone, length * place / np.linalg.norm(place), atol=3e-6)
    knee = made[4:6, node("knee")]
    np.testing.assert_allclose(knee, whole[4:6, column("knee")], atol=3e-6)  # is as measured


def test_the_bone_of_a_joint_that_is_never_seen_goes_on_with_its_parent():
    time_s, xyz = moving()
    xyz[:, BODY.joints.index("ankle")] = np.nan
    found = posing.of_joints(time_s, xyz, BODY)
    knee = found.parent_from_joint[:, found.hierarchy.joints.index("knee")]
    np.testing.assert_allclose(knee, np.tile(np.eye(3), (25, 1, 1)), atol=1e-9)
    assert np.isfinite(forward(found)[0]).all()
    nobody = posing.of_joints(time_s, np.full_like(xyz, np.nan), BODY)
    assert len(nobody.time_s) == 0 and not nobody.hierarchy.offsets.any()


def test_bvhio_finds_the_joints_in_the_file(tmp_path):
    time_s, xyz = moving()
    posed = posing.turned(posing.of_joints(time_s, xyz, BODY))
    bvh.write(tmp_path / "a.bvh", posing.even(posed))
    root = bvhio.readAsHierarchy(str(tmp_path / "a.bvh"))
    for frame in (0, 9, 24):
        root.loadPose(frame)
        found = {joint.Name: 0.01 * np.array(joint.PositionWorld) for joint, _, _ in root.layout()}
        for name in posed.hierarchy.joints:
            if name in BODY.joints:
                x, y, z = xyz[frame, BODY.joints.index(name)]
                np.testing.assert_allclose(found[name], [x, z, -y], atol=1e-5)
