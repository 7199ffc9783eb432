"""Errors of a network's 2D joints in a camera's pictures, frame by frame, against the truth."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.evaluation import joints as pose_errors
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError

# Of the torso's length (`torso_px`): PCK@0.2, the usual threshold (Yang & Ramanan 2013).
TOLERANCE = 0.2
TRUNK = ("left_shoulder", "right_shoulder", "left_hip", "right_hip")
EDGE_S = 1e-3  # a frame this little outside the truth's span, by rounding, counts as its end
COLUMNS = [
    "person", "camera", "frame_idx", "time_s", "joint", "x_px", "y_px", "true_x_px", "true_y_px",
    "torso_px", "error_px", "error_torso", "found", "in_picture", "placed", "exchanged",
    "in_stroke",
]  # fmt: skip


class FilmedTruth(pose_errors.Truth, Protocol):
    """A truth with the poses of cameras that shook, by frame, and the events of persons.

    Events `*_start` and `*_stop` of a hit bound a stroke.
    """

    shaken: dict[str, NDArray]
    events: dict[str, dict[str, float]]


def torso_px(camera: Camera, joints: Sequence[str] | NDArray, xyz: NDArray) -> NDArray:
    """Return the length (...) px of the torso in the picture as if it were seen square-on.

    The distance from the middle of the shoulders to the middle of the hips of `xyz` (..., J, 3) m,
    at its place but turned parallel to the picture's columns. Otherwise a torso that leans towards
    the camera would be shorter, and the tolerance of that camera stricter.
    """
    at = [list(joints).index(name) for name in TRUNK]
    shoulders, hips = (xyz[..., at[part : part + 2], :].mean(axis=-2) for part in (0, 2))
    half = np.linalg.norm(shoulders - hips, axis=-1)[..., None] / 2
    middle, upright = (shoulders + hips) / 2, camera.cam_from_world[1, :3]
    ends = [camera_models.project(camera, middle + sign * half * upright) for sign in (-1, 1)]
    return np.linalg.norm(ends[1] - ends[0], axis=-1)


def evaluate(
    camera: Camera, view: Keypoints2D, clock: Clock, truth: FilmedTruth, joints: Sequence[str]
) -> pd.DataFrame:
    """Compare one camera's keypoints with the true joints in its pictures.

    One row for each person, frame with a truth, and joint. found: the network reports a trunk
    within a torso's length of the true one; placed: found, and the joint's error is below
    `TOLERANCE`; exchanged: not placed, but the keypoint of the other side would be.

    Camera and clock are the true ones. The view's tracklets are not assigned to persons yet.
    `joints` are compared; the trunk's must be among the truth's.

    A tracklet belongs to the person whose trunk is nearest, by the assignment of the least sum;
    `placed` is PCK, the percentage of correct keypoints (Yang & Ramanan 2013).
    """
    start_s, stop_s = truth.time_s[[0, -1]]
    time_s = clock.to_reference(view.time_s)
    inside = (time_s >= start_s - EDGE_S) & (time_s <= stop_s + EDGE_S)
    frames = np.flatnonzero(inside)
    time_s = time_s[frames]
    real = pose_errors.at_times(truth.time_s, truth.xyz, np.clip(time_s, start_s, stop_s))
    true, torso = _seen(camera, truth, view, frames, real)
    true = true[:, :, _places(truth.joints, joints, "the truth")]
    rows = view.xy[:, frames][:, :, _places(view.joints, joints, f"{view.camera}, {view.model}")]
    detected = _assign(rows, true, torso, [list(joints).index(name) for name in TRUNK])
    names = list(map(str, truth.person_id))
    strokes = np.array([_strokes(truth.events.get(name, {}), time_s) for name in names])
    known = names, frames, time_s, strokes
    return _table(view, joints, known, detected, true, torso)


def against(
    view: Keypoints2D, reference: Keypoints2D, joints: Sequence[str], n_persons: int = 1
) -> pd.DataFrame:
    """Compare one camera's keypoints with those of another program, or of a hand, in its pictures.

    A table as of `evaluate`, with the reference in place of the truth: its errors count, too.
    Persons are the reference's `n_persons` tracklets of the most frames, in the reference's order
    and named after it. `torso_px` is the reference's own in that picture, not turned square-on.
    `InputError` if the two have different frames.
    """
    if not np.array_equal(view.time_s.round(3), reference.time_s.round(3)):
        raise InputError(
            f"{view.camera}, {reference.model}: expected the {len(view.time_s)} frames of "
            f"{view.model}, found {len(reference.time_s)} or other times; import those of the video"
        )
    places = _places(reference.joints, joints, f"{reference.camera}, {reference.model}")
    true, trunk = reference.xy[:, :, places], [list(joints).index(name) for name in TRUNK]
    n_frames = np.isfinite(true[:, :, trunk]).all(axis=(2, 3)).sum(axis=1)
    true = true[np.sort(np.argsort(-n_frames, kind="stable")[:n_persons])]
    shoulders, hips = (true[:, :, trunk[part : part + 2]].mean(axis=2) for part in (0, 2))
    torso = np.linalg.norm(shoulders - hips, axis=-1)
    rows = view.xy[:, :, _places(view.joints, joints, f"{view.camera}, {view.model}")]
    names = [f"{reference.model} {at + 1}" for at in range(len(true))]
    known = names, np.arange(len(view.time_s)), view.time_s, np.zeros(torso.shape, dtype=bool)
    return _table(view, joints, known, _assign(rows, true, torso, trunk), true, torso)


def _seen(
    camera: Camera, truth: FilmedTruth, view: Keypoints2D, frames: NDArray, real: NDArray
) -> tuple[NDArray, NDArray]:
    """Return the true joints (P, F, J, 2) and torsos (P, F) in the pictures, px."""
    poses = truth.shaken.get(view.camera)
    if poses is None:
        return camera_models.project(camera, real), torso_px(camera, truth.joints, real)
    each = [replace(camera, cam_from_world=poses[frame]) for frame in frames]
    xy = [camera_models.project(one, real[:, at]) for at, one in enumerate(each)]
    torso = [torso_px(one, truth.joints, real[:, at]) for at, one in enumerate(each)]
    return np.stack(xy, axis=1), np.stack(torso, axis=1)


def _places(known: Iterable, wanted: Sequence[str], where: str) -> list[int]:
    known = list(map(str, known))
    missing = [name for name in wanted if name not in known]
    if missing:
        raise InputError(
            f"{where}: expected the joints {list(wanted)}, missing {missing}; choose a network "
            "that has them"
        )
    return [known.index(name) for name in wanted]


def _assign(rows: NDArray, true: NDArray, torso: NDArray, trunk: list[int]) -> NDArray:
    """Return keypoints (P, F, K, 2) by true person of tracklets (R, F, K, 2), or NaN."""
    found = np.full(true.shape, np.nan)
    middle = rows[:, :, trunk].mean(axis=2)
    apart = np.linalg.norm(middle[None] - true[:, None, :, trunk].mean(axis=3), axis=-1)
    apart = apart / torso[:, None]  # (P, R, F)
    cost = np.where(apart < 1, apart, 1e3)
    for at in range(true.shape[1]):
        for person, row in zip(*scipy.optimize.linear_sum_assignment(cost[:, :, at]), strict=True):
            if apart[person, row, at] < 1:
                found[person, at] = rows[row, at]
    return found


def _table(view, joints, known, detected, true, torso):
    names, frames, time_s, strokes = known  # persons, frames, times, (P, F) in a stroke
    other = skeleton.mirror(list(joints))
    error = np.linalg.norm(detected - true, axis=-1)
    share = error / torso[..., None]
    crossed = np.linalg.norm(detected[:, :, other] - true, axis=-1) / torso[..., None]
    placed = share < TOLERANCE
    labels = np.reshape(names, (-1, 1, 1)), frames[:, None], time_s[:, None], np.array(joints)
    columns = {
        **dict(zip(("person", "frame_idx", "time_s", "joint"), labels, strict=True)),
        "x_px": detected[..., 0],
        "y_px": detected[..., 1],
        "true_x_px": true[..., 0],
        "true_y_px": true[..., 1],
        "torso_px": torso[..., None],
        "error_px": error,
        "error_torso": share,
        "found": np.isfinite(detected).all(axis=-1).any(axis=-1)[..., None],
        "in_picture": ((true > -0.5) & (true < view.size - 0.5)).all(axis=-1),
        "placed": placed,
        "exchanged": ~placed & (crossed < TOLERANCE),
        "in_stroke": strokes[..., None],
    }
    flat = {name: np.broadcast_to(of, error.shape).ravel() for name, of in columns.items()}
    return pd.DataFrame(flat).assign(camera=view.camera)[COLUMNS]


def is_hit(name: str) -> bool:
    """Return whether an event of a virtual person is a hit: `hit`, or `hit_` and a number."""
    return name == "hit" or (name.startswith("hit_") and name.removeprefix("hit_").isdigit())


def _strokes(events: dict[str, float], time_s: NDArray) -> NDArray:
    """Return which times lie in a stroke of a person with these events, (F,) bool."""
    inside = np.zeros(len(time_s), dtype=bool)
    for hit in filter(is_hit, events):
        start_s, stop_s = events.get(f"{hit}_start"), events.get(f"{hit}_stop")
        if start_s is not None and stop_s is not None:
            inside |= (time_s >= start_s) & (time_s <= stop_s)
    return inside
