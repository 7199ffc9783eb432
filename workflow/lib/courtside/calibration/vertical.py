"""World frames without a floor: z is up as in the pictures."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.geometry.camera import Camera

TURNED = np.array([[0.0, -1.0], [1.0, 0.0]])  # of a normal's x and y to rotations about x and y
ROUNDS = 30  # of estimating how much cameras are rolled
# ASSUME: by how much cameras are rolled, and look down or up, standard deviations; the first counts
# as that many cameras.
ROLLED, LOOKING_DOWN, SURE = np.radians(3.0), np.radians(20.0), 3
# ASSUME: pictures do not tell what is up if it may be further off than this in some direction
# (standard deviation), or if fewer than three in four have it on one side, of those that look
# straight down less than `STEEP` of the way.
UNSURE, STEEP = np.radians(15.0), np.cos(np.radians(75.0))


def upright(cameras: Sequence[Camera]) -> NDArray:
    """Return the rotation (3, 3) to z up and x from the first camera to the second."""
    along = cameras[1].centre_in_world - cameras[0].centre_in_world
    return axes(up_in_pictures(cameras), along)


def axes(up: NDArray, along: NDArray) -> NDArray:
    """Return the rotation (3, 3) to axes with z up and x along a direction."""
    x = rotations.unit(along - (along @ up) * up)
    return np.stack([x, np.cross(up, x), up])


def up_in_pictures(cameras: Sequence[Camera]) -> NDArray:
    """Return the direction (3,) that is up in the pictures."""
    return _up_in_pictures(cameras)[0]


def error_of_pictures(cameras: Sequence[Camera]) -> NDArray:
    """Return the covariance of a world frame whose z is `up_in_pictures`.

    As `CameraCovariance.frame` has it. The height of the origin is one of choice, without an error.
    """
    found = np.zeros((3, 3))
    found[:2, :2] = TURNED @ _up_in_pictures(cameras)[1][:2, :2] @ TURNED.T
    return found


def is_unknown(cameras: Sequence[Camera]) -> bool:
    """Return whether the pictures do not tell what is up."""
    up, covariance = _up_in_pictures(cameras)
    y = np.array([camera.cam_from_world[1, :3] for camera in cameras])
    agreed = abs(np.clip(y @ up / STEEP, -1, 1).mean())
    return bool(agreed < 0.5 or np.linalg.eigvalsh(covariance)[-1] > UNSURE**2)


def words(cameras: Sequence[Camera]) -> str:
    """Return a clause on the z of a world frame whose z is `up_in_pictures`."""
    if is_unknown(cameras):
        return (
            "the pictures do not tell what is up, because cameras look in one direction, face each "
            "other, look straight down, or are turned differently; z may have any direction"
        )
    within_deg = sigma_deg(error_of_pictures(cameras))
    return f"z is up as in the pictures, within {within_deg:.0f} degrees (standard deviation)"


def _up_in_pictures(cameras: Sequence[Camera]) -> tuple[NDArray, NDArray]:
    """Return up (3,) and its covariance (3, 3).

    Few cameras are rolled, so that up is perpendicular to the pictures' x axes; more look down, so
    that it is less surely perpendicular to where they look: all of them may by the same angle,
    which is not better known from several. How much they are rolled, they say.
    """
    x, y, z = np.array([camera.cam_from_world[:, :3] for camera in cameras]).swapaxes(0, 1)
    rolled = ROLLED**2
    for _ in range(ROUNDS):
        level = z.T @ z / (len(cameras) * LOOKING_DOWN**2)
        extent, directions = np.linalg.eigh(x.T @ x / rolled + level)
        up = directions[:, 0]
        seen = np.square(x @ up).sum()
        rolled = (SURE * ROLLED**2 + seen) / (SURE + len(cameras) - 1)
    aside = directions[:, 1:]
    return up * -np.sign(y.sum(axis=0) @ up), aside / extent[1:] @ aside.T


def sigma_deg(frame: NDArray) -> float:
    """Return the standard deviation of the vertical, degrees, of a frame's covariance (3, 3)."""
    return round(float(np.degrees(np.sqrt(np.trace(frame[:2, :2]) / 2))), 2)
