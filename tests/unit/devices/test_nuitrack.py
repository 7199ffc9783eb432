import json
import re
from pathlib import Path

import numpy as np
import pytest

from courtside.devices import nuitrack
from courtside.geometry.camera_fields import METRES
from courtside.records.keypoints import missing_reason, skeleton
from courtside.study.errors import InputError

CONFIG = Path(__file__).parents[3] / "config"
JOINTS = skeleton.read(CONFIG / "skeletons" / "nuitrack19.yaml").joints
N = 4
TIMES_US = 1715151474879921 + 33333 * np.arange(N)
PLACES = np.random.default_rng(0).uniform((-1, -1, 2), (1, 1, 4), (N, len(JOINTS), 3))
PLACES[:, JOINTS.index("neck")] = [0.0, 0.8, 3.3]  # y is up
PLACES[:, JOINTS.index("waist")] = [0.0, 0.26, 3.38]


def names(joint):
    return ("left_collar", "right_collar") if joint == "collar" else (joint,)


def csv_rows():
    header = ["timestamp", "serial", "id"]
    for joint in JOINTS:
        header += [f"JOINT_{name.upper()}.{axis}" for name in names(joint) for axis in "xyz"]
        header += [f"JOINT_{joint.upper()}.rot"]
    rows = [header]
    for time_us, places in zip(TIMES_US, PLACES, strict=True):
        row = [time_us, "AS3M323001D", 1]
        for joint, place in zip(JOINTS, places, strict=True):
            row += [*place] * len(names(joint)) + [170.1]
        rows += [row, row]  # as the maker's sample has it: rows are repeated
    return rows


def write_csv(path, rows):
    path.write_text("\n".join(",".join(map(str, row)) for row in rows) + "\n")
    return path


def frames():
    """Return frames in millimetres with joints by name."""
    return [
        {
            "timestamp": int(time_us),
            "skeletons": [
                {"user_id": 1}
                | {
                    name: {"real": (1000 * place).tolist(), "confidence": 0.75}
                    for joint, place in zip(JOINTS, places, strict=True)
                    for name in names(joint)
                }
            ],
        }
        for time_us, places in zip(TIMES_US, PLACES, strict=True)
    ]


def listed(frame):
    """Return a frame with joints in a list, as numbers and in capital letters."""
    joints = [
        {
            "Type": nuitrack.NUMBERS.index(name),
            "Confidence": joint["confidence"],
            "Real": dict(zip("XYZ", joint["real"], strict=True)),
        }
        for name, joint in frame["skeletons"][0].items()
        if name != "user_id"
    ]
    return {"Timestamp": str(frame["timestamp"]), "Skeletons": [{"ID": 1, "Joints": joints}]}


def check(motion):
    assert motion.joints.tolist() == list(JOINTS)
    assert np.allclose(motion.xyz, PLACES * [1, -1, 1])  # y down
    assert np.allclose(motion.time_s, TIMES_US * 1e-6, atol=1e-6)
    assert (motion.reason == missing_reason.OK).all()
    assert (motion.source, motion.kind) == ("n", "rgbd")


def test_joint_numbers_are_those_of_the_interface():
    """Nuitrack's enumeration: head is 1, left hand 9, right shoulder 12, right ankle 23."""
    wanted = {1: "head", 4: "waist", 9: "left_hand", 12: "right_shoulder", 17: "left_hip"}
    assert {k: nuitrack.NUMBERS[k] for k in wanted} == wanted
    assert nuitrack.NUMBERS[23] == "right_ankle"
    assert len(nuitrack.NUMBERS) == 25


def test_a_csv_becomes_camera_axes_and_seconds(tmp_path):
    check(nuitrack.read(write_csv(tmp_path / "a.csv", csv_rows()), JOINTS, "n"))


def test_json_by_name_in_a_list_or_in_lines(tmp_path):
    whole, lines, capitals = (tmp_path / f"{name}.json" for name in "abc")
    whole.write_text(json.dumps(frames()))
    lines.write_text("\n".join(json.dumps(frame) for frame in frames()) + "\n")
    capitals.write_text(json.dumps([listed(frame) for frame in frames()]))
    for path in (whole, lines, capitals):
        check(nuitrack.read(path, JOINTS, "n"))


