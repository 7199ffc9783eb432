"""Warnings about cameras from people alone, one line each."""

from collections.abc import Iterator, Sequence
from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people import views
from courtside.calibration.people.held_out import Score
from courtside.calibration.people.views import Limits, Seen
from courtside.geometry import rotations
from courtside.geometry.camera import Camera

LEAST_S = 15.0  # ASSUME: time of all persons in two cameras or more, together
LEAST_ANGLE_DEG = 10.0  # ASSUME: between rays; below it, depth is 6 times less certain
LEAST_TIED = 0.25  # ASSUME: joints shared with other cameras, over the median camera's
LEAST_ACCEPTED = 75.0  # ASSUME: percent of a camera's views
TILT_DEG, HEIGHT_M = 1.0, 0.03  # ASSUME: difference of the floors of two halves of the time


def find(
    cameras: Sequence[Camera],
    seen: Seen,
    joints: NDArray,
    score: Score,
    limits: Limits,
    apart: NDArray | None,
) -> list[str]:
    """Return the warnings; none for good cameras.

    `joints` (T, J, 3) m are those of `seen`, NaN where unknown; `apart` is that of
    `world_frame.halves_apart`.
    """
    return [
        *_short(seen, limits),
        *_narrow(cameras, joints),
        *_loose(cameras, seen, limits),
        *_contradicting(cameras, score),
        *_floor(apart),
    ]


def _short(seen: Seen, limits: Limits) -> Iterator[str]:
    """Yield a warning if people are seen for a short time only."""
    usable = (np.nan_to_num(seen.score) >= limits.score).any(axis=2).sum(axis=0) >= 2
    seconds = 0.0
    for track in np.unique(seen.track):
        own = seen.track == track
        if own.sum() > 1:
            seconds += float(np.median(np.diff(seen.time_s[own])) * usable[own].sum())
    if seconds < LEAST_S:
        yield (
            f"people: expected {LEAST_S:.0f} s or more in the views of two cameras, all persons "
            f"together, found {seconds:.0f} s; add longer takes"
        )


def _narrow(cameras: Sequence[Camera], joints: NDArray) -> Iterator[str]:
    """Yield a warning for each camera whose rays meet those of others at small angles only."""
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
                f"camera {camera.name}: expected rays that meet those of another camera at "
                f"{LEAST_ANGLE_DEG:.0f} degrees or more, found {angle:.0f} at most; its position "
                "is uncertain along its view: place it farther from the others"
            )


def _loose(cameras: Sequence[Camera], seen: Seen, limits: Limits) -> Iterator[str]:
    """Yield a warning for each camera that shares few joints with the others."""
    accepted = views.placed(cameras, seen, limits).accepted
    tied = accepted.sum(axis=1)
    usual = float(np.median(tied))
    for camera, count in zip(cameras, tied, strict=True):
        if count < LEAST_TIED * usual:
            yield (
                f"camera {camera.name}: it shares only {count} joints with the others, the median "
                f"camera {usual:.0f}; add takes in which it sees more of the people"
            )


def _contradicting(cameras: Sequence[Camera], score: Score) -> Iterator[str]:
    """Yield a warning for each camera with few accepted views of held-out joints."""
    for camera, share in zip(cameras, score.accepted_percent(), strict=True):
        if share < LEAST_ACCEPTED:
            yield (
                f"camera {camera.name}: expected {LEAST_ACCEPTED:.0f} % or more of its views of "
                f"held-out joints to agree with the others, found {share:.0f} %; check its clock"
            )


def _floor(apart: NDArray | None) -> Iterator[str]:
    """Yield a warning if the floors from two halves of the time differ."""
    if apart is None:
        yield "floor: it is defined by few frames with whole bodies; add longer takes"
        return
    tilt_deg = float(np.degrees(np.hypot(*apart[:2])))
    if tilt_deg > TILT_DEG or abs(apart[2]) > HEIGHT_M:
        yield (
            "floor: the first half of each track and the second half give floors that differ by "
            f"{tilt_deg:.1f} degrees and {100 * abs(apart[2]):.0f} cm; add takes in which people "
            "walk about more"
        )
