"""What can be said of calibrated cameras without the truth, and how wrong they are where it is known."""

import numpy as np
from scipy import special
from scipy.spatial.transform import Rotation

from courtside.calibration import point_covariance
from courtside.calibration.court import click_checks, joint_adjustment
from courtside.study.errors import InputError


def of_court(
    court, cameras, clicks, *, click_sigma_px, point_covariance=None, inwards=None, strict=True
):
    """Check cameras against the clicked court points, each left out in turn.

    Parameters
    ----------
    court : courtside.calibration.court.court.Court
    cameras : list of Camera
        In the court's frame.
    clicks : dict of str to (P, 2) float
        By camera; NaN where not clicked.
    click_sigma_px : float
        Of a good click, in the largest picture.
    point_covariance : callable, optional
        Covariance (N, 3, 3) m2 of points (N, 3) that these cameras triangulate.
    inwards : (float, float), optional
        As for `click_checks.find`.
    strict : bool
        Whether points that cannot be this court are an error; otherwise they are a warning.

    Returns
    -------
    quality : dict
        For a JSON file: `warnings`; `left_out`, by point: how far it is from its place (cm) and from each
        click (px) in a similarity fitted to the other points; `expected_volume_rms_cm` where the covariance
        is known.

    Raises
    ------
    InputError
        If the points cannot be this court.
    """
    table, each = _leave_one_out(court, cameras, clicks)
    try:
        warnings = click_checks.find(
            court, cameras, clicks, sigma_px=click_sigma_px, inwards=inwards, table=table
        )
    except InputError as error:
        if strict:
            raise
        warnings = [str(error)]
    quality = {"warnings": warnings, "left_out": each}
    if point_covariance is not None:
        covariance = point_covariance(volume(court))
        quality["expected_volume_rms_cm"] = _number(expected_rms_cm(covariance))
    return quality


def of_ties(court, ties, clicks, **weights):
    """Adjust the fixed cameras with the clicked court points, and check these against the result.

    Parameters
    ----------
    court : courtside.calibration.court.court.Court
    ties : courtside.calibration.court.joint_adjustment.Ties
    clicks : dict of str to (P, 2) float
        By camera; NaN where not clicked.
    **weights
        Of the clicks, as for `joint_adjustment.solve`.

    Returns
    -------
    solution : courtside.calibration.court.joint_adjustment.Solution
    quality : dict
        As `of_court` gives it.

    Raises
    ------
    InputError
        If the points cannot be this court.

    Notes
    -----
    A model of structure from motion is bent by what its ties leave open, mostly focal lengths: with 12 small
    pictures by 0.02 to 0.4 m at the court points, where clicks are 1 cm off. The adjustment takes off as much
    of the bend as the ties' own covariance allows: what is left is the fault of the clicks or the court.
    """
    solved = joint_adjustment.solve(ties, clicks, court, max_iterations=30, **weights)
    known = {
        "click_sigma_px": joint_adjustment.largest_click_sigma(
            weights["click_sigma_px"], solved.cameras
        ),
        "point_covariance": solved.point_covariance,
        "inwards": click_checks.shift(ties, clicks, court, **weights),
    }
    return solved, of_court(court, solved.cameras, clicks, **known)


def without_court(n_agreeing, n_maps):
    """Return the quality of cameras that no court scales: how many maps of the same images agree."""
    warnings = ["no court: scale and frame are arbitrary"]
    if n_agreeing == 1 < n_maps:
        warnings.append(
            f"walk: expected maps of its images to agree, found {n_maps} that all differ by more than 1 % of "
            "their extent: angles and proportions are that uncertain; take more bridging images, or name a "
            "court"
        )
    return {"warnings": warnings}


def left_out(court, cameras, clicks):
    """Return `left_out` of `of_court` alone: how well cameras put court points where they belong.

    Parameters
    ----------
    court, cameras, clicks
        As of `of_court`.
    """
    return _leave_one_out(court, cameras, clicks)[1]


def _leave_one_out(court, cameras, clicks):
    """Return the table, None where there is none, and the same or the reason by point, as JSON has it."""
    try:
        table = click_checks.leave_one_out(cameras, clicks, court)
    except InputError as error:
        return None, str(error)
    return table, _by_point(table)


def _by_point(table):
    return {
        point: {
            "error_cm": _number(table.error_cm[at]),
            "error_px": {c: _number(table.error_px[v, at]) for v, c in enumerate(table.cameras)},
        }
        for at, point in enumerate(table.points)
    }


def _number(value):
    """Return a float as JSON has it: rounded, null where it is none."""
    return round(float(value), 4) if np.isfinite(value) else None


HEIGHTS_M = (0.0, 1.0, 2.0, 3.0)
COLUMNS, ROWS = 5, 7  # of the grid, along the short and the long side
# Of chi-squared with three degrees of freedom; `scipy.stats` has it too, but takes half a second to import.
LIMITS = {level: 2 * special.gammaincinv(3 / 2, level) for level in (0.5, 0.9, 0.95)}


def volume(court, heights_m=HEIGHTS_M, columns=COLUMNS, rows=ROWS):
    """Return a grid of points over the court, (N, 3) m, height after height, row after row.

    Parameters
    ----------
    court : courtside.calibration.court.court.Court
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
    court : courtside.calibration.court.court.Court
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
    square = point_covariance.mahalanobis(error_m, covariance)
    shares = {
        f"coverage{100 * level:.0f}": np.mean(square <= limit) for level, limit in LIMITS.items()
    }
    return {**shares, "predicted_volume_cm": expected_rms_cm(covariance)}


def expected_rms_cm(covariance):
    """Return the root mean square length, cm, of errors with covariances (N, 3, 3) m2."""
    return 100 * np.sqrt(np.mean(np.trace(covariance, axis1=1, axis2=2)))
