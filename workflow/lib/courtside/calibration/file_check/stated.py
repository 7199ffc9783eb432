"""What no calibration may state about the cameras of a session, before they see anything."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError, StrPath

SAME = 1e-3  # m and entries of rotations: no two cameras can be so close to each other


def check(path: StrPath, cameras: Sequence[Camera]) -> None:
    """Raise `InputError` for cameras of a session that the calibration at `path` states wrongly.

    Their pictures are those of the file, not cropped.
    """
    _check_poses_differ(path, cameras)


def _check_poses_differ(path: StrPath, cameras: Sequence[Camera]) -> None:
    for one, other in combinations(cameras, 2):
        turned = np.abs(one.cam_from_world[:, :3] - other.cam_from_world[:, :3]).max()
        apart_m = np.linalg.norm(one.centre_in_world - other.centre_in_world)
        if turned < SAME and apart_m < SAME:
            raise InputError(
                f"{path}: cameras {one.name} and {other.name}: expected a pose of its own for "
                f"each, found one and the same for both; {camera_fields.EXPORT_AGAIN}"
            )
