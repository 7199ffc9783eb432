"""One trial of the study: clicks of the court, several calibrations from them, and their errors."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court import joint_adjustment, known_points, quality, sfm_alignment
from courtside.calibration.court.court import Court
from courtside.calibration.court.resection import Fitted, Linear
from courtside.calibration.records.tie_points import Record
from courtside.geometry.camera import Camera, project
from courtside.geometry.triangulation import triangulate
from courtside.study.errors import InputError

FIRST = ("method", "n_clicks", "in_sample", "outcome")
ERRORS = (
    "xo_cm", "yo_cm", "xy_cm", "volume_rms_cm", "volume_p95_cm", "camera_position_cm",
    "camera_rotation_deg", "focal_percent", "predicted_volume_cm", "coverage50", "coverage90",
    "coverage95", "squared_ratio",
)  # fmt: skip
COLUMNS = FIRST + ERRORS


def choices(court: Court, sets: Sequence[str]) -> Iterator[tuple[int, bool, NDArray]]:
    """Yield the choices of clicks to calibrate from: (number, in sample, (P,) bool).

    Each of the court's `sets` comes whole, and without the two scored points if three others
    remain.
    """
    scored = np.zeros(len(court.points), dtype=bool)
    scored[court.indices("three")[1:]] = True
    for name in sets:
        use = np.zeros(len(court.points), dtype=bool)
        use[court.indices(name)] = True
        yield int(use.sum()), True, use
        if (use & ~scored).sum() >= 3:
            yield int(use.sum()), False, use & ~scored


def of_ties(
    record: Record,
    truth: list[Camera],
    court: Court,
    clicks: dict[str, NDArray],
    *,
    sets: Sequence[str],
    **settings: Any,
) -> list[dict]:
    """Evaluate the ways that start from structure from motion: `sfm`, `sim3` and `paper`.

    Rows with the keys `COLUMNS`; `paper` with its three points only, which cannot be left out. The
    record has no outcome; `clicks` are those of this trial by camera, (P, 2) px; `sets` are of
    court points; `settings` are `click_sigma_px`, `click_bias_px` and `click_loss` of
    `joint_adjustment.solve`.
    """
    rows, sfm = [], record.sfm_cameras
    xyz_in_sfm = sfm_alignment.reconstruct(sfm, clicks)
    for n_clicks, in_sample, use in choices(court, sets):
        row = {"n_clicks": n_clicks, "in_sample": in_sample}
        errors = _of_sfm(record, truth, court, clicks, points=use, **settings)
        rows.append({"method": "sfm", **row, **errors})
        try:
            frame, _ = sfm_alignment.align(court, np.where(use[:, None], xyz_in_sfm, np.nan))
            errors = score([frame.camera(camera) for camera in sfm], truth, court, clicks)
        except InputError as error:
            errors = {"outcome": str(error)}
        rows.append({"method": "sim3", **row, **errors})
    try:
        frame, _ = sfm_alignment.paper_frame(court, xyz_in_sfm)
        errors = score([frame.camera(camera) for camera in sfm], truth, court, clicks)
    except InputError as error:
        errors = {"outcome": str(error)}
    return [*rows, {"method": "paper", "n_clicks": 3, "in_sample": True, **errors}]


def _of_sfm(
    record: Record, truth: list[Camera], court: Court, clicks: dict[str, NDArray], **how: Any
) -> dict:
    """Return the errors of the joint adjustment, or the outcome that says why it failed."""
    if record.fault or record.ties is None:
        return {"outcome": record.fault}
    try:
        solved = joint_adjustment.solve_with_factors(record.ties, clicks, court, **how)
    except InputError as error:
        return {"outcome": str(error)}
    return score(solved.cameras, truth, court, clicks, solved.point_covariance)


def of_known(
    truth: list[Camera],
    court: Court,
    clicks: dict[str, NDArray],
    lenses: dict[str, Camera],
    *,
    sets: Sequence[str],
    click_sigma_px: float,
) -> list[dict]:
    """Evaluate the ways that need known points: `dlt`, `known` and, with lenses, `known-board`.

    `lenses` are from boards and may be empty; `outcome` says why a way failed.
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


def score(
    cameras: list[Camera],
    truth: list[Camera],
    court: Court,
    clicks: dict[str, NDArray],
    point_covariance: Callable | None = None,
) -> dict:
    """Return the errors of calibrated cameras, by the names of `ERRORS`.

    `truth` is in the same order, `clicks` (P, 2) px by camera. `point_covariance` returns (N, 3, 3)
    m2 for points (N, 3), for cameras with a known covariance.
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


def score_linear(
    found: dict[str, Linear | Fitted], truth: list[Camera], court: Court, clicks: dict[str, NDArray]
) -> dict:
    """Return the errors of the projection matrices that DLT gives, which may be skewed."""
    matrix = known_points.matrices(found)
    matrices = np.stack([matrix[camera.name] for camera in truth])

    def place(seen: dict[str, NDArray]) -> NDArray:
        xy = np.stack([seen[camera.name] for camera in truth])
        weight = np.isfinite(xy).all(axis=-1).astype(float)
        return triangulate(np.nan_to_num(xy), weight, matrices)

    grid = quality.volume(court)
    seen = {camera.name: project(camera, grid) for camera in truth}
    errors = quality.court_points(court, place(clicks))
    errors |= quality.over_volume(place(seen) - grid)
    placed = [camera for true in truth if (camera := found[true.name].camera)]
    if len(placed) == len(truth):
        errors |= quality.poses(placed, truth)
    return {"outcome": ""} | errors
