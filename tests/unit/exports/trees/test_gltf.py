"""GLB written, and read back by pygltflib: every joint where the motion has it, in every frame."""

import json
import struct
from dataclasses import replace

import numpy as np
import pygltflib
import pytest
from scipy.spatial.transform import Rotation

from courtside.exports.trees import gltf
from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy, forward
from courtside.study.errors import InputError

PARENTS = [NO_PARENT, 0, 1, 1, 0]
NAMES = ("root", "chest", "left_arm", "right_arm", "leg")
TIPS = {"leg": np.array([0, -0.4, 0.1]), "right_arm": np.array([0, -0.3, 0.0])}


def made(n_frames=30):
    rng = np.random.default_rng(5)
    offsets = rng.normal(0, 0.3, (5, 3))
    translation = np.repeat(offsets[None], n_frames, axis=0)
    translation[:, 0] = rng.normal(0, 2, (n_frames, 3))
    steps = Rotation.from_rotvec(rng.normal(0, 0.5, (n_frames * 5, 3))).as_matrix()
    turns = steps.reshape(n_frames, 5, 3, 3)
    for frame in range(1, n_frames):
        turns[frame] = turns[frame - 1] @ turns[frame]
    time_s = 7.5 + np.arange(n_frames) / 60
    return PosedHierarchy(
        Hierarchy(NAMES, np.array(PARENTS), offsets, TIPS), time_s, translation, turns
    )


def values(read, index):
    """Return the numbers of an accessor, as the specification lays them out."""
    accessor = read.accessors[index]
    view = read.bufferViews[accessor.bufferView]
    kind = {pygltflib.FLOAT: "<f4", pygltflib.UNSIGNED_SHORT: "<u2"}[accessor.componentType]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[accessor.type]
    raw = read.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    found = np.frombuffer(raw, kind).reshape(accessor.count, width)
    assert found.min(axis=0).tolist() == accessor.min
    assert found.max(axis=0).tolist() == accessor.max
    return found.astype(float)


def local(read, frame):
    """Return {node: (rotation, translation, scale)} in a frame: keys, else the node's own."""
    found = {}
    for index, node in enumerate(read.nodes):
        turn = Rotation.from_quat(node.rotation or [0, 0, 0, 1]).as_matrix()
        place = node.translation or [0, 0, 0]
        found[index] = [turn, np.array(place, float), np.array(node.scale or [1, 1, 1], float)]
    (animation,) = read.animations
    for channel in animation.channels:
        keys = values(read, animation.samplers[channel.sampler].output)[frame]
        if channel.target.path == "rotation":
            found[channel.target.node][0] = Rotation.from_quat(keys).as_matrix()
        else:
            found[channel.target.node][1] = keys
    return found


def world(read, frame):
    """Return {name: 4 x 4 matrix} of all nodes."""
    own, found = local(read, frame), {}

    def walk(index, above):
        turn, place, scale = own[index]
        here = np.eye(4)
        here[:3, :3], here[:3, 3] = turn * scale, place
        found[read.nodes[index].name] = above @ here
        for child in read.nodes[index].children or []:
            walk(child, above @ here)

    for root in read.scenes[read.scene].nodes:
        walk(root, np.eye(4))
    return found


@pytest.fixture
def written(tmp_path):
    gltf.write(tmp_path / "a.glb", made(), "p1 walk")
    return pygltflib.GLTF2().load(str(tmp_path / "a.glb"))


def test_every_joint_is_where_the_motion_has_it(written):
    xyz, turns = forward(made())
    for frame in (0, 1, 17, 29):
        found = world(written, frame)
        for joint, name in enumerate(made().hierarchy.joints):
            np.testing.assert_allclose(found[name][:3, 3], xyz[frame, joint], atol=2e-6)
            np.testing.assert_allclose(found[name][:3, :3], turns[frame, joint], atol=2e-6)


def test_times_start_at_zero_and_only_the_root_is_moved(written):
    (animation,) = written.animations
    assert animation.name == "p1 walk"
    assert animation.extras == {"start_s": 7.5}
    times = values(written, animation.samplers[0].input)[:, 0]
    np.testing.assert_allclose(times, np.arange(30) / 60, atol=1e-6)
    moved = [one.target.node for one in animation.channels if one.target.path == "translation"]
    assert [written.nodes[node].name for node in moved] == ["root"]
    assert len(animation.channels) == 5 + 1
    for one in animation.channels:
        if one.target.path == "rotation":
            keys = values(written, animation.samplers[one.sampler].output)
            np.testing.assert_allclose(np.linalg.norm(keys, axis=1), 1, atol=1e-6)
            assert (np.sum(keys[1:] * keys[:-1], axis=1) >= 0).all()


