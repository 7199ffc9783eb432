"""Adjust the cameras of a walk together with the court's painted lines.

An edge is measured only across its line. Its error has three parts. First, a painted line deviates
by some millimetres from the court's file, by one value for all its stretches in all cameras, and
for the clicked points on it. Second, a thin line in the picture has a bias from blur, pixels and
its surroundings, which is similar in neighbouring stretches. Third, each stretch has noise. The
covariance of edges and clicks contains all of them, so that many stretches and points of one line
are not treated as independent. Lines that deviate more than expected enlarge the covariance.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.bundle import conversion, problem, solver
from courtside.calibration.bundle.problem import IMAGE, POSE, Network
from courtside.calibration.court import joint_adjustment, line_edges, quality
from courtside.calibration.court.court import ClickedPoints, Court
from courtside.calibration.court.joint_adjustment import Solution, Ties
from courtside.calibration.court_lines import edges
from courtside.calibration.court_lines.edges import Edges

# Standard deviations of an edge, chosen on development halls so that the ellipsoids of the cameras
# have the stated coverage. With two thirds of these values the cameras are a tenth better, but
# their ellipsoids are too small.
FINE_PX = 0.05  # of a stretch of a wide line
THIN_PX = 0.1  # bias of a line 1 px wide; inversely proportional to the width
ALIKE_M = 4.0  # ASSUME: correlation length of this bias along a line
LOSS = 3.0  # ASSUME: sigmas; scale of the Cauchy loss of a stretch
# Deviation of the painted lines, in standard deviations of the floor points in the court's file;
# chosen as above, on halls whose lines deviate by 3 to 10 mm.
PAINTING = 2.0
PAINTING_PRIOR = 6.0  # ASSUME: weight of the court's file, in lines, for the painting deviation
ON_LINE_M = 0.001  # ASSUME: standard deviation of a named point across its painted line
ROUNDS = 4  # of adjusting, reweighting, and estimating the painting deviation
# ASSUME: limit in sigmas for the root mean square distance of a camera's edges from the walk's
# prediction: 0.4 to 1 in development sessions, far more for another court or other lines.
CONTRADICTED = 4.0


@dataclass(frozen=True, eq=False)
class LineConstraints:
    """Fixed cameras by walk, clicks and court lines, and the constraints of the lines alone."""

    solution: Solution | None  # None where no line is seen
    knowledge: solver.Quadratic | None  # of lines alone, for `joint_adjustment.solve`
    n_edges: dict[str, int]  # by camera
    off_sigmas: dict[str, float]  # by camera: root mean square distance from the walk's prediction
    painting_m: float  # standard deviation of the painting deviation, across the line
    warnings: list[str]  # cameras whose lines contradict the walk
    remarks: tuple[str, ...] = ()  # cameras whose lines are not seen

    def summary(self) -> dict[str, Any]:
        """Return a summary for a JSON file."""
        off = {name: round(value, 2) for name, value in self.off_sigmas.items()}
        painting = {"painting_mm": round(1000 * self.painting_m, 2)}
        return {"lines": {"n_edges": self.n_edges, "off_sigmas": off, **painting}}


def adjust_and_check(
    court: Court,
    ties: Ties,
    clicks: ClickedPoints,
    pictures: Mapping[str, NDArray],
    search: Mapping[str, Any],
    **options: Any,
) -> tuple[Solution, dict[str, Any]]:
    """Adjust the fixed cameras with clicks and lines, and check them: `quality.adjust_and_check`.

    `search` are options of `of_pictures`. The result also holds the summary of the lines.
    """
    found = of_pictures(ties, clicks, court, pictures, **search, **options)
    solved, checked = quality.adjust_and_check(
        court, ties, clicks, solved=found.solution, lines=found.knowledge, **options
    )
    told = {"warnings": [*checked["warnings"], *found.warnings], "remarks": found.remarks}
    return solved, checked | found.summary() | told


def of_pictures(
    ties: Ties,
    clicks: ClickedPoints,
    court: Court,
    images: Mapping[str, NDArray],
    *,
    search_share: float,
    lines: str,
    **weights: Any,
) -> LineConstraints:
    """Measure a court's lines in the fixed cameras' pictures, near their predicted positions.

    The prediction comes from walk and clicks; `search_share` is the search range as a share of the
    picture's longer side. `**weights` are those of `joint_adjustment.solve`.
    """
    weights = {**weights, "max_iterations": joint_adjustment.SOLVE_ITERATIONS}
    base = joint_adjustment.solve_with_factors(ties, clicks, court, **weights)
    found, remarks = {}, []
    for camera in base.cameras:
        image, search_px = images[camera.name], search_share * max(camera.size)
        seen, reason = edges.measure(camera, image, court, search_px=search_px, lines=lines)
        if seen is None:
            remarks.append(f"camera {camera.name}: court lines not used: {reason}")
        else:
            found[camera.name] = seen
    constraints = from_edges(base, ties, clicks, court, found, **weights)
    return replace(constraints, remarks=tuple(remarks))


def from_edges(
    base: Solution,
    ties: Ties,
    clicks: ClickedPoints,
    court: Court,
    measured: Mapping[str, Edges],
    **weights: Any,
) -> LineConstraints:
    """Compute the constraints from the edges `measured` in each camera.

    `base` is the solution from ties and clicks alone. If the edges of a camera contradict this
    solution, they are left out, and a warning names the camera.
    """
    off = {name: _off_sigmas(base, name, seen, court) for name, seen in measured.items()}
    found = {name: seen for name, seen in measured.items() if off[name] <= CONTRADICTED}
    warnings = [
        f"camera {name}: expected its court lines within {CONTRADICTED:.0f} sigmas of where the "
        f"walk has them, found {off[name]:.1f}; they are not used: look whether it moved after the "
        "walk, or sees another court"
        for name in measured
        if name not in found
    ]
    n_edges = {c.name: len(found[c.name].line) if c.name in found else 0 for c in base.cameras}
    stated_m = _painting_m(court)
    if not found:
        return LineConstraints(None, None, n_edges, off, stated_m, warnings)
    solved, knowledge, painting_m = _adjusted(base, ties, clicks, court, found, **weights)
    return LineConstraints(solved, knowledge, n_edges, off, painting_m, warnings)


def _adjusted(
    base: Solution,
    ties: Ties,
    clicks: ClickedPoints,
    court: Court,
    found: Mapping[str, Edges],
    **weights: Any,
) -> tuple[Solution, solver.Quadratic, float]:
    """Return cameras by ties, clicks and edges, what edges alone tell, and the painting deviation.

    Clicks and edges are linearised together; the adjustment sees no clicks besides.
    """
    nothing = {name: np.full_like(xy, np.nan) for name, xy in clicks.items()}
    options = {"factors": base.factors, **weights}

    def observed(solved: Solution) -> _Observations:
        of_clicks = _of_clicks(solved, clicks, court, weights)
        return _joined(_of_edges(solved, found, court), of_clicks)

    stated_m = painting_m = _painting_m(court)
    solved, seen = base, observed(base)
    trust = seen.trusted(painting_m, np.ones(len(seen.off_px)))
    for _ in range(ROUNDS):
        known = seen.knowledge(painting_m, trust)
        solved = joint_adjustment.solve(
            ties, nothing, court, lines=known, start=solved.network, **options
        )
        seen = observed(solved)
        trust = seen.trusted(painting_m, trust)
        squares = seen.painted_squares(painting_m, trust, solved.covariance)
        mean = (PAINTING_PRIOR * stated_m**2 + squares.sum()) / (PAINTING_PRIOR + len(squares))
        painting_m = max(stated_m, float(np.sqrt(mean)))
    lines = _of_edges(solved, found, court)
    known = lines.knowledge(painting_m, trust[: len(lines.off_px)])
    clicked = any(np.isfinite(xy).any() for xy in clicks.values())
    widening = base.factors.widening if clicked else 1.0
    return replace(solved, covariance=solved.covariance * widening), known, painting_m


def _painting_m(court: Court) -> float:
    """Return the standard deviation of a painted line from the court's file, m."""
    return PAINTING * float(court.sigma_m[court.on_floor].mean())


