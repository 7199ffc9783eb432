"""Planned fixed cameras, the path of a planned walk, and the angles between its views."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

# ASSUME: how far a person who walks strays from the path (along x, y, z) and misses the aim, m, and
# turns the camera about its axis, degrees: standard deviations. It helps: without it the camera's
# tilt can hardly be separated from its principal point.
STRAY_M, MISS_M, ROLL_DEG = (0.25, 0.25, 0.05), (0.35, 0.35, 0.2), 0.3
STRAY_EVERY_M = 5.0  # ASSUME: of path between independent strays
FINE = 1000  # places to measure the path's length: centimetres apart on a walk round a court


def camera(
    name: str,
    place_m: Sequence[float] | NDArray,
    aim_m: Sequence[float] | NDArray,
    size_px: Sequence[int],
    *,
    focal_px: float | None = None,
    fov_deg: float | None = None,
    roll: float = 0.0,
) -> Camera:
    """Return a planned camera at a place (3,) m: no distortion, principal point in the middle.

    Either its focal length or its field of view across the width is given; `roll` turns it about
    its own axis, rad. Raises `InputError` if it looks straight up or down, or nowhere.
    """
    width, height = size_px
    if fov_deg is not None:
        focal_px = width / 2 / np.tan(np.radians(fov_deg) / 2)
    K = np.array([[focal_px, 0, (width - 1) / 2], [0, focal_px, (height - 1) / 2], [0, 0, 1]])
    forward = np.subtract(aim_m, place_m)
    if np.hypot(*forward[:2]) < 1e-3 * np.maximum(np.linalg.norm(forward), 1e-9):
        raise InputError(
            f"camera {name}: expected it to look sideways, found the aim {list(aim_m)} from "
            f"{list(place_m)}; move one of them"
        )
    pose = camera_models.look_at(place_m, aim_m, roll)
    return Camera(name, (int(width), int(height)), K, np.zeros(5), pose)


def places_on_path(points_m: ArrayLike, n_places: int, height_m: float) -> NDArray:
    """Return places (n_places, 3) m evenly spaced along a smooth path, both ends included.

    `points_m` (P, 2) are two or more on the floor.
    """
    fine, length_m = _measured(points_m)
    wanted_m = length_m[-1] * _shares(n_places)
    xy = [np.interp(wanted_m, length_m, column) for column in fine.T]
    return np.column_stack([*xy, np.full(n_places, float(height_m))])


def _measured(points_m: ArrayLike) -> tuple[NDArray, NDArray]:
    """Return `FINE` places along a smooth path through points, and how far along they are, m."""
    points_m = np.asarray(points_m, dtype=float)
    along = np.append(0, np.linalg.norm(np.diff(points_m, axis=0), axis=1).cumsum())
    fine = scipy.interpolate.CubicSpline(along, points_m)(np.linspace(0, along[-1], FINE))
    return fine, np.append(0, np.linalg.norm(np.diff(fine, axis=0), axis=1).cumsum())


def _shares(n_places: int) -> NDArray:
    return np.linspace(0, 1, n_places) if n_places != 1 else np.array([0.5])


def walked_cameras(
    way_m: ArrayLike,
    n_images: int,
    height_m: float,
    aim_m: ArrayLike,
    size_px: Sequence[int],
    *,
    seed: int,
    **lens: Any,
) -> list[Camera]:
    """Return the bridging images of a planned walk, in order, with the scatter of a person's aim.

    The way is as for `places_on_path`; `**lens` is `focal_px` or `fov_deg` of `camera`.
    """
    length_m = _measured(way_m)[1][-1]
    knots = np.linspace(0, 1, max(4, round(length_m / STRAY_EVERY_M) + 1))
    stray_m = STRAY_M * np.random.default_rng(seed).standard_normal((len(knots), 3))
    places = places_on_path(way_m, n_images, height_m) + scipy.interpolate.CubicSpline(
        knots, stray_m
    )(_shares(n_images))
    rng = np.random.default_rng([seed, n_images])
    aims = np.asarray(aim_m, dtype=float) + MISS_M * rng.standard_normal((n_images, 3))
    rolls = np.radians(ROLL_DEG) * rng.standard_normal(n_images)
    return [
        camera(f"walk{at}", place, aim, size_px, roll=roll, **lens)
        for at, (place, aim, roll) in enumerate(zip(places, aims, rolls, strict=True))
    ]


def path_order(centres: NDArray, fixed: NDArray) -> NDArray:
    """Return the order (V,) int in which a walk passes all images.

    Each fixed camera, `fixed` (V,) bool, stands where it lengthens the path least: before, within
    or behind the walk, whose optical centres are in order among `centres` (V, 3).
    """
    order = np.flatnonzero(~fixed).tolist()
    for camera in np.flatnonzero(fixed):
        near = np.linalg.norm(centres[order] - centres[camera], axis=1)
        steps = np.linalg.norm(np.diff(centres[order], axis=0), axis=1)
        longer = np.concatenate([near[:1], near[:-1] + near[1:] - steps, near[-1:]])
        order.insert(int(np.argmin(longer)) if order else 0, int(camera))
    return np.array(order, dtype=int)


def path_angles_deg(fixed: NDArray, centres: NDArray, point: ArrayLike) -> NDArray:
    """Return the angles (V - 1,) between neighbouring views, 0 to 180, as seen from a point (3,).

    Views have optical centres (V, 3) and are in their `path_order`; `fixed` (V,) bool tells which
    are of fixed cameras. Angles beside a centre that is NaN are NaN.
    """
    ray = centres[path_order(centres, fixed)] - np.asarray(point, dtype=float)
    cross = np.linalg.norm(np.cross(ray[:-1], ray[1:]), axis=1)
    return np.degrees(np.arctan2(cross, np.sum(ray[:-1] * ray[1:], axis=1)))
