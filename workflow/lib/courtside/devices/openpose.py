"""2D keypoints of other programs: a folder of OpenPose's JSON files, one for each frame.

OpenPose, AlphaPose (`--format open`), RTMLib and Pose2Sim write the same: `people`, each with
`pose_keypoints_2d`: x, y and score of each point in turn, zeros where unseen.
"""

import json
import re
from pathlib import Path

import numpy as np

from courtside.devices import openpose_people
from courtside.records import reasons
from courtside.records.keypoints import Keypoints2D
from courtside.study.errors import InputError, reading

# BODY_25 and BODY_25B have 25 points each, in another order: the 9th is the middle of the hips, or an elbow.
MISTAKEN = ("body25", "body25b")
MIDDLE_IN_BODY25 = (8, 9, 12)
MIDDLE = 0.05  # of the person's size: so near to the middle of the hips lies a point that is it


def read(folder, skeleton, *, camera, model, size, time_s=None, rate_hz=None, trim_s=None):
    """Read the keypoints of one camera.

    Parameters
    ----------
    folder : str or Path
        Files `*.json`; the last number in a name counts the frames, and the lowest is that of the first.
    skeleton : courtside.records.skeleton.Skeleton
        Joints in the order of the files.
    camera, model : str
        What the result is called.
    size : (int, int)
        Width and height of the video, px.
    time_s : (T,) float, optional
        Times of the video's frames. Frames without a file are unseen.
    rate_hz : float, optional
        In place of times: frames per second.
    trim_s : (start, stop), optional
        Only frames from the one to before the other.

    Returns
    -------
    keypoints : Keypoints2D
        A tracklet for each person that could be followed.

    Raises
    ------
    InputError
        If there are no such files, one is damaged or has another number of points, there are more frames
        than in the video, or the points are those of another skeleton.
    ValueError
        If not exactly one of `time_s` and `rate_hz` is given.
    """
    if (time_s is None) == (rate_hz is None):
        raise ValueError("expected one of time_s and rate_hz")
    files = _numbered(Path(folder))
    first, last = min(files), max(files)
    n_frames = last - first + 1 if time_s is None else len(time_s)
    if last - first >= n_frames:
        raise InputError(
            f"{folder}: expected frames of a video that has {n_frames}, found numbers {first} to {last}; "
            "name the video that the files were made from"
        )
    empty = np.empty((0, len(skeleton.joints), 3))
    people = [empty] * n_frames
    for number, path in files.items():
        people[number - first] = _people(path, len(skeleton.joints), skeleton.name)
    _check_order(folder, skeleton.name, people)
    times = np.arange(n_frames) / rate_hz if time_s is None else np.asarray(time_s, dtype=float)
    kept = np.flatnonzero((times >= trim_s[0]) & (times < trim_s[1]) if trim_s else times >= 0)
    tracks = openpose_people.link([people[at] for at in kept])
    return _keypoints(tracks, skeleton, camera, model, size, times[kept])


def _numbered(folder):
    if not folder.is_dir():
        raise InputError(f"{folder}: expected a folder of JSON files, found none; correct the path")
    files = {}
    for path in sorted(folder.glob("*.json")):
        digits = re.findall(r"[0-9]+", path.stem)
        if not digits:
            raise InputError(
                f"{path}: expected the frame's number in the name, found none; rename it"
            )
        number = int(digits[-1])
        if number in files:
            raise InputError(
                f"{path}: expected one file for frame {number}, found {files[number].name} as well; keep the "
                "files of one camera in one folder"
            )
        files[number] = path
    if not files:
        raise InputError(
            f"{folder}: expected JSON files, found none; give the folder of one camera"
        )
    return files


def _people(path, n_joints, skeleton):
    """Return the persons of a file, (K, J, 3); NaN where a point is unseen."""
    with reading(path, "OpenPose's JSON, `people` with `pose_keypoints_2d`", "export it again"):
        content = json.loads(path.read_text(encoding="utf-8-sig"))
        rows = [person["pose_keypoints_2d"] for person in content["people"]]
        table = [np.asarray(row, dtype=float) for row in rows]
    for row in table:
        if row.shape != (3 * n_joints,):
            raise InputError(
                f"{path}: expected {n_joints} points of skeleton {skeleton}, found {row.size / 3:g}; "
                "name the skeleton that the files were made with"
            )
    people = np.stack(table).reshape(-1, n_joints, 3) if table else np.empty((0, n_joints, 3))
    unseen = ~np.isfinite(people).all(axis=2) | (people[..., 2] <= 0)
    people[unseen] = np.nan
    return people[~unseen.all(axis=1)]


def _check_order(folder, skeleton, people):
    """Refuse points of BODY_25 under the name of BODY_25B, and the other way round."""
    if skeleton not in MISTAKEN:
        return
    everyone = np.concatenate(people)
    middle, one, other = (everyone[:, at, :2] for at in MIDDLE_IN_BODY25)
    size_px = np.nanmax(everyone[..., :2], axis=1) - np.nanmin(everyone[..., :2], axis=1)
    off = np.linalg.norm(middle - (one + other) / 2, axis=1) / size_px.max(axis=1)
    if not np.isfinite(off).any():
        return
    found = "body25" if np.nanmedian(off) < MIDDLE else "body25b"
    if found != skeleton:
        raise InputError(
            f"{folder}: expected the points of {skeleton}, found what looks like {found}, with as many "
            "points in another order; name that skeleton"
        )


def _keypoints(tracks, skeleton, camera, model, size, times):
    xy, score = tracks[..., :2], np.clip(tracks[..., 2], 0, 1)
    reason = np.where(np.isfinite(score), reasons.OK, reasons.UNSEEN)
    with np.errstate(invalid="ignore"):
        outside = ((xy < -0.5) | (xy > np.array(size) - 0.5)).any(axis=-1)
    reason = np.where(outside, reasons.OUT_OF_IMAGE, reason)
    kept = reason == reasons.OK
    return Keypoints2D(
        camera=camera,
        model=model,
        joints=np.array(skeleton.joints),
        size=np.array(size),
        time_s=times,
        xy=np.where(kept[..., None], xy, np.nan),
        score=np.where(kept, score, np.nan),
        reason=reason.astype(np.uint8),
        xyz_in_body=np.full((*score.shape, 3), np.nan),
    )
