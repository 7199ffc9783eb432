"""All fixed cameras from points at known places alone, weighted together, with their covariance.

First each camera is calibrated alone (`misfits`, `resection`). Then all are adjusted together: the
position of a point is one unknown for all cameras that see it, and the scatter of clicks is
estimated from all residuals. Clicks that contradict their camera lose weight and are named.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle import conversion, selection, solver
from courtside.calibration.court import (
    click_checks,
    joint_adjustment,
    line_edges,
    misfits,
    place_checks,
)
from courtside.calibration.court.court import ClickedPoints, Court
from courtside.calibration.court.joint_adjustment import Solution, Ties
from courtside.geometry.camera import Camera, project

# ASSUME: what lenses and sensors usually are, standard deviations: square pixels, a principal point
# within 1 % of the picture's width of its centre, barrel distortion that a k2 follows. Points on a
# floor tell the principal point badly; fixed at the centre it makes other errors look too small.
CENTRE_SHARE = 0.01  # of the picture's width
SPREAD = {"aspect": 1e-3, "k1": 0.3, "k2": 0.2, "p1": 5e-4, "p2": 5e-4}
MAX_ITERATIONS = 200
ROUNDS = 8  # of the variance factors: see `joint_adjustment`
# ASSUME: a camera whose clicks scatter so much more than the others', or than stated, is named. In
# a real hall, points with errors of some centimetres scatter 2.4 times as much as stated at most.
SCATTERED, LARGEST = 3.0, 6.0
# ASSUME: of cameras whose clicks scatter more than stated, those that scatter less than this share
# of the worst are drawn away by it: they share the places of points.
AS_THE_WORST = 0.6


@dataclass(frozen=True, eq=False)
class Found:
    """Cameras from points alone."""

    solution: Solution
    error_px: dict[str, NDArray]  # (P,) by camera: of each click, NaN where there is none
    wrong: list[click_checks.WrongClick]  # clicks that their camera's others contradict
    warnings: list[str]


def calibrate(
    court: Court,
    clicks: ClickedPoints,
    sizes: Mapping[str, tuple[int, int]],
    *,
    click_sigma_px: float,
    click_bias_px: float,
    click_loss: float,
) -> Found:
    """Calibrate cameras, whose pictures have the given sizes (px), from their clicks.

    The weights are those of `joint_adjustment.solve`. Raises `InputError` if the points do not
    determine a camera: each needs eight, not on one line; or if they are mirrored.
    """
    weights = {
        "click_sigma_px": click_sigma_px,
        "click_bias_px": click_bias_px,
        "click_loss": click_loss,
    }
    starts = [_start(court, clicks[name], name, sizes[name], click_sigma_px) for name in sizes]
    solved = _solved(_lenses(starts), clicks, court, weights)
    doubts = place_checks.check_cameras(court, solved.cameras, clicks)
    projected = np.stack([project(camera, court.xyz) for camera in solved.cameras])
    clicked = np.stack([np.asarray(clicks[name], float) for name in sizes])
    on_edge = line_edges.on_lines(court)
    crossing = np.stack([click_checks.crossings(c, court.xyz, on_edge) for c in solved.cameras])
    unplaced = np.full_like(court.xyz, np.nan)
    seen = unplaced, projected, clicked, crossing
    table = click_checks.ClickErrors(court.points, tuple(sizes), *seen)
    sigma_px = joint_adjustment.click_sigmas(click_sigma_px, solved.cameras)
    wrong = click_checks.find_wrong_clicks(table, sigma_px=sigma_px)
    error_px = dict(zip(sizes, table.error_px, strict=True))
    scattered = _scattered(solved, error_px, click_sigma_px, {one.camera for one in wrong})
    return Found(solved, error_px, wrong, [*map(str, wrong), *scattered, *doubts])


def _start(
    court: Court, xy: NDArray, name: str, size: tuple[int, int], click_sigma_px: float
) -> Camera:
    """Return a camera by itself from its clicks (P, 2) px."""
    return misfits.fitted(
        court.xyz,
        xy,
        size,
        sigma_px=joint_adjustment.click_sigma(click_sigma_px, size),
        xyz_sigma=court.sigma_m,
        edges=line_edges.on_lines(court),
        name=name,
        placed=court.placed,
    ).camera


def summary(found: Found) -> dict[str, Any]:
    """Return the fit of the points, and the lenses with their uncertainty, for a JSON file.

    By camera: `n_points`; `rms_px`, per axis; `f_px` and `k1` with their standard deviations.
    """
    report: dict[str, Any] = {"warnings": found.warnings}
    cameras = found.solution.cameras
    spread = found.solution.named
    for camera in cameras:
        error_px = found.error_px[camera.name]
        one = {
            "n_points": int(np.isfinite(error_px).sum()),
            "rms_px": _rms_px(error_px),
            "f_px": camera.K[1, 1],
            "f_sigma_px": spread.sigma(camera.name, "f_px"),
            "k1": camera.dist[0],
            "k1_sigma": spread.sigma(camera.name, "k1"),
        }
        for key, value in one.items():
            shown = value if isinstance(value, int) else round(float(value), 4)
            report.setdefault(key, {})[camera.name] = shown
    return report


def _lenses(starts: Sequence[Camera]) -> Ties:
    """Return what is known of the lenses before any click, about cameras to start from."""
    sizes = [camera.size for camera in starts]
    network = conversion.network_of(starts)
    usual = selection.with_lens_priors(network, sizes, SPREAD, CENTRE_SHARE)
    information = np.zeros(network.n_columns)
    information[-network.lens.size :] = usual.lens_sigma.ravel() ** -2.0
    reference = replace(network, lens=usual.lens_mean)
    known = solver.Quadratic(reference, np.diag(information), np.zeros(len(information)))
    return Ties(tuple(camera.name for camera in starts), tuple(sizes), known)


def _solved(lenses: Ties, clicks: ClickedPoints, court: Court, weights: dict) -> Solution:
    """Adjust all cameras, their clicks weighted by the scatter that the residuals show.

    The covariance is not enlarged by `Factors.widening`: with two cameras of 8, 10 or 14 points the
    90 % ellipsoids held 89 to 91 % of the errors (40 draws each), and 92 to 94 % if enlarged.
    """
    options = {**weights, "max_iterations": MAX_ITERATIONS}
    return joint_adjustment.solve_by_scatter(
        lenses, clicks, court, of_ties=False, rounds=ROUNDS, **options
    )


def _rms_px(error_px: NDArray) -> float:
    """Return the root mean square per axis of the errors (P,) of a camera's clicks; NaN: none."""
    return float(np.sqrt(np.nanmean(error_px**2) / 2))


