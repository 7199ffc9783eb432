"""Keypoint files of OpenPose and AlphaPose, and the tracklets of the people in them."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import RAISED_BY_READERS, InputError, StrPath, reading, require_type
from courtside.study.execution import log

# BODY_25 and BODY_25B have 25 points each, in another order: the 9th is the mid-hip, or an elbow.
MISTAKEN = ("body25", "body25b")
MIDDLE_IN_BODY25 = (8, 9, 12)
# ASSUME: a mid-hip lies within this share of the person's size of the middle of both hips; an elbow
# does not.
MIDDLE = 0.05


def read(
    folder: StrPath,
    skeleton: Skeleton,
    *,
    camera: str,
    model: str,
    size: tuple[int, int],
    time_s: NDArray,
    trim_s: tuple[float, float] | None = None,
) -> Keypoints2D:
    """Read the keypoints of one camera: a tracklet for each person that could be followed.

    The `folder` holds files `*.json`; the last number in a name is that of the frame, from 0, or
    from any number where the files reach over the whole video. Their points are in the order of the
    `skeleton`; `size` is the width and height of the video, px. `time_s` (T,) are the times of all
    frames of the video; in those without a file nobody is seen. With `trim_s`, only frames from its
    start to before its stop.

    An `InputError` if there are no such files, one is damaged or has another number of points, the
    numbers do not say which frames the files are of, no frame lies within `trim_s`, or the points
    are those of another skeleton.
    """
    files = _numbered(Path(folder))
    first = _first_number(folder, files, len(time_s))
    times = np.asarray(time_s, dtype=float)
    kept = np.flatnonzero((times >= trim_s[0]) & (times < trim_s[1]) if trim_s else times >= 0)
    if trim_s and not len(kept):
        raise InputError(
            f"{folder}: expected frames from {trim_s[0]:g} s to before {trim_s[1]:g} s (trim_s of "
            f"the take), found a video from 0 to {times[-1]:.2f} s; correct trim_s"
        )
    empty = np.empty((0, len(skeleton.joints), 3))
    people = [empty] * len(times)
    for number, path in files.items():
        people[number - first] = _people(path, len(skeleton.joints), skeleton.name)
    _check_order(folder, skeleton.name, people)
    tracks = link([people[at] for at in kept])
    return _keypoints(tracks, skeleton, camera, model, size, times[kept])


# ASSUME: of fewer files, numbers that are a whole share of the video's may be so by chance.
LEAST_FILES = 10
RENUMBER = "number the files by the frames of the video, from 0, or name the video of these files"


def _first_number(folder: StrPath, files: Mapping[int, Path], n_frames: int) -> int:
    """Return the number of the video's first frame; `InputError` where the numbers do not say it.

    Numbers within the video are those of its frames, as OpenPose writes them even where it begins
    later; others must reach over the whole video.
    """
    first, last = min(files), max(files)
    span = last - first + 1
    if span > n_frames:
        raise InputError(
            f"{folder}: expected at most {n_frames} frames, as many as the video has, found "
            f"{len(files)} files numbered {first} to {last}; name the video that the files were "
            "made from"
        )
    if span == n_frames:
        return first
    every = round(n_frames / span)
    whole_share = every > 1 and abs(span * every - n_frames) < every
    if first <= 1 and len(files) == span >= LEAST_FILES and whole_share:
        raise InputError(
            f"{folder}: expected a file for each of {n_frames} frames of the video, found {span} "
            f"numbered {first} to {last}, as of every {_ordinal(every)} frame; {RENUMBER}"
        )
    if last >= n_frames:
        raise InputError(
            f"{folder}: expected numbers of frames from 0 to {n_frames - 1} or a file for each, "
            f"found {len(files)} files numbered {first} to {last}; {RENUMBER}"
        )
    said = "%s: %d files for %d frames; taken as frames %d to %d, counted from 0"
    log.logger.warning(said, folder, len(files), n_frames, first, last)
    return 0


def _ordinal(number: int) -> str:
    return {2: "second", 3: "third"}.get(number, f"{number}th")


def _numbered(folder: Path) -> dict[int, Path]:
    if not folder.is_dir():
        raise InputError(f"{folder}: expected a folder of JSON files, found none; correct the path")
    files: dict[int, Path] = {}
    for path in sorted(folder.glob("*.json")):
        digits = re.findall(r"[0-9]+", path.stem)
        if not digits:
            raise InputError(
                f"{path}: expected the frame's number in the name, found none; rename it"
            )
        number = int(digits[-1])
        if number in files:
            raise InputError(
                f"{path}: expected one file for frame {number}, found {files[number].name} as "
                "well; keep the files of one camera in one folder"
            )
        files[number] = path
    if not files:
        raise InputError(
            f"{folder}: expected JSON files, found none; give the folder of one camera"
        )
    return files


def _people(path: Path, n_joints: int, skeleton: str) -> NDArray:
    """Return the persons of a file, (K, J, 3); NaN where a point is unseen."""
    wanted = "OpenPose's JSON, `people` with `pose_keypoints_2d`", "export it again"
    with reading(path, *wanted):
        content = require_type(json.loads(path.read_text(encoding="utf-8-sig")), dict)
        found = [require_type(one, dict) for one in require_type(content["people"], list)]
        rows = [person["pose_keypoints_2d"] for person in found]
    # numpy raises TypeError for entries other than numbers.
    with reading(path, *wanted, kinds=(*RAISED_BY_READERS, TypeError)):
        table = [np.asarray(row, dtype=float) for row in rows]
    for row in table:
        if row.shape != (3 * n_joints,):
            raise InputError(
                f"{path}: expected {n_joints} points of skeleton {skeleton}, found "
                f"{row.size / 3:g}; name the skeleton that the files were made with"
            )
    people = np.stack(table).reshape(-1, n_joints, 3) if table else np.empty((0, n_joints, 3))
    unseen = ~np.isfinite(people).all(axis=2) | (people[..., 2] <= 0)
    people[unseen] = np.nan
    return people[~unseen.all(axis=1)]


def _check_order(folder: StrPath, skeleton: str, people: Sequence[NDArray]) -> None:
    """Raise `InputError` if the points of BODY_25 are named BODY_25B, or the other way round."""
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
            f"{folder}: expected the points of {skeleton}, found what looks like {found}, with as "
            "many points in another order; name that skeleton"
        )


def _keypoints(
    tracks: NDArray,
    skeleton: Skeleton,
    camera: str,
    model: str,
    size: tuple[int, int],
    times: NDArray,
) -> Keypoints2D:
    xy, score = tracks[..., :2], np.clip(tracks[..., 2], 0, 1)
    reason = np.where(np.isfinite(score), missing_reason.OK, missing_reason.UNSEEN)
    with np.errstate(invalid="ignore"):
        outside = ((xy < -0.5) | (xy > np.array(size) - 0.5)).any(axis=-1)
    reason = np.where(outside, missing_reason.OUT_OF_IMAGE, reason)
    kept = reason == missing_reason.OK
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
        clothing=np.full((*score.shape[:2], 2, 3), np.nan),
    )


# ASSUME: people move by less than a third of their size in the picture since last seen.
FARTHEST = 0.33
LONGEST_GAP = 10  # frames. ASSUME: a person unseen for longer may be another one
# ASSUME: smaller visible parts of a person say little of how far they may move.
LEAST_SIZE_PX = 30.0


def link(people: Sequence[NDArray]) -> NDArray:
    """Follow persons through the frames of one camera.

    `people` holds for each frame its persons (K, J, 3): x, y in px, NaN where unseen, and score.
    The tracks (P, T, J, 3) are in the order in which they appear, NaN where a person is not there.

    Each frame's persons are assigned to the tracks so that the sum of median distances between
    common keypoints is least (Kuhn 1955); a person too far from all tracks begins a new one.
    Crossing persons may be swapped.
    """
    tracks: list[dict[int, NDArray]] = []
    last_seen: list[int] = []
    for at, found in enumerate(people):
        open_tracks = [k for k, seen in enumerate(last_seen) if at - seen <= LONGEST_GAP]
        costs = np.full((len(found), len(open_tracks)), np.inf)
        for row, person in enumerate(found):
            for column, k in enumerate(open_tracks):
                costs[row, column] = _distance(tracks[k][last_seen[k]], person)
        owner = _assign(costs)
        for row, person in enumerate(found):
            if row in owner:
                k = open_tracks[owner[row]]
            else:
                k = len(tracks)
                tracks.append({})
                last_seen.append(at)
            tracks[k][at], last_seen[k] = person, at
    return _stacked(tracks, people)


def _distance(before: NDArray, after: NDArray) -> float:
    """Return how far a person moved, as a share of the allowed; inf without a common point."""
    step = np.linalg.norm(after[:, :2] - before[:, :2], axis=1)
    both = np.isfinite(step)
    if not both.any():
        return np.inf
    seen = before[np.isfinite(before[:, 0]), :2]
    size_px = max(np.ptp(seen, axis=0).max(), LEAST_SIZE_PX)
    return float(np.median(step[both]) / size_px / FARTHEST)


def _assign(costs: NDArray) -> dict[int, int]:
    """Return {row: column} of the pairs that are near enough."""
    if not costs.size:
        return {}
    near = costs <= 1
    rows, columns = linear_sum_assignment(np.where(near, costs, 1e6))
    return {int(r): int(c) for r, c in zip(rows, columns, strict=True) if near[r, c]}


def _stacked(tracks: Sequence[Mapping[int, NDArray]], people: Sequence[NDArray]) -> NDArray:
    n_joints = people[0].shape[1] if people else 0
    whole = np.full((len(tracks), len(people), n_joints, 3), np.nan)
    for k, track in enumerate(tracks):
        for at, person in track.items():
            whole[k, at] = person
    return whole
