"""BVH: its text, its rows, and poses against bvhio, SciPy and another tool's forward kinematics."""

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
    """Return all joints' world places by bvhio's own hierarchy, (T, J, 3) in the file's unit."""
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


def read(tmp_path, text, **how):
    path = tmp_path / "take.bvh"
    path.write_text(text, encoding="utf-8", **how)
    return bvh.read_text(path)


def test_a_file_is_read_as_it_stands(tmp_path):
    found = read(tmp_path, ARM)
    np.testing.assert_array_equal(
        found.offsets, [[0, 95.5, 0], [0, 30.25, -1.5], [18, 12, 0], [0, 3, 12], [9, -4, 2]]
    )
    assert {at: tip.tolist() for at, tip in found.ends.items()} == {2: [25.5, 0, 0], 4: [0, -80, 0]}
    assert found.frame_time_s == 0.0166667
    assert found.rows.shape == (3, 14)
    assert found.rows[2, [0, 3, 7, 10]].tolist() == [1.75, -170, 0.5, 90]


@pytest.mark.parametrize(
    "change",
    [
        str.lower,
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n", " \n\n\t"),
        lambda text: text.replace("\n{", " {").replace("}\n", "} "),
        lambda text: text.replace("Frames:", " frames :\t").replace("Time:", "  Time  :"),
    ],
    ids=["lower case", "DOS", "old Mac", "byte order mark", "padded", "run together", "colons"],
)
def test_another_writer_s_habits_change_nothing(tmp_path, change):
    plain, other = read(tmp_path, ARM), read(tmp_path, change(ARM), newline="")
    assert other.hierarchy == plain.hierarchy
    np.testing.assert_array_equal(other.rows, plain.rows)
    np.testing.assert_array_equal(other.offsets, plain.offsets)
    assert other.frame_time_s == plain.frame_time_s


FAULTS = [
    ("HIERARCHY", "HIERARCHY2", "line 1: expected HIERARCHY in front"),
    ("ROOT hips", "JOINT hips", "line 2: expected ROOT after HIERARCHY, found 'JOINT'"),
    ("ROOT hips\n", "ROOT\n", "expected a joint's name .*, found '{'"),
    ("ROOT hips\n", "ROOT the hips\n", "expected { after the name of joint the, found 'hips'"),
    ("ROOT hips\n", "ROOT hi\x1bps\n", "printable letters, found 'hi\\\\x1bps'"),
    ("ROOT hips\n", f"ROOT {'h' * 200}\n", "expected a joint's name of up to 100"),
    (
        "OFFSET 18 12 0",
        "OFFSET 18 12",
        "line 13: expected a number in OFFSET of joint arm, found 'CHANNELS'",
    ),
    (
        "OFFSET 18 12 0",
        "OFFSET 18 12 0 0",
        "expected CHANNELS after OFFSET of joint arm, found '0'",
    ),
    ("OFFSET 18 12 0", "OFFSET 18 inf 0", "found 'inf'"),
    ("OFFSET 18 12 0", "OFFSET 18 1e300 0", "found '1e300'"),
    ("OFFSET 25.5 0 0", "OFFSET 25.5 0", "OFFSET of the End Site of joint arm, found '}'"),
    ("CHANNELS 3 ", "CHANNELS 2 ", "expected JOINT, one End Site or } in joint arm"),
    ("CHANNELS 3 ", "CHANNELS 4 ", "expected 4 different ones .* found 'End'"),
    ("CHANNELS 3 ", "CHANNELS -3 ", "expected 0 to 6 CHANNELS of joint arm, found '-3'"),
    ("CHANNELS 3 ", "CHANNELS 7 ", "expected 0 to 6 CHANNELS of joint arm, found '7'"),
    ("CHANNELS 3 ", "CHANNELS three ", "found 'three'"),
    (
        "CHANNELS 3 Xrotation",
        "CHANNELS 3 Zrotation",
        "found 'Zrotation'; correct the one after the first 2",
    ),
    (
        "CHANNELS 3 Xrotation",
        "CHANNELS 3 Xscale",
        "found 'Xscale'; correct the one after the first 0",
    ),
    ("End Site", "End", "expected SITE after End in joint arm"),
    ("CHANNELS 0\n", "CHANNELS 0 OFFSET 0 0 0\n", "in joint prop, found 'OFFSET'"),
    ("}\nMOTION", "MOTION", "in joint hips, found 'MOTION'"),
    ("}\nMOTION", "}\n}\nMOTION", "expected MOTION after the joints of the one ROOT, found '}'"),
    ("MOTION", "ROOT more", "expected MOTION after the joints of the one ROOT, found 'ROOT'"),
    (
        "Frames: 3",
        "Frames:",
        "line 36: expected 0 to 5000000 as the number of Frames, found nothing",
    ),
    ("Frames: 3", "Frames: 3.0", "found '3.0'"),
    ("Frames: 3", "Frames: -3", "found '-3'"),
    ("Frames: 3", "Frames: 99999999999999999999", "found '99999999999999999999'"),
    ("Frames: 3", "Frames: 3 4", "expected `Frames: COUNT` alone on its line"),
    (
        "Frames: 3\n",
        "",
        "expected `Frames: COUNT` alone on its line, found 'Frame Time: 0.0166667'",
    ),
    ("Frames: 3", "Frames: 4", "expected 4 rows of motion .* found 3"),
    ("Frames: 3", "Frames: 4000000", "at most 5000000 joints times frames, found 5 times 4000000"),
    ("Frame Time: 0.0166667", "", "expected `Frame Time: SECONDS`"),
    ("Frame Time: 0.0166667", "Frame Time: 0", "expected a Frame Time above 0 .*found '0'"),
    ("Frame Time: 0.0166667", "Frame Time: nan", "line 37: .*found 'nan'"),
    ("Frame Time: 0.0166667", "Frame Time: 1e5", "up to 3600 s, found '1e5'"),
]


