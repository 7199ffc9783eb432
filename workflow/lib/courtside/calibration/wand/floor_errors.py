"""Errors of the world frame that a wand on the floor defines, by the errors of its markers there.

The cameras misplace these markers, and each marker has errors of its own in the pictures. Where the
wand lies still, the tracker makes the same error in every frame: more frames are no more exact.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.people import world_frame
from courtside.calibration.people.world_frame import TINY_STEP
from courtside.calibration.wand import start, world
from courtside.calibration.wand.adjustment import WRONG_SIGMAS
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3

STILL_M = 0.05  # ASSUME: a marker that is nearer to its place in another frame has not moved


def covariances(
    cameras: Sequence[Camera], covariance: NDArray, xy: NDArray, above_m: float, sigma_px: float
) -> tuple[NDArray, NDArray]:
    """Return the covariance (K, K) of cameras in their world, and that (6, 6) of this world.

    `cameras` are in the world frame `world.of_floor` of markers `xy` (C, F, M, 2) px with a
    standard deviation of `sigma_px`, or of the worst residual of a marker that is wrong; `above_m`
    is their height. `covariance` is that of a network's columns in any frame. The world's is by the
    markers' own errors alone: a small rotation about its axes (rad) and a shift (m). That of the
    cameras contains it.
    """
    found, limit_px = start.robust(cameras, xy)
    known = np.isfinite(found.xyz).all(axis=1)
    places, seen = found.xyz[known], found.accepted[:, known].T
    by_place = _world_by_place(found.xyz.reshape(*xy.shape[1:3], 3), above_m, cameras)[:, known]
    by_world = world_frame.by_similarities(cameras, map(_moved, TINY_STEP * np.eye(6)))
    by_cameras = point_covariance.sensitivity(conversion.network_of(cameras), places, seen)
    keep = np.eye(len(covariance)) + by_world @ np.einsum("api,pik->ak", by_place, by_cameras)
    marker = np.flatnonzero(known) % xy.shape[2]
    off_px = np.where(found.accepted, found.error_px, 0.0)[:, known].max(axis=0)
    sigma = np.where(off_px > WRONG_SIGMAS * sigma_px, off_px, sigma_px) / limit_px
    own = np.linalg.cholesky(found.covariance[known]) * sigma[:, None, None]
    shift = np.zeros((len(places), 6, 3))
    np.add.at(shift, _still(places, marker), np.einsum("api,pij->paj", by_place, own))
    frame = np.einsum("paj,pbj->ab", shift, shift)
    return keep @ covariance @ keep.T + by_world @ frame @ by_world.T, frame


def _moved(step: NDArray) -> Sim3:
    """Return a small rotation (rad) and shift (m), (6,), as a similarity."""
    return Sim3(1.0, rotations.rotation_from_rodrigues(step[:3]), step[3:])


def _world_by_place(xyz: NDArray, above_m: float, cameras: Sequence[Camera]) -> NDArray:
    """Return how the world of markers (F, M, 3) m follows their places, (6, F M, 3); 0 if NaN."""

    def of(places: NDArray) -> NDArray:
        found = world.of_floor(places.reshape(xyz.shape), above_m, cameras)
        return np.append(rotations.rodrigues_from_rotation(found.rotation), found.translation)

    flat = xyz.ravel()
    found, base = np.zeros((6, flat.size)), of(flat)
    for at in np.flatnonzero(np.isfinite(xyz).all(axis=2).repeat(3)):
        step = TINY_STEP * (np.arange(flat.size) == at)
        found[:, at] = (of(flat + step) - base) / TINY_STEP
    return found.reshape(6, -1, 3)


def _still(places: NDArray, marker: NDArray) -> NDArray:
    """Return for places (P, 3) m of markers the index of the first where it lay as still, (P,)."""
    apart = np.linalg.norm(places[:, None] - places, axis=2)
    return ((apart < STILL_M) & (marker[:, None] == marker)).argmax(axis=1)
