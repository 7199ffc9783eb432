"""Import skeletons that Nuitrack recorded.

Accepted are
- `.csv` of its recorder (the maker's repository, `doc/CSV_Recorder.md`): columns `timestamp` (the
  sensor's, microseconds), `id` (of the user) and `JOINT_<NAME>.x .y .z` in metres; `serial` and
  `.rot` are not used;
- `.json` with the fields of its programming interface (`GET_SKELETON` of PyNuitrack): a list of
  frames, or one frame per line, each
  `{"timestamp": 1715151474879921, "skeletons": [{"user_id": 1, "left_wrist": {"real": [x, y, z],
  "confidence": 0.75}, ...}]}` with `real` in millimetres; `projection`, `orientation` and `type`
  are not used. In place of joints by name, a skeleton may hold `"joints": [{"type":
  "JOINT_LEFT_WRIST", "real": ..., "confidence": ...}, ...]`, `type` being the name or the number of
  the interface. Letter case is ignored (`Timestamp`, `Real`), `real` may be
  `{"x": ..., "y": ..., "z": ...}`, and `confidence` may be missing.

Nuitrack's x points to the right of the picture, y up and z away from the camera: left-handed. Here
y is negated, which gives the axes of a camera.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.devices import plausible
from courtside.geometry.camera_fields import METRES
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.keypoints import missing_reason
from courtside.study.errors import InputError, StrPath, reading, require_scalar, require_type
from courtside.study.execution import log

COLLARS = ("left_collar", "right_collar")  # one point under two names
SIDED = ("collar", "shoulder", "elbow", "wrist", "hand", "fingertip")
LEGS = ("hip", "knee", "ankle", "foot")
NUMBERS: tuple[str, ...] = ("none", "head", "neck", "torso", "waist")  # of the interface, from 0
NUMBERS += tuple(f"{side}_{joint}" for side in ("left", "right") for joint in SIDED)
NUMBERS += tuple(f"{side}_{joint}" for side in ("left", "right") for joint in LEGS)
UNITS = {".csv": "m", ".json": "mm"}
# ASSUME: no median neck-to-waist distance lies outside; it tells millimetres from metres.
TRUNK_M = (0.2, 1.0)
MIN_CONFIDENCE = 0.5  # ASSUME: Nuitrack tells nothing in between; less sure joints are missing
# ASSUME: share of the frames with anybody that the one user has, without a warning: that user may
# leave the picture for moments, while somebody passes.
LEAST_SHARE = 0.9
EXPORT = "export the skeletons from Nuitrack again"


def read(
    path: StrPath, joints: Sequence[str], source: str, *, unit: str | None = None
) -> DeviceMotion:
    """Read the skeleton of the user seen in most frames, from a `.csv` or `.json` as above.

    `joints` are those of `config/skeletons/nuitrack19.yaml`; `collar` is the mean of the two that
    are one. The motion, named `source`, is in the axes of a camera (x right, y down, z forward),
    metres; seconds on the sensor's clock. `unit` is that of its lengths, where it is not that of
    the format. An `InputError` if the file is not such a recording, holds no user, or size of the
    body, rate or order of the times are not a person's recording.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in UNITS:
        raise InputError(
            f"{path}: expected a recording of Nuitrack (.csv or .json), found *{kind}; {EXPORT}"
        )
    users, time_us, xyz, confidence = (_csv if kind == ".csv" else _json)(path, list(joints))
    chosen = _user(path, users, time_us)
    time_us, xyz, confidence = time_us[chosen], xyz[chosen], confidence[chosen]
    newer = _in_order(path, time_us)
    time_us, confidence = time_us[newer], confidence[newer]
    unit = unit or UNITS[kind]
    xyz = xyz[newer] * METRES[unit] * (1.0, -1.0, 1.0)
    unseen = ~np.isfinite(xyz).all(axis=-1) | (xyz == 0).all(axis=-1)
    unsure = confidence < MIN_CONFIDENCE
    xyz[unseen | unsure] = np.nan
    _check_size(path, xyz, list(joints), unit)
    reason = np.where(
        unseen, missing_reason.UNSEEN, np.where(unsure, missing_reason.LOW_SCORE, missing_reason.OK)
    )
    return DeviceMotion(
        source=source,
        kind="rgbd",
        joints=np.array(joints),
        time_s=time_us * 1e-6,
        xyz=xyz,
        reason=reason.astype(np.uint8),
        performed=np.ones(len(xyz), dtype=bool),
    )


def _in_order(path: Path, time_us: NDArray) -> NDArray:
    """Return which rows to keep, as indices: the recorder repeats rows."""
    newer = plausible.in_order(path, time_us * 1e-6)
    if len(newer) < 2 <= len(time_us):
        raise InputError(
            f"{path}: expected rows at different timestamps, found one for {len(time_us)} rows; "
            "a spreadsheet may have rounded them: give the file as the recorder wrote it"
        )
    plausible.check_rate(path, time_us[newer] * 1e-6, "its timestamps must be in microseconds")
    return newer


