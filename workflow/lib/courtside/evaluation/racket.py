"""One trial of measuring a racket: its length from two cameras, calibrated in several ways."""

from collections.abc import Callable, Sized
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.calibration.court import joint_adjustment, known_points, quality, sfm_alignment
from courtside.calibration.court.court import Court
from courtside.calibration.records.tie_points import Record
from courtside.evaluation.calibration import over_volume
from courtside.geometry.camera import Camera, project
from courtside.geometry.triangulation import triangulate
from courtside.study.errors import InputError

THREE, EIGHT, ALL = "three", "eight", "all"  # sets of court points
REWEIGHTED = 3  # times; each divides the remaining effect of unequal depths by about 1000
ERRORS = ("mean_abs_mm", "bias_mm", "std_below_mm", "std_above_mm")
COLUMNS = ("method", "n_clicks", "outcome", "volume_rms_cm", "n_frames", *ERRORS)


@dataclass(frozen=True, eq=False)
class Way:
    """Cameras calibrated in one way.

    Methods: `dlt` and `known`: from court points alone, linear and by least squares; `paper`:
    structure from motion in the published frame; `sfm`: structure from motion adjusted with court
    points; `perfect`: the true cameras.
    """

    method: str
    n_clicks: int  # court points that were to be clicked in each picture
    outcome: str  # empty, or in one line why there is no calibration
    place: Callable | None  # points (N, 3) m from pixels (N, 2) by camera, NaN where missing
    volume_rms_cm: float  # of points in the playing volume from exact pixels; NaN if uncalibrated


def calibrate(
    record: Record,
    truth: list[Camera],
    court: Court,
    clicks: dict[str, NDArray],
    *,
    click_sigma_px: float,
    click_bias_px: float,
    click_loss: float,
) -> list[Way]:
    """Calibrate cameras in every way, from the same clicks.

    `truth` are the true cameras that see the racket; the fixed cameras of the record include them.
    The court has the sets "three" and "eight". `clicks` are (P, 2) px by camera, NaN where not
    clicked. The keywords are those of `joint_adjustment.solve`.
    """
    eight, points = court.indices(EIGHT), court.indices(ALL)
    known: dict = {"court": court, "clicks": clicks, "sigma_px": click_sigma_px, "truth": truth}
    tied: dict = {"click_sigma_px": click_sigma_px, "click_bias_px": click_bias_px}
    tied |= {"click_loss": click_loss, "clicks": clicks, "court": court, "truth": truth}
    made: list[tuple[str, Sized, Callable]] = [
        ("dlt", eight, partial(_by_points, points=eight, linear=True, **known)),
        ("known", eight, partial(_by_points, points=eight, linear=False, **known)),
        ("paper", court.indices(THREE), partial(_by_paper, record, court, clicks, truth)),
        ("sfm", eight, partial(_by_ties, record, points=eight, **tied)),
        ("sfm", points, partial(_by_ties, record, points=points, **tied)),
        ("perfect", (), partial(partial, sfm_alignment.reconstruct, truth)),
    ]
    grid = quality.volume(court)
    seen = {camera.name: project(camera, grid) for camera in truth}
    return [_way(name, len(used), find, grid, seen) for name, used, find in made]


def _way(
    method: str, n_clicks: int, find: Callable, grid: NDArray, seen: dict[str, NDArray]
) -> Way:
    try:
        place = find()
    except InputError as error:
        return Way(method, n_clicks, str(error), None, np.nan)
    errors = over_volume(place(seen) - grid)
    return Way(method, n_clicks, "", place, errors["volume_rms_cm"])


def _by_points(court: Court, clicks, sigma_px, truth, *, points, linear):
    sizes = {camera.name: camera.size for camera in truth}
    way = known_points.Method(linear, False, points)
    found = known_points.calibrate(way, court, clicks, sizes, {}, click_sigma_px=sigma_px)
    if linear:
        return partial(place_linearly, known_points.matrices(found))
    return partial(sfm_alignment.reconstruct, known_points.cameras(found))