@pytest.mark.parametrize(("old", "new", "message"), FAULTS)
def test_a_fault_is_one_line(tmp_path, old, new, message):
    assert old in ARM
    with pytest.raises(InputError, match=message) as caught:
        read(tmp_path, ARM.replace(old, new, 1))
    assert "take.bvh: " in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_cut_anywhere_is_refused(tmp_path):
    end = ARM.index("1.75 93.5e0")  # whatever is lost before the last row is missed
    for at in range(0, end, 7):
        with pytest.raises(InputError):
            read(tmp_path, ARM[:at])


def test_what_is_no_text_is_refused(tmp_path):
    with pytest.raises(InputError, match="found no file"):
        bvh.read_text(tmp_path / "none.bvh")
    with pytest.raises(InputError, match="found no file"):
        bvh.read_text(tmp_path)
    (tmp_path / "video.bvh").write_bytes(b"\x00\xff\xfe" * 100)
    with pytest.raises(InputError, match="expected a text file"):
        bvh.read_text(tmp_path / "video.bvh")


JOINT = "JOINT a { OFFSET 0 0 0 CHANNELS 0 "
STATIC = "HIERARCHY ROOT a { OFFSET 0 0 0 CHANNELS 1 Xrotation "
HEAVY = {
    "a deep chain": STATIC + JOINT * 100_000,
    "many joints": STATIC + (JOINT + "} ") * 100_000,
    "braces": STATIC + "{ " * 1_000_000,
    "one long word": "x" * 10_000_000,
    "blanks": " " * 10_000_000,
    "blank lines": "\n" * 2_000_000,
    "a blank header": STATIC + "} MOTION\nFrames" + " " * 10_000_000,
    "a long number": STATIC + "} MOTION\nFrames: 1\nFrame Time: 0\n" + "9" * 10_000_000,
    "a wide row": STATIC + "} MOTION\nFrames: 1\nFrame Time: 0\n" + "0 " * 5_000_000,
    "joints times frames": STATIC
    + (JOINT + "} ") * 900
    + "} MOTION\nFrames: 900000\nFrame Time: 1\n"
    + "0\n" * 900_000,
}


