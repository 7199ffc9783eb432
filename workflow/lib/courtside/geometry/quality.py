"""What can be said of calibrated cameras without knowing the truth."""

import numpy as np

from courtside.geometry import click_faults, court_errors
from courtside.study.errors import InputError


def of_court(
    court, cameras, clicks, *, click_sigma_px, point_covariance=None, inwards=None, strict=True
):
    """Check cameras against the clicked court points, each left out in turn.

    Parameters
    ----------
    court : courtside.geometry.courts.Court
    cameras : list of Camera
        In the court's frame.
    clicks : dict of str to (P, 2) float
        By camera; NaN where not clicked.
    click_sigma_px : float
        Of a good click, in the largest picture.
    point_covariance : callable, optional
        Covariance (N, 3, 3) m2 of points (N, 3) that these cameras triangulate.
    inwards : (float, float), optional
        As for `click_faults.find`.
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
    try:
        table = click_faults.leave_one_out(cameras, clicks, court)
        left_out = _by_point(table)
    except InputError as error:
        table, left_out = None, str(error)
    try:
        warnings = click_faults.find(
            court, cameras, clicks, sigma_px=click_sigma_px, inwards=inwards, table=table
        )
    except InputError as error:
        if strict:
            raise
        warnings = [str(error)]
    quality = {"warnings": warnings, "left_out": left_out}
    if point_covariance is not None:
        covariance = point_covariance(court_errors.volume(court))
        quality["expected_volume_rms_cm"] = _number(court_errors.expected_rms_cm(covariance))
    return quality


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
