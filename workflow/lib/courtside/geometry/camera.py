"""Pinhole cameras with lens distortion: projection, its inverse, and camera files."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import camera_fields, lens_fit, picture_size, rotations
from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution.files import atomic

OTHER_TABLES = ("metadata", "capture_volume", "charuco", "checkerboard")  # as Pose2Sim has it
TOLERANCE_PX = 1e-10  # of `undistort`: far below the noise of any keypoint, above rounding errors
MAX_ITERATIONS = 50  # ASSUME: enough for Newton's method; pixels not solved by then become NaN
ENTRIES = 2048  # radii tabulated for its start, which so lies within about 1 %
LEAST_SLOPE = 0.3  # ASSUME: no lens that is calibrated well shows its pictures' edges smaller
LONG_DIST = 9  # coefficients of a lens that no calibration here estimates
NEGLIGIBLE = 1e-30  # dividing by a coefficient this much smaller than the others overflows


@dataclass(frozen=True, eq=False)
class Camera:
    """A calibrated camera with OpenCV's five distortion coefficients; a true one may have more.

    Raises `ValueError` if a shape or value is impossible, or the rotation not orthonormal to 1e-6.
    """

    name: str
    size: tuple[int, int]  # width and height, px
    # (3, 3) px: focal lengths, principal point (the first pixel's centre is (0, 0)); no skew.
    K: NDArray
    # (5,): k1 k2 p1 p2 k3; or (9,), with s1 s2 s3 s4 of a thin prism, of true cameras alone.
    dist: NDArray
    cam_from_world: NDArray  # (3, 4): rotation, and translation in metres

    def __post_init__(self) -> None:
        n_dist = LONG_DIST if np.shape(self.dist) == (LONG_DIST,) else 5
        for field, shape in (("K", (3, 3)), ("dist", (n_dist,)), ("cam_from_world", (3, 4))):
            value = np.array(getattr(self, field), dtype=float)
            if value.shape != shape or not np.isfinite(value).all():
                found = camera_fields.short(value)
                raise ValueError(f"expected {field} as {shape} finite numbers, found {found}")
            value.setflags(write=False)
            object.__setattr__(self, field, value)
        object.__setattr__(self, "size", _whole(self.size))
        pinhole = np.diag([self.K[0, 0], self.K[1, 1], 1.0])
        pinhole[:2, 2] = self.K[:2, 2]
        if np.diag(self.K).min() <= 0 or not np.array_equal(self.K, pinhole):
            found = camera_fields.short(self.K)
            raise ValueError(f"expected a matrix of positive focal lengths, no skew, found {found}")
        rotation = self.cam_from_world[:, :3]
        if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-6 or np.linalg.det(rotation) < 0:
            raise ValueError(
                "expected a right-handed rotation matrix, orthonormal to 1e-6, found another matrix"
            )

    @property
    def centre_in_world(self) -> NDArray:
        """The projection centre, (3,) m."""
        return rotations.invert(self.cam_from_world)[:, 3]

    @cached_property
    def fold_radius(self) -> float:
        """Radius on the z = 1 plane where the lens model folds back; inf if it never does.

        Beyond it the lens model maps several directions to one pixel.
        """
        k1, k2, _, _, k3 = self.dist[:5]
        coefficients = np.array([7 * k3, 5 * k2, 3 * k1, 1.0])
        coefficients[np.abs(coefficients) < NEGLIGIBLE * np.abs(coefficients).max()] = 0.0
        squares = np.roots(coefficients)
        real = squares.real[(np.abs(squares.imag) < 1e-9 * np.abs(squares)) & (squares.real > 0)]
        return float(np.sqrt(real.min(initial=np.inf)))


def _whole(size: Sequence[float]) -> tuple[int, ...]:
    whole = tuple(int(length) for length in size)
    if len(whole) != 2 or min(whole) <= 0 or whole != tuple(size):
        raise ValueError(
            f"expected size as two positive whole px, found {camera_fields.short(size)}"
        )
    return whole


def plain(name: str, size: tuple[int, int], focal_share: float) -> Camera:
    """Return a camera at the origin without distortion; its principal point is the centre.

    `focal_share` is the focal length over the longer side of the picture.
    """
    (width, height), focal_px = size, focal_share * max(size)
    matrix = [[focal_px, 0, (width - 1) / 2], [0, focal_px, (height - 1) / 2], [0, 0, 1]]
    return Camera(name, size, np.array(matrix), np.zeros(5), np.eye(3, 4))


def look_at(place: ArrayLike, target: ArrayLike, roll: float = 0.0) -> NDArray:
    """Return cam_from_world (3, 4) of a camera at `place` (3,) m that looks at `target` (3,) m.

    At roll 0 the picture's x is horizontal; `roll`, radians, turns the camera about its optical
    axis, anticlockwise as it sees the world. It must not look straight up or down.
    """
    forward = np.subtract(target, place)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    upright = np.stack([right, np.cross(forward, right), forward])
    rotation = rotations.rotation_from_rodrigues([0, 0, roll]) @ upright
    return np.column_stack([rotation, -rotation @ np.asarray(place, dtype=float)])


def project(camera: Camera, xyz_in_world: ArrayLike) -> NDArray:
    """Project points (..., 3) m to distorted px (..., 2), not limited to the picture.

    NaN where the point is missing, behind the camera, or outside the fold radius of the lens model.
    """
    in_cam = np.asarray(xyz_in_world, dtype=float) @ camera.cam_from_world[:, :3].T
    in_cam = in_cam + camera.cam_from_world[:, 3]
    normalised = in_cam[..., :2] / np.where(in_cam[..., 2:] > 0, in_cam[..., 2:], np.nan)
    radius = np.hypot(normalised[..., :1], normalised[..., 1:])
    normalised = np.where(radius < camera.fold_radius, normalised, np.nan)
    return distort(camera.dist, normalised) * _focal(camera) + camera.K[:2, 2]


def turned(camera: Camera, vector: ArrayLike) -> Camera:
    """Return a camera turned in place by a rotation vector (3,), radians, in its own axes.

    The vector leads from the axes before to those after: a direction d of the camera becomes R d.
    """
    rotation = rotations.rotation_from_rodrigues(np.asarray(vector, dtype=float))
    return replace(camera, cam_from_world=rotation @ camera.cam_from_world)


def turned_back(camera: Camera, xy: ArrayLike, vector: ArrayLike) -> NDArray:
    """Return where a turned camera would have seen px (..., 2) before it was `turned`.

    `vector` (..., 3) may be one or one for each leading axis of `xy`; NaN outside the lens.
    """
    seen = undistort(camera, xy)
    directions = np.concatenate([seen, np.ones((*seen.shape[:-1], 1))], axis=-1)
    back = rotations.rotation_from_rodrigues(-np.asarray(vector, dtype=float))
    return project(replace(camera, cam_from_world=np.eye(3, 4)), directions @ back.mT)


def in_picture(camera: Camera, xy: NDArray) -> NDArray:
    """Say which px (..., 2) lie in the picture, (...) bool; NaN does not."""
    with np.errstate(invalid="ignore"):
        return np.all((xy >= -0.5) & (xy <= np.array(camera.size) - 0.5), axis=-1)


def undistort(camera: Camera, xy: ArrayLike) -> NDArray:
    """Return the viewing directions of distorted px (..., 2): the inverse of `project`.

    They lie on the z = 1 plane in front of the camera (..., 2), no unit. NaN where a pixel is
    missing, and where no direction below the fold maps to it.

    Newton's method from the inverse of the radial part, tabulated up to the fold: it neither
    diverges under strong distortion nor ends at a direction beyond the fold.
    """
    xy = np.asarray(xy, dtype=float)
    distorted = (np.where(np.isfinite(xy), xy, np.nan) - camera.K[:2, 2]) / _focal(camera)
    # Far from the centre, rounding errors exceed the tolerance that holds near the centre.
    tolerance = TOLERANCE_PX / _focal(camera).max() * (1 + np.abs(distorted).sum(axis=-1))
    dist, fold = camera.dist, camera.fold_radius
    normalised = _undistort_radially(dist, fold, distorted)
    for _ in range(MAX_ITERATIONS):
        error = distorted - distort(dist, normalised)
        solved = np.abs(error).max(axis=-1) <= tolerance
        a, b, d = _slopes(dist, normalised)
        determinant = a * d - b * b
        rising = determinant > 0
        if (solved | ~rising).all():
            break
        step = [d * error[..., 0] - b * error[..., 1], a * error[..., 1] - b * error[..., 0]]
        divisor = np.where(rising, determinant, np.nan)[..., np.newaxis]
        normalised = normalised + np.stack(step, axis=-1) / divisor
    found = solved & rising & (np.hypot(normalised[..., 0], normalised[..., 1]) < fold)
    return np.where(found[..., np.newaxis], normalised, np.nan)


def _focal(camera: Camera) -> NDArray:
    return np.diag(camera.K)[:2]


def crop(camera: Camera, crop_px: Sequence[int]) -> Camera:
    """Return the camera of a video that shows only a part of the calibrated picture.

    `crop_px` is x, y, width, height in px of that picture. The principal point shifts; nothing is
    scaled. Raises `InputError` if the part is not inside the calibrated picture.
    """
    x, y, width, height = crop_px
    outside = x + width > camera.size[0] or y + height > camera.size[1]
    if min(x, y) < 0 or min(width, height) <= 0 or outside:
        raise InputError(
            f"camera {camera.name}: expected crop_px [x, y, width, height] inside the calibrated "
            f"{camera_fields.times(camera.size)} px, found {list(crop_px)}; correct crop_px in the "
            "session file"
        )
    shift = np.zeros((3, 3))
    shift[:2, 2] = x, y
    return replace(camera, size=(width, height), K=camera.K - shift)


def scaled(camera: Camera, scale: float) -> Camera:
    """Return the camera of a video that is a scaled copy: `scale` video px per px of the camera's.

    Each axis is scaled by the ratio of its whole numbers of pixels, as programs scale pictures; the
    first pixel's centre stays at (0, 0), so that its corner stays at (-0.5, -0.5).
    """
    size = picture_size.scaled_size(camera.size, scale)
    by = np.array(size) / camera.size
    matrix = camera.K.copy()
    matrix[[0, 1], [0, 1]] *= by
    matrix[:2, 2] = (matrix[:2, 2] + 0.5) * by - 0.5
    return replace(camera, size=size, K=matrix)


def in_other_picture(camera: Camera, other: Camera, xy: ArrayLike) -> NDArray:
    """Return px (..., 2) of a camera's picture as px of another cut-out or copy of that picture."""
    by = _focal(other) / _focal(camera)
    return (np.asarray(xy, dtype=float) - camera.K[:2, 2]) * by + other.K[:2, 2]


