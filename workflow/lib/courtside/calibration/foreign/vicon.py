"""Cameras of Vicon's `.xcp` files.

The form is that of Vicon's page "About calibration data (XCP) files": millimetres, a quaternion
whose last number is real and turns the world into the camera, and a camera that looks along +z with
y down. VICON_RADIAL2 holds the centre of distortion in px and three coefficients per px^2, px^4 and
px^6, which map a seen place to the ideal one: the inverse of OpenCV's model. Programs that copy
them into OpenCV's distortion unchanged (Pose2Sim, OpenCap) have another sign and unit.
"""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.foreign import inverse_lens, xml_fields
from courtside.geometry import camera as camera_files
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

MODEL = "Vicon3Parameter"
FILMING = ("video", "vue")  # in the type of cameras that film; the others see markers


def read(path: Path, root: ElementTree.Element) -> list[Camera]:
    """Return the cameras that film, by their DEVICEID; those of markers where none films."""
    calibrated = [c for c in root.findall("Camera") if c.find("KeyFrames/KeyFrame") is not None]
    films = [c for c in calibrated if any(kind in c.get("TYPE", "").lower() for kind in FILMING)]
    return [_camera(path, element) for element in films or calibrated]


def _camera(path: Path, element: ElementTree.Element) -> Camera:
    name = element.get("DEVICEID", "without DEVICEID")
    where = f"{path}: camera {name}"
    frames = element.findall("KeyFrames/KeyFrame")
    if len(frames) > 1:
        raise InputError(
            f"{where}: expected a camera at rest, found {len(frames)} places of a moving one; "
            "export the calibration of a static trial"
        )
    frame = frames[0]
    stated = element.get("PIXEL_ASPECT_RATIO", "1")
    aspect = float(camera_fields.numbers(where, "PIXEL_ASPECT_RATIO", stated, ()))
    focal = float(camera_fields.numbers(where, "FOCAL_LENGTH", frame.get("FOCAL_LENGTH"), ()))
    if min(aspect, focal) <= 0:
        raise InputError(
            f"{where}: expected a positive FOCAL_LENGTH and PIXEL_ASPECT_RATIO, found {focal:g} "
            f"and {aspect:g}; {camera_fields.EXPORT_AGAIN}"
        )
    centre = xml_fields.row(where, frame, "PRINCIPAL_POINT", 2)
    skew = camera_fields.numbers(where, "SKEW", element.get("SKEW", "0"), ())
    matrix = np.array([[focal, skew, centre[0]], [0, focal / aspect, centre[1]], [0, 0, 1]])
    lens = _radial(where, frame, centre)
    size = xml_fields.row(where, element, "SENSOR_SIZE", 2)
    rotation = _rotation(where, xml_fields.row(where, frame, "ORIENTATION", 4))
    table = {
        "size": size,
        "matrix": matrix,
        "distortions": inverse_lens.coefficients(
            where, size, matrix, lambda xy: _undistorted(xy, matrix, *lens)
        ),
        "rotation": rotation,
        "translation": -rotation @ xml_fields.row(where, frame, "POSITION", 3),
    }
    return camera_files.build(where, name, table, camera_fields.METRES["mm"])


def _rotation(where: str, turned: NDArray) -> NDArray:
    """Return the rotation of a quaternion x y z w; raise `InputError` if its length is not 1."""
    if not 0.99 < np.linalg.norm(turned) < 1.01:
        raise InputError(
            f"{where}: expected ORIENTATION as a quaternion of length 1, found length "
            f"{np.linalg.norm(turned):.3g}; {camera_fields.EXPORT_AGAIN}"
        )
    return scipy.spatial.transform.Rotation.from_quat(turned).as_matrix()


def _undistorted(xy: NDArray, matrix: NDArray, centre: NDArray, radial: NDArray) -> NDArray:
    """Return directions (N, 2) of px, by way of px of the aspect 1, as Vicon does."""
    focal = matrix[0, 0]
    square = np.array([1.0, focal / matrix[1, 1]])
    offset = (xy - centre) * square
    power = (offset**2).sum(axis=-1, keepdims=True)
    scale = 1 + power * (radial[0] + power * (radial[1] + power * radial[2]))
    return (offset * scale + (centre - matrix[:2, 2]) * square) / focal


def _radial(where: str, frame: ElementTree.Element, centre: NDArray) -> tuple[NDArray, NDArray]:
    """Return the centre of distortion (2,) px, and the three coefficients (3,)."""
    new = frame.get("VICON_RADIAL2", "").split()
    if not new:  # of older programs: two coefficients around the principal point
        old = frame.get("VICON_RADIAL", "0 0").split()
        return centre, camera_fields.numbers(where, "VICON_RADIAL", [*old, 0], (3,))
    if new[0] != MODEL:
        raise InputError(
            f"{where}: expected VICON_RADIAL2 of {MODEL}, found {camera_fields.short(new[0])}; "
            "export the calibration from Vicon Nexus, Shogun or Tracker again"
        )
    values = camera_fields.numbers(where, "VICON_RADIAL2", new[1:], (5,))
    return values[:2], values[2:]
