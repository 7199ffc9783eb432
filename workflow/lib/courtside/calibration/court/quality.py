"""Checks of calibrated cameras without the truth, and the errors to expect of them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.court import click_checks, joint_adjustment
from courtside.calibration.court.court import ClickedPoints, Court, to_line_centres
from courtside.calibration.records.covariance import CameraCovariance
from courtside.calibration.records.support import Support
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

# Of the verified matches of a pair of images. Chosen on small halls with ten images
# (docs/measured/running.md): wrong maps explained 0.24 or less of one pair, good ones 0.36 or more
# of all.
SUPPORTED = 0.3
# ASSUME: of the extent of a map. Cameras that a map joined to the wrong end of a symmetric hall
# were 0.1 to 0.6 % from those opposite, others 40 % or more.
ONE_PLACE = 0.007
# ASSUME: of points of a map near a court. In 65 maps at most 9 % were lower; with one of two
# cameras clicked on a neighbouring court a third or more, where the map grew.
SUNKEN_M, SUNKEN_SHARE, BESIDE_M, LEAST_POINTS = 0.2, 0.25, 3.0, 10
# ASSUME: of `joint_adjustment.strain`. In good maps it was at most 7; with one of two cameras
# clicked on a neighbouring court, where nothing else told it, 30 or more; in five of six maps of
# ten images of a plain hall 21 to 47.
MOST_STRAIN = 20.0
# ASSUME: of a camera's clicks; good ones had at most 4, four points of another court 400.
MOST_FACTOR = 30.0
# ASSUME: heights of a match, from the floor to a player's reach; the grid is about 2 m wide on a
# badminton court.
HEIGHTS_M = (0.0, 1.0, 2.0, 3.0)
COLUMNS, ROWS = 5, 7  # of the grid, along the short and the long side


def check_cameras(
    court: Court,
    cameras: Sequence[Camera],
    clicks: ClickedPoints,
    *,
    click_sigma_px: ArrayLike,
    strict: bool = True,
    **known: Any,
) -> dict[str, Any]:
    """Check cameras, in the court's frame, against the clicked court points, each left out in turn.

    The result, for a JSON file, holds `warnings`, and `left_out`, by point: how far it is from its
    place (cm) and from each click (px) in a similarity fitted to the other points. Raises
    `InputError`, or if not `strict` warns, if the points cannot be this court. `click_sigma_px` is
    that of a good click, (C,) by camera or one of all, `**known` what else `click_checks.check`
    takes.
    """
    table, each = leave_one_out_errors(court, cameras, clicks)
    try:
        warnings = click_checks.check(
            court, cameras, clicks, sigma_px=click_sigma_px, table=table, **known
        )
    except InputError as error:
        if strict:
            raise
        warnings = [str(error)]
    return {"warnings": warnings, "left_out": each}


def adjust_and_check(
    court: Court,
    ties: joint_adjustment.Ties,
    clicks: ClickedPoints,
    *,
    solved: joint_adjustment.Solution | None = None,
    **weights: Any,
) -> tuple[joint_adjustment.Solution, dict[str, Any]]:
    """Adjust the fixed cameras with the clicked court points, and check them, as `check_cameras`.

    `solved` are the cameras where another adjustment has found them. `**weights` are those of the
    clicks, as for `joint_adjustment.solve`; warnings judge clicks by the scatter found. The result
    also holds the error to expect (`expected_volume`) and `variance_factors`. Raises `InputError`
    if the points cannot be this court. A model of structure from motion is bent by what its ties
    leave open, mostly focal lengths: with 12 small pictures by 0.02 to 0.4 m at the court points,
    where clicks are 1 cm off. The adjustment removes as much of the bend as the ties' own
    covariance allows: what is left is the fault of the clicks or the court.
    """
    options = {"max_iterations": joint_adjustment.SOLVE_ITERATIONS, **weights}

    def adjust(clicks: ClickedPoints) -> list[Camera]:
        return joint_adjustment.solve(ties, clicks, court, **options).cameras

    if solved is None:
        solved = joint_adjustment.solve_with_factors(ties, clicks, court, **options)
    sigma_px = joint_adjustment.found_click_sigmas(weights["click_sigma_px"], solved)
    quality = check_cameras(
        court,
        solved.cameras,
        clicks,
        click_sigma_px=sigma_px,
        inwards=_inwards(court, ties, clicks, solved.factors, **weights),
        adjust=adjust,
        error_modes_m=point_covariance.field(solved.network, solved.covariance)(court.xyz),
    )
    quality["warnings"] += _scattered(solved, quality["warnings"])
    quality |= expected_volume(court, solved.cameras, solved.named)
    return solved, quality | {"variance_factors": _variance_factors(solved)}


def _scattered(solved: joint_adjustment.Solution, told: Sequence[str]) -> list[str]:
    """Return a line on the camera whose clicks scatter most, if too much and none of it is told.

    Where several clicks of a camera are wrong, their own scatter hides each of them.
    """
    factor = solved.factors.clicks.max(axis=1)
    worst = int(factor.argmax())
    name = solved.cameras[worst].name
    if factor[worst] < MOST_FACTOR or any(line.startswith(f"camera {name}: ") for line in told):
        return []
    return [
        f"camera {name}: expected its clicks to fit the walk and the other clicks as good ones do, "
        f"found them {np.sqrt(factor[worst]):.0f} times as far off; several are wrong, such as "
        "points of another court: look at them on the page for clicking"
    ]


def _inwards(court, ties, clicks, factors, **weights) -> tuple[float, float]:
    """Return `click_checks.inward_shift`, with the scatter of the likelier of edges and centres.

    Clicks on line centres do not fit the edges: the scatter found with edges hides them.
    """
    found = click_checks.inward_shift(ties, clicks, court, factors=factors, **weights)
    if not click_checks.CENTRES[0] < found[0] < click_checks.CENTRES[1]:
        return found
    centres = replace(court, xyz=court.xyz + to_line_centres(court))
    solved = joint_adjustment.solve_with_factors(
        ties, clicks, centres, max_iterations=joint_adjustment.SOLVE_ITERATIONS, **weights
    )
    return click_checks.inward_shift(ties, clicks, court, factors=solved.factors, **weights)


def _variance_factors(solved: joint_adjustment.Solution) -> dict[str, Any]:
    """Return variance factors for JSON, with the redundancy that they rest on."""
    factors = solved.factors
    each = zip(solved.cameras, factors.clicks, factors.clicks_redundancy, strict=True)
    clicks = {
        camera.name: {"x": _number(x), "y": _number(y), "redundancy": _number(left.sum())}
        for camera, (x, y), left in each
    }
    ties = {"factor": _number(factors.ties), "redundancy": _number(factors.ties_redundancy)}
    return {"clicks": clicks, "ties": ties}


def check_maps(n_agreeing: int, n_maps: int) -> dict[str, Any]:
    """Return the quality of cameras without a court: how many maps of the same images agree."""
    warnings = [
        "no court: scale and frame are arbitrary, and lengths have no unit; for metres name a "
        "`court`, or describe the place as one of your own, and click three of its points or more "
        "(config/README.md, A court of your own)"
    ]
    if n_agreeing == 1 < n_maps:
        warnings.append(
            "walk: expected maps of its images to agree within 1 % of their extent, found that "
            f"none of {n_maps - 1} others agrees with the best: angles and proportions are that "
            "uncertain; take more bridging images, or name a court"
        )
    return {"warnings": warnings}


def map_warning(support: Support) -> str:
    """Return in one line why a map is doubtful, empty if it is not.

    A doubtful map says nothing about clicks, court or names of cameras.
    """
    if support.pair_share >= SUPPORTED:
        return ""
    one, other = support.pair
    return (
        f"map doubtful: expected {100 * SUPPORTED:.0f} % or more of the matches of {one} with "
        f"{other} to agree with it, found {100 * support.pair_share:.0f} %; take more bridging "
        "images; if parts of the hall look alike, put bags or posters into some of them"
    )


def one_place(centres: Mapping[str, NDArray], others: NDArray) -> str:
    """Return in one line which fixed cameras stand in one place of a map, empty if none do.

    `centres` (3,) are those of the fixed cameras, `others` (V, 3) of all images. In a hall with
    equal ends a walk can join a camera to the wrong end: one that stands opposite another then
    seems to stand where the other does.
    """
    extent = np.linalg.norm(np.ptp(others, axis=0))
    for one, other in combinations(centres, 2):
        if np.linalg.norm(centres[one] - centres[other]) < ONE_PLACE * extent:
            return (
                f"cameras {one} and {other}: expected them in two places of the map, found them "
                f"within {100 * ONE_PLACE:g} % of its extent; if they stand apart in the hall, its "
                "ends look alike and the walk joined one of them to the wrong end: film the walk "
                "without a break until close beside both, with bags or posters at one end"
            )
    return ""


def sunken(court: Court, xyz: NDArray) -> str:
    """Return in one line that a map lies below the floor of the court, empty if it does not.

    `xyz` (N, 3) m are the map's points in the court's frame. Two cameras beside each other that
    were clicked on different courts of a row agree with each other: only the scale is wrong.
    """
    if court.placed:
        return ""
    reach = court.xyz[:, :2].min(axis=0) - BESIDE_M, court.xyz[:, :2].max(axis=0) + BESIDE_M
    height_m = xyz[((xyz[:, :2] > reach[0]) & (xyz[:, :2] < reach[1])).all(axis=1), 2]
    low_m = np.quantile(height_m, SUNKEN_SHARE) if len(height_m) >= LEAST_POINTS else 0.0
    if low_m > -SUNKEN_M:
        return ""
    return (
        "court points: expected the points of the walk's map on the floor or above it, found "
        f"{100 * SUNKEN_SHARE:.0f} % or more of {len(height_m)} near the court {-low_m:.1f} m or "
        "more below it; click the same court in all cameras, and check that its file has its size"
    )


def strained(strain: float) -> str:
    """Return in one line that clicks bend the walk's map, empty if not; of `Record.strain`.

    In a hall with few features a walk ties cameras weakly, and wrong clicks that agree with one
    another bend its map by metres.
    """
    if not strain > MOST_STRAIN:
        return ""
    return (
        "court points: expected clicks that fit the walk, found that its tie points fit worse with "
        f"them, by {strain:.0f} half squared sigmas (good: up to {MOST_STRAIN:g}): they bend the "
        "walk's map; look whether all cameras are clicked on the same court, the points have their "
        "right names, and all walks are of this hall; if so, take more bridging images"
    )


def leave_one_out_errors(
    court: Court, cameras: Sequence[Camera], clicks: ClickedPoints
) -> tuple[click_checks.ClickErrors | None, str | dict[str, dict]]:
    """Leave each court point out; return the table, and for JSON its errors by point.

    Where there is no table, the reason stands in place of the errors.
    """
    try:
        table = click_checks.leave_one_out(cameras, clicks, court)
    except InputError as error:
        return None, str(error)
    return table, {
        point: {
            "error_cm": _number(table.error_cm[at]),
            "error_px": {c: _number(table.error_px[v, at]) for v, c in enumerate(table.cameras)},
        }
        for at, point in enumerate(table.points)
    }


def _number(value: float) -> float | None:
    """Return a number as JSON has it: rounded, null where it is not finite."""
    return round(float(value), 4) if np.isfinite(value) else None


def volume(
    court: Court, heights_m: Sequence[float] = HEIGHTS_M, columns: int = COLUMNS, rows: int = ROWS
) -> NDArray:
    """Return a grid of points over the court, both ends included, (N, 3) m, by height, then row.

    `columns` and `rows` are the points along the short and the long side.
    """
    x = np.linspace(0, court.size_m[0], columns)
    y = np.linspace(0, court.size_m[1], rows)
    z, y, x = np.meshgrid(np.asarray(heights_m, dtype=float), y, x, indexing="ij")
    return np.stack([x, y, z], axis=-1).reshape(-1, 3)


def place_covariance(
    cameras: Sequence[Camera], covariance: CameraCovariance, xyz: NDArray
) -> NDArray:
    """Return the covariance (N, 3, 3) m2 of places (N, 3) m from the cameras that show each.

    NaN where fewer than two do.
    """
    spread = covariance.of([camera.name for camera in cameras]).of_columns()
    network, seen = conversion.network_of(cameras), point_covariance.shown(cameras, xyz)
    return point_covariance.point_covariance(network, spread, xyz, seen)


def expected_cm(
    cameras: Sequence[Camera], covariance: CameraCovariance, xyz: NDArray
) -> tuple[float, float]:
    """Return the expected error of places (N, 3) m, root mean square, cm, and the share seen.

    Of places that two cameras or more have in their pictures, from these alone; NaN of none.
    """
    variance = np.trace(place_covariance(cameras, covariance, xyz), axis1=1, axis2=2)
    seen = np.isfinite(variance)
    error_cm = 100 * np.sqrt(np.mean(variance[seen])) if seen.any() else np.nan
    return float(error_cm), float(seen.mean())


def expected_volume(
    court: Court, cameras: Sequence[Camera], covariance: CameraCovariance
) -> dict[str, float | None]:
    """Return for a JSON file the expected error over a court, cm, and the share of it seen.

    The error is None if no two cameras show the same place. Points with your own coordinates have
    no lines: their frame begins anywhere.
    """
    grid = volume(court)
    if court.placed and not len(court.lines_m):
        grid[:, :2] += court.xyz[:, :2].min(axis=0)
    expected, share = expected_cm(cameras, covariance, grid)
    return {"expected_volume_rms_cm": _number(expected), "volume_seen": _number(share)}