def test_persons_of_one_take_share_its_time(tmp_path):
    """One who enters later moves later when both files are opened together."""
    gltf.write(tmp_path / "a.glb", made(), "late", zero_s=5.0)
    (animation,) = (read := pygltflib.GLTF2().load(str(tmp_path / "a.glb"))).animations
    times = values(read, animation.samplers[0].input)[:, 0]
    np.testing.assert_allclose(times, 2.5 + np.arange(30) / 60, atol=1e-6)
    assert animation.extras == {"start_s": 7.5}


def test_sticks_reach_from_joint_to_joint_and_to_tips(written):
    """By the specification a skinned vertex is at joint times inverse bind matrix (3.7.3.3)."""
    (skin,), (mesh,) = written.skins, written.meshes
    keys = vars(mesh.primitives[0].attributes)
    corners, normals, owners, weights = (
        values(written, keys[key]) for key in ("POSITION", "NORMAL", "JOINTS_0", "WEIGHTS_0")
    )
    assert weights.tolist() == [[1, 0, 0, 0]] * len(weights)
    unbound = values(written, skin.inverseBindMatrices).reshape(-1, 4, 4).swapaxes(1, 2)
    names, posed = [written.nodes[node].name for node in skin.joints], world(written, 11)
    at = owners[:, 0].astype(int)
    moves = np.array([posed[name] @ own for name, own in zip(names, unbound, strict=True)])[at]
    moved = np.einsum("nij,nj->ni", moves[:, :3, :3], corners) + moves[:, :3, 3]
    sticks = moved.reshape(4 + len(TIPS), -1, 3)
    xyz = forward(made())[0][11]
    starts = [*xyz[PARENTS[1:]], *(xyz[NAMES.index(name)] for name in TIPS)]
    ends = [*xyz[1:], *(tip(name) for name in TIPS)]
    for stick, start, end in zip(sticks, starts, ends, strict=True):
        along = (stick - start) @ (end - start) / np.sum((end - start) ** 2)
        np.testing.assert_allclose(stick[along.argmin()], start, atol=3e-6)
        np.testing.assert_allclose(stick[along.argmax()], end, atol=3e-6)
    outwards = corners.reshape(len(sticks), -1, 3)
    outwards = outwards - outwards.mean(axis=1, keepdims=True)
    assert (np.sum(normals * outwards.reshape(-1, 3), axis=1) > 0).all()


def test_one_skin_binds_every_joint_at_rest_below_a_node_of_the_clip_s_name(written):
    """Programs make an armature of a skin alone; Blender binds the root only below `skeleton`."""
    (skin,) = written.skins
    above = written.nodes[skin.skeleton]
    assert (above.name, [written.nodes[node].name for node in above.children]) == (
        "p1 walk",
        ["root"],
    )
    assert [written.nodes[node].name for node in skin.joints] == list(NAMES)
    unbound = values(written, skin.inverseBindMatrices).reshape(-1, 4, 4).swapaxes(1, 2)
    still = replace(made(1), parent_from_joint=np.tile(np.eye(3), (1, 5, 1, 1)))
    still.translation[:, 0] = still.hierarchy.offsets[0]
    rest = np.tile(np.eye(4), (5, 1, 1))
    rest[:, :3, 3] = forward(still)[0][0]
    np.testing.assert_allclose(unbound @ rest, np.tile(np.eye(4), (5, 1, 1)), atol=1e-6)


def tip(name, frame=11):
    xyz, turns = forward(made())
    at = NAMES.index(name)
    return xyz[frame, at] + turns[frame, at] @ TIPS[name]


def test_gaps_are_refused(tmp_path):
    posed = made()
    posed.translation[3, 0] = np.nan
    with pytest.raises(InputError, match=r"a\.glb: expected .* found 30 frames with gaps"):
        gltf.write(tmp_path / "a.glb", posed, "a")
    assert list(tmp_path.iterdir()) == []


def test_without_frames_there_is_the_pose_at_rest(tmp_path):
    gltf.write(tmp_path / "a.glb", made(0), "a")
    read = pygltflib.GLTF2().load(str(tmp_path / "a.glb"))
    assert read.animations == []
    assert read.nodes[1].translation == made().hierarchy.offsets[1].tolist()


def test_a_body_that_was_never_placed_is_a_file_without_buffers(tmp_path):
    """The specification has no empty lists and no buffer of zero bytes (glTF 2.0, 3.6 and 5.1)."""
    one, path = made(0), tmp_path / "a.glb"
    shape = Hierarchy(one.hierarchy.joints, one.hierarchy.parents, np.zeros((5, 3)))
    gltf.write(path, replace(one, hierarchy=shape), "a")
    content = path.read_bytes()
    size, length, kind = struct.unpack_from("<8xII4s", content)
    assert (size, length, kind) == (len(content), len(content) - 20, b"JSON")  # one chunk alone
    read = json.loads(content[20:])
    assert sorted(read) == ["asset", "materials", "nodes", "scene", "scenes"]
    assert [key for key, value in read.items() if value == []] == []