def check_size(camera: Camera, video_size: tuple[int, int], video_path: StrPath) -> None:
    """Raise `InputError` unless a video has the (width, height) its camera was calibrated at."""
    if tuple(video_size) != camera.size:
        raise InputError(
            f"{video_path}: expected {camera_fields.times(camera.size)} px, the size that camera "
            f"{camera.name} was calibrated at, found {camera_fields.times(video_size)}; "
            f"{picture_size.advice(camera.size, video_size)}"
        )


def read_toml(path: StrPath) -> list[Camera]:
    """Read cameras, in metres, from a TOML file as this study, Pose2Sim and aniposelib write it.

    The file holds one table per camera with `name size matrix distortions rotation translation`, in
    the order of the result; `[metadata]` may hold `unit`, m where absent. Raises `InputError` if
    the file is not TOML or a camera is incomplete, impossible or named twice.
    """
    with reading(path, "TOML", camera_fields.EXPORT_AGAIN):
        tables = camera_fields.toml(Path(path).read_text(encoding="utf-8-sig"))
    metadata = tables.get("metadata", {})
    unit = metadata.get("unit", "m") if isinstance(metadata, dict) else metadata
    metres = camera_fields.unit_in_metres(path, unit)
    found = []
    for key, table in tables.items():
        if isinstance(table, dict) and key not in OTHER_TABLES:
            name = str(table.get("name", key))
            found.append(build(f"{path}: camera {name}", name, table, metres))
    return camera_fields.check_distinct(path, found)


