"""BVH against forward kinematics by another tool, bvhio's own hierarchy, and SciPy's rotations."""

import csv
import json
import time

import bvhio
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.devices import bvh
from courtside.records.devices.hierarchy import NO_PARENT, forward
from courtside.study.errors import InputError
from fixtures.recordings.bvh_texts import ARM
from fixtures.recordings.real_data import REAL, needs_real

MOCOPI = REAL / "mocopi"
CENTIMETRE = {"unit_m": 1.0}  # keep the file's unit
WALK = REAL / "bvh-walk01" / "walk01.bvh"
VALID = [
    WALK,
    MOCOPI / "mocopi-mobile-arm-raise-turn.bvh",
    MOCOPI / "jump.bvh",
    *sorted((MOCOPI / "edge-cases").glob("*.bvh")),
]


def by_bvhio(path, frames):
    """Return the world places of all joints by bvhio's own hierarchy, (T, J, 3) in the file's unit."""
    root = bvhio.readAsHierarchy(str(path))
    joints = [joint for joint, _, _ in root.layout()]
    places = []
    for frame in frames:
        root.loadPose(frame)
        places.append([tuple(joint.PositionWorld) for joint in joints])
    return [joint.Name for joint in joints], np.array(places).reshape(len(frames), len(joints), 3)


def written(tmp_path, text):
    path = tmp_path / "take.bvh"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_tree_and_the_channels_are_the_file_s(tmp_path):
    posed = bvh.read(written(tmp_path, ARM))
    shape = posed.hierarchy
    assert shape.joints == ("hips", "chest", "arm", "prop", "leg")
    assert shape.parents.tolist() == [NO_PARENT, 0, 1, 1, 0]
    np.testing.assert_allclose(shape.offsets[2], [0.18, 0.12, 0])
    assert {joint: tip.tolist() for joint, tip in shape.ends.items()} == {
        "arm": pytest.approx([0.255, 0, 0]),
        "leg": pytest.approx([0, -0.8, 0]),
    }
    np.testing.assert_allclose(posed.time_s, [0, 0.0166667, 0.0333334])
    rows = bvh.read_text(tmp_path / "take.bvh").rows
    for joint, order, columns in (
        (0, "ZXY", [3, 4, 5]),
        (1, "YXZ", [7, 8, 9]),
        (2, "XYZ", [10, 11, 12]),
    ):
        expected = Rotation.from_euler(order, rows[:, columns], degrees=True).as_matrix()
        np.testing.assert_allclose(posed.parent_from_joint[:, joint], expected, atol=1e-12)
    tilt = Rotation.from_rotvec(np.radians(rows[:, 13:]) * [[1, 0, 0]]).as_matrix()
    np.testing.assert_allclose(posed.parent_from_joint[:, 4], tilt, atol=1e-12)
    np.testing.assert_array_equal(posed.parent_from_joint[:, 3], np.tile(np.eye(3), (3, 1, 1)))


def test_position_channels_replace_the_offset_axis_by_axis(tmp_path):
    posed = bvh.read(written(tmp_path, ARM), **CENTIMETRE)
    np.testing.assert_array_equal(
        posed.translation[:, 0], [[0, 95.5, 0], [1.5, 94, -2.25], [1.75, 93.5, -2]]
    )
    np.testing.assert_array_equal(
        posed.translation[:, 1], [[0, 30.25, -1.5], [0, 31, -1.5], [0, -29.5, -1.5]]
    )
    np.testing.assert_array_equal(posed.translation[:, 2], [[18, 12, 0]] * 3)


def test_a_made_file_is_placed_as_bvhio_places_it(tmp_path):
    path = written(tmp_path, ARM)
    names, places = by_bvhio(path, range(3))
    xyz, _ = forward(bvh.read(path))
    assert names == ["hips", "chest", "arm", "prop", "leg"]
    np.testing.assert_allclose(xyz, 0.01 * places, atol=1e-6)


def test_names_need_not_be_ascii(tmp_path):
    found = bvh.read(written(tmp_path, ARM.replace("chest", "胸%20a").replace("arm\n", "胸%20a\n")))
    assert found.hierarchy.joints == ("hips", "胸%20a", "胸%20a", "prop", "leg")


@needs_real
def test_forward_kinematics_is_what_another_tool_computed():
    with (WALK.with_name("walk01_pos.csv")).open() as stream:
        head, *rows = csv.reader(stream)
    truth = np.array(rows, dtype=float)
    column = {name: at for at, name in enumerate(head)}
    posed = bvh.read(WALK, **CENTIMETRE)
    xyz, world = forward(posed)
    assert len(truth) == len(xyz) == 101
    checked = 0
    for at, joint in enumerate(posed.hierarchy.joints):
        places = {joint: xyz[:, at]}
        if joint in posed.hierarchy.ends:  # the tip also checks the last joint's rotation
            places[f"{joint}_End"] = xyz[:, at] + world[:, at] @ posed.hierarchy.ends[joint]
        for name, place in places.items():
            expected = truth[:, [column[f"{name}.{axis}"] for axis in "xyz"]]
            np.testing.assert_allclose(place, expected, atol=1e-3)
            checked += 3
    assert checked == len(head) - 1
    np.testing.assert_allclose(posed.time_s, truth[:, 0], atol=1e-4)


