"""Adjust the cameras of a walk together with the court's painted lines.

An edge is measured only across its line. Its error has three parts. First, a painted line deviates
by some millimetres from the court's file, by one value for all its stretches in all cameras.
Second, a thin line in the picture has a bias from blur, pixels and its surroundings, which is
similar in neighbouring stretches. Third, each stretch has noise. The covariance of the edges
contains the first two parts, so that many stretches of one line are not treated as independent. The
deviation of the painted lines is estimated from the lines themselves, with the court's file as
prior.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle import problem, selection, solver
from courtside.calibration.bundle.problem import IMAGE, POSE, Network
from courtside.calibration.court import joint_adjustment
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
MAX_ITERATIONS = 30  # of each adjustment
ROUNDS = 4  # of adjusting, reweighting, and estimating the painting deviation
# ASSUME: limit in sigmas for the root mean square distance of a camera's edges from the walk's
# prediction: 0.4 to 1 in development sessions, far more for another court or other lines.
CONTRADICTED = 4.0


@dataclass(frozen=True, eq=False)
class LineConstraints:
    """Constraints of court lines on the fixed cameras of a walk."""

    knowledge: solver.Quadratic | None  # for `joint_adjustment.solve`; None where no line is seen
    n_edges: dict[str, int]  # by camera
    off_sigmas: dict[str, float]  # by camera: root mean square distance from the walk's prediction
    painting_m: float  # standard deviation of the painting deviation, across the line
    warnings: list[str]  # cameras whose lines are not seen, or contradict the walk

    def summary(self) -> dict[str, Any]:
        """Return a summary for a JSON file."""
        off = {name: round(value, 2) for name, value in self.off_sigmas.items()}
        painting = {"painting_mm": round(1000 * self.painting_m, 2)}
        return {"lines": {"n_edges": self.n_edges, "off_sigmas": off, **painting}}


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
    picture's width. `**weights` are those of `joint_adjustment.solve`.
    """
    weights = {**weights, "max_iterations": MAX_ITERATIONS}
    base = joint_adjustment.solve_with_factors(ties, clicks, court, **weights)
    found, warnings = {}, []
    for camera in base.cameras:
        image, search_px = images[camera.name], search_share * camera.size[0]
        seen, reason = edges.measure(camera, image, court, search_px=search_px, lines=lines)
        if seen is None:
            warnings.append(f"camera {camera.name}: court lines not used: {reason}")
        else:
            found[camera.name] = seen
    constraints = from_edges(base, ties, clicks, court, found, **weights)
    return replace(constraints, warnings=[*warnings, *constraints.warnings])


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
    stated_m = painting_m = _painting_m(court)
    if not found:
        return LineConstraints(None, n_edges, off, stated_m, warnings)
    solved, trust = base, np.ones(sum(n_edges.values()))
    known = _linearised(base, found, court).knowledge(painting_m, trust)
    for _ in range(ROUNDS):
        solved = joint_adjustment.solve(
            ties, clicks, court, lines=known, factors=base.factors, start=solved.network, **weights
        )
        seen = _linearised(solved, found, court)
        trust = 1 / (1 + (seen.noise(painting_m, trust) / LOSS) ** 2)
        squares = seen.painted_squares(painting_m, trust, solved.covariance)
        lines_and_prior = PAINTING_PRIOR + len(squares)
        painting_m = np.sqrt((PAINTING_PRIOR * stated_m**2 + squares.sum()) / lines_and_prior)
        known = seen.knowledge(painting_m, trust)
    return LineConstraints(known, n_edges, off, float(painting_m), warnings)


def _painting_m(court: Court) -> float:
    """Return the standard deviation of a painted line from the court's file, m."""
    return PAINTING * float(court.sigma_m[court.xyz[:, 2] == 0].mean())


def _off_sigmas(base: Solution, name: str, seen: Edges, court: Court) -> float:
    """Return the root mean square distance, in sigmas, of edges from a camera's prediction."""
    one = _linearised(base, {name: seen}, court)
    spread = np.einsum("mk,kl,ml->m", one.rows, base.covariance, one.rows)
    spread += np.diag(one.covariance(_painting_m(court), 1.0))
    return float(np.sqrt(np.mean(one.off_px**2 / spread)))


