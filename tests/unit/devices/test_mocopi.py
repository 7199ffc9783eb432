"""mocopi's files: the study's names, metres, the row nobody performed, the app's frame rates."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.devices import bvh, mocopi
from courtside.exports import bvh as writer
from courtside.records.devices import device_motion
from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy, forward
from courtside.records.keypoints import missing_reason, skeleton
from courtside.study.errors import InputError
from fixtures.recordings.real_data import REAL, needs_real

ROOT = Path(__file__).parents[3]
YAML = ROOT / "config" / "skeletons" / "mocopi27.yaml"
MOCOPI = skeleton.read(YAML)
PARENT = {child: parent for parent, child in MOCOPI.bones}
REAL_FILES = [("mocopi-mobile-arm-raise-turn", 853, 50.0), ("jump", 802, 60.0)]


def recorded(path, *, n_frames=5, rest=True, period_s=1 / 60, names=None, unit_m=1.0, turn=0.5):
    """Write a file as the app does: every row turns every joint, except a rest pose in front."""
    rng = np.random.default_rng(2)
    parents = [
        MOCOPI.index(PARENT[joint]) if joint in PARENT else NO_PARENT for joint in MOCOPI.joints
    ]
    shape = Hierarchy(
        tuple(names or MOCOPI.device_names()),
        np.array(parents),
        rng.normal(0, 0.08, (27, 3)),  # 1.6 m from head to ankles
    )
    angle = rng.uniform(-turn, turn, (n_frames, 27))
    angle[: int(rest)] = 0
    c, s, one, zero = np.cos(angle), np.sin(angle), np.ones_like(angle), np.zeros_like(angle)
    rotation = np.stack([c, -s, zero, s, c, zero, zero, zero, one], axis=-1).reshape(
        n_frames, 27, 3, 3
    )
    posed = PosedHierarchy(
        shape,
        np.arange(n_frames) * period_s,
        np.repeat(shape.offsets[None], n_frames, axis=0),
        rotation,
    )
    other = replace(posed, translation=posed.translation / unit_m)
    other = replace(other, hierarchy=replace(shape, offsets=shape.offsets / unit_m))
    writer.write(path, other)
    return posed


def test_the_skeleton_is_a_tree_from_the_root():
    assert len(MOCOPI.joints) == 27
    assert set(PARENT) == set(MOCOPI.joints) - {"root"}
    assert [PARENT[joint] for joint in ("neck_1", "left_clavicle", "right_clavicle")] == [
        "torso_7"
    ] * 3
    assert PARENT["left_hip"] == PARENT["right_hip"] == "root"


@needs_real
@pytest.mark.parametrize(("name", "n_frames", "rate_hz"), REAL_FILES)
def test_a_real_file_has_the_study_s_joints(name, n_frames, rate_hz):
    path = REAL / "mocopi" / f"{name}.bvh"
    motion = mocopi.read(path, MOCOPI)
    posed = motion.posed
    assert (motion.source, motion.kind) == ("mocopi", "inertial")
    assert motion.joints.tolist() == list(posed.hierarchy.joints) == list(MOCOPI.joints)
    assert motion.xyz.shape == (n_frames, 27, 3)
    np.testing.assert_allclose(motion.time_s, np.arange(n_frames) / rate_hz, rtol=0, atol=1e-12)
    assert (motion.reason == missing_reason.OK).all()
    assert motion.performed.tolist() == [False] + [True] * (n_frames - 1)
    for joint, parent in zip(posed.hierarchy.joints, posed.hierarchy.parents, strict=True):
        assert PARENT.get(joint) == (
            None if parent == NO_PARENT else posed.hierarchy.joints[parent]
        )
    np.testing.assert_array_equal(motion.xyz, forward(bvh.read(path))[0])


@needs_real
@pytest.mark.parametrize("name", [name for name, _, _ in REAL_FILES])
def test_a_real_body_stands_upright_in_metres(name):
    motion = mocopi.read(REAL / "mocopi" / f"{name}.bvh", MOCOPI)
    place = {joint: motion.joint(joint) for joint in MOCOPI.joints}
    rest = {joint: path[0] for joint, path in place.items()}
    assert 0.85 < rest["root"][1] < 1.05
    assert 1.5 < rest["head"][1] < 1.75
    assert abs(rest["left_toes"][1]) < 0.05
    assert rest["left_toes"][2] > rest["left_ankle"][2]  # toes point along Z
    assert rest["left_wrist"][0] > rest["left_shoulder"][0] > 0 > rest["right_wrist"][0]
    for (
        start,
        end,
    ) in MOCOPI.segments.values():  # bones keep their length: position channels are offsets
        length = np.linalg.norm(place[end] - place[start], axis=1)
        assert np.ptp(length) < 1e-6
        assert 0.2 < length[0] < 0.5
    assert set(motion.posed.hierarchy.ends) == {
        "head",
        "left_wrist",
        "right_wrist",
        "left_toes",
        "right_toes",
    }


@pytest.mark.parametrize(("written_s", "rate_hz"), [(0.033333, 30), (0.02, 50), (0.016667, 60)])
def test_the_app_s_rates_are_exact(tmp_path, written_s, rate_hz):
    recorded(tmp_path / "a.bvh", n_frames=1001, period_s=written_s)
    motion = mocopi.read(tmp_path / "a.bvh", MOCOPI, source="suit")
    assert motion.source == "suit"
    assert motion.time_s[-1] == pytest.approx(1000 / rate_hz, abs=1e-9)
    np.testing.assert_array_equal(motion.posed.time_s, motion.time_s)


def test_another_rate_is_as_written(tmp_path):
    recorded(tmp_path / "a.bvh", period_s=0.0167)
    assert mocopi.read(tmp_path / "a.bvh", MOCOPI).time_s[4] == pytest.approx(4 * 0.0167)


def test_only_a_first_row_without_any_rotation_is_the_rest_pose(tmp_path):
    recorded(tmp_path / "a.bvh")
    assert mocopi.read(tmp_path / "a.bvh", MOCOPI).performed.tolist() == [False] + [True] * 4
    recorded(tmp_path / "a.bvh", rest=False)
    assert mocopi.read(tmp_path / "a.bvh", MOCOPI).performed.all()


@pytest.mark.parametrize(("n_repeats", "told"), [(0, ""), (3, ""), (30, "from 0.3 to 0.8 s:")])
def test_a_pose_that_is_repeated_is_told(tmp_path, capsys, n_repeats, told):
    """A suit that loses its sensors writes the last pose on."""
    path = tmp_path / "a.bvh"
    recorded(path, n_frames=100)
    lines = path.read_text().splitlines()
    row = len(lines) - 100 + 20
    lines[row : row + n_repeats + 1] = [lines[row]] * (n_repeats + 1)
    path.write_text("\n".join(lines))
    found = mocopi.read(path, MOCOPI)
    assert len(found.time_s) == 100
    said = capsys.readouterr().err
    assert told in said if told else not said


@pytest.mark.parametrize(
    ("seconds", "way_m", "told"), [(3, (0, 0.1, 0), True), (3, (0.001, 0, 0), False), (1, 0, False)]
)
def test_a_root_without_its_way_is_told(tmp_path, capsys, seconds, way_m, told):
    posed = recorded(tmp_path / "take.bvh", n_frames=1 + 60 * seconds)
    moved = posed.translation.copy()
    moved[:, 0] += np.sin(np.arange(len(moved)) / 20)[:, None] * way_m
    writer.write(tmp_path / "take.bvh", replace(posed, translation=moved))
    mocopi.read(tmp_path / "take.bvh", MOCOPI)
    assert ("take.bvh: the root is at one place of the floor" in capsys.readouterr().err) == told


@pytest.mark.parametrize(("n_frames", "n_performed"), [(0, 0), (1, 0), (2, 1)])
def test_fewer_than_two_frames_of_motion_are_refused(tmp_path, n_frames, n_performed):
    recorded(tmp_path / "a.bvh", n_frames=n_frames)
    with pytest.raises(InputError, match=rf"a\.bvh: expected 2 frames .* found {n_performed}; rec"):
        mocopi.read(tmp_path / "a.bvh", MOCOPI)


def test_joints_in_another_order_come_out_in_the_skeleton_s(tmp_path):
    posed = recorded(tmp_path / "a.bvh")
    text = (tmp_path / "a.bvh").read_text()
    start, end = text.index("  JOINT l_up_leg"), text.index("  JOINT r_up_leg")
    last = text.index("}\nMOTION")
    head = text[:start] + text[end:last] + text[start:end] + text[last:].split("0.016666", 1)[0]
    rows = np.loadtxt(text.splitlines()[-5:])
    rows = np.hstack([rows[:, : 19 * 6], rows[:, 23 * 6 :], rows[:, 19 * 6 : 23 * 6]])
    table = "\n".join(" ".join(map(str, row)) for row in rows)
    (tmp_path / "a.bvh").write_text(f"{head}0.016667\n{table}\n")
    motion = mocopi.read(tmp_path / "a.bvh", MOCOPI)
    assert motion.posed.hierarchy.joints[19] == "right_hip"
    assert motion.joints.tolist() == list(MOCOPI.joints)
    np.testing.assert_allclose(motion.xyz, forward(posed)[0], atol=1e-6)


def test_other_joints_are_named_in_one_line(tmp_path):
    names = MOCOPI.device_names()
    names[5], names[20] = "spine", "shin"
    recorded(tmp_path / "a.bvh", names=names)
    message = r"a\.bvh: expected the 27 joints of mocopi27, found 27: "
    with pytest.raises(
        InputError, match=message + "missing: torso_5, l_low_leg; unknown: spine, shin;"
    ):
        mocopi.read(tmp_path / "a.bvh", MOCOPI)
    text = (tmp_path / "a.bvh").read_text()
    (tmp_path / "a.bvh").write_text(text.replace("spine", "torso_5").replace("shin", "torso_5"))
    with pytest.raises(InputError, match="missing: l_low_leg; twice: torso_5;") as caught:
        mocopi.read(tmp_path / "a.bvh", MOCOPI)
    assert "\n" not in str(caught.value)


# The writer writes centimetres: a file in another unit has other numbers.
@pytest.mark.parametrize(
    ("unit", "metres", "tall"),
    [("m", 1.0, "0.01"), ("mm", 0.001, "15"), ("in", 0.0254, "0.6"), ("ft", 0.3048, "0.05")],
)
def test_a_file_in_another_unit_is_named_and_read_with_its_key(tmp_path, unit, metres, tall):
    path = tmp_path / "a.bvh"
    posed = recorded(path, unit_m=metres / 0.01)
    with pytest.raises(InputError, match=f"ankles to head .* found {tall}.*read in cm") as caught:
        mocopi.read(path, MOCOPI)
    assert f"`unit: {unit}`" in str(caught.value)
    assert "\n" not in str(caught.value)
    found = mocopi.read(path, MOCOPI, unit=unit)
    np.testing.assert_allclose(found.xyz, forward(posed)[0], atol=1e-5)


def test_angles_in_radians_are_named_and_read_with_their_key(tmp_path):
    path = tmp_path / "a.bvh"
    posed = recorded(path, turn=np.radians(0.5))  # its degrees are half radians at most
    with pytest.raises(InputError, match=r"turn by 11 deg.*`angles: radians`") as caught:
        mocopi.read(path, MOCOPI)
    assert "\n" not in str(caught.value)
    still = mocopi.read(path, MOCOPI, angles="degrees")
    np.testing.assert_allclose(still.xyz, forward(posed)[0], atol=1e-6)
    angle = np.degrees(Rotation.from_matrix(posed.parent_from_joint.reshape(-1, 3, 3)).magnitude())
    turned = mocopi.read(path, MOCOPI, angles="radians").posed.parent_from_joint
    found = Rotation.from_matrix(turned.reshape(-1, 3, 3)).magnitude()
    np.testing.assert_allclose(found, angle, atol=1e-6)


@pytest.mark.parametrize("period_s", [20.0, 0.5, 1e-4])
def test_a_frame_time_in_another_unit_is_named(tmp_path, period_s):
    recorded(tmp_path / "a.bvh", period_s=period_s)
    message = (
        f"5 to 500 frames a second, found a frame every {period_s:g} s; correct .*`Frame Time`"
    )
    with pytest.raises(InputError, match=message):
        mocopi.read(tmp_path / "a.bvh", MOCOPI)


def test_the_script_hands_the_motion_on(tmp_path):
    posed = recorded(tmp_path / "a.bvh")
    script = runpy.run_path(str(ROOT / "workflow" / "scripts" / "import_device.py"))
    script["main"](tmp_path / "a.bvh", YAML, tmp_path / "suit.npz", device="suit", kind="inertial")
    found = device_motion.read(tmp_path / "suit.npz")
    assert (found.source, found.kind) == ("suit", "inertial")
    assert found.performed.tolist() == [False] + [True] * 4
    np.testing.assert_allclose(found.joint("left_wrist"), forward(posed)[0][:, 14], atol=1e-6)
    np.testing.assert_array_equal(forward(found.posed)[0], found.xyz)