def _scattered(
    solved: Solution, error_px: Mapping[str, NDArray], click_sigma_px: float, mistaken: set[str]
) -> list[str]:
    """Return a warning for each camera whose clicks scatter far more than those of the others.

    Or far more than clicks do, as all do in pictures of another size, and nearly as much as those
    of the worst camera. Nothing of the `mistaken` cameras, whose wrong clicks are named; these draw
    the others away, which are then only compared with one another.
    """
    share = np.sqrt(solved.factors.clicks.mean(axis=1))
    least = np.inf if mistaken else max(LARGEST, AS_THE_WORST * share.max())
    rms_px = np.array([_rms_px(error_px[camera.name]) for camera in solved.cameras])
    found = []
    for at, camera in enumerate(solved.cameras):
        others = np.delete(np.arange(len(share)), at)
        usual = max(1.0, float(np.median(share[others]))) if len(others) else np.inf
        if camera.name in mistaken or share[at] <= min(SCATTERED * usual, least):
            continue
        stated_px = joint_adjustment.click_sigma(click_sigma_px, camera.size)
        whose, usual_px = (
            ("those of the other cameras", np.median(rms_px[others]))
            if share[at] > SCATTERED * usual
            else ("clicks", stated_px)
        )
        found.append(
            f"camera {camera.name}: expected its points to fit as {whose} do, to "
            f"{usual_px:.1f} px, found {rms_px[at]:.1f} px; check the names and places of its "
            "points, and that its clicks are px of the picture's own "
            f"{camera.size[0]} x {camera.size[1]}"
        )
    return found
