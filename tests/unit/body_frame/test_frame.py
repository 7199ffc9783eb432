"""The body's frame against the same definition on the exact joints, and against geometry."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.body_frame import frame as bodyframe
from courtside.events import tpose
from courtside.geometry.similarity import Sim3
from courtside.records.keypoints import derived_joints
from courtside.study.errors import InputError
from fixtures.recordings import device_takes

TABLE = derived_joints.read(Path(__file__).parents[3] / "config" / "derived_joints.yaml")
CARRIED_BY = bodyframe.anchors(TABLE, "rig", device_takes.JOINTS)


def expected(take, number=1):
    """Return axes (rows), unit and origin in world by definition, on the exact joints."""
    times, xyz, events = take
    held = (times > events[f"tpose_{number}_start"]) & (times < events[f"tpose_{number}_stop"])
    at = dict(zip(device_takes.JOINTS, np.median(xyz[held], axis=0), strict=True))
    hips, shoulders = ((at[f"left_{p}"] + at[f"right_{p}"]) / 2 for p in ("hip", "shoulder"))
    y = (shoulders - hips) / np.linalg.norm(shoulders - hips)
    across = at["left_wrist"] - at["right_wrist"]
    across = across - (across @ y) * y
    x = across / np.linalg.norm(across)
    return (
        np.array([x, y, np.cross(x, y)]),
        np.linalg.norm(across) / 2,
        0.7 * hips + 0.3 * shoulders,
    )


@pytest.mark.parametrize("number", [1, 2])
@pytest.mark.parametrize(
    ("make", "axes", "scale"),
    [
        (device_takes.device, device_takes.Y_DOWN, 1.0),
        (device_takes.device, device_takes.Y_UP, 1.07),
        (device_takes.mocopi, device_takes.Y_UP, 0.94),
        (device_takes.blazepose, device_takes.Y_DOWN, 1.1),
    ],
)
def test_axes_and_unit_are_those_of_the_exact_joints(make, axes, scale, number):
    take = device_takes.truth(0)
    motion = make(np.random.default_rng(1), take, axes=axes, scale=scale)
    frame = bodyframe.at_tpose(motion, CARRIED_BY, tpose.find(motion)[number - 1])
    true_axes, unit_m, _ = expected(take, number)
    found = frame.body_from_device.rotation @ axes  # body from world
    turned = np.degrees(Rotation.from_matrix(found @ true_axes.T).magnitude())
    noisy = make is device_takes.blazepose
    assert turned < (5.0 if noisy else 1.0)  # 4 cm in depth over a second
    assert frame.residuals["unit_m"] / scale == pytest.approx(unit_m, rel=0.01)
    assert frame.body_from_device.scale == pytest.approx(1 / frame.residuals["unit_m"])


def test_the_frame_is_right_handed_with_wrists_at_one_and_toes_in_front():
    take = device_takes.truth(1)
    motion = device_takes.device(np.random.default_rng(0), take)
    spell = tpose.find(motion)[0]
    frame = bodyframe.at_tpose(motion, CARRIED_BY, spell)
    body = np.median(bodyframe.fixed(motion, frame)[spell.frames], axis=0)
    at = dict(zip(device_takes.JOINTS, body, strict=True))
    assert at["left_wrist"][0] - at["right_wrist"][0] == pytest.approx(2.0, abs=1e-3)
    assert at["head"][1] > at["left_shoulder"][1] > 0 > at["left_hip"][1]
    assert at["left_toe"][2] > at["left_ankle"][2]
    assert np.linalg.det(frame.body_from_device.rotation) == pytest.approx(1)
    assert frame.residuals["forward"] > 0.05


PITCH_15, ROLL_15, Z_UP = (
    Rotation.from_rotvec(turn, degrees=True).as_matrix()
    for turn in ([15, 0, 0], [0, 0, -15], [90, 0, 0])
)


@pytest.mark.parametrize(
    ("make", "axes", "found"),
    [
        (device_takes.device, device_takes.Y_DOWN, None),
        (device_takes.device, PITCH_15 @ device_takes.Y_DOWN, r"found 1\d.*: .* not level"),
        (device_takes.device, ROLL_15 @ device_takes.Y_DOWN, r"found 1\d.*: .* not level"),
        (device_takes.mocopi, device_takes.Y_UP, None),
        (device_takes.mocopi, Z_UP @ device_takes.Y_UP, r"found [89]\d.*: Y is not up"),
    ],
)
def test_a_device_whose_vertical_is_another_is_doubted(make, axes, found):
    kind = "inertial" if make is device_takes.mocopi else "rgbd"
    rng, take = np.random.default_rng(0), device_takes.truth(0)
    motion = replace(make(rng, take, axes=axes), kind=kind)
    frame = bodyframe.at_tpose(motion, CARRIED_BY, tpose.find(motion)[0])
    doubt = bodyframe.doubt(motion, frame)
    assert (doubt is None) if found is None else re.search(found, doubt)


def test_the_colour_camera_alone_is_not_doubted():
    """Its network leans by itself."""
    take = device_takes.truth(0)
    motion = device_takes.device(np.random.default_rng(0), take, axes=Z_UP @ device_takes.Y_DOWN)
    frame = bodyframe.at_tpose(motion, CARRIED_BY, tpose.find(motion)[0])
    assert (motion.kind, bodyframe.doubt(motion, frame)) == ("rgb", None)


@pytest.mark.parametrize(("bent_deg", "told"), [(10, False), (30, True)])
def test_bent_arms_in_the_t_pose_are_told(bent_deg, told):
    motion = device_takes.mocopi(np.random.default_rng(0), device_takes.truth(0))
    spell = tpose.find(motion)[0]
    turn = Rotation.from_rotvec([0, bent_deg, 0], degrees=True)  # about the vertical of the suit
    elbow, wrist = (motion.joints.tolist().index(f"left_{part}") for part in ("elbow", "wrist"))
    xyz = motion.xyz.copy()
    xyz[:, wrist] = xyz[:, elbow] + turn.apply(xyz[:, wrist] - xyz[:, elbow])
    bent = replace(motion, xyz=xyz)
    said = bodyframe.doubt(bent, bodyframe.at_tpose(bent, CARRIED_BY, spell)) or ""
    assert ("found elbows bent by 3" in said and "the unit" in said) == told == bool(said)


def test_residuals_are_those_of_a_known_body():
    tilt, n = np.radians(3.0), 31
    wave = 0.01 * np.where(np.arange(n) % 2, 1.0, -1.0)
    wave[-1] = 0.0
    names = list(tpose.JOINTS)
    rest = np.array(
        [(.2, .5, 0), (-.2, .5, 0), (.45, .5, 0), (-.45, .5, 0), (.7, .5, 0), (-.7, .5, 0),
         (.1, 0, 0), (-.1, 0, 0)]
    )  # fmt: skip
    xyz = np.tile(rest, (n, 1, 1))
    xyz[:, names.index("left_wrist"), 1] += 1.4 * np.tan(tilt)
    xyz[:, names.index("left_wrist"), 0] += wave
    motion = device_takes.of(xyz, np.arange(n) / 30, joints=names)
    spell = tpose.TPose(0.0, 1.0, 0, n, 0, 0, 0, 0, 0)
    carried_by = bodyframe.anchors(TABLE, "rig", names)
    residuals = bodyframe.at_tpose(motion, carried_by, spell).residuals
    assert residuals["unit_m"] == pytest.approx(0.7)
    assert residuals["level_deg"] == pytest.approx(3.0)
    assert residuals["wrist_height_difference_m"] == pytest.approx(1.4 * np.tan(tilt))
    assert residuals["unit_spread_percent"] == pytest.approx(100 * wave.std() / 1.4)
    assert residuals["stillness_m"] == pytest.approx(np.sqrt(np.mean(wave**2) / 6))
    assert residuals["elbow_right_deg"] == pytest.approx(0, abs=1e-5)
    assert residuals["frame_spread_deg"] == pytest.approx(0, abs=1e-6)
    assert residuals["forward"] is residuals["head_deg"] is None


def test_exchanged_sides_are_refused():
    motion = device_takes.device(np.random.default_rng(0), device_takes.truth(0))
    swapped = [
        {"left": "right", "right": "left"}.get(name.split("_")[0], "") + name[name.find("_") :]
        if "_" in name
        else name
        for name in device_takes.JOINTS
    ]
    exchanged = device_takes.of(motion.xyz, motion.time_s, joints=swapped)
    carried_by = bodyframe.anchors(TABLE, "rig", swapped)
    with pytest.raises(InputError, match="exchanged") as caught:
        bodyframe.at_tpose(exchanged, carried_by, tpose.find(exchanged)[0])
    assert "\n" not in str(caught.value)


def test_mirrored_axes_are_refused():
    motion = device_takes.device(np.random.default_rng(0), device_takes.truth(0))
    mirrored = device_takes.of(motion.xyz * [1, 1, -1], motion.time_s)
    with pytest.raises(InputError, match="left-handed"):
        bodyframe.at_tpose(mirrored, CARRIED_BY, tpose.find(mirrored)[0])


def test_the_following_frame_takes_off_any_motion_of_the_whole_body():
    rng = np.random.default_rng(5)
    still = device_takes.device(rng, device_takes.truth(0))
    spell = tpose.find(still)[0]
    still = device_takes.of(np.tile(still.xyz[spell.first], (80, 1, 1)), np.arange(80) / 30)
    spell = tpose.find(still)[0]
    turns = Rotation.from_rotvec(np.linspace(0, 2.5, 80)[:, None] * [0.1, 1.0, -0.2]).as_matrix()
    turns[: spell.stop] = np.eye(3)
    moved = (
        np.einsum("tij,tkj->tki", turns, still.xyz)
        + np.cumsum(turns[:, :1, 0] * 0.01, axis=0)[:, None]
    )
    moved[: spell.stop] = still.xyz[: spell.stop]
    walking = device_takes.of(moved, still.time_s)
    frame = bodyframe.at_tpose(walking, CARRIED_BY, spell)
    np.testing.assert_allclose(
        bodyframe.following(walking, frame), bodyframe.fixed(still, frame), atol=1e-9
    )


def test_a_skeleton_without_a_definition_is_named():
    with pytest.raises(InputError, match="pelvis_thorax"):
        bodyframe.anchors(TABLE, "nobody12", device_takes.JOINTS)


def test_a_written_frame_is_read_back(tmp_path):
    path = tmp_path / "frame.json"
    rotation = Rotation.from_euler("xyz", [0.3, -1.0, 2.0]).as_matrix()
    spell = tpose.TPose(0.0, 1.0, 0, 30, 0, 0, 0, 0, 0)
    frame = bodyframe.BodyFrame(Sim3(1.25, rotation, np.array([1.0, 2.0, 3.0])), spell, {})
    stated = frame.as_dict()
    path.write_text(json.dumps(stated))
    found = bodyframe.read_transform(path)
    np.testing.assert_array_equal(found.points([0.0, 0.0, 0.0]), [1, 2, 3])
    np.testing.assert_array_equal(found.rotation, rotation)
    for broken in ("{}", json.dumps(stated | {"rotation": [1, 2]}), "x"):
        path.write_text(broken)
        with pytest.raises(InputError, match=r"frame\.json: expected a body frame"):
            bodyframe.read_transform(path)