@dataclass(frozen=True, eq=False)
class _Linearised:
    """Edges of all cameras about a network."""

    network: Network
    off_px: NDArray  # (M,): predicted minus observed, across
    rows: NDArray  # (M, K): its derivatives by the network's columns
    px_of_m: NDArray  # (M,): of a line that is painted off
    line: NDArray  # (M,)
    variance: NDArray  # (M,): px2, of each stretch alone
    alike: NDArray  # (M, M): px2, of stretches of one line in one picture

    def covariance(self, painting_m: float, trust: NDArray | float) -> NDArray:
        """Return the covariance of `off_px` (M, M); `trust` weights the noise of each stretch."""
        same = self.line[:, None] == self.line
        painted = same * np.outer(self.px_of_m, self.px_of_m) * painting_m**2
        return np.diag(self.variance / trust) + self.alike + painted

    def knowledge(self, painting_m: float, trust: NDArray | float) -> solver.Quadratic:
        """Return the information of the edges on images and lenses, all else eliminated."""
        weighed = np.linalg.solve(self.covariance(painting_m, trust), self.rows)
        return solver.Quadratic(self.network, self.rows.T @ weighed, weighed.T @ self.off_px)

    def noise(self, painting_m: float, trust: NDArray | float) -> NDArray:
        """Return the part of `off_px` that is each stretch's own, in its sigmas, (M,)."""
        pull = np.linalg.solve(self.covariance(painting_m, trust), self.off_px)
        return np.sqrt(self.variance) / trust * pull

    def painted_squares(
        self, painting_m: float, trust: NDArray | float, spread: NDArray
    ) -> NDArray:
        """Return the expected square of each line's painting deviation, m2.

        `spread` is the covariance of the network's columns. The step of expectation maximisation
        (Dempster, Laird & Rubin 1977).
        """
        inverse = np.linalg.inv(self.covariance(painting_m, trust))
        weighed = inverse @ self.rows
        left = inverse - weighed @ spread @ weighed.T
        each = (self.line[:, None] == np.unique(self.line)) * self.px_of_m[:, None]
        mean = painting_m**2 * each.T @ (inverse @ self.off_px)
        known = painting_m**4 * np.einsum("ml,mn,nl->l", each, left, each)
        return mean**2 + np.maximum(painting_m**2 - known, 0.0)


def _linearised(solved: Solution, found: Mapping[str, Edges], court: Court) -> _Linearised:
    """Return the edges of cameras, by name, about the solution's network."""
    names = [camera.name for camera in solved.cameras]
    image = np.concatenate(
        [np.full(len(seen.line), names.index(name)) for name, seen in found.items()]
    )
    line, xyz, across, xy, normal, sigma_px = (
        np.concatenate([getattr(seen, key) for seen in found.values()])
        for key in ("line", "xyz", "across", "xy", "normal", "sigma_px")
    )
    network = selection.of_cameras(solved.cameras)
    seen = problem.with_points(network, xyz, image, np.arange(len(xyz)), xy)
    residual, by_camera, by_point = problem.linearised(seen)
    by_camera = np.einsum("mr,mrk->mk", normal, by_camera)
    by_camera[:, len(POSE) : IMAGE] = 0.0  # the flex stands for the bias of clicks
    rows = np.zeros((len(line), network.n_columns))
    np.put_along_axis(rows, seen.columns(), by_camera, axis=1)
    px_of_m = np.einsum("mr,mrk,mk->m", normal, by_point, across)
    shared_px = THIN_PX / (np.abs(px_of_m) * court.line_width_m)
    same = (image[:, None] == image) & (line[:, None] == line)
    away_m = np.linalg.norm(xyz[:, None] - xyz, axis=2)
    return _Linearised(
        network,
        np.sum(residual * normal, axis=1),
        rows,
        px_of_m,
        line,
        sigma_px**2 + FINE_PX**2,
        same * np.outer(shared_px, shared_px) * np.exp(-away_m / ALIKE_M),
    )
