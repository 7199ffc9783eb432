"""A camera that stands elsewhere than calibrated, found by the people that the others place.

It was moved after its calibration, or its calibration is of another court or end.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.people import resection
from courtside.calibration.people.views import Limits
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, in_picture, project
from courtside.quality import seen as views
from courtside.quality.seen import Seen
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

# ASSUME: of a person's extent in the picture, 0.8 of the height: with the right pose cameras agree
# as usual ones do, to 0.012 to 0.031 of the height.
FITS = 0.045
NEARER = 0.6  # and at most this share of the error is left: a right camera may miss people
LEAST = 0.5  # of the frames in which a person is placed: the camera must then show the person there
MOST_POINTS = 3000  # of the fit of a pose
TOLD_M = 1.0  # standard deviation of a place that is worth telling
STEP = 1e-5  # rad or m: of a derivative


@dataclass(frozen=True, eq=False)
class Moved:
    """The pose of a camera by the people whom the others place."""

    before: Camera
    after: Camera
    sigma_m: float  # standard deviation of its place

    def __str__(self) -> str:
        by_m = self.after.centre_in_world - self.before.centre_in_world
        x, y, z = np.round(by_m, 1) + 0.0
        turn = self.after.cam_from_world[:, :3] @ self.before.cam_from_world[:, :3].T
        where = (
            f"{np.linalg.norm(by_m):.1f} m (+-{max(self.sigma_m, 0.1):.1f}) from the calibrated "
            f"place (x {x:+.1f}, y {y:+.1f}, z {z:+.1f} m), turned by "
            f"{np.degrees(rotations.angles(turn)):.0f} degrees"
        )
        if self.sigma_m > TOLD_M:
            where = "elsewhere or is turned; how far, they move too little to tell"
        return (
            f"by the people in its pictures it stands {where}; it was moved after the calibration, "
            "or its clicks are of another court or end"
        )


def find(seen: Seen, camera: int) -> Moved | None:
    """Return the pose at which people found in a camera's pictures fit those of the other cameras.

    None if there is no such pose: nobody found there moves as a person whom the others place does.
    """
    if seen.hardly_placed(camera):
        return None
    before, xyz = seen.cameras[camera], seen.others[camera]
    rows = seen.rows[camera][:, seen.at]
    limits = Limits(views.MIN_SCORE, views.AGREED, views.AGREED)
    found = resection.find(before, xyz, rows, limits)
    if found is None or np.isinf(_left(found[0], xyz, rows)):
        return None
    after, sigma_m = _refined(found[0], xyz, rows)
    if _left(after, xyz, rows) > min(FITS, NEARER * _left(before, xyz, rows)):
        return None
    return Moved(before, after, sigma_m)


def _refined(camera: Camera, xyz: NDArray, rows: NDArray) -> tuple[Camera, float]:
    """Return a camera whose pose fits the nearest tracklets best, and the sigma of its place, m.

    RANSAC's pose rests on few middles: in short takes it is metres off. A network errs alike
    through a take, so each middle of each person counts as one view.
    """
    world, xy, extent_px = _nearest(camera, xyz, rows)
    centre = np.median(world, axis=0)

    def posed(step: NDArray) -> Camera:
        rotation = rotations.rotation_from_rodrigues(step[:3])
        motion = np.column_stack([rotation, centre - rotation @ centre + step[3:]])
        return replace(camera, cam_from_world=rotations.composed(camera.cam_from_world, motion))

    def residual(step: NDArray) -> NDArray:
        off = (project(posed(step), world) - xy) / extent_px[:, None]
        return np.nan_to_num(off, nan=1.0).ravel()

    fit = scipy.optimize.least_squares(residual, np.zeros(6), loss="soft_l1", f_scale=FITS)
    spread = MEDIAN_TO_SIGMA * np.median(np.abs(residual(fit.x)))
    share = len(world) / (xyz.shape[0] * xyz.shape[2])
    covariance = np.linalg.pinv(fit.jac.T @ fit.jac) * spread**2 * share
    after = posed(fit.x)
    ahead = [posed(fit.x + step).centre_in_world for step in STEP * np.eye(6)]
    slopes = (np.array(ahead) - after.centre_in_world) / STEP
    return after, float(np.sqrt(np.trace(slopes.T @ covariance @ slopes)))


def _nearest(camera: Camera, xyz: NDArray, rows: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Return middles (N, 3) m, where the nearest tracklets have them, and the person's extent, px.

    Of persons (P, S, K, 3) and tracklets (R, S, K, 2).
    """
    there = project(camera, xyz)
    off_px = np.nan_to_num([views.typical(row - there) for row in rows], nan=np.inf)
    xy = rows[off_px.argmin(axis=0), np.arange(there.shape[1])]
    extent_px = np.broadcast_to(np.ptp(there, axis=2).max(axis=-1)[..., None], xy.shape[:-1])
    known = np.isfinite(xy).all(axis=-1) & np.isfinite(extent_px)
    known &= np.isfinite(off_px.min(axis=0))[..., None]
    chosen = np.flatnonzero(known)[:: max(1, int(known.sum()) // MOST_POINTS)]
    return xyz.reshape(-1, 3)[chosen], xy.reshape(-1, 2)[chosen], extent_px.ravel()[chosen]


def _left(camera: Camera, xyz: NDArray, rows: NDArray) -> float:
    """Return how far the nearest of tracklets (R, S, K, 2) are from persons (P, S, K, 3), median.

    In the persons' extents in the picture. Infinite if fewer than `LEAST` of the persons in the
    picture are shown.
    """
    there = project(camera, xyz)
    extent_px = np.ptp(there, axis=2).max(axis=-1)  # NaN where a middle is missing
    inside = in_picture(camera, there).all(axis=-1) & np.isfinite(extent_px)
    off_px = np.stack([views.typical(row - there) for row in rows])
    nearest = (np.nan_to_num(off_px, nan=np.inf).min(axis=0) / extent_px)[inside]
    if not len(nearest) or np.isfinite(nearest).mean() < LEAST:
        return float("inf")
    return float(np.median(nearest))