def _by_paper(record, court: Court, clicks, truth):
    if record.outcome:
        raise InputError(record.outcome)
    sfm = record.sfm_cameras
    frame, _ = sfm_alignment.paper_frame(court, sfm_alignment.reconstruct(sfm, clicks))
    return _cameras([frame.camera(camera) for camera in sfm], truth)


def _by_ties(record, clicks, court: Court, truth, *, points, **settings):
    if record.ties is None:
        raise InputError(record.outcome or record.fault)
    use = np.isin(np.arange(len(court.points)), points)
    solved = joint_adjustment.solve_with_factors(record.ties, clicks, court, points=use, **settings)
    return _cameras(solved.cameras, truth)


def _cameras(found: list[Camera], truth: list[Camera]) -> Callable:
    """Return the triangulation by those of the cameras that see the racket."""
    by_name = {camera.name: camera for camera in found}
    return partial(sfm_alignment.reconstruct, [by_name[camera.name] for camera in truth])


def place_linearly(matrices: dict[str, NDArray], seen: dict[str, NDArray]) -> NDArray:
    """Triangulate (N, 3) m from the projection matrices (3, 4) that DLT gives, which may be skewed.

    They map homogeneous world points (m) to homogeneous pixels; `seen` are px (N, 2) by camera, NaN
    where missing. The result is NaN if fewer than two cameras see the point.

    The error of a row of the linear system is the error in px times the depth. The system is solved
    again with weights of one over the depth, which minimises the error in px as least squares does
    (Hartley & Sturm 1997, iterative linear method).
    """
    stacked = np.stack(list(matrices.values()))
    xy = np.stack([np.asarray(seen[name], dtype=float) for name in matrices])
    known = np.isfinite(xy).all(axis=-1)
    weight = known.astype(float)
    for _ in range(REWEIGHTED):
        xyz = triangulate(np.nan_to_num(xy), weight, stacked)
        depth = np.abs(np.einsum("cj,nj->cn", stacked[:, 2, :3], xyz) + stacked[:, 2, 3:])
        weight = np.where(known & np.isfinite(depth), 1 / np.maximum(depth, 1e-9), 0.0)
    return xyz


def measure(way: Way, seen: dict[str, NDArray]) -> NDArray:
    """Return the length of a racket in every frame, (F,) m; NaN where an end lacks a second view.

    `seen` are clicks (2 F, 2) px of top and butt by camera, frame after frame, NaN where missing.
    """
    if way.place is None:
        raise ValueError(f"{way.method}: expected a calibration, found {way.outcome}")
    ends = way.place(seen).reshape(-1, 2, 3)
    return np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)


def score(length_m: NDArray, true_m: float, below: NDArray) -> dict[str, float]:
    """Return the errors of measured lengths (F,), by the names of `ERRORS`, and `n_frames`.

    Mean absolute error, mean error, standard deviations of the frames in which the racket is
    `below` (F,) the net's height, and above, mm. NaN are left out.

    # ASSUME: the published standard deviations divide by n - 1, which the paper does not say.
    """
    off_mm = pd.Series(1000 * (length_m - true_m))  # whose statistics leave out NaN
    return {
        "n_frames": int(off_mm.count()),
        "mean_abs_mm": off_mm.abs().mean(),
        "bias_mm": off_mm.mean(),
        "std_below_mm": off_mm[below].std(),
        "std_above_mm": off_mm[~below].std(),
    }


def rows(ways: list[Way], seen: dict[str, NDArray], true_m: float, below: NDArray) -> list[dict]:
    """Return one row for each way, measured from the same clicks of a racket.

    Parameters are those of `measure` and `score`; the keys are `COLUMNS` and `length_columns`.
    """
    found = []
    for way in ways:
        row = {"method": way.method, "n_clicks": way.n_clicks, "outcome": way.outcome}
        if way.place is not None:
            length_m = measure(way, seen)
            row |= {"volume_rms_cm": way.volume_rms_cm, **score(length_m, true_m, below)}
            row |= dict(zip(length_columns(len(below)), 1000 * length_m, strict=True))
        found.append(row)
    return found


def length_columns(n_frames: int) -> list[str]:
    """Return the names of the columns with each frame's length in mm."""
    return [f"length_{frame:02}_mm" for frame in range(1, n_frames + 1)]
