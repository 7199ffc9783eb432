"""The height of a person in each picture, in px: limits in pixels are shares of this height."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import boxes, epipolar, triangulation
from courtside.geometry.camera import Camera
from courtside.records.keypoints import skeleton as limbs

STATURE_M = 1.7  # of everybody: limits need no better; adults are 1.5 to 2.0 m tall
NEAREST_M = 0.5  # nobody stands closer to a camera
AGREED = 0.1  # of the extent: views of a trunk this close agree on where it is
LEAST_PX = 20.0  # ASSUME: smaller persons are not detected


def in_pictures(
    cameras: Sequence[Camera], xy: NDArray, score: NDArray, joints: Sequence[str]
) -> NDArray:
    """Return the height (C, P, T) px that each person, standing, would have in each picture.

    `xy` (C, P, T, J, 2) are distorted px at common times, `score` (C, P, T, J) is 0 to 1, both NaN
    where unseen, `joints` (J,) are their names. The height is that of a person of `STATURE_M` at
    the depth of the trunk, which is triangulated robustly; between frames in which views agree on
    it, it is interpolated. Where they never do, it is the usual extent of the keypoints in each
    picture. Neither posture nor a view that tracks somebody else changes this height.
    """
    extent_px = np.maximum(boxes.usual_side(xy), LEAST_PX)
    trunk = [list(joints).index(joint) for joint in limbs.TRUNK if joint in joints]
    height_px = np.broadcast_to(extent_px[..., None], score.shape[:3]).copy()
    for person in range(score.shape[1] if trunk else 0):
        middle = _middle(
            cameras, xy[:, person][:, :, trunk], score[:, person][:, :, trunk], extent_px[:, person]
        )
        if middle is None:
            continue
        for view, camera in enumerate(cameras):
            depth_m = middle @ camera.cam_from_world[2, :3] + camera.cam_from_world[2, 3]
            focal_px = epipolar.focal_px(camera)
            height_px[view, person] = STATURE_M * focal_px / np.maximum(depth_m, NEAREST_M)
    return np.maximum(height_px, LEAST_PX)


def _middle(
    cameras: Sequence[Camera], xy: NDArray, score: NDArray, extent_px: NDArray
) -> NDArray | None:
    """Return the middle (T, 3) m of a trunk by its joints (C, T, K, 2), None if views disagree."""
    flat = score.reshape(len(cameras), -1)
    found = triangulation.triangulate_robust(
        cameras,
        xy.reshape(len(cameras), -1, 2),
        flat,
        max_error_px=np.broadcast_to(AGREED * extent_px[:, None], flat.shape),
    )
    xyz = np.ma.masked_invalid(found.xyz.reshape(*score.shape[1:], 3))
    middle = np.ma.median(xyz, axis=1).filled(np.nan)
    known = np.flatnonzero(np.isfinite(middle).all(axis=1))
    if not len(known):
        return None
    frames = np.arange(len(middle))
    return np.stack([np.interp(frames, known, axis) for axis in middle[known].T], axis=1)
