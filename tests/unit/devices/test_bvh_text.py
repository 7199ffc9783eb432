"""What is accepted as the text of a BVH file, and what each fault is told."""

import time

import numpy as np
import pytest

from courtside.devices import bvh
from courtside.study.errors import InputError
from fixtures.recordings.bvh_texts import ARM


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


@pytest.mark.parametrize(("old", "new", "told"), FAULTS)
def test_a_fault_is_one_line(tmp_path, old, new, told):
    assert old in ARM
    with pytest.raises(InputError, match=told) as caught:
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
    with pytest.raises(InputError, match="at most 64 MiB"):
        bvh.read_text(tmp_path / "large.bvh")
