"""How wrong calibrated cameras are, in the terms of the study: court points, playing volume, camera poses."""

import numpy as np
from scipy import special
from scipy.spatial.transform import Rotation

from courtside.geometry import uncertainty

HEIGHTS_M = (0.0, 1.0, 2.0, 3.0)
COLUMNS, ROWS = 5, 7  # of the grid, along the short and the long side
# Of chi-squared with three degrees of freedom; `scipy.stats` has it too, but takes half a second to import.
LIMITS = {level: 2 * special.gammaincinv(3 / 2, level) for level in (0.5, 0.9, 0.95)}


def volume(court, heights_m=HEIGHTS_M, columns=COLUMNS, rows=ROWS):
    """Return a grid of points over the court, (N, 3) m, height after height, row after row.

    Parameters
    ----------
    court : courtside.geometry.courts.Court
    heights_m : sequence of float
    columns, rows : int
        Points along the short and the long side, both ends included.
    """
    x = np.linspace(0, court.size_m[0], columns)
    y = np.linspace(0, court.size_m[1], rows)
    z, y, x = np.meshgrid(np.asarray(heights_m, dtype=float), y, x, indexing="ij")
    return np.stack([x, y, z], axis=-1).reshape(-1, 3)


def court_points(court, xyz):
    """Return the published errors: of the end of x and the end of y, cm.

    Parameters
    ----------
    court : courtside.geometry.courts.Court
    xyz : (P, 3) float
        Its points as reconstructed from clicks, m.

    Returns
    -------
    errors : dict of str to float
        `xo_cm`, `yo_cm`, and their mean `xy_cm`.
    """
    ends = court.indices("three")[1:]
    xo_cm, yo_cm = 100 * np.linalg.norm(xyz[ends] - court.xyz[ends], axis=1)
    return {"xo_cm": xo_cm, "yo_cm": yo_cm, "xy_cm": (xo_cm + yo_cm) / 2}


def poses(cameras, truth):
    """Return mean errors of the cameras themselves: position (cm), rotation (degrees), focal length (%).

    Parameters
    ----------
    cameras, truth : list of Camera
        In the same order.
    """
    place, turn, focal = [], [], []
    for found, true in zip(cameras, truth, strict=True):
        place.append(np.linalg.norm(found.centre_in_world - true.centre_in_world))
        between = found.cam_from_world[:, :3] @ true.cam_from_world[:, :3].T
        turn.append(np.degrees(Rotation.from_matrix(between).magnitude()))
        focal.append(abs(found.K[1, 1] / true.K[1, 1] - 1))
    return {
        "camera_position_cm": 100 * np.mean(place),
        "camera_rotation_deg": np.mean(turn),
        "focal_percent": 100 * np.mean(focal),
    }


def over_volume(error_m):
    """Return root mean square and 95 % quantile of displacements (N, 3) m, in cm."""
    distance = 100 * np.linalg.norm(error_m, axis=1)
    return {
        "volume_rms_cm": np.sqrt(np.mean(distance**2)),
        "volume_p95_cm": np.quantile(distance, 0.95),
    }


def coverage(error_m, covariance):
    """Return how often errors lie within the ellipsoids of their covariance, and the size expected.

    Parameters
    ----------
    error_m : (N, 3) float
    covariance : (N, 3, 3) float
        m2.

    Returns
    -------
    shares : dict of str to float
        `coverage50`, `coverage90`, `coverage95` in 0..1 and `predicted_volume_cm`, the expected root
        mean square.
    """
    square = uncertainty.mahalanobis(error_m, covariance)
    shares = {
        f"coverage{100 * level:.0f}": np.mean(square <= limit) for level, limit in LIMITS.items()
    }
    return {**shares, "predicted_volume_cm": expected_rms_cm(covariance)}


def expected_rms_cm(covariance):
    """Return the root mean square length, cm, of errors with covariances (N, 3, 3) m2."""
    return 100 * np.sqrt(np.mean(np.trace(covariance, axis1=1, axis2=2)))
