"""Keypoint files of OpenPose and AlphaPose, and the tracklets of the people in them."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.devices import frame_numbers
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D, full_score
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
    video: StrPath | None = None,
    first: int | None = None,
    trim_s: tuple[float, float] | None = None,
) -> Keypoints2D:
    """Read the keypoints of one camera: a tracklet for each person that could be followed.

    The `folder` holds files `*.json`; the last number in a name is that of the frame
    (`frame_numbers`). Their points are in the order of the `skeleton`; `size` is the width and
    height of the picture, px. `time_s` (T,) are the times of all frames of the `video`; in those
    without a file nobody is seen. Without a video, `first` is the number of the first of them. With
    `trim_s`, only frames from its start to before its stop.

    An `InputError` if there are no such files, one is damaged or has another number of points, the
    numbers do not say which frames the files are of, no frame lies within `trim_s`, the points are
    those of another skeleton, or lie outside the pictures.
    """
    files, times = frame_numbers.numbered(folder), np.asarray(time_s, dtype=float)
    if first is None:
        first, remark = frame_numbers.matched(folder, files, len(times), _n_needed(times, trim_s))
        if remark:
            log.logger.warning("%s", remark)
    kept = np.flatnonzero((times >= trim_s[0]) & (times < trim_s[1]) if trim_s else times >= 0)
    if trim_s and not len(kept):
        raise InputError(
            f"{folder}: expected frames from {trim_s[0]:g} s to before {trim_s[1]:g} s (trim_s of "
            f"the take), found a recording from 0 to {times[-1]:.2f} s; correct trim_s"
        )
    empty = np.empty((0, len(skeleton.joints), 3))
    people = [empty] * len(times)
    for number, name in files.items():
        if number - first < len(people):  # the last one may be one too many
            path = Path(folder, name)
            people[number - first] = _people(path, len(skeleton.joints), skeleton.name)
    _check_px(folder, np.concatenate(people))
    _check_order(folder, skeleton.name, people)
    _check_size(folder, np.concatenate(people), size, video)
    tracks = link([people[at] for at in kept])
    tracks[..., 2] = _up_to_one(folder, tracks[..., 2])
    return _keypoints(tracks, skeleton, camera, model, size, times[kept])


# ASSUME: of points that were found in pictures of this size so many lie within them.
WITHIN = 0.8


def _n_needed(times: NDArray, trim_s: tuple[float, float] | None) -> int:
    return int(np.count_nonzero(times < trim_s[1])) if trim_s else len(times)


def _check_px(folder: StrPath, people: NDArray) -> None:
    """Raise `InputError` if all points (K, J, 3) lie within one pixel: they are shares."""
    xy = people[np.isfinite(people[..., 0])][:, :2]
    if len(xy) and np.abs(xy).max() <= 1:
        raise InputError(
            f"{folder}: expected points in px, found all from {xy.min():.2g} to {xy.max():.2g}, as "
            "shares of the picture; export them again in px (OpenPose: --keypoint_scale 0)"
        )


def _check_size(
    folder: StrPath, people: NDArray, size: tuple[int, int], video: StrPath | None
) -> None:
    """Raise `InputError` if points, (K, J, 3), were found in pictures larger than `size`, px."""
    xy = people[np.isfinite(people[..., 0])][:, :2]
    within = ((xy >= -0.5) & (xy <= np.array(size) - 0.5)).all(axis=1)
    if len(xy) and within.mean() < WITHIN:
        of = f"of {video}" if video else "that the camera was calibrated for"
        how = "name the video that they were found in"
        raise InputError(
            f"{folder}: expected points within the {size[0]}x{size[1]} px {of}, found "
            f"{1 - within.mean():.0%} outside, up to ({xy[:, 0].max():.0f}, {xy[:, 1].max():.0f}); "
            f"{how if video else 'declare `scale` or `crop_px` of the camera'}, or the "
            "folder of this camera"
        )


def _up_to_one(folder: StrPath, score: NDArray) -> NDArray:
    """Return scores from 0 to 1; the largest of unlimited ones, such as RTMW's, count as 1."""
    if (high := full_score(score)) > 1:
        message = "%s: scores are not limited to 1: divided by %.2f, which 5 %% of them exceed"
        log.logger.info(message, folder, high)
    return np.clip(score / high, 0, 1)


