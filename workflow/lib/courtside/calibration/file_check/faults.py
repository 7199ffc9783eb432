"""What usually goes wrong with a calibration file, and how the cameras look without it.

A `Fault` names what may be wrong with the numbers of a camera and holds the cameras mended. These
faults have no free number: a mirrored coordinate, exchanged cameras, another picture size, a turned
picture. `fitted` holds those with free numbers: focal length, direction, place.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry.camera import Camera, project, turned

# ASSUME: the ratios between sizes that cameras record and programs work with.
SCALES = (1 / 2, 2 / 3, 3 / 4, 4 / 3, 3 / 2, 2)
LEAST_MIRRORED_PX = 3.0  # ASSUME: a coordinate nearer to the middle looks the same mirrored
LARGEST_FOCAL = 1.0  # ASSUME: no focal length is off by more than a factor of e


@dataclass(frozen=True)
class Fault:
    """One thing that may be wrong, and the cameras without it."""

    what: str  # of which camera what
    advice: str
    names: tuple[str, ...]  # of the cameras that it is a fault of
    cameras: tuple[Camera, ...]  # all of them, mended
    n_free: int = 0  # numbers that were fitted


def simple(cameras: Sequence[Camera]) -> Iterator[Fault]:
    """Yield the faults without free numbers that one camera or a pair may have."""
    for at, camera in enumerate(cameras):
        for axis in (0, 1):
            yield from mirrored(cameras, at, axis)
        for turns in (1, 2, 3):
            what = f"the picture of camera {camera.name} is turned by {90 * turns} degrees"
            advice = "calibrate with pictures turned as the videos are, or turn the videos"
            mended = turned_picture(camera, turns)
            yield Fault(what, advice, (camera.name,), _put(cameras, at, mended))
        for scale in SCALES:
            what = f"camera {camera.name} was calibrated at {1 / scale:.3g} times the picture size"
            advice = "export the calibration at the size of the videos"
            mended = scaled_picture(camera, scale)
            yield Fault(what, advice, (camera.name,), _put(cameras, at, mended))
    for one, other in combinations(range(len(cameras)), 2):
        yield _exchanged(cameras, one, other)


def mirrored(cameras: Sequence[Camera], at: int, axis: int) -> Iterator[Fault]:
    """Yield the fault of a principal point mirrored in x (axis 0) or y (1) if it would show."""
    camera, letter = cameras[at], "xy"[axis]
    mended = mirrored_point(camera, axis)
    old, new = camera.K[axis, 2], mended.K[axis, 2]
    if abs(new - old) >= LEAST_MIRRORED_PX:
        what = f"the principal point of camera {camera.name} is mirrored in {letter}"
        last = camera.size[axis] - 1
        advice = f"principal_point_px: {letter} {old:.1f} should be {last} - {old:.1f} = {new:.1f}"
        yield Fault(what, advice, (camera.name,), _put(cameras, at, mended))


def _exchanged(cameras: Sequence[Camera], one: int, other: int) -> Fault:
    swapped = list(cameras)
    for a, b in ((one, other), (other, one)):
        swapped[a] = replace(cameras[b], name=cameras[a].name, size=cameras[a].size)
    names = cameras[one].name, cameras[other].name
    what = f"cameras {' and '.join(names)} are exchanged"
    return Fault(what, "exchange their names or their videos", names, tuple(swapped))


def _put(cameras: Sequence[Camera], at: int, mended: Camera) -> tuple[Camera, ...]:
    return (*cameras[:at], mended, *cameras[at + 1 :])


def mirrored_point(camera: Camera, axis: int) -> Camera:
    """Return a camera whose principal point is mirrored in x (axis 0) or y (1)."""
    matrix = camera.K.copy()
    matrix[axis, 2] = camera.size[axis] - 1 - matrix[axis, 2]
    return replace(camera, K=matrix)


def scaled_picture(camera: Camera, scale: float) -> Camera:
    """Return a camera whose numbers are of a picture `scale` times as large."""
    matrix = camera.K.copy()
    matrix[:2, :2] *= scale
    matrix[:2, 2] = (matrix[:2, 2] + 0.5) * scale - 0.5
    return replace(camera, K=matrix)


def turned_picture(camera: Camera, turns: int) -> Camera:
    """Return a camera whose picture is turned by so many quarter turns, of unchanged size.

    A quarter turn shows a point (x, y) at (width - 1 - y, x), the width being the new picture's.
    The size stated in the file is kept.
    """
    for _ in range(turns % 4):
        quarter = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        (fx, fy), (cx, cy) = np.diag(camera.K)[:2], camera.K[:2, 2]
        # Numbers of a picture whose height is the stated width.
        matrix = np.array([[fy, 0, camera.size[0] - 1 - cy], [0, fx, cx], [0, 0, 1]])
        k1, k2, p1, p2, k3 = camera.dist
        camera = replace(
            camera,
            K=matrix,
            dist=np.array([k1, k2, p2, -p1, k3]),
            cam_from_world=quarter @ camera.cam_from_world,
            size=(camera.size[1], camera.size[0]),
        )
    width, height = camera.size
    return camera if turns % 2 == 0 else replace(camera, size=(height, width))


@dataclass(frozen=True)
class Way:
    """Numbers of a camera that may be wrong together."""

    n_free: int
    name: str
    advice: str
    change: Callable[[Camera, NDArray], Camera]  # the camera changed by so many numbers


def fitted(
    cameras: Sequence[Camera], at: int, xyz: NDArray, xy: NDArray, ways: Sequence[Way]
) -> Iterator[Fault]:
    """Yield the faults with free numbers that camera number `at` may have, fitted.

    `xyz` (N, 3) are points that the other cameras see, `xy` (N, 2) px this camera's views of them.
    """
    camera = cameras[at]
    seen = np.isfinite(xyz).all(axis=-1) & np.isfinite(xy).all(axis=-1)
    for way in ways:
        if seen.sum() * 2 < way.n_free + 4:
            continue
        mended = fit(camera, xyz[seen], xy[seen], way)
        what = f"the {way.name} of camera {camera.name}"
        are = "are" if " and " in way.name else "is"
        what += f" is {_percent(camera, mended)}" if way.n_free == 1 else f" {are} wrong"
        yield Fault(what, way.advice, (camera.name,), _put(cameras, at, mended), way.n_free)


def _percent(camera: Camera, mended: Camera) -> str:
    off = 100 * (camera.K[0, 0] / mended.K[0, 0] - 1)
    return f"{abs(off):.1f} % too {'long' if off > 0 else 'short'}"


def fit(camera: Camera, xyz: NDArray, xy: NDArray, way: Way) -> Camera:
    """Fit the numbers of a camera to views (N, 2) px of points (N, 3); some may be outliers."""

    def residuals(free: NDArray) -> NDArray:
        return np.nan_to_num(project(way.change(camera, free), xyz) - xy, nan=1e3).ravel()

    start = np.zeros(way.n_free)
    scale_px = max(float(np.median(np.abs(residuals(start)))) / 3, 1.0)
    found = scipy.optimize.least_squares(
        residuals, start, loss="soft_l1", f_scale=scale_px, max_nfev=30
    )
    return way.change(camera, found.x)


def _focal(camera: Camera, free: NDArray) -> Camera:
    matrix = camera.K.copy()
    matrix[[0, 1], [0, 1]] *= np.exp(np.clip(free[0], -LARGEST_FOCAL, LARGEST_FOCAL))
    return replace(camera, K=matrix)


def _moved(camera: Camera, free: NDArray) -> Camera:
    moved = turned(camera, free[:3])
    pose = moved.cam_from_world.copy()
    pose[:, 3] += free[3:]
    return replace(camera, cam_from_world=pose)


def _turned_zoomed(camera: Camera, free: NDArray) -> Camera:
    return _focal(turned(camera, free[:3]), free[3:])


def _lens(camera: Camera, free: NDArray) -> Camera:
    dist = camera.dist.copy()
    dist[0] += free[1]
    return replace(_focal(camera, free), dist=dist)


FOCAL = Way(1, "focal length", "calibrate its lens again", _focal)
TURNED = Way(3, "direction or principal point", "calibrate it again: it was turned", turned)
ZOOMED = Way(
    4, "direction and focal length", "calibrate it again: it was turned and zoomed", _turned_zoomed
)
MOVED = Way(6, "place and direction", "calibrate it again: it was moved", _moved)
LENS = Way(2, "focal length and distortion", "calibrate its lens again", _lens)
