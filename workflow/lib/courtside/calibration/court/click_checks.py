"""Find wrong clicks of court points, and clicks on line centres in place of edges."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.bundle import solver
from courtside.calibration.court import joint_adjustment, line_edges, sfm_alignment
from courtside.calibration.court.court import ClickedPoints, Court, is_raised, to_line_centres
from courtside.geometry.camera import Camera, project
from courtside.statistics.normal_errors import MEDIAN_2D, mahalanobis

WRONG = 6.0  # ASSUME: a click this many sigmas off is wrong
# Of a normal vector in two dimensions, sigma 1 per axis: length that half and 80 % stay within. The
# second counts scatter that differs from point to point.
NORMAL_2D = np.array([MEDIAN_2D, 1.794])
RAISED = 2.0  # ASSUME: times the error across an edge: of points above the floor
CERTAIN = 4.0  # ASSUME: the inward shift must be this many standard deviations from zero
CENTRES = (0.5, 1.6)  # ASSUME: of half a line width: shifts that mean line centres
# In half line widths: edges, half way, line centres; three points determine a parabola.
SHIFTS = (0.0, 0.5, 1.0)


@dataclass(frozen=True, eq=False)
class ClickErrors:
    """Every clicked point against where cameras have it.

    From `leave_one_out`, the cameras are aligned to all the other points.
    """

    points: tuple[str, ...]
    cameras: tuple[str, ...]
    # (P, 3): reconstructed minus true place in the world; NaN without clicks of two cameras.
    residual_m: NDArray
    projected_px: NDArray  # (C, P, 2): where the court's point should be in the picture
    clicked_px: NDArray  # (C, P, 2): NaN where not clicked
    # (C, P, 2, 2): covariance of a click of unit error across each of its two edges, if it lies on
    # lines; may be NaN where the point is not before the camera
    crossing: NDArray

    @property
    def error_cm(self) -> NDArray:
        """Distance in the world, (P,) cm."""
        return 100 * np.linalg.norm(self.residual_m, axis=1)

    @property
    def error_px(self) -> NDArray:
        """Distance in each picture, (C, P) px."""
        return np.linalg.norm(self.clicked_px - self.projected_px, axis=-1)

    @property
    def edge_error_px(self) -> NDArray:
        """The same across the edges, px; clicks are inaccurate along edges that cross flat."""
        off = self.clicked_px - self.projected_px
        seen = np.isfinite(off).all(axis=-1) & np.isfinite(self.crossing).all(axis=(-2, -1))
        error = np.full(seen.shape, np.nan)
        error[seen] = np.sqrt(mahalanobis(off[seen], self.crossing[seen]))
        return error


@dataclass(frozen=True)
class WrongClick:
    """One click that contradicts the others."""

    camera: str
    point: str
    error_px: float
    error_cm: float  # of the point in the world; NaN where one camera alone has it
    looks_like: str | None  # another point of the court that lies where this one was clicked

    def __str__(self) -> str:
        other = f", where {self.looks_like} should be" if self.looks_like else ""
        size = "" if np.isnan(self.error_cm) else f" ({self.error_cm:.0f} cm on the court)"
        return (
            f"camera {self.camera}: point {self.point}: expected the click near the place that the "
            f"other clicks give, found it {self.error_px:.1f} px away{size}{other}; click it again "
            "or delete it"
        )


def leave_one_out(cameras: Sequence[Camera], clicks: ClickedPoints, court: Court) -> ClickErrors:
    """Compare each court point with its prediction from all the other points.

    The cameras, in one frame of structure from motion or the world, stay fixed. The similarity to
    the world is estimated again without the point, robustly against other wrong clicks. Cameras
    that were fitted to the clicks hide a part of the error, the more so the fewer points. Raises
    `InputError` if the others cannot be aligned without one point: too few, collinear, mirrored.
    """
    xyz = sfm_alignment.reconstruct(cameras, clicks)
    residual = np.full_like(xyz, np.nan)
    projected = np.full((len(cameras), len(xyz), 2), np.nan)
    crossing = np.full((len(cameras), len(xyz), 2, 2), np.nan)
    clicked = np.stack([np.asarray(clicks[camera.name], float) for camera in cameras])
    world_from_sfm, _ = sfm_alignment.align(court, xyz)
    on_edge = line_edges.on_lines(court)
    for at in range(len(xyz)):
        others = xyz.copy()
        others[at] = np.nan
        known = np.isfinite(xyz[at]).all()
        fitted = sfm_alignment.align(court, others)[0] if known else world_from_sfm
        residual[at] = fitted.points(xyz[at]) - court.xyz[at]
        for row, camera in enumerate(cameras):
            projected[row, at] = project(fitted.camera(camera), court.xyz[at])
            of_point = fitted.camera(camera), court.xyz[[at]], on_edge[[at]]
            crossing[row, at] = crossings(*of_point)[0]
    names = tuple(camera.name for camera in cameras)
    return ClickErrors(court.points, names, residual, projected, clicked, crossing)


def crossings(camera: Camera, xyz: NDArray, on_edge: NDArray) -> NDArray:
    """Return `line_edges.crossings` (P, 2, 2) of points `on_edge`, (P,) bool, with all others.

    Others on the floor, as points with places of their own, have no edges: 1 in all directions. The
    edges of a post's tip are upright and level, and cross at a right angle; few such points carry
    all heights.
    """
    raised = is_raised(xyz)[:, None, None]
    other = np.where(raised, RAISED**2, 1.0) * np.eye(2)
    return np.where(on_edge[:, None, None], line_edges.crossings(camera, xyz), other)


def find_wrong_clicks(table: ClickErrors, *, sigma_px: ArrayLike) -> list[WrongClick]:
    """Return the clicks that contradict the others, the worst first.

    A wrong click pulls the prediction of the others. Among six points in a camera nearly every one
    is found, among five one in twenty, among four none; good clicks alone are not accused.
    `sigma_px` is that of a good click across an edge, (C,) by camera or one of all; if the clicks
    of a camera scatter more, their scatter is used.
    """
    error, by_edge = table.error_px, table.edge_error_px
    good_px = np.broadcast_to(np.asarray(sigma_px, dtype=float), len(table.cameras))
    wrong = []
    for row, camera in enumerate(table.cameras):
        seen = np.isfinite(by_edge[row])
        if seen.sum() < 4:
            continue
        middle, most = np.quantile(by_edge[row, seen], [0.5, 0.8]) / NORMAL_2D
        sigma = max(good_px[row], middle, most)
        for at in np.flatnonzero(seen & (np.nan_to_num(by_edge[row]) > WRONG * sigma)):
            away = np.linalg.norm(table.projected_px[row] - table.clicked_px[row, at], axis=-1)
            near = int(np.argmin(np.where(np.isfinite(away), away, np.inf)))
            other = table.points[near] if near != at and away[near] < WRONG * sigma else None
            off = float(error[row, at]), float(table.error_cm[at])
            wrong.append(WrongClick(camera, table.points[at], *off, other))
    return sorted(wrong, key=lambda click: -click.error_px)


def inward_shift_of_points(court: Court, xyz_in_sfm: NDArray) -> tuple[float, float]:
    """Find how far, in half line widths, all points lie inwards of the edges that the court names.

    Fits the residuals by one shift along `court.to_line_centres` and a small similarity together,
    by least squares. The scale absorbs most of the shrinking; lines within the court determine the
    rest.

    The reconstructed court points (P, 3) may be in any frame, NaN where missing. The shift is 0 if
    edges were clicked, 1 if line centres were. Its standard deviation, the second number, comes
    from the residuals of the fit; it is inf if there are too few points.
    """
    world_from_sfm, accepted = sfm_alignment.align(court, xyz_in_sfm)
    inwards = to_line_centres(court)
    if accepted.sum() < 5 or not inwards[accepted].any():
        return 0.0, np.inf
    residual = (world_from_sfm.points(xyz_in_sfm) - court.xyz)[accepted]
    design = np.concatenate([inwards[..., None], _small_similarity(court.xyz)], axis=2)[accepted]
    weight = 1 / court.sigma_m[accepted, None]
    rows = (design * weight[..., None]).reshape(-1, 8)
    right = (residual * weight).ravel()
    solution, _, rank, _ = np.linalg.lstsq(rows, right)
    if rank < 8:
        return 0.0, np.inf
    variance = ((right - rows @ solution) ** 2).sum() / (len(right) - 8)
    sigma = np.sqrt(np.linalg.inv(rows.T @ rows)[0, 0] * variance)
    return float(solution[0]), float(sigma)


def _small_similarity(xyz: NDArray) -> NDArray:
    """Return derivatives (P, 3, 7) of points by translation, rotation and scale."""
    turned = np.zeros((len(xyz), 3, 3))
    for axis in range(3):
        turned[:, :, axis] = np.cross(np.eye(3)[axis], xyz)
    shifted = np.broadcast_to(np.eye(3), turned.shape)
    return np.concatenate([shifted, turned, xyz[..., None]], axis=2)


def check(
    court: Court,
    cameras: Sequence[Camera],
    clicks: ClickedPoints,
    *,
    sigma_px: ArrayLike,
    table: ClickErrors | None,
    inwards: tuple[float, float] | None = None,
    adjust: Callable[[ClickedPoints], Sequence[Camera]] | None = None,
    error_modes_m: NDArray | None = None,
) -> list[str]:
    """Check clicked court points as far as the fixed cameras, in one frame, allow.

    Return warnings of one line: weak geometry, wrong clicks by camera and point, line centres.
    `sigma_px` is as for `find_wrong_clicks`; `table` is from `leave_one_out`, None where that
    fails. `inwards`, the shift of all clicks towards line centres and its sigma, is from
    `inward_shift`, by default from `inward_shift_of_points`; `adjust` is as for
    `sfm_alignment.refuse_misplaced_cameras`, `error_modes_m` as for `sfm_alignment.stretch`. Raises
    `InputError` if the points cannot be this court: see `sfm_alignment.check`.
    """
    sfm_alignment.refuse_misplaced_cameras(court, cameras, clicks, adjust)
    xyz = sfm_alignment.reconstruct(cameras, clicks)
    warnings = sfm_alignment.check(court, xyz, cameras, error_modes_m)
    if table is None:
        return warnings + _unchecked(xyz)
    warnings += [str(click) for click in find_wrong_clicks(table, sigma_px=sigma_px)]
    shift, sigma = inwards or inward_shift_of_points(court, xyz)
    if CENTRES[0] < shift < CENTRES[1] and shift > CERTAIN * sigma:
        warnings.append(
            f"court points: all lie inwards of the edges by {500 * court.line_width_m * shift:.0f} "
            f"mm (+-{500 * court.line_width_m * sigma:.0f}), half a line width: line centres seem "
            "to be clicked; click the edges that the court's file names"
        )
    return warnings


def _unchecked(xyz_in_sfm: NDArray) -> list[str]:
    """Return why no point can be left out; of three or fewer, `sfm_alignment.check` says it."""
    if np.isfinite(xyz_in_sfm).all(axis=1).sum() < 4:
        return []
    return [
        "court points: without one of them, the others do not tell where the court is: a wrong "
        "click cannot be noticed; click more points that are not on one line"
    ]


def inward_shift(
    ties: joint_adjustment.Ties, clicks: ClickedPoints, court: Court, **weights: Any
) -> tuple[float, float]:
    """Find how far, in half line widths, the clicks lie inwards of the edges that the court names.

    The cameras are solved for the court as it is, half way, and with all points at line centres.
    The cost is a parabola of the shift: its minimum is the shift and its curvature gives sigma.
    `inward_shift_of_points` finds a third of the shift, because adjusted cameras have absorbed the
    rest. Both numbers mean what they mean there; `**weights` are those of `joint_adjustment.solve`.
    """
    inwards, costs = to_line_centres(court), []
    options = {"max_iterations": joint_adjustment.SOLVE_ITERATIONS, **weights}
    for share in SHIFTS:
        moved = replace(court, xyz=court.xyz + share * inwards)
        solved = joint_adjustment.solve(ties, clicks, moved, **options)
        known = joint_adjustment.knowledge(ties, solved.factors, weights.get("lines"))
        costs.append(solver.cost(solved.network, known))
    bend, slope, _ = np.polyfit(SHIFTS, costs, 2)
    if bend < 1e-9 * max(costs[0], 1.0):
        return 0.0, np.inf
    return float(-slope / (2 * bend)), float(1 / np.sqrt(2 * bend))