# Skeletons by their number of points.
SKELETONS = {17: ("coco17",), 25: MISTAKEN, 26: ("halpe26",), 133: ("coco133",)}
LOOKED_AT = 30  # files of a folder, to see what its points are


def skeletons(folder: StrPath) -> tuple[int, tuple[str, ...]]:
    """Return how many points people of a folder have, and which skeletons these may be of.

    The likeliest is first: of 25 points the ninth tells, where it is seen. An `InputError` if the
    files are no such files, nobody is in them, or no skeleton has so many points.
    """
    people = [person.ravel() for path in _looked_at(folder) for person in _rows(path)]
    counts = {row.size for row in people}
    n_points, rest = divmod(counts.pop(), 3) if len(counts) == 1 else (0, 0)
    known = () if rest else SKELETONS.get(n_points, ())
    if not known:
        found = ", ".join(sorted({f"{row.size / 3:g}" for row in people})) or "nobody"
        raise InputError(
            f"{folder}: expected people with {', '.join(map(str, SKELETONS))} points, found "
            f"{found}; see config/README.md, Keypoints of other programs"
        )
    likely = _likely(_seen(np.stack(people).reshape(-1, n_points, 3))) if len(known) > 1 else ""
    return n_points, tuple(sorted(known, key=lambda name: name != likely))


def sample(folder: StrPath, skeleton: Skeleton) -> NDArray:
    """Return the persons (K, J, 3) in some files of a folder, NaN where a point is unseen.

    An `InputError` if their points are not those of the `skeleton`, or not in px, or a file is
    damaged.
    """
    n_joints = len(skeleton.joints)
    people = [_people(path, n_joints, skeleton.name) for path in _looked_at(folder)]
    _check_px(folder, np.concatenate(people))
    _check_order(folder, skeleton.name, people)
    return np.concatenate(people)