def _off_sigmas(base: Solution, name: str, seen: Edges, court: Court) -> float:
    """Return the root mean square distance, in sigmas, of edges from a camera's prediction."""
    one = _of_edges(base, {name: seen}, court)
    spread = np.einsum("mk,kl,ml->m", one.rows, base.covariance, one.rows)
    spread += np.diag(one.covariance(_painting_m(court), 1.0))
    return float(np.sqrt(np.mean(one.off_px**2 / spread)))


@dataclass(frozen=True, eq=False)
class _Observations:
    """Edges or clicks of all cameras about a network; each measurement has one axis or two."""

    network: Network
    off_px: NDArray  # (M,): predicted minus observed
    rows: NDArray  # (M, K): its derivatives by the network's columns
    by_line: NDArray  # (M, L): and by how far each line is painted off, px / m
    variance: NDArray  # (M,): px2, of each measurement alone
    shared: NDArray  # (M, M): px2, of what measurements share besides lines
    measurement: NDArray  # (M,) int
    loss: NDArray  # (M,): scale of the Cauchy loss, sigmas

    def covariance(self, painting_m: float, trust: NDArray | float) -> NDArray:
        """Return the covariance of `off_px` (M, M); `trust` weights the noise of measurements."""
        painted = painting_m**2 * self.by_line @ self.by_line.T
        return np.diag(self.variance / trust) + self.shared + painted

    def knowledge(self, painting_m: float, trust: NDArray | float) -> solver.Quadratic:
        """Return the information of the observations on images and lenses, all else eliminated."""
        weighed = np.linalg.solve(self.covariance(painting_m, trust), self.rows)
        return solver.Quadratic(self.network, self.rows.T @ weighed, weighed.T @ self.off_px)

    def trusted(self, painting_m: float, trust: NDArray) -> NDArray:
        """Return the weights (M,) of the Cauchy loss for the noise of each measurement."""
        pull = np.linalg.solve(self.covariance(painting_m, trust), self.off_px)
        noise = np.sqrt(self.variance) / trust * pull  # in sigmas
        squares = np.bincount(self.measurement, noise**2)[self.measurement]
        return 1 / (1 + squares / self.loss**2)

    def painted_squares(self, painting_m: float, trust: NDArray, spread: NDArray) -> NDArray:
        """Return the expected square of the painting deviation of each line that is seen, m2.

        `spread` is the covariance of the network's columns. The step of expectation maximisation
        (Dempster, Laird & Rubin 1977).
        """
        inverse = np.linalg.inv(self.covariance(painting_m, trust))
        weighed = inverse @ self.rows
        left = inverse - weighed @ spread @ weighed.T
        each = self.by_line[:, self.by_line.any(axis=0)]
        mean = painting_m**2 * each.T @ (inverse @ self.off_px)
        known = painting_m**4 * np.einsum("ml,mn,nl->l", each, left, each)
        return mean**2 + np.maximum(painting_m**2 - known, 0.0)


