"""The body's own frame and unit, from a T-pose: the same for devices of any axes and scale.

Origin: the point that stands for the navel (derived joint `pelvis_thorax`). y: to the head, along
the trunk. x: from the right wrist to the left one, square to y. z = x cross y: forwards. Unit: half
the distance of the wrists along x, which is their distance in the x-z plane.
"""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.events import tpose as tposes
from courtside.geometry import rotations
from courtside.geometry.rotations import unit
from courtside.geometry.similarity import Sim3, kabsch
from courtside.records.devices.device_motion import UPRIGHT, DeviceMotion
from courtside.records.devices.events import TPose
from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.records.keypoints.skeleton import TRUNK
from courtside.study.errors import (
    RAISED_BY_READERS,
    InputError,
    StrPath,
    reading,
    require_scalar,
    require_type,
)

ORIGIN = "pelvis_thorax"
# ASSUME: the middle of the shoulders shows where the head is. It has one definition in every
# skeleton; the head itself is another point for each (ears, eyes, base of the skull), and nods.
TOP = "mid_shoulder"
HEADS = (("left_ear", "right_ear"), ("head",), ("left_eye", "right_eye"), ("nose",))
FORWARDS = (  # pairs of joints, the second in front of the first
    ("left_heel", "left_foot_index"),
    ("right_heel", "right_foot_index"),
    ("left_ankle", "left_toe"),
    ("right_ankle", "right_toe"),
    ("left_ankle", "left_toes"),
    ("right_ankle", "right_toes"),
    ("left_ear", "nose"),
    ("right_ear", "nose"),
)
LEAST_FORWARD = 0.02  # ASSUME: units; less does not tell front from back
OUTLIER_RATIO = 4.0  # ASSUME: median distances from the median; further is an outlier
SMALLEST_M = 1e-9  # for joints that do not move at all
# ASSUME: degrees; by how much a trunk in a T-pose may lean. In level devices 1 to 3 (depth) and 7
# (disturbed suits); what a network sees in single pictures leans by 22, so `rgb` has no limit.
LEANS_DEG = {
    "rgbd": (10.0, "the camera is not level, and tilt and list of the pelvis and all exports lean "
             "as much; level it before the next take"),
    "inertial": (45.0, "Y is not up in its file, and all exports lie down; export it with Y up"),
}  # fmt: skip
# ASSUME: degrees; T-poses of the virtual gym had 13 at most. 30 shorten the unit by 5 %.
BENT_DEG = 20.0
REMAKE = "make it again with the rule align_bodies"


@dataclass(frozen=True, eq=False)
class Anchors:
    """Weights (J,) of a device's joints that make the frame's origin and top; each sum to 1."""

    origin: NDArray
    top: NDArray


@dataclass(frozen=True, eq=False)
class BodyFrame:
    """The frame of one T-pose of one device.

    `body_from_device` takes metres of the device to units of the body. `residuals` holds:
    unit_m: metres in a unit, the inverse of the scale.
    elbow_left_deg, elbow_right_deg: bend of the arms.
    level_deg: angle of the wrists' line from square to y, positive with the left one higher.
    wrist_height_difference_m: left less right, along y.
    stillness_m: root mean square, per axis, of the wrists about their median.
    unit_spread_percent, origin_spread_m, frame_spread_deg: standard deviations of the unit, origin
    (per axis) and axes (angle) from frame to frame.
    head_deg: angle between y and the line from the origin to the head.
    forward: how far toes or nose are in front, units; None where the device has neither.
    n_frames: with all joints known.
    """

    body_from_device: Sim3
    tpose: TPose
    residuals: dict[str, float | None]

    def as_dict(self) -> dict[str, Any]:
        """Return all numbers for JSON."""
        transform = self.body_from_device
        return {
            "scale_per_m": transform.scale,
            "rotation": transform.rotation.tolist(),
            "translation": transform.translation.tolist(),
            "tpose": asdict(self.tpose),
            "residuals": self.residuals,
        }


def read_transform(path: StrPath) -> Sim3:
    """Read `body_from_device` from the JSON of a body frame; `InputError` for other content."""
    # numpy raises TypeError for entries other than numbers.
    with reading(path, "a body frame", REMAKE, kinds=(*RAISED_BY_READERS, TypeError)):
        found = require_type(json.loads(Path(path).read_text(encoding="utf-8")), dict)
        scale = float(require_scalar(found["scale_per_m"]))
        rotation, translation = (
            np.array(found[key], dtype=float).reshape(shape)
            for key, shape in (("rotation", (3, 3)), ("translation", (3,)))
        )
        return Sim3(scale, rotation, translation)