def build(where: str, name: str, table: Mapping[str, Any], metres: float) -> Camera:
    """Build a camera from its table in a file; `where` begins error messages.

    The parsed table, of any types, holds `size matrix distortions rotation translation`, optionally
    `fisheye`; rotation as vector or matrix. `metres` is the unit of the translation. A lens of more
    than five coefficients, or a fisheye lens, becomes one of five if `lens_fit.five` can.
    """
    fisheye = bool(table.get("fisheye", False))
    size = camera_fields.numbers(where, "size", table.get("size"), (2,))
    matrix = camera_fields.numbers(where, "matrix", table.get("matrix"), (3, 3))
    dist = camera_fields.distortions(where, table.get("distortions"), fisheye=fisheye)
    other = fisheye or len(dist) > 5
    pose = camera_fields.pose(where, table.get("rotation"), table.get("translation"), metres)
    try:
        camera = Camera(name, size.tolist(), matrix, np.zeros(5) if other else dist, pose)
    except ValueError as error:
        raise InputError(f"{where}: {error}; {camera_fields.EXPORT_AGAIN}") from error
    if not other:
        return camera
    return replace(camera, dist=lens_fit.five(where, camera.size, matrix, dist, fisheye=fisheye))


def write_toml(path: StrPath, cameras: Sequence[Camera], *, source: str, unit: str = "m") -> None:
    """Write cameras so that `read_toml`, Pose2Sim and aniposelib read them.

    `source`, how the cameras were found, goes into `[metadata]`. `unit` is `camera_fields.UNSCALED`
    where lengths are not in metres: `read_toml` refuses such files.
    """
    camera_fields.check_distinct(path, cameras)
    digits = len(str(len(cameras) - 1))  # aniposelib sorts the tables by name
    content: dict[str, dict[str, object]] = {
        f"cam_{index:0{digits}}": {
            "name": camera.name,
            "size": list(camera.size),
            "matrix": camera.K.tolist(),
            "distortions": camera.dist.tolist(),
            "rotation": rotations.rodrigues_from_rotation(camera.cam_from_world[:, :3]).tolist(),
            "translation": camera.cam_from_world[:, 3].tolist(),
            "fisheye": False,
        }
        for index, camera in enumerate(cameras)
    }
    content["metadata"] = {"adjusted": False, "error": 0.0, "unit": unit, "source": source}
    with atomic(path) as temporary:
        temporary.write_text(tomli_w.dumps(content), encoding="utf-8", newline="\n")