def _looked_at(folder: StrPath) -> list[Path]:
    """Return some files of a folder, from all of its frames."""
    names = [name for _, name in sorted(frame_numbers.numbered(folder).items())]
    return [Path(folder, name) for name in names[:: max(1, len(names) // LOOKED_AT)]]


def is_one(path: StrPath) -> bool:
    """Return whether a JSON file says who is in a frame, as OpenPose's do."""
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8-sig"))
    except RAISED_BY_READERS:
        return False
    return isinstance(content, dict) and isinstance(content.get("people"), list)


def _rows(path: Path) -> list[NDArray]:
    """Return the numbers of each person of a file as they stand there."""
    wanted = "OpenPose's JSON, `people` with `pose_keypoints_2d`", "export it again"
    with reading(path, *wanted):
        content = require_type(json.loads(path.read_text(encoding="utf-8-sig")), dict)
        found = [require_type(one, dict) for one in require_type(content["people"], list)]
        rows = [person["pose_keypoints_2d"] for person in found]
    # numpy raises TypeError for entries other than numbers.
    with reading(path, *wanted, kinds=(*RAISED_BY_READERS, TypeError)):
        return [np.asarray(row, dtype=float) for row in rows]


def _people(path: Path, n_joints: int, skeleton: str) -> NDArray:
    """Return the persons of a file, (K, J, 3); NaN where a point is unseen."""
    table = _rows(path)
    for row in table:
        if row.shape != (3 * n_joints,):
            raise InputError(
                f"{path}: expected {n_joints} points of skeleton {skeleton}, found "
                f"{row.size / 3:g}; name the skeleton that the files were made with"
            )
    return _seen(np.array(table).reshape(-1, n_joints, 3))


def _seen(people: NDArray) -> NDArray:
    """Return the persons (K, J, 3) of whom a point is seen, with NaN where one is not."""
    unseen = ~np.isfinite(people).all(axis=2) | (people[..., 2] <= 0)
    people[unseen] = np.nan
    return people[~unseen.all(axis=1)]


def _likely(everyone: NDArray) -> str:
    """Return which skeleton of 25 points people (K, 25, 3) show; "" where they do not."""
    middle, one, other = (everyone[:, at, :2] for at in MIDDLE_IN_BODY25)
    size_px = np.nanmax(everyone[..., :2], axis=1) - np.nanmin(everyone[..., :2], axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):  # all points at one place
        off = np.linalg.norm(middle - (one + other) / 2, axis=1) / size_px.max(axis=1)
    if not np.isfinite(off).any():
        return ""
    return "body25" if np.nanmedian(off) < MIDDLE else "body25b"


def _check_order(folder: StrPath, skeleton: str, people: Sequence[NDArray]) -> None:
    """Raise `InputError` if the points of BODY_25 are named BODY_25B, or the other way round."""
    found = _likely(np.concatenate(people)) if skeleton in MISTAKEN else ""
    if found and found != skeleton:
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
    xy, score = tracks[..., :2], tracks[..., 2]
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
# ASSUME: who is seen in fewer frames of a long take (and in less than this share of a short one) is
# a false detection.
FEWEST_FRAMES, FEWEST_SHARE = 5, 0.01


def link(people: Sequence[NDArray]) -> NDArray:
    """Follow persons through the frames of one camera.

    `people` holds for each frame its persons (K, J, 3): x, y in px, NaN where unseen, and score.
    The rows (P, T, J, 3) are in the order in which they begin, NaN where a person is not there. A
    row holds persons one after another, more than `LONGEST_GAP` frames apart: P grows with those
    seen at once, not with the length of the take.

    Each frame's persons are assigned to the tracks so that the sum of median distances between
    common keypoints is least (Kuhn 1955); a person too far from all tracks begins a new one.
    Crossing persons may be swapped. Tracks of very few frames are left out, and logged.
    """
    tracks: list[dict[int, NDArray]] = []
    last_seen: list[int] = []
    open_tracks: list[int] = []
    for at, found in enumerate(people):
        open_tracks = [k for k in open_tracks if at - last_seen[k] <= LONGEST_GAP]
        before = [tracks[k][last_seen[k]] for k in open_tracks]
        owner = _assign(_distances(np.stack(before), found)) if before and len(found) else {}
        for row, person in enumerate(found):
            if row in owner:
                k = open_tracks[owner[row]]
            else:
                k = len(tracks)
                tracks.append({})
                last_seen.append(at)
                open_tracks.append(k)
            tracks[k][at], last_seen[k] = person, at
    fewest = min(FEWEST_FRAMES, FEWEST_SHARE * len(people))
    kept = [track for track in tracks if len(track) >= fewest]
    if len(kept) < len(tracks):
        message = "%d persons seen in fewer than %g frames are left out"
        log.logger.info(message, len(tracks) - len(kept), fewest)
    return _stacked(kept, people)


def _distances(before: NDArray, after: NDArray) -> NDArray:
    """Return how far (F, K) from each track (K, J, 3) each person (F, J, 3) is.

    As a share of how far it may move; inf without a common point.
    """
    low, high = (edge(before[..., :2], axis=1) for edge in (np.nanmin, np.nanmax))
    size_px = np.maximum((high - low).max(axis=1), LEAST_SIZE_PX)
    step = np.sort(np.linalg.norm(after[:, None, :, :2] - before[..., :2], axis=-1), axis=-1)
    n = np.isfinite(step).sum(axis=-1, keepdims=True)  # what is not finite is sorted last
    middle = [np.take_along_axis(step, at, axis=-1) for at in (np.maximum(n - 1, 0) // 2, n // 2)]
    return np.where(n > 0, sum(middle) / 2, np.inf)[..., 0] / size_px / FARTHEST


def _assign(costs: NDArray) -> dict[int, int]:
    """Return {row: column} of the pairs that are near enough."""
    near = costs <= 1
    rows, columns = scipy.optimize.linear_sum_assignment(np.where(near, costs, 1e6))
    return {int(r): int(c) for r, c in zip(rows, columns, strict=True) if near[r, c]}


def _stacked(tracks: Sequence[Mapping[int, NDArray]], people: Sequence[NDArray]) -> NDArray:
    n_joints = people[0].shape[1] if people else 0
    rows = _shared_rows(tracks)
    whole = np.full((max(rows, default=0) + 1, len(people), n_joints, 3), np.nan)
    for row, track in zip(rows, tracks, strict=True):
        for at, person in track.items():
            whole[row, at] = person
    return whole


def _shared_rows(tracks: Sequence[Mapping[int, NDArray]]) -> list[int]:
    """Return the row of each track: the first one that has long been empty when it begins."""
    ends: list[int] = []
    rows = []
    for track in tracks:
        first, last = min(track), max(track)
        free = (row for row, end in enumerate(ends) if first - end > LONGEST_GAP)
        row = next(free, len(ends))
        ends[row : row + 1] = [last]
        rows.append(row)
    return rows
