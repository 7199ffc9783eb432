"""One trial of the study: clicks of the court, a way to calibrate, and how wrong the cameras are."""

import numpy as np

from courtside.calibration.court import joint_adjustment, known_points, quality, sfm_alignment
from courtside.geometry.camera import project
from courtside.geometry.triangulation import triangulate
from courtside.study.errors import InputError

FIRST = ("method", "n_clicks", "in_sample", "outcome")
ERRORS = (
    "xo_cm",
    "yo_cm",
    "xy_cm",
    "volume_rms_cm",
    "volume_p95_cm",
    "camera_position_cm",
    "camera_rotation_deg",
    "focal_percent",
    "predicted_volume_cm",
    "coverage50",
    "coverage90",
    "coverage95",
)
COLUMNS = FIRST + ERRORS


def choices(court, sets):
    """Yield the choices of clicks to calibrate from: (number, in sample, (P,) bool).

    Parameters
    ----------
    court : courtside.calibration.court.court.Court
    sets : sequence of str
        Of its sets. Each comes whole, and without the two scored points where enough others are left.
    """
    scored = np.zeros(len(court.points), dtype=bool)
    scored[court.indices("three")[1:]] = True
    for name in sets:
        use = np.zeros(len(court.points), dtype=bool)
        use[court.indices(name)] = True
        yield int(use.sum()), True, use
        if (use & ~scored).sum() >= 3:
            yield int(use.sum()), False, use & ~scored


def of_ties(record, truth, court, clicks, *, sets, **settings):
    """Try the ways that start from structure from motion: `sfm`, `sim3` and `paper`.

    Parameters
    ----------
    record : courtside.calibration.records.tie_points.Record
        Without an outcome.
    truth : list of Camera
    court : courtside.calibration.court.court.Court
    clicks : dict of str to (P, 2) float
        Of this trial, by camera.
    sets : sequence of str
        Sets of court points.
    **settings
        `click_sigma_px` and `click_loss` of `joint_adjustment.solve`.

    Returns
    -------
    rows : list of dict
        With the keys `COLUMNS`; `paper` with its three points only, which cannot be left out.
    """
    rows, sfm = [], record.sfm_cameras
    xyz_in_sfm = sfm_alignment.reconstruct(sfm, clicks)
    for n_clicks, in_sample, use in choices(court, sets):
        row = {"n_clicks": n_clicks, "in_sample": in_sample}
        if record.fault:
            rows.append({"method": "sfm", **row, "outcome": record.fault})
        else:
            solved = joint_adjustment.solve(record.ties, clicks, court, points=use, **settings)
            errors = score(solved.cameras, truth, court, clicks, solved.point_covariance)
            rows.append({"method": "sfm", **row, **errors})
        try:
            frame, _ = sfm_alignment.align(court, np.where(use[:, None], xyz_in_sfm, np.nan))
            errors = score([frame.camera(camera) for camera in sfm], truth, court, clicks)
        except InputError as error:
            errors = {"outcome": str(error)}
        rows.append({"method": "sim3", **row, **errors})
    try:
        frame = sfm_alignment.paper_frame(court, xyz_in_sfm).nearest
        errors = score([frame.camera(camera) for camera in sfm], truth, court, clicks)
    except InputError as error:
        errors = {"outcome": str(error)}
    return [*rows, {"method": "paper", "n_clicks": 3, "in_sample": True, **errors}]


def of_known(truth, court, clicks, lenses, *, sets, click_sigma_px):
    """Try the ways that need known points only: `dlt`, `known`, and `known-board` where lenses are known.

    Parameters
    ----------
    truth : list of Camera
    court : courtside.calibration.court.court.Court
    clicks : dict of str to (P, 2) float
    lenses : dict of str to Camera
        From boards; may be empty.
    sets : sequence of str
    click_sigma_px : float

    Returns
    -------
    rows : list of dict
        With the keys `COLUMNS`; `outcome` says why a way failed.
    """
    rows, sizes = [], {camera.name: camera.size for camera in truth}
    ways = [("dlt", True, False), ("known", False, False)]
    ways += [("known-board", False, True)] if lenses else []
    for n_clicks, in_sample, use in choices(court, sets):
        for method, linear, board in ways:
            row = {"method": method, "n_clicks": n_clicks, "in_sample": in_sample}
            way = known_points.Method(linear, board, np.flatnonzero(use))
            try:
                found = known_points.calibrate(
                    way, court, clicks, sizes, lenses, click_sigma_px=click_sigma_px
                )
            except InputError as error:
                rows.append(row | {"outcome": str(error)})
                continue
            if linear:
                rows.append(row | score_linear(found, truth, court, clicks))
            else:
                rows.append(row | score(known_points.cameras(found), truth, court, clicks))
    return rows


def score(cameras, truth, court, clicks, point_covariance=None):
    """Return the errors of calibrated cameras, by the names of `ERRORS`.

    Parameters
    ----------
    cameras, truth : list of Camera
        In the same order.
    court : courtside.calibration.court.court.Court
    clicks : dict of str to (P, 2) float
    point_covariance : callable, optional
        Covariance (N, 3, 3) m2 of points (N, 3), of cameras that know theirs.
    """
    grid = quality.volume(court)
    seen = {true.name: np.vstack([project(true, grid), clicks[true.name]]) for true in truth}
    xyz = sfm_alignment.reconstruct(cameras, seen)
    error_m = xyz[: len(grid)] - grid
    found = quality.court_points(court, xyz[len(grid) :])
    found |= quality.over_volume(error_m) | quality.poses(cameras, truth)
    if point_covariance is not None:
        found |= quality.coverage(error_m, point_covariance(grid))
    return {"outcome": ""} | found


def score_linear(found, truth, court, clicks):
    """Return the errors of projection matrices as DLT gives them, skew and all.

    Parameters
    ----------
    found : dict of str to resection.Linear
    truth : list of Camera
    court : courtside.calibration.court.court.Court
    clicks : dict of str to (P, 2) float
    """
    matrices = np.stack([found[camera.name].matrix for camera in truth])

    def place(seen):
        xy = np.stack([seen[camera.name] for camera in truth])
        weight = np.isfinite(xy).all(axis=-1).astype(float)
        return triangulate(np.nan_to_num(xy), weight, matrices)

    grid = quality.volume(court)
    seen = {camera.name: project(camera, grid) for camera in truth}
    errors = quality.court_points(court, place(clicks))
    errors |= quality.over_volume(place(seen) - grid)
    if all(result.camera for result in found.values()):
        errors |= quality.poses([found[camera.name].camera for camera in truth], truth)
    return {"outcome": ""} | errors
