"""Cameras of Qualisys Track Manager: `.qca.txt`, and `<calibration>` of its settings."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from courtside.calibration.foreign import xml_fields
from courtside.geometry import camera as camera_files
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

PER_PX = 64  # see `_camera`
LARGEST_PX = 1 << 14  # of a sensor that is stated in px: Qualisys's are larger in its 1/64 px
TURNS = ("0", "90", "180", "270")
# A Qualisys camera looks along -z with y up, ours along +z with y down.
CAM_FROM_CAM = np.diag([1.0, -1.0, -1.0])


def read(path: Path, root: ElementTree.Element) -> list[Camera]:
    """Return the cameras of a calibration that are active and calibrated, by serial number."""
    calibration = root if root.tag == "calibration" else root.find(".//calibration")
    return [
        _camera(path, element)
        for element in (root if calibration is None else calibration).findall("cameras/camera")
        if element.get("active", "1") != "0" and element.get("calibrated", "true") != "false"
    ]


def is_one(root: ElementTree.Element) -> bool:
    """Return whether a file has a calibration of this form, with cameras or without."""
    return root.tag == "calibration" or root.find(".//calibration") is not None


def is_theia(root: ElementTree.Element) -> bool:
    """Return whether a calibration is Theia3D's own: like Qualisys's, with a sensor in px."""
    camera = root.find("cameras/camera")
    lens = None if camera is None else camera.find("intrinsic")
    if camera is None or lens is None or camera.find("fov_video") is not None:
        return False
    try:
        return float(lens.get("sensorMaxU", "inf")) < LARGEST_PX
    except ValueError:
        return False


def _camera(path: Path, element: ElementTree.Element) -> Camera:
    """Turn one <camera> into a camera.

    Lengths on the sensor are in 1/64 px. Distortion is OpenCV's, without a unit; Pose2Sim 0.10
    divides it by 64 too, which chessboard stills of its own demonstration contradict (k1 -0.04, not
    -0.0007).
    """
    name = element.get("serial", "without serial")
    where = f"{path}: camera {name}"
    # ASSUME: viewrotation turns the picture in QTM's windows only; the video file and these numbers
    # are those of the sensor as it is.
    turned = element.get("viewrotation", "0")
    if turned not in TURNS:
        raise InputError(
            f"{where}: expected viewrotation as one of {', '.join(TURNS)}, found "
            f"{camera_fields.short(turned)}; {camera_fields.EXPORT_AGAIN}"
        )
    left, top, right, bottom = xml_fields.attributes(
        where, element, "fov_video", "left top right bottom"
    )
    focal_u, focal_v, centre_u, centre_v, skew = xml_fields.attributes(
        where, element, "intrinsic", "focalLengthU focalLengthV centerPointU centerPointV skew"
    )
    # ASSUME: coordinate 0 is the first pixel's centre, as Pose2Sim takes it; were it that pixel's
    # corner, the principal point would move by half a pixel.
    matrix = np.array([[focal_u, skew, centre_u], [0, focal_v, centre_v], [0, 0, 0]])
    matrix = matrix / PER_PX - [[0, 0, left], [0, 0, top], [0, 0, -1]]
    dist = "radialDistortion1 radialDistortion2 tangentalDistortion1 tangentalDistortion2"
    place = xml_fields.attributes(
        where, element, "transform", "r11 r12 r13 r21 r22 r23 r31 r32 r33 x y z"
    )
    rotation = CAM_FROM_CAM @ place[:9].reshape(3, 3)
    table = {
        "size": (right - left + 1, bottom - top + 1),
        "matrix": matrix,
        "distortions": xml_fields.attributes(
            where, element, "intrinsic", f"{dist} radialDistortion3"
        ),
        "rotation": rotation,
        "translation": -rotation @ place[9:],
    }
    return camera_files.build(where, name, table, camera_fields.METRES["mm"])
