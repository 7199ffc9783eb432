"""Planned fixed cameras and the path of a planned walk, with the angles between its views."""

import numpy as np
from scipy.interpolate import CubicSpline

from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

# ASSUME: how far a person who walks strays from the way (along x, y, z) and misses the aim, m, and turns the
# camera about its axis, degrees: standard deviations. It helps: without it the camera's tilt is hardly told
# from its principal point.
STRAY_M, MISS_M, ROLL_DEG = (0.25, 0.25, 0.05), (0.35, 0.35, 0.2), 0.3
STRAY_EVERY_M = 5.0  # slowly
FINE = 1000  # places by which the way is measured


def camera(name, place_m, aim_m, size_px, *, focal_px=None, fov_deg=None, roll=0.0):
    """Return a planned camera: no distortion, principal point in the middle.

    Parameters
    ----------
    name : str
    place_m, aim_m : (3,) float
        World, m.
    size_px : (int, int)
        Width and height.
    focal_px, fov_deg : float, optional
        One of them: focal length, or field of view across the width.
    roll : float
        Its turn about its own axis, rad.

    Returns
    -------
    camera : Camera

    Raises
    ------
    ValueError
        If none or both of focal length and field of view are given.
    InputError
        If it looks straight up or down, or nowhere.
    """
    if (focal_px is None) == (fov_deg is None):
        raise ValueError("expected one of focal_px and fov_deg")
    width, height = size_px
    focal_px = focal_px or width / 2 / np.tan(np.radians(fov_deg) / 2)
    K = np.array([[focal_px, 0, (width - 1) / 2], [0, focal_px, (height - 1) / 2], [0, 0, 1]])
    forward = np.subtract(aim_m, place_m).astype(float)
    if np.hypot(*forward[:2]) < 1e-3 * max(np.linalg.norm(forward), 1e-9):
        raise InputError(
            f"camera {name}: expected it to look sideways, found the aim {list(aim_m)} from {list(place_m)}; "
            "move one of them"
        )
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    upright = np.stack([right, np.cross(forward, right), forward])
    rotation = rotations.rotation_from_rodrigues([0, 0, roll]) @ upright
    pose = np.column_stack([rotation, -rotation @ np.asarray(place_m, dtype=float)])
    return Camera(name, (int(width), int(height)), K, np.zeros(5), pose)


def on_way(points_m, n_places, height_m):
    """Return places evenly spaced along a smooth way through points, both ends included.

    Parameters
    ----------
    points_m : (P, 2) float
        On the floor, m; two or more.
    n_places : int
    height_m : float

    Returns
    -------
    places_m : (n_places, 3) float
    """
    fine, length_m = _measured(points_m)
    wanted_m = length_m[-1] * _shares(n_places)
    xy = [np.interp(wanted_m, length_m, column) for column in fine.T]
    return np.column_stack([*xy, np.full(n_places, float(height_m))])


def _measured(points_m):
    """Return places close by each other along a smooth way through points, and how far along they are, m."""
    points_m = np.asarray(points_m, dtype=float)
    along = np.append(0, np.linalg.norm(np.diff(points_m, axis=0), axis=1).cumsum())
    fine = CubicSpline(along, points_m)(np.linspace(0, along[-1], FINE))
    return fine, np.append(0, np.linalg.norm(np.diff(fine, axis=0), axis=1).cumsum())


def _shares(n_places):
    return np.linspace(0, 1, n_places) if n_places != 1 else np.array([0.5])


def walked_cameras(way_m, n_images, height_m, aim_m, size_px, *, seed, **lens):
    """Return the bridging images of a planned walk, as a person takes them.

    Parameters
    ----------
    way_m, n_images, height_m
        As for `on_way`.
    aim_m : (3,) float
        What the camera is aimed at.
    size_px : (int, int)
    seed : int
    **lens
        `focal_px` or `fov_deg` of `camera`.

    Returns
    -------
    walked : list of Camera
        In order.
    """
    rng = np.random.default_rng([seed, n_images])
    length_m = _measured(way_m)[1][-1]
    knots = np.linspace(0, 1, max(4, round(length_m / STRAY_EVERY_M) + 1))
    stray_m = STRAY_M * np.random.default_rng(seed).standard_normal((len(knots), 3))
    places = on_way(way_m, n_images, height_m) + CubicSpline(knots, stray_m)(_shares(n_images))
    rng = np.random.default_rng([seed, n_images])
    aims = np.asarray(aim_m, dtype=float) + MISS_M * rng.standard_normal((n_images, 3))
    rolls = np.radians(ROLL_DEG) * rng.standard_normal(n_images)
    return [
        camera(f"walk{at}", place, aim, size_px, roll=roll, **lens)
        for at, (place, aim, roll) in enumerate(zip(places, aims, rolls, strict=True))
    ]


def neighbour_angles_deg(centres, point):
    """Measure the angles between neighbouring views, as seen from a point.

    Parameters
    ----------
    centres : (V, 3) float
        Optical centres in order along the path, the fixed cameras at its ends included; metres.
    point : (3,) float
        Where the angles are measured: for the study the court's centre, 1 m high.

    Returns
    -------
    angle_deg : (V - 1,) float
        Between 0 and 180; NaN beside a centre that is NaN.
    """
    ray = np.asarray(centres, dtype=float) - np.asarray(point, dtype=float)
    cross = np.linalg.norm(np.cross(ray[:-1], ray[1:]), axis=1)
    return np.degrees(np.arctan2(cross, np.sum(ray[:-1] * ray[1:], axis=1)))


def path_order(centres, fixed):
    """Put fixed cameras where a walk passes them.

    Parameters
    ----------
    centres : (V, 3) float
        Optical centres, those of the walk in order.
    fixed : (V,) bool
        Which are fixed cameras.

    Returns
    -------
    order : (V,) int
        Each fixed camera stands where it lengthens the path least: before, within or behind the walk.
    """
    order = np.flatnonzero(~fixed).tolist()
    for camera in np.flatnonzero(fixed):
        near = np.linalg.norm(centres[order] - centres[camera], axis=1)
        steps = np.linalg.norm(np.diff(centres[order], axis=0), axis=1)
        longer = np.concatenate([near[:1], near[:-1] + near[1:] - steps, near[-1:]])
        order.insert(int(np.argmin(longer)) if order else 0, int(camera))
    return np.array(order, dtype=int)


def path_angles_deg(fixed, centres, point):
    """Return `neighbour_angles_deg` of registered images, fixed cameras put where the walk passes them.

    Parameters
    ----------
    fixed : (V,) bool
        Which of the images are of fixed cameras.
    centres : (V, 3) float
    point : (3,) float
    """
    order = path_order(centres, fixed)
    return neighbour_angles_deg(centres[order], point)
