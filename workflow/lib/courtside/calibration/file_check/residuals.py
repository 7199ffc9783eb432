"""How far views of static points and of people disagree.

C cameras, N points. `xy` is (C, N, 2) px, NaN where unseen. Residuals are from a keypoint to the
projection of the point that all views give, or to a keypoint from the projection of the point that
all other views give.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import epipolar
from courtside.geometry.camera import Camera, project, undistort
from courtside.geometry.triangulation import triangulate, triangulate_all

MOST_POINTS = 200  # ASSUME: of people's joints; more take longer and say the same
BEHIND_PX = 1e3  # counts as residual of a point behind a camera or where its lens sees nothing
NEAREST_M = 1e-3  # keeps divisions finite
FROM_SHOULDERS = 0.78  # ASSUME: height of the shoulders above the ankles, over a person's height


class Rays:
    """Views of points whose viewing directions are computed once for each camera."""

    def __init__(self, xy: NDArray) -> None:
        self.xy = xy
        self._of: dict[tuple, NDArray] = {}

    def _straight(self, at: int, camera: Camera) -> NDArray:
        key = (at, camera.K.tobytes(), camera.dist.tobytes())
        if key not in self._of:
            self._of[key] = undistort(camera, self.xy[at])
        return self._of[key]

    def residuals(self, cameras: Sequence[Camera]) -> NDArray:
        """Return residuals (C, N, 2), straight px, of points from all views; NaN where unseen.

        A linear triangulation, weighted again by the depths that it gives: close to least squares
        of the pixels, and many times as fast.
        """
        straight = np.stack([self._straight(at, camera) for at, camera in enumerate(cameras)])
        seen = np.isfinite(self.xy).all(axis=-1)
        seen &= seen.sum(axis=0) >= 2
        known = seen & np.isfinite(straight).all(axis=-1)  # no direction beyond the lens's fold
        matrix = np.stack([camera.cam_from_world for camera in cameras])
        focal_px = np.array([epipolar.focal_px(camera) for camera in cameras])[:, None]
        weight = np.where(known, focal_px, 0.0)
        for _ in range(2):
            xyz = triangulate(straight, weight, matrix)
            in_cam = np.einsum("cij,nj->cni", matrix[:, :, :3], xyz) + matrix[:, None, :, 3]
            depth = in_cam[..., 2]
            weight = known * focal_px / np.maximum(np.nan_to_num(np.abs(depth)), NEAREST_M)
        away = (in_cam[..., :2] / np.where(depth > 0, depth, np.nan)[..., None]) - straight
        away = np.nan_to_num(away * focal_px[..., None], nan=BEHIND_PX)
        return np.where(seen[..., None], away, np.nan)


def left_out(cameras: Sequence[Camera], xy: NDArray) -> NDArray:
    """Return the residuals (C, N, 2) px of each camera to points that the others alone give.

    From projection to keypoint. NaN where the camera or fewer than two others see the point.
    """
    found = np.full(xy.shape, np.nan)
    if len(cameras) >= 3:
        for at, camera in enumerate(cameras):
            found[at] = xy[at] - project(camera, placed_by_others(cameras, xy, at))
    return found


def placed_by_others(cameras: Sequence[Camera], xy: NDArray, at: int) -> NDArray:
    """Return the points (..., 3) that all cameras but one place, by views `xy` (C, ..., 2)."""
    others = [k for k in range(len(cameras)) if k != at]
    return triangulate_all([cameras[k] for k in others], xy[others])


def rms_px(residuals: NDArray) -> float:
    """Return the root mean square of residuals (..., 2) per axis, px."""
    seen = np.isfinite(residuals)
    return float(np.sqrt((residuals[seen] ** 2).mean())) if seen.any() else float("nan")


def typical_px(residuals: NDArray) -> float:
    """Return the median over points of their root mean square per axis, px: holds with outliers."""
    seen = np.isfinite(residuals)
    count = seen.sum(axis=(0, 2))
    if not count.any():
        return float("nan")
    squares = np.where(seen, residuals, 0.0) ** 2
    return float(np.median(np.sqrt(squares.sum(axis=(0, 2))[count > 0] / count[count > 0])))


def of_people(views: Sequence[NDArray]) -> NDArray:
    """Return keypoints (C, N, 2) px of cameras (C) times (..., 2), evenly spaced in time.

    At most `MOST_POINTS`, each seen by two cameras or more.
    """
    xy = np.stack([view.reshape(-1, 2) for view in views])
    seen = np.flatnonzero(np.isfinite(xy).all(axis=-1).sum(axis=0) >= 2)
    steps = np.linspace(0, len(seen) - 1, min(len(seen), MOST_POINTS))
    return xy[:, seen[np.round(steps).astype(int)]] if len(seen) else xy[:, :0]


def height_px(views: Sequence[NDArray], standing_px: NDArray) -> float:
    """Return the median height of people, px, over their limb joints; inf without anybody.

    `views` are these joints (T, J, 2) by camera: of somebody upright, from shoulders to ankles. If
    no picture shows anybody whole, the height follows from `standing_px` (C, T), that of each
    person, standing, in each picture.
    """
    whole = [view[np.isfinite(view).all(axis=(-2, -1))] for view in views]
    heights = [np.ptp(view[..., 1], axis=-1) for view in whole]
    if not any(map(len, heights)):
        shown = [np.isfinite(view).any(axis=(-2, -1)) for view in views]
        both = zip(standing_px, shown, strict=True)
        heights = [FROM_SHOULDERS * each[seen] for each, seen in both]
    found = np.concatenate([*heights, np.zeros(0)])
    return float(np.median(found)) if len(found) else float("inf")
