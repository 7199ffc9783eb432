"""Follow the one person whom a camera films."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.pose.detector import LandmarkNetwork, PersonDetector, Pose, Region
from courtside.pose.foreground import Box
from courtside.records.keypoints import keypoints, missing_reason

# The detector looks at the foreground box times this. ASSUME: what the box misses of a body lies
# within.
SEARCH_MARGIN = 1.3
# ASSUME: joints of a tracked body have their middle within this share of the box's longer side
# around it.
STRAY = 0.25
# ASSUME: times for a person who moves, sizes for one who squats beside a bystander.
LOOK_S = 0.99  # between two looks of the detector for somebody nearer to the camera
NEARER = 1.3  # somebody nearer is so many times as large as who is followed
LARGE = 0.9  # quantile of the sizes of who is followed: squatting, a person is still that large


@dataclass(frozen=True)
class Track:
    """The joints of P persons in every frame of one camera."""

    time_s: NDArray  # (T,)
    xy: NDArray  # (P, T, J, 2): pixels; NaN where nobody was found
    score: NDArray  # (P, T, J)
    reason: NDArray  # (P, T, J) uint8: `courtside.records.keypoints.missing_reason`
    xyz_in_body: NDArray  # (P, T, J, 3): metres, see `courtside.pose.detector.Pose`
    clothing: NDArray  # (P, T, 2, 3): L*a*b* of upper body and thighs; NaN where not looked at


def track_person(
    frames: Iterable[tuple[float, NDArray]],
    detector: PersonDetector,
    landmarks: LandmarkNetwork,
    *,
    min_presence: float,
    redetect: bool,
) -> Track:
    """Follow the person who fills most of each picture: a track of one person.

    This is for a device that films one person from near. The detector sees the whole picture when
    there is no track, and once a second: somebody clearly larger is followed from then on.

    Parameters
    ----------
    frames : time in seconds, and picture (H, W, 3) uint8, BGR
    min_presence : below this confidence, 0 to 1, the network's answer is dropped and the person
        searched again
    redetect : search in every frame instead of following: slower, and without memory
    """
    times: list[float] = []
    rows: list[tuple[NDArray, ...]] = []
    region: Region | None = None
    looked_s, sizes = -np.inf, [0.0]
    for time_s, image in frames:
        pose = None if region is None or redetect else landmarks.estimate(image, region)
        if pose is not None and pose.presence < min_presence:
            pose = None
        if pose is None or time_s - looked_s > LOOK_S:
            largest, looked_s = _largest(image, detector, landmarks, min_presence), time_s
            nearer = largest.size_px > NEARER * np.quantile(sizes, LARGE)
            if pose is None or (nearer and largest.presence >= min_presence):
                pose, sizes = largest, []
        sizes.append(pose.size_px)
        found = pose if pose.presence >= min_presence else None
        region = None if found is None else found.region
        times.append(time_s)
        rows.append(as_row(found, landmarks.n_joints, image.shape))
    xy, score, reason, xyz = (np.stack(column)[None] for column in zip(*rows, strict=True))
    return Track(np.array(times), xy, score, reason, xyz, np.full((1, len(times), 2, 3), np.nan))


def limited(track: Track, model: str, full_score: float) -> tuple[Track, str]:
    """Return a track with scores up to 1, and a warning if many were higher, or all too low.

    `full_score` is that of the network `model` in `models.yaml`, by which they were divided.
    """
    found, doubt = keypoints.full_score(track.score), ""
    if found > 1:
        doubt = (
            f"{model}: 5 % of its scores exceed {found * full_score:.3g}, and all from "
            f"{full_score:g} on count as 1, so that doubtful joints count as much as certain ones; "
            f"set `full_score: {found * full_score:.3g}` of {model} in config/models.yaml"
        )
    elif full_score > 1 and np.isnan(track.xy).all():
        doubt = (
            f"{model}: nobody was found, with scores divided by `full_score: {full_score:g}`; if "
            "the video shows people, remove that key from config/models.yaml: a warning then names "
            "the value to set"
        )
    return replace(track, score=np.clip(track.score, 0, 1)), doubt


def _largest(
    image: NDArray, detector: PersonDetector, landmarks: LandmarkNetwork, min_presence: float
) -> Pose:
    """Return the pose of the largest detected person in whom the landmark network is confident."""
    regions = regions_near(image, (0, 0, image.shape[1], image.shape[0]), detector)
    for region in sorted(regions, key=lambda one: -one.side):
        pose = landmarks.estimate(image, region)
        if pose.presence >= min_presence:
            break
    return pose


def strayed(xy: NDArray, boxes: Sequence[Box]) -> bool:
    """Return whether joints (J, 2) px have left the foreground, perhaps for a poster.

    Without foreground it returns False: a person may stand still for long.
    """
    middle = np.median(xy, axis=0)
    for x, y, width, height in boxes:
        reach = STRAY * max(width, height)
        low, high = np.array([x, y]) - reach, np.array([x + width, y + height]) + reach
        if (low <= middle).all() and (middle <= high).all():
            return False
    return bool(boxes)


def regions_near(
    image: NDArray, box: Box, detector: PersonDetector, *, fallback: bool = True
) -> list[Region]:
    """Return the regions of all persons in or near a foreground box, best first.

    Where the detector finds nobody, the only region is the box itself, upright, with `fallback`.
    """
    x, y, width, height = box
    half = SEARCH_MARGIN * max(width, height) / 2
    centre_x, centre_y = x + width / 2, y + height / 2
    left, top = max(0, int(centre_x - half)), max(0, int(centre_y - half))
    found = detector.detect(image[top : int(centre_y + half), left : int(centre_x + half)])
    if not found and fallback:
        return [Region(centre_x, centre_y, SEARCH_MARGIN * max(width, height))]
    return [one.placed(left, top) for one in found]


def as_row(
    pose: Pose | None, n_joints: int, shape: Sequence[int] | None
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return xy, score, reason and xyz_in_body of one frame of a `Track`.

    Joints outside the picture, whose `shape` begins with height and width, are NaN with that
    reason. `shape` is not used without a pose, where nobody was found.
    """
    if pose is None or shape is None:
        xy, xyz = np.full((n_joints, 2), np.nan), np.full((n_joints, 3), np.nan)
        unseen = np.full(n_joints, missing_reason.UNSEEN, np.uint8)
        return xy, np.full(n_joints, np.nan), unseen, xyz
    size = np.array([shape[1], shape[0]])
    inside = np.all((pose.xy > -0.5) & (pose.xy < size - 0.5), axis=1)
    xy = np.where(inside[:, None], pose.xy, np.nan)
    reason = np.where(inside, missing_reason.OK, missing_reason.OUT_OF_IMAGE).astype(np.uint8)
    return xy, np.where(inside, pose.score, np.nan), reason, pose.xyz_in_body
