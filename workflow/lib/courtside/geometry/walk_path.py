"""The path of a walk past the fixed cameras: its order, and the angles between neighbouring views."""

import numpy as np


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
