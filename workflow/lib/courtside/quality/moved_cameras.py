"""A camera that stands elsewhere than calibrated, found by the people that the others place.

It was moved after its calibration, or its calibration is of another court or end.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people import resection
from courtside.calibration.people.views import Limits
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, in_picture, project
from courtside.quality import seen as views
from courtside.quality.seen import Seen

# ASSUME: of a person's extent in the picture, 0.8 of the height: with the right pose cameras agree
# as usual ones do, to 0.012 to 0.031 of the height.
FITS = 0.045
NEARER = 0.6  # and at most this share of the error is left: a right camera may miss people
LEAST = 0.5  # of the frames in which a person is placed: the camera must then show the person there


@dataclass(frozen=True, eq=False)
class Moved:
    """The pose of a camera by the people whom the others place."""

    before: Camera
    after: Camera

    def __str__(self) -> str:
        by_m = self.after.centre_in_world - self.before.centre_in_world
        x, y, z = np.round(by_m, 1) + 0.0
        turn = self.after.cam_from_world[:, :3] @ self.before.cam_from_world[:, :3].T
        return (
            f"by the people in its pictures it stands {np.linalg.norm(by_m):.1f} m from the "
            f"calibrated place (x {x:+.1f}, y {y:+.1f}, z {z:+.1f} m), turned by "
            f"{np.degrees(rotations.angles(turn)):.0f} degrees; it was moved after the "
            "calibration, or its clicks are of another court or end"
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
    if found is None:
        return None
    if _left(found[0], xyz, rows) > min(FITS, NEARER * _left(before, xyz, rows)):
        return None
    return Moved(before, found[0])


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
