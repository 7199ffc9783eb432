"""A camera moved a little so that the lines of a court lie where they are seen."""

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from courtside.geometry import camera as cameras
from courtside.geometry import rotations

# How far a camera from two or three clicks is off, standard deviation: rad, m, relative, of k1.
KNOWN = np.array([0.01] * 3 + [0.15] * 3 + [0.01] + [0.01])
FLOOR_PX = 0.3  # painted lines are some mm from where the court's model has them
PARAMETERS = ("rx", "ry", "rz", "x", "y", "z", "log_f", "k1")


def moved(camera, change):
    """Return a camera turned, moved, zoomed and with another k1.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
    change : (8,) float
        `PARAMETERS`: rotation about its own axes (rad), of its centre along them (m), relative focal length
        (natural logarithm), and what is added to k1.
    """
    turn = rotations.rotation_from_rodrigues(change[:3])
    rotation = turn @ camera.cam_from_world[:, :3]
    shift = turn @ (camera.cam_from_world[:, 3] - change[3:6])
    K = camera.K.copy()
    K[[0, 1], [0, 1]] *= np.exp(change[6])
    dist = camera.dist.copy()
    dist[0] += change[7]
    return replace(camera, K=K, dist=dist, cam_from_world=np.column_stack([rotation, shift]))


def refine(camera, xyz, normal, offset_px, sigma_px):
    """Move a camera so that points of lines appear shifted across these lines as was seen.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
        As far as it is known; remains near by where the lines do not say otherwise.
    xyz : (M, 3) float
        On lines, metres.
    normal : (M, 2) float
        Across the lines in the picture, unit length.
    offset_px : (M,) float
        Along the normal, from where the camera expects the line to where it is seen.
    sigma_px : (M,) float
        Standard deviation of that.

    Returns
    -------
    camera : courtside.geometry.camera.Camera
    rest_px : (M,) float
        What remains of the offsets.
    """
    start = cameras.project(camera, xyz)
    sigma = np.hypot(sigma_px, FLOOR_PX)

    def rest(change):
        shift = np.sum((cameras.project(moved(camera, change), xyz) - start) * normal, axis=1)
        return np.nan_to_num(offset_px - shift, nan=1e3)

    def residuals(scaled):
        return np.concatenate([rest(scaled * KNOWN) / sigma, scaled])

    found = least_squares(residuals, np.zeros(len(KNOWN)), loss="cauchy", f_scale=2.0, x_scale=1.0)
    return moved(camera, found.x * KNOWN), rest(found.x * KNOWN)