@pytest.mark.parametrize("name", HEAVY)
def test_a_hostile_file_is_refused_at_once(tmp_path, name):
    started = time.perf_counter()
    with pytest.raises(InputError) as caught:
        read(tmp_path, HEAVY[name])
    assert time.perf_counter() - started < 2.0
    assert len(str(caught.value)) < 500


def test_a_file_too_large_is_not_even_opened(tmp_path):
    with (tmp_path / "large.bvh").open("wb") as stream:
        stream.truncate(bvh.MAX_BYTES + 1)  # a hole: takes no space
    with pytest.raises(InputError, match="at most 256 MiB"):
        bvh.read_text(tmp_path / "large.bvh")


def test_half_an_hour_of_mocopi_is_not_too_large(tmp_path):
    """It has 150 MiB; here blanks after the last row take most of them."""
    found = read(tmp_path, ARM + " " * (150 << 20))
    np.testing.assert_array_equal(found.rows, read(tmp_path, ARM).rows)


def test_rows_are_numbers_whatever_their_padding():
    text = "head\n\n 1\t2.5e-1  -3. \n   \n+.5 6 7E2\n\n"
    found = bvh.read_rows("a.bvh", text, len("head\n"), 2, 3)
    np.testing.assert_array_equal(found, [[1, 0.25, -3], [0.5, 6, 700]])
    assert bvh.read_rows("a.bvh", "head\n \n", 5, 0, 3).shape == (0, 3)


@pytest.mark.parametrize(
    ("rows", "line", "message"),
    [
        ("1 2 3\n4 5\n", 3, "expected 3 numbers, one for each channel, found 2"),
        ("1 2 3 4\n1 2 3 4\n", 2, "found 4"),
        ("1 2 3\n\n4 nan 6\n", 4, "'nan'"),
        ("1 2 3\n4 -Infinity 6\n", 3, "'-Infinity'"),
        ("1 2 3\n4 1e999 6\n", 3, "'1e999'"),
        ("1 2 3\n4 2e9 6\n", 3, "at most 1e\\+09, found '2e9'"),
        ("1 2 3\n4 0,5 6\n", 3, "'0,5'"),
        ("1 2 3\n4 0x10 6\n", 3, "'0x10'"),
        ("1 2 3\n4 1_0 6\n", 3, "'1_0'"),
        ("1 2 3\n4 # 6\n", 3, "'#'"),
        (f"1 2 3\n4 {'1' * 50} 6\n", 3, "1111..."),
        ("1 2 3\n" + "5 " * 5000 + "\n", 3, "a line of 10000 characters"),
    ],
)
def test_a_bad_row_is_named(rows, line, message):
    with pytest.raises(InputError, match=message) as caught:
        bvh.read_rows("a.bvh", "head\n" + rows, 5, 2, 3)
    assert str(caught.value).startswith(f"a.bvh: line {line}: ")
    assert "\n" not in str(caught.value)


def test_more_or_fewer_rows_are_refused():
    with pytest.raises(InputError, match="expected 4 rows of motion as `Frames:` says, found 2"):
        bvh.read_rows("a.bvh", "1 2\n3 4\n", 0, 4, 2)
    with pytest.raises(InputError, match=r"expected 1 rows .*, found 2"):
        bvh.read_rows("a.bvh", "1 2\n3 4\n", 0, 1, 2)
    with pytest.raises(InputError, match="expected a channel in some joint"):
        bvh.read_rows("a.bvh", "1\n", 0, 1, 0)


def test_words_are_numbers_between_bounds():
    assert bvh.is_number("-9.23872e-007")
    assert bvh.is_number("0", least=0.0)
    assert not bvh.is_number("-1e-9", least=0.0)
    assert not bvh.is_number("٣")  # a digit, but not one of BVH's
    assert bvh.shown("") == "nothing"
    assert bvh.shown("a\nb") == "'a\\nb'"
