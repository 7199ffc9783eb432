"""BVH written and read back: by the study's reader, by bvhio, and by eye."""

from dataclasses import replace

import bvhio
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.devices import bvh as reader
from courtside.exports import bvh
from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy, forward
from courtside.study.errors import InputError
from fixtures.recordings.real_data import REAL, needs_real

PARENTS = [NO_PARENT, 0, 1, 1, 0]
NAMES = ("root", "chest", "left_arm", "right_arm", "leg")
REAL_FILES = ["mocopi/mocopi-mobile-arm-raise-turn", "mocopi/jump", "bvh-walk01/walk01"]


def made(n_frames=40, seed=5):
    rng = np.random.default_rng(seed)
    offsets = rng.normal(0, 0.3, (5, 3))
    shape = Hierarchy(NAMES, np.array(PARENTS), offsets, {"leg": np.array([0, -0.4, 0.1])})
    translation = np.repeat(offsets[None], n_frames, axis=0)
    translation[:, 0] = rng.normal(0, 2, (n_frames, 3))
    rotation = Rotation.random(n_frames * 5, rng=rng).as_matrix().reshape(n_frames, 5, 3, 3)
    return PosedHierarchy(shape, np.arange(n_frames) / 60, translation, rotation)


def turned_deg(a, b):
    """Return the largest angle between two sets of rotations, degrees."""
    apart = np.swapaxes(a, -1, -2) @ b
    return np.degrees(Rotation.from_matrix(apart.reshape(-1, 3, 3)).magnitude().max())


def test_what_is_written_is_read_back(tmp_path):
    posed = made()
    bvh.write(tmp_path / "a.bvh", posed)
    found = reader.read(tmp_path / "a.bvh")
    assert found.hierarchy.joints == NAMES
    assert found.hierarchy.parents.tolist() == PARENTS
    np.testing.assert_allclose(found.hierarchy.offsets, posed.hierarchy.offsets, atol=1e-6)
    np.testing.assert_allclose(found.hierarchy.ends["leg"], [0, -0.4, 0.1], atol=1e-6)
    assert found.hierarchy.ends["left_arm"].tolist() == [0, 0, 0]
    np.testing.assert_allclose(found.time_s, posed.time_s, atol=1e-6)
    np.testing.assert_allclose(found.translation, posed.translation, atol=1e-6)
    assert turned_deg(found.parent_from_joint, posed.parent_from_joint) < 2e-6
    assert [path.name for path in tmp_path.iterdir()] == ["a.bvh"]


def test_the_middle_angle_may_be_90_degrees(tmp_path):
    posed = made(n_frames=2)
    posed.parent_from_joint[:, 1] = Rotation.from_euler(
        "ZXY", [20, 90, 35], degrees=True
    ).as_matrix()
    posed.parent_from_joint[:, 2] = Rotation.from_euler(
        "ZXY", [20, -90, 0], degrees=True
    ).as_matrix()
    bvh.write(tmp_path / "a.bvh", posed)
    found = reader.read(tmp_path / "a.bvh")
    assert turned_deg(found.parent_from_joint, posed.parent_from_joint) < 2e-6


def test_channels_do_not_jump_where_a_joint_turns_on(tmp_path):
    """Programs interpolate channels: a jump of 360 degrees is a whole turn between two frames."""
    deg = 7.03 * np.arange(110)  # never where the middle angle leaves the others open
    about = [np.outer(deg, np.eye(3)[axis]) for axis in range(3)]  # Z, X, Y
    about.append(np.stack([20 + deg / 7, deg, -deg / 9], axis=1))  # a knee that swings sideways
    angles = np.stack([*about, np.zeros((110, 3))], axis=1)
    turns = Rotation.from_euler("ZXY", angles.reshape(-1, 3), degrees=True).as_matrix()
    bvh.write(tmp_path / "a.bvh", replace(made(110), parent_from_joint=turns.reshape(110, 5, 3, 3)))
    lines = (tmp_path / "a.bvh").read_text().splitlines()
    found = np.loadtxt(lines[lines.index("MOTION") + 3 :]).reshape(110, 5, 6)[:, :, 3:]
    np.testing.assert_allclose(found, angles, atol=2e-6)


def test_the_text_is_what_the_format_wants(tmp_path):
    shape = Hierarchy(
        ("root", "tail"), np.array([NO_PARENT, 0]), np.array([[0, 0.9, 0], [0, 0, -0.2]])
    )
    turn = Rotation.from_euler("ZXY", [[10, 20, 30], [0, 0, -45]], degrees=True).as_matrix()
    posed = PosedHierarchy(shape, np.zeros(1), np.array([[[0.5, 1, 0], [0, 0, -0.2]]]), turn[None])
    bvh.write(tmp_path / "a.bvh", posed)
    words = (tmp_path / "a.bvh").read_text().split()
    channels = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    expected = f"""HIERARCHY ROOT root {{ OFFSET 0 90 0 {channels}
        JOINT tail {{ OFFSET 0 0 -20 {channels}
        End Site {{ OFFSET 0 0 0 }} }} }} MOTION Frames: 1 Frame Time: 0
        50 100 0 10 20 30 0 0 -20 0 0 -45"""
    for found, wanted in zip(words, expected.split(), strict=True):
        assert found == wanted or float(found) == pytest.approx(float(wanted), abs=1e-6)


