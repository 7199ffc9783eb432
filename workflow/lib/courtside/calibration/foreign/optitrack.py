"""Cameras of OptiTrack's `.mcal` files, which Motive writes since version 3.2.

The form is that of Motive's page ".mcal XML Calibration Files": metres, y up, rotations row by row
from the camera to the world, a camera that looks along -z with y up. The "standard camera model"
maps a seen place to the ideal one, as that page's own function does: the inverse of OpenCV's model.
The world is turned so that z is up.
"""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.foreign import inverse_lens, xml_fields
from courtside.geometry import camera as camera_files
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

LENS = "IntrinsicStandardCameraModel"
CAM_FROM_CAM = np.diag([1.0, -1.0, -1.0])  # y up and looking along -z, to y down and along +z
OURS_FROM_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def read(path: Path, root: ElementTree.Element) -> list[Camera]:
    """Return the cameras of a file by their serial numbers, in metres, z up."""
    return [_camera(path, element) for element in root.iter("Camera")]


def _camera(path: Path, element: ElementTree.Element) -> Camera:
    name = element.get("Serial", "without Serial")
    where = f"{path}: camera {name}"
    size = xml_fields.attributes(where, element, "Attributes", "ImagerPixelWidth ImagerPixelHeight")
    focal_x, focal_y, centre_x, centre_y = xml_fields.attributes(
        where, element, LENS, "HorizontalFocalLength VerticalFocalLength LensCenterX LensCenterY"
    )
    if min(focal_x, focal_y) <= 0:
        raise InputError(
            f"{where}: expected positive focal lengths, found {focal_x:g} and {focal_y:g}; save "
            "the calibration in Motive again"
        )
    # ASSUME: coordinate 0 is the first pixel's centre; were it that pixel's corner, the principal
    # point would move by half a pixel.
    matrix = np.array([[focal_x, 0, centre_x], [0, focal_y, centre_y], [0, 0, 1]])
    lens = xml_fields.attributes(where, element, LENS, "k1 k2 k3 TangentialX TangentialY")
    turned = " ".join(f"OrientMatrix{k}" for k in range(9))
    rotation = xml_fields.attributes(where, element, "Extrinsic", turned).reshape(3, 3)
    centre = xml_fields.attributes(where, element, "Extrinsic", "X Y Z")
    cam_from_world = CAM_FROM_CAM @ rotation.T @ OURS_FROM_Y_UP.T
    table = {
        "size": size,
        "matrix": matrix,
        "distortions": inverse_lens.coefficients(
            where, size, matrix, lambda xy: undistorted(xy, matrix, lens)
        ),
        "rotation": cam_from_world,
        "translation": -cam_from_world @ OURS_FROM_Y_UP @ centre,
    }
    return camera_files.build(where, name, table, 1.0)


def undistorted(xy: NDArray, matrix: NDArray, lens: NDArray) -> NDArray:
    """Return the directions (N, 2) of px (N, 2) by k1 k2 k3 and the tangential x and y, (5,).

    Word for word that page's function: its tangential part has x^2 where OpenCV's has 2 x^2.
    """
    k1, k2, k3, tangential_x, tangential_y = lens
    x, y = ((xy - matrix[:2, 2]) / np.diag(matrix)[:2]).T
    square = x * x + y * y
    radial = 1 + square * (k1 + square * (k2 + square * k3))
    return np.stack(
        [
            x * radial + 2 * tangential_x * x * y + tangential_y * (square + x * x),
            y * radial + 2 * tangential_y * x * y + tangential_x * (square + y * y),
        ],
        axis=-1,
    )
