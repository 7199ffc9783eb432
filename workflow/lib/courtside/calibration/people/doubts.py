"""What is doubtful about cameras that people alone place, one line each."""

from collections.abc import Iterator, Sequence
from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people import unit, views, world_frame
from courtside.calibration.people.adjustment import Limits
from courtside.calibration.people.held_out import Score
from courtside.calibration.people.views import Seen
from courtside.geometry import rotations
from courtside.geometry.camera import Camera

LEAST_S = 15.0  # ASSUME: of people in two cameras or more, all persons together
LEAST_ANGLE_DEG = 10.0  # ASSUME: of the rays of two cameras; at less, depth is 6 times less certain
LEAST_TIED = 0.25  # ASSUME: of the joints that tie the camera in the middle of the order
LEAST_ACCEPTED = 75.0  # ASSUME: percent of a camera's views
TILT_DEG, HEIGHT_M = 1.0, 0.03  # ASSUME: by which the floors of two halves of the time may differ


def lines(
    cameras: Sequence[Camera], seen: Seen, joints: NDArray, score: Score, limits: Limits
) -> list[str]:
    """Return what to know before cameras are used; nothing of good ones.

    `joints` (T, J, 3) m are those of `seen`, NaN where unknown.
    """
    return [
        *_short(seen, limits),
        *_narrow(cameras, joints),
        *_loose(cameras, seen, limits),
        *_contradicting(cameras, score),
        *_floor(cameras, seen, joints),
    ]


def _short(seen: Seen, limits: Limits) -> Iterator[str]:
    usable = (np.nan_to_num(seen.score) >= limits.score).any(axis=2).sum(axis=0) >= 2
    seconds = 0.0
    for track in np.unique(seen.track):
        own = seen.track == track
        if own.sum() > 1:
            seconds += float(np.median(np.diff(seen.time_s[own])) * usable[own].sum())
    if seconds < LEAST_S:
        yield (
            f"people are in two cameras or more for {seconds:.0f} s, all persons together; "
            f"{LEAST_S:.0f} s or more are better: name longer takes"
        )


def _narrow(cameras: Sequence[Camera], joints: NDArray) -> Iterator[str]:
    places = joints.reshape(-1, 3)
    places = places[np.isfinite(places).all(axis=1)]
    rays = [rotations.unit(places - camera.centre_in_world) for camera in cameras]
    widest = np.zeros(len(cameras))
    for (at, one), (_, other) in permutations(enumerate(rays), 2):
        sine = np.linalg.norm(np.cross(one, other), axis=1)
        widest[at] = max(widest[at], np.degrees(np.arcsin(np.clip(np.median(sine), 0, 1))))
    for camera, angle in zip(cameras, widest, strict=True):
        if angle < LEAST_ANGLE_DEG:
            yield (
                f"camera {camera.name}: its rays meet those of no other camera at more than "
                f"{angle:.0f} degrees: its place is uncertain along its view; move it aside"
            )


def _loose(cameras: Sequence[Camera], seen: Seen, limits: Limits) -> Iterator[str]:
    accepted = views.placed(cameras, seen, limits.score, limits.limit, limits.fade).accepted
    tied = (accepted & (accepted.sum(axis=0) >= 2)).sum(axis=1)
    usual = float(np.median(tied))
    for camera, count in zip(cameras, tied, strict=True):
        if count < LEAST_TIED * usual:
            yield (
                f"camera {camera.name}: {count} joints tie it to the others, {usual:.0f} the "
                "camera in the middle of the order; name takes in which it sees more of people"
            )


def _contradicting(cameras: Sequence[Camera], score: Score) -> Iterator[str]:
    for camera, share in zip(cameras, score.accepted_percent(), strict=True):
        if share < LEAST_ACCEPTED:
            yield (
                f"camera {camera.name}: {share:.0f} % of its views of joints that the fit left out "
                f"agree with the others, {LEAST_ACCEPTED:.0f} % or more are usual; check its clock"
            )


def _floor(cameras: Sequence[Camera], seen: Seen, joints: NDArray) -> Iterator[str]:
    """Yield that feet at other times say of the floor something else."""
    half = seen.blocks(2) % 2 == 1
    whole = np.isfinite(joints).all(axis=(1, 2))
    if min((whole & half).sum(), (whole & ~half).sum()) < unit.LEAST_FRAMES:
        yield "floor: it rests on few frames that show whole bodies; name longer takes"
        return
    one, other = (world_frame.floor(joints[rows], cameras) for rows in (half, ~half))
    tilt_deg = float(np.degrees(np.arccos(np.clip(one.rotation[2] @ other.rotation[2], -1, 1))))
    middle = np.nanmedian(joints.reshape(-1, 3), axis=0)
    apart_m = abs(float((one.points(middle) - other.points(middle))[2]))
    if tilt_deg > TILT_DEG or apart_m > HEIGHT_M:
        yield (
            f"floor: by the feet in the first half of each track's time it is tilted by "
            f"{tilt_deg:.1f} degrees and {100 * apart_m:.0f} cm off that by the second half; name "
            "takes in which people walk about more"
        )