def anchors(table: DerivedJoints, skeleton: str, joints: Sequence[str] | NDArray) -> Anchors:
    """Return the anchors of a skeleton; raise InputError if the table does not name it."""
    return Anchors(*(table.weights(skeleton, name, joints) for name in (ORIGIN, TOP)))


def axes(
    origin: NDArray, top: NDArray, left_wrist: NDArray, right_wrist: NDArray
) -> tuple[NDArray, NDArray]:
    """Return the body's axes and unit, for points (..., 3) m of poses in the device's frame.

    Axes (..., 3, 3): the rotation body_from_device, whose rows are x, y, z of the body in the
    device's frame. Unit (...) m: half the distance of the wrists, seen along y.
    """
    y = unit(top - origin)
    across = left_wrist - right_wrist
    across = across - (across * y).sum(axis=-1, keepdims=True) * y
    x = unit(across)
    rotation = np.stack([x, y, np.cross(x, y)], axis=-2)
    return rotation, np.linalg.norm(across, axis=-1) / 2


def at_tpose(motion: DeviceMotion, carried_by: Anchors, tpose: TPose) -> BodyFrame:
    """Return the frame of a T-pose of this motion, from the joints' means over it without outliers.

    An `InputError` if joints are missing throughout, or toes and nose are behind: left and right
    are exchanged, or the device's axes are left-handed.
    """
    xyz = motion.xyz[tpose.frames]
    names = [str(name) for name in motion.joints]
    used = (carried_by.origin != 0) | (carried_by.top != 0) | np.isin(names, tposes.JOINTS)
    whole = np.isfinite(xyz[:, used]).all(axis=(1, 2))
    if not whole.any():
        raise InputError(
            f"{motion.source}: expected arms and trunk in the T-pose of {tpose.start_s:.2f} to "
            f"{tpose.stop_s:.2f} s, found no frame with all of them; choose another T-pose"
        )
    middle = _middle(xyz)
    points = _carried(middle, names, carried_by)
    rotation, unit_m = axes(*points)
    scale = float(1 / unit_m)
    transform = Sim3(scale, rotation, -scale * rotation @ points[0])
    forward = _forward(transform.points(middle), names)
    if forward is not None and forward < -LEAST_FORWARD:
        raise InputError(
            f"{motion.source}: expected toes or nose in front at the T-pose of {tpose.start_s:.2f} "
            f"s, found them {-forward:.2f} units behind; left and right are exchanged, or the axes "
            "are left-handed"
        )
    residuals = _arms(middle, names, transform) | _spread(xyz[whole], names, carried_by, rotation)
    head = _head_deg(transform.points(middle), names)
    residuals |= {"head_deg": head, "forward": forward, "n_frames": int(whole.sum())}
    return BodyFrame(transform, tpose, {"unit_m": float(unit_m), **residuals})


def doubt(motion: DeviceMotion, frame: BodyFrame) -> str | None:
    """Return what makes a T-pose doubtful; None if nothing, or for a network in single pictures.

    The trunk leans too far, so that the vertical of the device is none; or the arms are bent, so
    that the unit is short.
    """
    if motion.kind not in LEANS_DEG:
        return None
    return "; ".join(filter(None, (_leaning(motion, frame), _bent(motion, frame)))) or None


def _leaning(motion: DeviceMotion, frame: BodyFrame) -> str:
    most_deg, why = LEANS_DEG[motion.kind]
    up = UPRIGHT[motion.kind][2] @ frame.body_from_device.rotation[1]
    lean_deg = np.degrees(np.arccos(np.clip(up, -1, 1)))
    if lean_deg <= most_deg:
        return ""
    return (
        f"{motion.source}: expected a trunk within {most_deg:g} degrees of its vertical in the "
        f"T-pose, found {lean_deg:.1f}: {why}"
    )


def _bent(motion: DeviceMotion, frame: BodyFrame) -> str:
    bent_deg = [frame.residuals[f"elbow_{side}_deg"] or 0.0 for side in tposes.SIDES]
    if max(bent_deg) <= BENT_DEG:
        return ""
    left, right = (f"{deg:.0f}" for deg in bent_deg)
    return (
        f"{motion.source}: expected straight arms in the T-pose, found elbows bent by {left} "
        f"degrees (left) and {right}: the unit, half the distance of the wrists, is too short, and "
        "lengths and arcs in units are too long; stretch the arms in the next take"
    )


def fixed(motion: DeviceMotion, frame: BodyFrame) -> NDArray:
    """Return the joints (T, J, 3) in the frame of the T-pose, which stays where it was, units."""
    return frame.body_from_device.points(motion.xyz)


