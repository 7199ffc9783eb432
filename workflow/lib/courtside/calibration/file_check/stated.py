"""What no calibration may state about the cameras of a session, before they see anything."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from courtside.calibration.file_check import inverted_poses
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera, in_picture, undistort
from courtside.study.errors import InputError, StrPath

CORNER_PX = 2.0  # ASSUME: no principal point in px is so near to the corner of the picture
FOCAL = (0.05, 30.0)  # ASSUME: focal lengths over the longer side of the picture: 2 to 170 degrees
# ASSUME: a lens that was estimated badly towards the corners has no direction for so much of the
# picture; one with more has its coefficients in another order or unit.
MOST_BLIND = 0.25
SAME = 1e-3  # m and entries of rotations: no two cameras can be so close to each other


def check(path: StrPath, cameras: Sequence[Camera]) -> None:
    """Raise `InputError` for cameras of a session that the calibration at `path` states wrongly.

    Their pictures are those of the file, not cropped.
    """
    for camera in cameras:
        _check_focal_lengths(path, camera)
        _check_principal_point(path, camera)
        _check_lens(path, camera)
    _check_poses_differ(path, cameras)
    if way := inverted_poses.judge(cameras):
        raise InputError(
            f"{path}: cameras {', '.join(camera.name for camera in cameras)}: expected rotations "
            "and translations from the world to the camera, with z up, found cameras on their side "
            f"or below the floor, which stand around one place if the file has {way.what}; "
            f"{way.advice}"
        )


def _check_focal_lengths(path: StrPath, camera: Camera) -> None:
    focal_px = np.diag(camera.K)[:2]
    shares = focal_px / max(camera.size)
    if not FOCAL[0] <= shares.min() <= shares.max() <= FOCAL[1]:
        raise InputError(
            f"{path}: camera {camera.name}: expected focal lengths in px, such as "
            f"{max(camera.size)} for the {camera_fields.times(camera.size)} px picture, found "
            f"{focal_px[0]:.4g} and {focal_px[1]:.4g}; convert them to px of this picture: mm "
            "times its width in px over the width of the sensor in mm"
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
    if not in_picture(camera, camera.K[:2, 2]):
        raise InputError(
            f"{path}: camera {camera.name}: expected the principal point in the "
            f"{camera_fields.times(camera.size)} px picture, found ({x:.4g}, {y:.4g}), as of a "
            "larger picture; state the size of the picture that its matrix is of, and `scale` or "
            "`crop_px` of the camera in the session file"
        )


def _check_lens(path: StrPath, camera: Camera) -> None:
    grid = np.meshgrid(*(np.linspace(0, length - 1, 9) for length in camera.size))
    blind = np.isnan(undistort(camera, np.stack(grid, axis=-1))[..., 0]).mean()
    if blind > MOST_BLIND:
        raise InputError(
            f"{path}: camera {camera.name}: expected distortions that give every pixel a "
            f"direction, found {camera_fields.short(camera.dist.tolist())}, with none for "
            f"{blind:.0%} of the picture; check their order, k1 k2 p1 p2 k3, and their unit"
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