def _user(path: Path, users: NDArray, time_us: NDArray) -> NDArray:
    """Return which rows are those of the user seen most often, (N,) bool; tell of what is lost."""
    known, counts = np.unique(users, return_counts=True)
    if not len(known):
        raise InputError(f"{path}: expected a skeleton of a user, found none; {EXPORT}")
    user = known[counts.argmax()]
    chosen = users == user
    if len(known) > 1:
        n_frames = dict(zip(known.tolist(), counts.tolist(), strict=True))
        log.logger.info("%s: user %s of %s", path, user, n_frames)
    alone = ~chosen & ~np.isin(time_us, time_us[chosen])
    n_own, n_alone = len(np.unique(time_us[chosen])), len(np.unique(time_us[alone]))
    if n_own < LEAST_SHARE * (n_own + n_alone):
        late_s = (time_us[alone] - time_us.min()) * 1e-6
        others = ", ".join(map(str, np.unique(users[alone])))
        log.tell(
            f"{path.name}: user {user} is used, seen in {n_own} frames; in {n_alone} others, from "
            f"{late_s.min():.1f} to {late_s.max():.1f} s after the start, only user {others} is "
            "seen: if this is the same person, whom Nuitrack lost and numbered anew, write one "
            "number for both",
            path,
        )
    return chosen


def _check_size(path: Path, xyz: NDArray, joints: list[str], unit: str) -> None:
    if not {"neck", "waist"} <= set(joints):
        return
    trunk = np.linalg.norm(xyz[:, joints.index("neck")] - xyz[:, joints.index("waist")], axis=-1)
    if not np.isfinite(trunk).any():
        raise InputError(f"{path}: expected neck and waist in some frame, found neither; {EXPORT}")
    median_m = float(np.nanmedian(trunk))
    plausible.check_length(path, "a trunk from neck to waist", median_m, unit, TRUNK_M)


def _names(joint: str) -> tuple[str, ...]:
    """Return Nuitrack's names of a joint."""
    return COLLARS if joint == "collar" else (joint,)


def _csv(path: Path, joints: list[str]) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return users (N,), times (N,) us, positions (N, J, 3) and confidences (N, J)."""
    with reading(path, "columns timestamp, id and JOINT_<NAME>.x .y .z of each joint", EXPORT):
        rows = pd.read_csv(path, skipinitialspace=True)
        rows.columns = [str(name).strip().lower() for name in rows.columns]
        users = rows["id"].to_numpy(dtype=np.int64)
        time_us = rows["timestamp"].to_numpy(dtype=np.int64)
        xyz = np.stack([_columns(rows, joint) for joint in joints], axis=1)
    return users, time_us, xyz, np.ones(xyz.shape[:2])


def _columns(rows: pd.DataFrame, joint: str) -> NDArray:
    found = [
        rows[[f"joint_{name}.{axis}" for axis in "xyz"]].to_numpy(dtype=float)
        for name in _names(joint)
    ]
    return np.mean(found, axis=0)


def _json(path: Path, joints: list[str]) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return the same as `_csv`."""
    users: list[int] = []
    time_us: list[int] = []
    xyz: list[list[list[float]]] = []
    confidence: list[list[float]] = []
    what = "frames with timestamp and skeletons, their joints with real"
    with reading(path, what, EXPORT):
        for frame in _frames(path):
            for skeleton in require_type(frame["skeletons"], list):
                user = require_type(skeleton, dict).get("user_id", skeleton.get("id", 0))
                users.append(int(require_scalar(user)))
                time_us.append(int(require_scalar(frame["timestamp"])))
                named = _by_name(skeleton)
                of_user = [_joint(named, joint) for joint in joints]
                xyz.append([place for place, _ in of_user])
                confidence.append([sure for _, sure in of_user])
        numbers = np.array([users, time_us], dtype=np.int64)
    places = np.array(xyz, dtype=float).reshape(-1, len(joints), 3)
    sure = np.array(confidence, dtype=float).reshape(-1, len(joints))
    return numbers[0], numbers[1], places, sure


def _frames(path: Path) -> list[Any]:
    text = path.read_text(encoding="utf-8-sig")
    try:
        found = json.loads(text)
    except json.JSONDecodeError:
        found = [json.loads(line) for line in text.splitlines() if line.strip()]
    found = _lower(found)
    frames = [found] if isinstance(found, dict) else require_type(found, list)
    return [require_type(frame, dict) for frame in frames]


def _lower(value: Any) -> Any:
    """Return parsed JSON with all keys in lower case."""
    if isinstance(value, dict):
        return {key.lower(): _lower(item) for key, item in value.items()}
    return [_lower(item) for item in value] if isinstance(value, list) else value


def _by_name(skeleton: Mapping[str, Any]) -> Mapping[str, Any]:
    if "joints" not in skeleton:
        return skeleton
    named = {}
    for joint in require_type(skeleton["joints"], list):
        kind = require_type(joint, dict)["type"]
        if isinstance(kind, int) and not 0 <= kind < len(NUMBERS):
            raise ValueError(f"joint of type {kind}")
        if isinstance(kind, int):
            named[NUMBERS[kind]] = joint
        else:
            named[require_type(kind, str).lower().removeprefix("joint_")] = joint
    return named


def _joint(skeleton: Mapping[str, Any], joint: str) -> tuple[list[float], float]:
    """Return a joint's position, as written, and confidence; NaN where it is missing."""
    found = [require_type(skeleton[name], dict) for name in _names(joint) if name in skeleton]
    if not found:
        return [np.nan] * 3, np.nan
    places = [_place(item["real"]) for item in found]
    sure = min(float(require_scalar(item.get("confidence", 1))) for item in found)
    return np.mean(places, axis=0).tolist(), sure


def _place(real: Any) -> list[float]:
    values = [real[axis] for axis in "xyz"] if isinstance(real, dict) else require_type(real, list)
    if len(values) != 3:
        raise ValueError(f"real of {len(values)} numbers")
    return [float(require_scalar(value)) for value in values]