@needs_real
@pytest.mark.parametrize("path", VALID, ids=lambda path: path.stem)
def test_every_valid_file_is_placed_as_bvhio_places_it(tmp_path, path):
    xyz, _ = forward(bvh.read(path))
    if "lowercase" in path.stem:  # bvhio wants capitals: give it the file in its own form
        with pytest.raises(SyntaxError):
            bvhio.readAsHierarchy(str(path))
        text = path.read_text().upper().replace("POSITION", "position")
        text = (
            text.replace("ROTATION", "rotation").replace(" :", ":").replace("END SITE", "End Site")
        )
        path = written(
            tmp_path, text.replace("FRAMES", "Frames").replace("FRAME TIME", "Frame Time")
        )
    frames = range(0, len(xyz), 1 + len(xyz) // 200)
    _, places = by_bvhio(path, frames)
    # Single precision is bvhio's: 5 m from the origin that alone is 1.5e-6 m.
    np.testing.assert_allclose(xyz[list(frames)], 0.01 * places, rtol=1e-6, atol=1e-6)


def fixtures(status):
    manifest = MOCOPI / "manifest.json"
    listed = json.loads(manifest.read_text())["fixtures"] if manifest.is_file() else []
    return [pytest.param(found, id=found["file"]) for found in listed if found["status"] == status]


@needs_real
@pytest.mark.parametrize("fixture", fixtures("valid"))
def test_an_edge_case_is_what_its_manifest_says(fixture):
    path = MOCOPI / "edge-cases" / fixture["file"]
    text, posed = bvh.read_text(path), bvh.read(path)
    assert len(posed.hierarchy.joints) == fixture["joints"]
    assert text.rows.shape == (fixture["frames"], fixture["channels"])
    assert text.frame_time_s == fixture["frameTime"]
    assert len(posed.time_s) == fixture["frames"]


def edge(name):
    return bvh.read(MOCOPI / "edge-cases" / f"valid-{name}.bvh", **CENTIMETRE)


@needs_real
def test_edge_cases_mean_what_they_pin():
    mixed = edge("channel-order-yxz")
    expected = Rotation.from_euler("YXZ", [11, 21, 31], degrees=True).as_matrix()
    np.testing.assert_allclose(mixed.parent_from_joint[1, 0], expected, atol=1e-12)
    expected = Rotation.from_euler("XYZ", [4, 5, 6], degrees=True).as_matrix()
    np.testing.assert_allclose(mixed.parent_from_joint[1, 1], expected, atol=1e-12)
    twice = edge("duplicate-joint-names")
    assert twice.hierarchy.joints == ("Root", "Bone", "Bone")
    assert twice.hierarchy.ends["Bone"].tolist() == [1, 0, 0]
    np.testing.assert_allclose(forward(twice)[0][0, 1:], [[1, 0, 0], [-1, 0, 0]])
    assert edge("lowercase-and-padding").hierarchy.joints == ("hips", "spine")
    assert edge("nested-joints").hierarchy.parents.tolist() == [NO_PARENT, 0, 1, 0]
    assert edge("position-on-joint").translation[:, 1].tolist() == [[1, 2, 3], [1.5, 2.5, 3.5]]
    assert edge("single-frame-zero-time").time_s.tolist() == [0]
    prop = forward(edge("static-joint"))[0][1, 1]  # the hips are tilted by 30 degrees about x
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    np.testing.assert_allclose(prop, [0, 90 + 3 * c - 12 * s, 3 * s + 12 * c], atol=1e-9)


REFUSALS = {
    "channel-count": r"line 6: CHANNELS of joint Hips: expected 6 .* found 'JOINT'",
    "frame-count": r"expected 4 rows of motion .* found 2",
    "frame-time": r"line 13: expected a Frame Time above 0 .* found '-0\.0333333'",
    "frame-width": r"line 15: expected 6 numbers, one for each channel, found 5",
    "missing-hierarchy": r"line 1: expected HIERARCHY .* found 'ROOT'",
    "missing-offset": r"line 4: expected OFFSET of joint Hips, found 'CHANNELS'",
    "no-motion": r"line 11: expected MOTION .* found nothing",
    "non-finite": r"line 15: expected finite numbers .* found 'nan'",
    "unclosed-joint": r"line 11: expected JOINT, one End Site or } in joint Hips, found 'MOTION'",
    "unsupported-channel": r"line 5: CHANNELS of joint Hips: expected 4 .* found 'Wrotation'",
}


@needs_real
@pytest.mark.parametrize("fixture", fixtures("refused"))
def test_a_malformed_file_is_refused_with_its_own_line(fixture):
    path = MOCOPI / "malformed" / fixture["file"]
    started = time.perf_counter()
    with pytest.raises(InputError, match=REFUSALS[path.stem.removeprefix("malformed-")]) as caught:
        bvh.read(path)
    assert time.perf_counter() - started < 1.0
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


@needs_real
def test_every_malformed_file_has_its_line():
    assert len(fixtures("refused")) == len(REFUSALS) == 10
    assert len(fixtures("valid")) == 9