def test_bvhio_places_it_the_same(tmp_path):
    posed = made()
    bvh.write(tmp_path / "a.bvh", posed)
    root = bvhio.readAsHierarchy(str(tmp_path / "a.bvh"))
    xyz, _ = forward(posed)
    for frame in range(len(xyz)):
        root.loadPose(frame)
        places = [tuple(joint.PositionWorld) for joint, _, _ in root.layout()]
        np.testing.assert_allclose(0.01 * np.array(places), xyz[frame], rtol=1e-6, atol=1e-6)


def added(path, frame):
    """Return {joint: place} in a frame by the rule of programs that add positions to offsets."""
    lines, found, stack = path.read_text().splitlines(), {}, []
    numbers = iter(map(float, lines[lines.index("MOTION") + 3 + frame].split()))
    for words in map(str.split, lines[: lines.index("MOTION")]):
        if words[0] in ("ROOT", "JOINT", "End"):
            stack.append([stack[-1][1] if stack else np.eye(4), None, " ".join(words[1:])])
        elif words[0] == "OFFSET":
            own = np.eye(4)
            own[:3, 3] = [0.01 * float(word) for word in words[1:]]
            stack[-1][1] = stack[-1][0] @ own
        elif words[0] == "CHANNELS":
            read = {word: next(numbers) for word in words[2:]}
            own = np.eye(4)
            own[:3, 3] = [0.01 * read.get(f"{axis}position", 0) for axis in "XYZ"]
            angles = [read[word] for word in words[-3:]]
            order = "".join(word[0] for word in words[-3:])
            own[:3, :3] = Rotation.from_euler(order, angles, degrees=True).as_matrix()
            stack[-1][1] = stack[-1][1] @ own
        elif words[0] == "}":
            _, place, name = stack.pop()
            found[name] = place[:3, 3]
    return found


def test_programs_that_add_positions_to_offsets_place_constant_bones_the_same(tmp_path):
    """three.js' BVHLoader adds them; Blender and bvhio do not: both must find one body."""
    posed = made()
    bvh.write(tmp_path / "a.bvh", posed, only_root_moves=True)
    root, xyz = bvhio.readAsHierarchy(str(tmp_path / "a.bvh")), forward(posed)[0]
    for frame in (0, 11, 39):
        root.loadPose(frame)
        places = {joint.Name: joint.PositionWorld for joint, _, _ in root.layout()}
        sums = added(tmp_path / "a.bvh", frame)
        for joint, name in enumerate(NAMES):
            np.testing.assert_allclose(0.01 * np.array(places[name]), xyz[frame, joint], atol=1e-6)
            np.testing.assert_allclose(sums[name], xyz[frame, joint], atol=1e-6)
    bvh.write(tmp_path / "b.bvh", posed)
    assert np.abs(added(tmp_path / "b.bvh", 0)["leg"] - xyz[0, 4]).max() > 0.1


def test_joints_are_written_chain_by_chain(tmp_path):
    posed = made(n_frames=3)
    mixed = [0, 1, 4, 2, 3]  # the leg before the arms: parents first, but no longer depth first
    shape = posed.hierarchy
    other = PosedHierarchy(
        Hierarchy(
            tuple(NAMES[at] for at in mixed),
            np.array([-1, 0, 0, 1, 1]),
            shape.offsets[mixed],
            shape.ends,
        ),
        posed.time_s,
        posed.translation[:, mixed],
        posed.parent_from_joint[:, mixed],
    )
    bvh.write(tmp_path / "a.bvh", posed)
    bvh.write(tmp_path / "b.bvh", other)
    assert (tmp_path / "a.bvh").read_text() == (tmp_path / "b.bvh").read_text()


@pytest.mark.parametrize("n_frames", [0, 1])
def test_files_of_no_frame_and_of_one_are_written(tmp_path, n_frames):
    bvh.write(tmp_path / "a.bvh", made(n_frames))
    found = reader.read(tmp_path / "a.bvh")
    np.testing.assert_allclose(found.translation, made(n_frames).translation, atol=1e-6)
    assert len(found.time_s) == n_frames


@needs_real
@pytest.mark.parametrize("name", REAL_FILES)
def test_a_real_file_is_written_back(tmp_path, name):
    posed = reader.read(REAL / f"{name}.bvh")
    bvh.write(tmp_path / "a.bvh", posed)
    found = reader.read(tmp_path / "a.bvh")
    np.testing.assert_allclose(forward(found)[0], forward(posed)[0], atol=1e-6)
    assert turned_deg(found.parent_from_joint, posed.parent_from_joint) < 2e-6
    assert abs(found.time_s - posed.time_s).max() < 1e-6


def broken(**changes):
    return replace(made(4), **changes)


def test_what_bvh_cannot_hold_is_one_line(tmp_path):
    path = tmp_path / "a.bvh"
    gap = made(4)
    gap.translation[2, 3, 1] = np.nan
    shape = made(4).hierarchy
    faults = {
        r"found none of 'right_arm' in frame 2": gap,
        r"frames even in time": broken(time_s=np.array([0, 0.02, 0.04, 0.08])),
        r"frames even": broken(time_s=np.zeros(4)),
        r"without blanks, found 'left arm'": broken(
            hierarchy=replace(shape, joints=("a", "b", "left arm", "c", "d"))
        ),
        r"that differ, .* found 'b'": broken(
            hierarchy=replace(shape, joints=("a", "b", "c", "b", "d"))
        ),
    }
    for fault, posed in faults.items():
        with pytest.raises(InputError, match=fault) as caught:
            bvh.write(path, posed)
        assert "\n" not in str(caught.value)
    with pytest.raises(ValueError, match="one root"):
        bvh.write(path, broken(hierarchy=replace(shape, parents=np.array([-1, 0, -1, 1, 0]))))
    assert list(tmp_path.iterdir()) == []