def following(motion: DeviceMotion, frame: BodyFrame) -> NDArray:
    """Return the joints (T, J, 3) in a frame that goes with the trunk, units.

    `frame` is of a T-pose of this motion. NaN throughout where a shoulder or hip is missing.

    In every frame a rotation and a shift bring shoulders and hips nearest to where they were in the
    T-pose (Kabsch 1976); the unit stays. The wrists' line cannot carry the axes here: hands meet.
    """
    xyz = fixed(motion, frame)
    names = list(motion.joints)
    trunk = xyz[:, [names.index(name) for name in TRUNK]]
    rest = np.nanmedian(trunk[frame.tpose.frames], axis=0)
    known = np.isfinite(trunk).all(axis=(1, 2))
    moved = np.full(xyz.shape, np.nan)
    if known.any():
        middle, rest_middle = trunk[known].mean(axis=1, keepdims=True), rest.mean(axis=0)
        products = np.einsum("ji,tjk->tik", rest - rest_middle, trunk[known] - middle)
        rotation, _ = kabsch(products)
        moved[known] = (xyz[known] - middle) @ rotation.transpose(0, 2, 1) + rest_middle
    return moved


def _middle(xyz: NDArray) -> NDArray:
    """Return the mean (J, 3) over frames near the median: steadier than the median alone."""
    known = np.isfinite(xyz).all(axis=2).any(axis=0)
    middle = np.full(xyz.shape[1:], np.nan)
    there = xyz[:, known]
    median = np.nanmedian(there, axis=0)
    off = np.abs(there - median)
    near = off <= OUTLIER_RATIO * np.nanmedian(off, axis=0) + SMALLEST_M
    middle[known] = np.nanmean(np.where(near, there, np.nan), axis=0)
    return middle


def _carried(
    xyz: NDArray, names: list[str], carried_by: Anchors
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return origin, top, left and right wrist (..., 3) of joints (..., J, 3)."""
    origin, top = (
        np.einsum("j,...jk->...k", weights[weights != 0], xyz[..., weights != 0, :])
        for weights in (carried_by.origin, carried_by.top)
    )
    left, right = (xyz[..., names.index(f"{side}_wrist"), :] for side in tposes.SIDES)
    return origin, top, left, right


def _arms(middle: NDArray, names: list[str], transform: Sim3) -> dict[str, float | None]:
    body = transform.points(middle)
    at = {name: body[names.index(name)] for name in tposes.JOINTS}
    found: dict[str, float | None] = {}
    for side in tposes.SIDES:
        upper = unit(at[f"{side}_elbow"] - at[f"{side}_shoulder"])
        fore = unit(at[f"{side}_wrist"] - at[f"{side}_elbow"])
        found[f"elbow_{side}_deg"] = float(np.degrees(np.arccos(np.clip(upper @ fore, -1, 1))))
    across = at["left_wrist"] - at["right_wrist"]
    found["level_deg"] = float(np.degrees(np.arcsin(across[1] / np.linalg.norm(across))))
    found["wrist_height_difference_m"] = float(across[1] / transform.scale)
    return found


def _spread(
    xyz: NDArray, names: list[str], carried_by: Anchors, rotation: NDArray
) -> dict[str, float | None]:
    points = _carried(xyz, names, carried_by)
    own, units_m = axes(*points)
    turned = rotations.angles(own @ rotation.T)
    wrists = np.stack(points[2:])
    about = wrists - np.median(wrists, axis=1, keepdims=True)
    return {
        "stillness_m": float(np.sqrt(np.mean(about**2))),
        "unit_spread_percent": float(100 * units_m.std() / units_m.mean()),
        "origin_spread_m": float(np.sqrt(points[0].var(axis=0).mean())),
        "frame_spread_deg": float(np.degrees(np.sqrt(np.mean(turned**2)))),
    }


def _head_deg(body: NDArray, names: list[str]) -> float | None:
    for head in HEADS:
        if all(name in names for name in head):
            way = unit(np.mean([body[names.index(name)] for name in head], axis=0))
            if np.isfinite(way).all():
                return float(np.degrees(np.arccos(np.clip(way[1], -1, 1))))
    return None


def _forward(body: NDArray, names: list[str]) -> float | None:
    """Return by how much toes and nose are in front, units; None where none is known."""
    pairs = [pair for pair in FORWARDS if all(name in names for name in pair)]
    ahead = np.array([body[names.index(b), 2] - body[names.index(a), 2] for a, b in pairs])
    ahead = ahead[np.isfinite(ahead)]
    return float(np.median(ahead)) if len(ahead) else None