def shifted(times_us):
    """Return rows of a table whose timestamps are other ones."""
    header, *rows = csv_rows()
    rows = [row for row in rows[::2] for _ in range(25)]
    return [header] + [[time_us, *row[1:]] for time_us, row in zip(times_us, rows, strict=True)]


def test_a_stray_timestamp_is_left_out_and_a_reset_is_named(tmp_path, caplog):
    steps = 33333 * np.arange(25 * N)
    ahead = steps + 3_600_000_000 * (np.arange(25 * N) == 40)
    found = nuitrack.read(write_csv(tmp_path / "a.csv", shifted(ahead)), JOINTS, "n")
    assert np.allclose(found.time_s, np.delete(steps, 40) * 1e-6)
    assert "left out: 1 of 100 frames out of order, the first at 3601.3" in caplog.text
    reset = np.where(np.arange(25 * N) < 40, steps + 10**9, steps)
    path = write_csv(tmp_path / "b.csv", shifted(reset))
    with pytest.raises(InputError, match=r"found 60 of 100 frames out of order.* clock was set"):
        nuitrack.read(path, JOINTS, "n")


def test_timestamps_in_milliseconds_are_named(tmp_path):
    path = write_csv(tmp_path / "a.csv", shifted(33 * np.arange(25 * N)))
    with pytest.raises(InputError, match=r"a frame every 3\.3e-05 s; .* in micro"):
        nuitrack.read(path, JOINTS, "n")


def test_timestamps_that_a_spreadsheet_rounded_are_refused(tmp_path):
    path = write_csv(tmp_path / "a.csv", shifted(["1.71515E+15"] * 25 * N))
    with pytest.raises(InputError, match=r"different timestamps, found one for 100 rows; a spread"):
        nuitrack.read(path, JOINTS, "n")


@pytest.mark.parametrize("unit", ["cm", "mm", "in", "ft"])
def test_a_table_in_another_unit_is_named_and_read_with_its_key(tmp_path, unit):
    header, *rows = csv_rows()
    at = [k for k, name in enumerate(header) if name.endswith((".x", ".y", ".z"))]
    for row in rows[::2]:
        for k in at:
            row[k] /= METRES[unit]
    path = write_csv(tmp_path / "a.csv", [header, *rows[::2]])
    with pytest.raises(InputError, match=f"neck to waist.*read in m; it is .*`unit: {unit}`"):
        nuitrack.read(path, JOINTS, "n")
    check(nuitrack.read(path, JOINTS, "n", unit=unit))


def test_unsure_and_absent_joints_are_missing_with_their_reason(tmp_path):
    made = frames()
    made[1]["skeletons"][0]["left_wrist"]["confidence"] = 0.1
    del made[2]["skeletons"][0]["head"]
    made[3]["skeletons"][0]["right_knee"]["real"] = [0, 0, 0]
    path = tmp_path / "a.json"
    path.write_text(json.dumps(made))
    motion = nuitrack.read(path, JOINTS, "n")
    missing = {
        (1, "left_wrist"): missing_reason.LOW_SCORE,
        (2, "head"): missing_reason.UNSEEN,
        (3, "right_knee"): missing_reason.UNSEEN,
    }
    for (frame, joint), reason in missing.items():
        assert motion.reason[frame, JOINTS.index(joint)] == reason
        assert np.isnan(motion.xyz[frame, JOINTS.index(joint)]).all()
    assert np.count_nonzero(motion.reason) == 3
    assert np.isnan(motion.xyz).any(axis=-1).sum() == 3


def test_the_user_seen_most_often_is_taken(tmp_path, caplog):
    rows = csv_rows()
    other = [
        [*row[:2], 7, *(v + 1 if isinstance(v, float) else v for v in row[3:])] for row in rows[1:4]
    ]
    path = write_csv(tmp_path / "a.csv", [*rows, *other])
    with caplog.at_level("INFO", logger="courtside"):
        check(nuitrack.read(path, JOINTS, "n"))
    assert re.search(r"a\.csv: user 1 of \{1: \d+, 7: \d+\}", caplog.text)


