"""What no calibration may state about the cameras of a session, before they see anything."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from courtside.calibration.file_check import inverted_poses
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError, StrPath

CORNER_PX = 2.0  # ASSUME: no principal point in px is so near to the corner of the picture
SAME = 1e-3  # m and entries of rotations: no two cameras can be so close to each other


def check(path: StrPath, cameras: Sequence[Camera]) -> None:
    """Raise `InputError` for cameras of a session that the calibration at `path` states wrongly.

    Their pictures are those of the file, not cropped.
    """
    for camera in cameras:
        _check_principal_point(path, camera)
    _check_poses_differ(path, cameras)
    if way := inverted_poses.judge(cameras):
        raise InputError(
            f"{path}: cameras {', '.join(camera.name for camera in cameras)}: expected rotations "
            "and translations from the world to the camera, with z up, found cameras on their side "
            f"or below the floor, which stand around one place if the file has {way.what}; "
            f"{way.advice}"
        )


def _check_principal_point(path: StrPath, camera: Camera) -> None:
    x, y = camera.K[:2, 2]
    if max(abs(x), abs(y)) < CORNER_PX:
        raise InputError(
            f"{path}: camera {camera.name}: expected the principal point in px from the upper left "
            f"corner of the {camera_fields.times(camera.size)} px picture, found ({x:.4g}, "
            f"{y:.4g}), as in shares of the picture or from its middle; convert it to px from the "
            "corner"
        )


def _check_poses_differ(path: StrPath, cameras: Sequence[Camera]) -> None:
    for one, other in combinations(cameras, 2):
        turned = np.abs(one.cam_from_world[:, :3] - other.cam_from_world[:, :3]).max()
        apart_m = np.linalg.norm(one.centre_in_world - other.centre_in_world)
        if turned < SAME and apart_m < SAME:
            raise InputError(
                f"{path}: cameras {one.name} and {other.name}: expected a pose of its own for "
                f"each, found one and the same for both; {camera_fields.EXPORT_AGAIN}"
            )
