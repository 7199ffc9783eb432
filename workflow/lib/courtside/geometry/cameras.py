"""A calibrated camera: its model, projection both ways, and the TOML file that rules hand on."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import tomli_w

from courtside.geometry import distortion, fields, transforms
from courtside.study.errors import InputError, reading
from courtside.study.files import atomic

OTHER_TABLES = ("metadata", "capture_volume", "charuco", "checkerboard")  # as Pose2Sim has it
TOLERANCE_PX = 1e-10


@dataclass(frozen=True, eq=False)
class Camera:
    """One calibrated view, with OpenCV's model of five distortion coefficients.

    Attributes
    ----------
    name : str
    size : (int, int)
        Width and height, px.
    K : (3, 3) float
        Focal lengths and principal point, px, with the first pixel's centre at (0, 0); no skew.
    dist : (5,) float
        k1 k2 p1 p2 k3.
    cam_from_world : (3, 4) float
        Rotation, and translation in metres.

    Raises
    ------
    ValueError
        If a shape or value is impossible, or the rotation is none within 1e-6.
    """

    name: str
    size: tuple
    K: np.ndarray
    dist: np.ndarray
    cam_from_world: np.ndarray

    def __post_init__(self):
        for field, shape in (("K", (3, 3)), ("dist", (5,)), ("cam_from_world", (3, 4))):
            value = np.array(getattr(self, field), dtype=float)
            if value.shape != shape or not np.isfinite(value).all():
                raise ValueError(
                    f"expected {field} as {shape} finite numbers, found {fields.short(value)}"
                )
            value.setflags(write=False)
            object.__setattr__(self, field, value)
        object.__setattr__(self, "size", _whole(self.size))
        pinhole = np.diag([self.K[0, 0], self.K[1, 1], 1.0])
        pinhole[:2, 2] = self.K[:2, 2]
        if np.diag(self.K).min() <= 0 or not np.array_equal(self.K, pinhole):
            found = fields.short(self.K)
            raise ValueError(f"expected a matrix of positive focal lengths, no skew, found {found}")
        rotation = self.cam_from_world[:, :3]
        if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-6 or np.linalg.det(rotation) < 0:
            raise ValueError("expected an orthonormal, right-handed rotation, found another matrix")

    @property
    def centre_in_world(self):
        """The projection centre, (3,) m."""
        return transforms.invert(self.cam_from_world)[:, 3]

    @cached_property
    def fold_radius(self):
        """Radius on the z = 1 plane from where the lens model shows nothing new; inf if there is none."""
        return distortion.fold_radius(self.dist)


def _whole(size):
    whole = tuple(int(length) for length in size)
    if len(whole) != 2 or min(whole) <= 0 or whole != tuple(size):
        raise ValueError(f"expected size as two positive whole px, found {fields.short(size)}")
    return whole


def project(camera, xyz_in_world):
    """Project points into the picture.

    Parameters
    ----------
    camera : Camera
    xyz_in_world : (..., 3) float
        Metres; NaN where missing.

    Returns
    -------
    xy : (..., 2) float
        Distorted px, not limited to the picture; NaN where the point is missing, behind the camera,
        or so far aside that the lens model folds back.
    """
    normalised, _ = _normalise(camera, xyz_in_world)
    return distortion.distort(camera.dist, normalised) * _focal(camera) + camera.K[:2, 2]


def projection_jacobian(camera, xyz_in_world):
    """Return the derivative of `project`, distortion included.

    Parameters
    ----------
    camera : Camera
    xyz_in_world : (..., 3) float
        Metres.

    Returns
    -------
    jacobian : (..., 2, 3) float
        d(x, y) / d(x, y, z), px per metre; NaN where `project` gives NaN.
    """
    normalised, depth = _normalise(camera, xyz_in_world)
    in_cam = distortion.jacobian_by_place(camera.dist, normalised, depth)
    return _focal(camera)[:, np.newaxis] * (in_cam @ camera.cam_from_world[:, :3])


def undistort(camera, xy):
    """Find the directions that pixels look along: the inverse of `project`.

    Parameters
    ----------
    camera : Camera
    xy : (..., 2) float
        Distorted px; NaN where missing.

    Returns
    -------
    xy_normalised : (..., 2) float
        On the z = 1 plane in front of the camera, no unit; NaN where missing, and where the lens
        model shows no direction at that pixel.
    """
    xy = np.asarray(xy, dtype=float)
    distorted = (np.where(np.isfinite(xy), xy, np.nan) - camera.K[:2, 2]) / _focal(camera)
    # Of a far-off pixel even the last digit is more than the tolerance near the centre.
    tolerance = TOLERANCE_PX / _focal(camera).max() * (1 + np.abs(distorted).sum(axis=-1))
    return distortion.undistort(camera.dist, camera.fold_radius, distorted, tolerance)


def _focal(camera):
    return np.diag(camera.K)[:2]


def _normalise(camera, xyz_in_world):
    """Return points on the z = 1 plane (..., 2) and their depths (..., 1), NaN where not visible."""
    in_cam = np.asarray(xyz_in_world, dtype=float) @ camera.cam_from_world[:, :3].T
    in_cam = in_cam + camera.cam_from_world[:, 3]
    depth = np.where(in_cam[..., 2:] > 0, in_cam[..., 2:], np.nan)
    normalised = in_cam[..., :2] / depth
    radius = np.hypot(normalised[..., :1], normalised[..., 1:])
    return np.where(radius < camera.fold_radius, normalised, np.nan), depth


def crop(camera, crop_px):
    """Return the camera of a video that shows only a part of the calibrated picture.

    Parameters
    ----------
    camera : Camera
    crop_px : (x, y, width, height) of int
        In px of the calibrated picture.

    Returns
    -------
    camera : Camera, with that size and a shifted principal point; nothing is scaled.

    Raises
    ------
    InputError
        If the part is not inside the calibrated picture.
    """
    x, y, width, height = crop_px
    outside = x + width > camera.size[0] or y + height > camera.size[1]
    if min(x, y) < 0 or min(width, height) <= 0 or outside:
        raise InputError(
            f"camera {camera.name}: expected crop_px [x, y, width, height] inside the calibrated "
            f"{fields.times(camera.size)} px, found {list(crop_px)}; correct crop_px in the session file"
        )
    shift = np.zeros((3, 3))
    shift[:2, 2] = x, y
    return replace(camera, size=(width, height), K=camera.K - shift)


def check_size(camera, video_size, video_path):
    """Raise `InputError` unless a video has the size its camera was calibrated at.

    Parameters
    ----------
    camera : Camera
    video_size : (int, int)
        Width and height, px.
    video_path : str or Path
    """
    if tuple(video_size) != camera.size:
        raise InputError(
            f"{video_path}: expected {fields.times(camera.size)} px, the size that camera {camera.name} was "
            f"calibrated at, found {fields.times(video_size)}; declare `crop_px: [x, y, width, height]` for "
            "this camera in the session file if the video is a cut-out of the calibrated picture, "
            "else calibrate at the video's size"
        )


def read_toml(path):
    """Read cameras from a TOML file as this study, Pose2Sim and aniposelib write it.

    Parameters
    ----------
    path : str or Path
        One table per camera with `name size matrix distortions rotation translation`; `[metadata]`
        may hold `unit`: m (where absent), cm or mm.

    Returns
    -------
    cameras : list of Camera
        In the file's order, in metres.

    Raises
    ------
    InputError
        If the file is not TOML or a camera is incomplete, impossible or named twice.
    """
    with reading(path, "TOML", fields.EXPORT_AGAIN):
        tables = fields.toml(Path(path).read_text(encoding="utf-8-sig"))
    metadata = tables.get("metadata", {})
    unit = metadata.get("unit", "m") if isinstance(metadata, dict) else metadata
    metres = fields.unit_in_metres(path, unit)
    found = []
    for key, table in tables.items():
        if isinstance(table, dict) and key not in OTHER_TABLES:
            name = str(table.get("name", key))
            found.append(build(f"{path}: camera {name}", name, table, metres))
    return fields.check_distinct(path, found)


def build(where, name, table, metres):
    """Make a camera of a table as a file holds it; `where` begins messages.

    Parameters
    ----------
    where, name : str
    table : dict
        `size matrix distortions rotation translation` and perhaps `fisheye`, rotation as vector or matrix.
    metres : float
        Unit of the translation.
    """
    if table.get("fisheye", False):
        raise InputError(
            f"{where}: expected a lens with distortions k1 k2 p1 p2 k3, found fisheye = true; "
            "calibrate with the standard lens model"
        )
    size = fields.numbers(where, "size", table.get("size"), (2,))
    matrix = fields.numbers(where, "matrix", table.get("matrix"), (3, 3))
    dist = fields.five_coefficients(where, table.get("distortions"))
    pose = fields.pose(where, table.get("rotation"), table.get("translation"), metres)
    try:
        return Camera(name, size.tolist(), matrix, dist, pose)
    except ValueError as error:
        raise InputError(f"{where}: {error}; {fields.EXPORT_AGAIN}") from error


def write_toml(path, cameras, *, source, unit="m"):
    """Write cameras so that `read_toml`, Pose2Sim and aniposelib read them.

    Parameters
    ----------
    path : str or Path
    cameras : list of Camera
    source : str
        How they were found; kept in `[metadata]`.
    unit : str
        `fields.UNSCALED` where lengths are not in metres: such files are refused by `read_toml`.
    """
    fields.check_distinct(path, cameras)
    digits = len(str(len(cameras) - 1))  # aniposelib sorts the tables by name
    content = {
        f"cam_{index:0{digits}}": {
            "name": camera.name,
            "size": list(camera.size),
            "matrix": camera.K.tolist(),
            "distortions": camera.dist.tolist(),
            "rotation": transforms.rodrigues_from_rotation(camera.cam_from_world[:, :3]).tolist(),
            "translation": camera.cam_from_world[:, 3].tolist(),
            "fisheye": False,
        }
        for index, camera in enumerate(cameras)
    }
    content["metadata"] = {"adjusted": False, "error": 0.0, "unit": unit, "source": source}
    with atomic(path) as temporary:
        temporary.write_text(tomli_w.dumps(content), encoding="utf-8")