def distort(dist: NDArray, normalised: NDArray) -> NDArray:
    """Return where a lens shows points (..., 2) of the plane z = 1 (Brown 1971, OpenCV's order).

    Nine coefficients end in those of a thin prism, s1 s2 s3 s4 (Weng, Cohen & Herniou 1992).
    """
    x, y = normalised[..., 0], normalised[..., 1]
    square, product = x * x + y * y, 2 * x * y
    p1, p2 = dist[2:4]
    radial = _radial(dist, square)
    seen = np.stack(
        [
            x * radial + p1 * product + p2 * (square + 2 * x * x),
            y * radial + p1 * (square + 2 * y * y) + p2 * product,
        ],
        axis=-1,
    )
    if len(dist) == LONG_DIST:
        s1, s2, s3, s4 = dist[5:]
        seen += np.stack([square * (s1 + square * s2), square * (s3 + square * s4)], axis=-1)
    return seen


def _slopes(dist: NDArray, normalised: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Return the three elements (...) of the symmetric derivative of `distort`.

    The prism of nine coefficients is left out: `undistort` then takes a few steps more.
    """
    x, y = normalised[..., 0], normalised[..., 1]
    square = x * x + y * y
    k1, k2, p1, p2, k3 = dist[:5]
    radial = _radial(dist, square)
    slope = 2 * (k1 + square * (2 * k2 + square * 3 * k3))  # of radial, over r
    mixed = x * y * slope + 2 * (p1 * x + p2 * y)
    along_x = radial + x * x * slope + 2 * p1 * y + 6 * p2 * x
    along_y = radial + y * y * slope + 6 * p1 * y + 2 * p2 * x
    return along_x, mixed, along_y


def picture_slopes(camera: Camera, normalised: NDArray) -> NDArray:
    """Return the derivative (..., 2, 2) px of places in the picture by undistorted ones (..., 2).

    These lie on the z = 1 plane. In no direction is it less than `LEAST_SLOPE` focal lengths, for
    at the fold of a lens model, where it is 0, any place would agree with a keypoint.
    """
    along_x, mixed, along_y = _slopes(camera.dist, normalised)
    lens = _matrices(along_x, mixed, along_y)
    least = (along_x + along_y) / 2 - np.hypot((along_x - along_y) / 2, mixed)
    if (flat := least < LEAST_SLOPE).any():
        slopes, axes = np.linalg.eigh(lens[flat])
        lens[flat] = axes * np.maximum(slopes, LEAST_SLOPE)[:, None] @ axes.mT
    return _focal(camera)[:, None] * lens


def jacobian_by_place(dist: NDArray, normalised: NDArray, depth: NDArray) -> NDArray:
    """Return the derivative (..., 2, 3) of distorted points with respect to camera coordinates.

    `normalised` (..., 2) lies on the z = 1 plane. `depth` (..., 1) is along the camera's axis; the
    derivative is per unit of it.
    """
    pinhole = np.zeros((*normalised.shape, 3))
    pinhole[..., 0, 0] = pinhole[..., 1, 1] = 1.0
    pinhole[..., 2] = -normalised
    return _matrices(*_slopes(dist, normalised)) @ pinhole / depth[..., np.newaxis]


def _matrices(along_x: NDArray, mixed: NDArray, along_y: NDArray) -> NDArray:
    """Return symmetric matrices (..., 2, 2) of their elements (...)."""
    return np.stack([along_x, mixed, mixed, along_y], axis=-1).reshape(*mixed.shape, 2, 2)


def _radial(dist: NDArray, square: Any) -> Any:  # a float for a float, else an array
    return 1 + square * (dist[0] + square * (dist[1] + square * dist[4]))


def _undistort_radially(dist: NDArray, fold: float, distorted: NDArray) -> NDArray:
    """Undo the radial part to about 1 %: the start for Newton's method."""
    radius = np.hypot(distorted[..., 0], distorted[..., 1])
    farthest = np.nan_to_num(radius).max(initial=1.0)
    limit = 1.0
    while limit < fold and limit * _radial(dist, limit**2) < farthest:
        limit *= 2
    radii = np.geomspace(1e-3, min(limit, fold), ENTRIES)
    seen = radii * _radial(dist, radii**2)
    # The entry below: the slope falls towards the fold, so that steps from below do not cross it.
    below = np.maximum(np.searchsorted(seen, radius) - 1, 0)
    return distorted / _radial(dist, radii[below] ** 2)[..., np.newaxis]
