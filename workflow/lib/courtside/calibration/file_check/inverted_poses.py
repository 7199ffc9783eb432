"""Poses that a calibration states the other way round, as from the camera to the world.

Cameras of a right calibration are upright and above the floor, z up, or, in a world of another
kind, agree on what is up in their pictures and look at one place. Where they do neither, their
poses are tried the other way round, and one way is believed only if it makes all that is true, and
the cameras look at the place from several sides. Without a place that all see nothing is said.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.geometry.camera import Camera, in_picture, project

FEWEST = 3  # ASSUME: two cameras may be right either way
UPRIGHT_DEG, TILTED_DEG = 45.0, 75.0  # ASSUME: up in a picture is surely nearer to z, or may be
AGREE = 0.7  # ASSUME: length of the mean of what is up in pictures that agree on it
ONE_SIDE = 0.9  # ASSUME: length of the mean direction of cameras that look from one side
HEIGHTS_M = (-1.0, 4.0)  # ASSUME: of the place that cameras look at, above the floor


@dataclass(frozen=True)
class Way:
    """A way to state poses, and what to do with them."""

    what: str
    advice: str
    right: Callable[[NDArray], NDArray]  # `cam_from_world` (3, 4) of a pose stated in this way


# A camera of OpenGL and Blender looks along -z with y up, ours along +z with y down.
CAM_FROM_CAM = np.diag([1.0, -1.0, -1.0])
WAYS = (
    Way("poses from the camera to the world", "invert them", rotations.invert),
    Way(
        "rotations from the camera to the world",
        "transpose them",
        lambda pose: np.column_stack([pose[:, :3].T, pose[:, 3]]),
    ),
    Way(
        "translations that are the places C of the cameras",
        "write -R C instead",
        lambda pose: np.column_stack([pose[:, :3], -pose[:, :3] @ pose[:, 3]]),
    ),
    Way(
        "cameras with y up that look along -z, as in OpenGL",
        "change the sign of y and z in the camera's axes",
        lambda pose: CAM_FROM_CAM @ pose,
    ),
    Way(
        "poses from the camera to the world, with y up and looking along -z, as in Blender",
        "invert them, and change the sign of y and z in the camera's axes",
        lambda pose: CAM_FROM_CAM @ rotations.invert(pose),
    ),
)


def judge(cameras: Sequence[Camera]) -> Way | None:
    """Return how the poses of cameras are surely stated; None if they may be right."""
    if len(cameras) < FEWEST or _may_be_right(cameras):
        return None
    for way in WAYS:
        if _are_surely_right(
            [replace(c, cam_from_world=way.right(c.cam_from_world)) for c in cameras]
        ):
            return way
    return None


def _may_be_right(cameras: Sequence[Camera]) -> bool:
    if _stand(cameras, TILTED_DEG):
        return True
    return bool(np.linalg.norm(_up(cameras).mean(axis=0)) > AGREE) and _place(cameras) is not None


def _are_surely_right(cameras: Sequence[Camera]) -> bool:
    if not _stand(cameras, UPRIGHT_DEG) or np.linalg.norm(_looks(cameras).mean(axis=0)) > ONE_SIDE:
        return False
    place = _place(cameras)
    return place is not None and HEIGHTS_M[0] < place[2] < HEIGHTS_M[1]


def _stand(cameras: Sequence[Camera], most_deg: float) -> bool:
    """Return whether all cameras are above z = 0 with z up in their pictures, to `most_deg`."""
    above = min(camera.centre_in_world[2] for camera in cameras) > 0
    return bool(above and _up(cameras)[:, 2].min() > np.cos(np.radians(most_deg)))


def _up(cameras: Sequence[Camera]) -> NDArray:
    return np.array([-camera.cam_from_world[1, :3] for camera in cameras])


def _looks(cameras: Sequence[Camera]) -> NDArray:
    return np.array([camera.cam_from_world[2, :3] for camera in cameras])


def _place(cameras: Sequence[Camera]) -> NDArray | None:
    """Return the place (3,) nearest to where all cameras look, None if not in all pictures."""
    looks = _looks(cameras)
    across = np.eye(3) - looks[:, :, None] * looks[:, None, :]
    centres = np.array([camera.centre_in_world for camera in cameras])
    if np.linalg.eigvalsh(across.sum(axis=0))[0] < 1e-9 * len(cameras):  # they look in parallel
        return None
    place = np.linalg.solve(across.sum(axis=0), np.einsum("cij,cj->i", across, centres))
    seen = [in_picture(camera, project(camera, place)) for camera in cameras]
    return place if all(seen) else None
