"""One trial of the study: clicks of the court, several calibrations from them, and their errors."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court import joint_adjustment, known_points, quality, sfm_alignment
from courtside.calibration.court.court import Court
from courtside.calibration.court.resection import Fitted, Linear
from courtside.calibration.records.tie_points import Record
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, project
from courtside.geometry.triangulation import triangulate
from courtside.statistics.normal_errors import ellipsoid, mahalanobis
from courtside.study.errors import InputError

FIRST = ("method", "n_clicks", "in_sample", "outcome")
ERRORS = (
    "xo_cm", "yo_cm", "xy_cm", "volume_rms_cm", "volume_p95_cm", "camera_position_cm",
    "camera_rotation_deg", "focal_percent", "predicted_volume_cm", "coverage50", "coverage90",
    "coverage95", "squared_ratio",
)  # fmt: skip
COLUMNS = FIRST + ERRORS
# Of chi-squared with three degrees of freedom; `scipy.stats` has it too, but takes half a second to
# import.
LIMITS = {level: ellipsoid(level) for level in (0.5, 0.9, 0.95)}


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
    found = court_points(court, xyz[len(grid) :])
    found |= over_volume(error_m) | poses(cameras, truth)
    if point_covariance is not None:
        found |= coverage(error_m, point_covariance(grid))
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
    errors = court_points(court, place(clicks))
    errors |= over_volume(place(seen) - grid)
    placed = [camera for true in truth if (camera := found[true.name].camera)]
    if len(placed) == len(truth):
        errors |= poses(placed, truth)
    return {"outcome": ""} | errors


def court_points(court: Court, xyz: NDArray) -> dict[str, float]:
    """Return the published errors: at the end of x `xo_cm` and y `yo_cm`, and their mean `xy_cm`.

    `xyz` (P, 3) are all court points as reconstructed from clicks, m.
    """
    ends = court.indices("three")[1:]
    xo_cm, yo_cm = 100 * np.linalg.norm(xyz[ends] - court.xyz[ends], axis=1)
    return {"xo_cm": xo_cm, "yo_cm": yo_cm, "xy_cm": (xo_cm + yo_cm) / 2}


def poses(cameras: Sequence[Camera], truth: Sequence[Camera]) -> dict[str, float]:
    """Return mean errors of cameras: position (cm), rotation (degrees), focal length (%).

    `truth` has the cameras in the same order.
    """
    place, turn, focal = [], [], []
    for found, true in zip(cameras, truth, strict=True):
        place.append(np.linalg.norm(found.centre_in_world - true.centre_in_world))
        between = found.cam_from_world[:, :3] @ true.cam_from_world[:, :3].T
        turn.append(np.degrees(rotations.angles(between)))
        focal.append(abs(found.K[1, 1] / true.K[1, 1] - 1))
    return {
        "camera_position_cm": 100 * np.mean(place),
        "camera_rotation_deg": np.mean(turn),
        "focal_percent": 100 * np.mean(focal),
    }


def over_volume(error_m: NDArray) -> dict[str, float]:
    """Return root mean square and 95 % quantile of displacements (N, 3) m, in cm."""
    distance = 100 * np.linalg.norm(error_m, axis=1)
    return {
        "volume_rms_cm": np.sqrt(np.mean(distance**2)),
        "volume_p95_cm": np.quantile(distance, 0.95),
    }


def coverage(error_m: NDArray, covariance: NDArray) -> dict[str, float]:
    """Return how often errors lie within the ellipsoids of their covariance, and the size expected.

    Errors (N, 3) are in m, covariances (N, 3, 3) in m2. The result holds `coverage50`, `coverage90`
    and `coverage95`, 0..1, `squared_ratio`, the normalised estimation error squared (1 where the
    covariance is right, more where it is too small), and `predicted_volume_cm`, the expected root
    mean square.
    """
    square = mahalanobis(error_m, covariance)
    shares = {
        f"coverage{100 * level:.0f}": np.mean(square <= limit) for level, limit in LIMITS.items()
    }
    size_cm = 100 * np.sqrt(np.mean(np.trace(covariance, axis1=1, axis2=2)))
    return {**shares, "squared_ratio": np.mean(square) / 3, "predicted_volume_cm": size_cm}