def renumbered(path, ids):
    """Write frames of one person whom Nuitrack gives these numbers."""
    made = [
        {**frame, "timestamp": int(TIMES_US[0] + 33333 * at)}
        for at, frame in enumerate((frames() * 10)[: len(ids)])
    ]
    for frame, user in zip(made, ids, strict=True):
        frame["skeletons"] = [frame["skeletons"][0] | {"user_id": user}]
    path.write_text(json.dumps(made))
    return path


def test_a_person_who_is_numbered_anew_is_told(tmp_path, capsys):
    path = renumbered(tmp_path / "a.json", [1] * 24 + [2] * 16)
    assert len(nuitrack.read(path, JOINTS, "n").time_s) == 24
    told = capsys.readouterr().err
    assert "user 1 is used, seen in 24 frames; in 16 others, from 0.8 to 1.3 s" in told
    assert "only user 2 is" in told


def test_users_who_are_seen_beside_the_one_are_not_told(tmp_path, capsys):
    path = renumbered(tmp_path / "a.json", [1] * 39 + [2])
    assert len(nuitrack.read(path, JOINTS, "n").time_s) == 39
    made = frames()
    for frame in made:
        frame["skeletons"].append(frame["skeletons"][0] | {"user_id": 2})
    made[1]["skeletons"].pop(1)
    path.write_text(json.dumps(made))
    check(nuitrack.read(path, JOINTS, "n"))
    assert not capsys.readouterr().err


def test_a_wrong_unit_is_noticed(tmp_path):
    rows = csv_rows()
    large = [[1000 * v if isinstance(v, np.floating | float) else v for v in row] for row in rows]
    path = write_csv(tmp_path / "a.csv", large)
    with pytest.raises(InputError, match="found 546 m"):
        nuitrack.read(path, JOINTS, "n")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.txt", "1"),
        ("a.csv", ""),
        ("a.csv", "timestamp,id\n1,1\n"),
        ("a.csv", "\x00\x01"),
        ("a.json", ""),
        ("a.json", "nothing"),
        ("a.json", "[]"),
        ("a.json", "[1, 2]"),
        ("a.json", '[{"timestamp": 1}]'),
        ("a.json", '[{"timestamp": 1, "skeletons": []}]'),
        ("a.json", '[{"timestamp": "x", "skeletons": [{}]}]'),
        ("a.json", '[{"timestamp": 1e400, "skeletons": [{}]}]'),
        ("a.json", '[{"timestamp": 1, "skeletons": [{"head": {"real": [1, 2]}}]}]'),
        ("a.json", '[{"timestamp": 1, "skeletons": [{"head": {"real": "abc"}}]}]'),
        ("a.json", '[{"timestamp": 1, "skeletons": [{"joints": [{"type": 99}]}]}]'),
        ("a.json", '[{"timestamp": 1, "skeletons": [{"head": {}}]}]'),
        ("a.json", "[" * 100000),
    ],
)
def test_what_is_no_such_recording_is_refused_in_one_line(tmp_path, name, content):
    path = tmp_path / name
    path.write_text(content)
    with pytest.raises(InputError, match="expected") as raised:
        nuitrack.read(path, JOINTS, "n")
    assert str(path) in str(raised.value)
    assert "\n" not in str(raised.value)


def test_a_missing_file_is_named(tmp_path):
    for name in ("a.csv", "a.json"):
        with pytest.raises(InputError, match=name):
            nuitrack.read(tmp_path / name, JOINTS, "n")


@pytest.mark.parametrize("number", [1 << 63, 10**400])
def test_a_user_or_time_beyond_all_numbers_is_one_line(tmp_path, number):
    for change in ({"timestamp": number}, {"skeletons": [{"user_id": number}]}):
        path = tmp_path / "a.json"
        path.write_text(json.dumps([frames()[0] | change]))
        with pytest.raises(InputError, match=r"a\.json: expected frames with timestamp") as caught:
            nuitrack.read(path, JOINTS, "n")
        assert "\n" not in str(caught.value)