def _joined(one: _Observations, other: _Observations) -> _Observations:
    after = 1 + one.measurement.max(initial=-1)
    both = ("off_px", "rows", "by_line", "variance", "loss")
    return _Observations(
        network=one.network,
        shared=scipy.linalg.block_diag(one.shared, other.shared),
        measurement=np.concatenate([one.measurement, after + other.measurement]),
        **{key: np.concatenate([getattr(one, key), getattr(other, key)]) for key in both},
    )


def _linearised(
    network: Network, xyz: NDArray, image: NDArray, xy: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    """Return predicted minus observed (M, 2), derivatives by columns (M, 2, K), by points."""
    seen = problem.with_points(network, xyz, image, np.arange(len(xyz)), xy)
    residual, by_camera, by_point = problem.linearised(seen)
    by_camera[:, :, len(POSE) : IMAGE] = 0.0  # no flex: a static camera
    return residual, seen.over_columns(by_camera), by_point


def _of_edges(solved: Solution, found: Mapping[str, Edges], court: Court) -> _Observations:
    """Return the edges of cameras, by name, about the solution's network."""
    names = [camera.name for camera in solved.cameras]
    image = np.concatenate(
        [np.full(len(seen.line), names.index(name)) for name, seen in found.items()]
    )
    line, xyz, across, xy, normal, sigma_px = (
        np.concatenate([getattr(seen, key) for seen in found.values()])
        for key in ("line", "xyz", "across", "xy", "normal", "sigma_px")
    )
    network = conversion.network_of(solved.cameras)
    residual, rows, by_point = _linearised(network, xyz, image, xy)
    px_of_m = np.einsum("mr,mrk,mk->m", normal, by_point, across)
    shared_px = THIN_PX / (np.abs(px_of_m) * court.line_width_m)
    same = (image[:, None] == image) & (line[:, None] == line)
    away_m = np.linalg.norm(xyz[:, None] - xyz, axis=2)
    return _Observations(
        network,
        np.sum(residual * normal, axis=1),
        np.einsum("mr,mrk->mk", normal, rows),
        (line[:, None] == np.arange(len(court.lines_m))) * px_of_m[:, None],
        sigma_px**2 + FINE_PX**2,
        same * np.outer(shared_px, shared_px) * np.exp(-away_m / ALIKE_M),
        np.arange(len(line)),
        np.full(len(line), LOSS),
    )


def _of_clicks(
    solved: Solution, clicks: ClickedPoints, court: Court, weights: Mapping[str, Any]
) -> _Observations:
    """Return the clicked points about the solution's network; points move with their lines."""
    every = np.stack([clicks[camera.name] for camera in solved.cameras])
    image, point = np.nonzero(np.isfinite(every).all(axis=2))
    n, n_images = len(image), len(every)
    network = conversion.network_of(solved.cameras)
    residual, rows, by_point = _linearised(network, court.xyz[point], image, every[image, point])
    by_line, sigma_m = of_points(court)
    own = np.zeros((n, 2, *sigma_m.shape))
    own[np.arange(n), :, point] = by_point * sigma_m[point][:, None]
    size = np.array([joint_adjustment.click_sigma(1.0, camera.size) for camera in solved.cameras])
    bias = np.zeros((n, 2, n_images, 2))
    bias[np.arange(n), :, image] = np.eye(2) * size[image, None, None]
    bias *= weights["click_bias_px"] * np.sqrt(solved.factors.bias)
    shared = [own.reshape(2 * n, sigma_m.size), bias.reshape(2 * n, 2 * n_images)]
    shared_px = np.concatenate(shared, axis=1)
    scatter = (weights["click_sigma_px"] * size[:, None]) ** 2 * solved.factors.clicks
    scatter = np.broadcast_to(scatter[:, None] * solved.factors.edges, every.shape)
    return _Observations(
        network,
        residual.ravel(),
        rows.reshape(2 * n, network.n_columns),
        np.einsum("nrk,nkl->nrl", by_point, by_line[point]).reshape(2 * n, by_line.shape[2]),
        scatter[image, point].ravel(),
        shared_px @ shared_px.T,
        np.repeat(np.arange(n), 2),
        np.full(2 * n, weights["click_loss"]),
    )


def of_points(court: Court) -> tuple[NDArray, NDArray]:
    """Return how named points move with each line (P, 3, L), and their own sigma (P, 3), m.

    Across a line on which it lies a point moves with it; otherwise it is as far off as a line.
    """
    moved = np.zeros((len(court.points), 3, len(court.lines_m)))
    sigma = np.repeat(court.sigma_m[:, None], 3, axis=1)
    sigma[court.on_floor, :2] = _painting_m(court)
    for point, lines in enumerate(line_edges.named(court)):
        for edge in lines:
            moved[point, edge.axis, edge.line] = 1.0
            sigma[point, edge.axis] = ON_LINE_M
    return moved, sigma
