"""Fixed cameras in the court's frame: bundle adjustment of tie points and clicked court points.

The tie points of one structure from motion are marginalised once to the fixed cameras. Then any set
of clicks costs milliseconds.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import (
    conversion,
    inverses,
    selection,
    solver,
    variance_components,
    walk_parts,
)
from courtside.calibration.bundle.problem import FLEX, IMAGE, POSE, Network
from courtside.calibration.bundle.variance_components import Factors
from courtside.calibration.bundle.walk_parts import Part
from courtside.calibration.court import line_edges, sfm_alignment
from courtside.calibration.court.court import ClickedPoints, Court
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records.covariance import CameraCovariance
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3
from courtside.study.errors import InputError

UHD = 3840  # longer side of a picture, px, at which click sigmas are stated
# Focal lengths are correlated with the bend of the whole model, and the cost falls slowly along a
# curved valley. Most sessions need 20 steps. With at most 20, one small session in thirty was 2.5
# cm off instead of 0.9, and without a court the fixed cameras of one in five were 4 to 7 degrees
# off instead of 1.2 to 1.7.
MAX_ITERATIONS, TOLERANCE = 200, 1e-6
SOLVE_ITERATIONS = 30  # at most, of a `solve` whose cameras are kept or judged
# Of the clicks' loss. Where a lens is still wrong, a good click near the edge of the picture looks
# like a false one, and the loss keeps it so: one session in thirty was 3.1 cm off instead of 0.8.
WIDE_LOSS = 10.0
# Of the variance factors: each round solves with the factors of the one before. They change by a
# few percent after the fourth.
FACTOR_ROUNDS, FACTOR_TOLERANCE = 6, 0.05
STATE = ("cam_from_world", "flex", "lens")  # of a network, what a search moves besides points


@dataclass(frozen=True, eq=False)
class Ties:
    """Tie-point constraints of one structure from motion on the fixed cameras.

    Attributes
    ----------
    cameras : names, in the order of the images of `knowledge.reference`
    sizes : of their pictures, px
    knowledge : in the court's frame, which the ties themselves leave open
    """

    cameras: tuple[str, ...]
    sizes: tuple[tuple[int, int], ...]
    knowledge: solver.Quadratic


@dataclass(frozen=True, eq=False)
class Solution:
    """Fixed cameras in the court's frame with their joint covariance.

    Attributes
    ----------
    network : of the fixed cameras and the court points used
    covariance : (K, K) float; of the network's columns: for each camera rotation (3, rad, in its
        own frame) and translation of cam_from_world (3, m) and its flex (5, always 0), then for
        each camera its lens (`problem.LENS`)
    factors : of the variances that it was weighted with
    """

    cameras: list[Camera]
    network: Network
    covariance: NDArray
    factors: Factors

    @property
    def named(self) -> CameraCovariance:
        """The covariance by camera, as files have it."""
        return camera_covariance.of_network([c.name for c in self.cameras], self.covariance)

    def point_covariance(self, xyz: NDArray) -> NDArray:
        """Return the covariance (N, 3, 3) m2 of points (N, 3) triangulated from exact pixels."""
        return point_covariance.point_covariance(self.network, self.covariance, xyz)


def condense(
    network: Network,
    fixed: Mapping[str, int],
    sizes: Mapping[str, tuple[int, int]],
    clicks: ClickedPoints,
    court: Court,
    *,
    images_per_part: int,
    tie_sigma_px: float,
    tie_loss: float,
    click_sigma_px: float,
    click_loss: float,
    **thinning: Any,
) -> tuple[Ties, list[Part]]:
    """Adjust a network with its clicks, part by part, and marginalise it to the fixed cameras.

    Raises `InputError` if the clicks cannot give a frame.

    Parameters
    ----------
    network : as `sfm.model.read` gives it
    fixed : index of each fixed camera's image; each has a lens of its own
    sizes : of their pictures, px
    images_per_part : see `walk_parts.split`
    tie_sigma_px : weight of the ties. Their errors are not independent: it is larger than a
        feature's own noise
    tie_loss, click_loss : scale of the Cauchy loss, in sigmas
    click_sigma_px : of a click per axis, in pictures with a longer side of 3840 px; in proportion
        in others
    **thinning : arguments of `selection.thin`

    Returns
    -------
    ties : the mean over the parts
    parts : with their chosen points after adjustment, in the court's frame
    """
    cameras = conversion.fixed_cameras(network, fixed, sizes)
    sigma_px = [click_sigma(click_sigma_px, sizes[name]) for name in fixed]

    def adjusted(clicks: ClickedPoints, straightened: bool) -> Iterator[Part]:
        in_world = selection.transform(network, _alignment(court, cameras, clicks))
        for part in walk_parts.split(in_world, list(fixed.values()), images_per_part):
            tied = _ties_of(part.network, tie_sigma_px, tie_loss, thinning)
            at = part.fixed.tolist()
            if straightened:  # from a bent start the clicks may pull it into another minimum
                tied = _adjusted_freely(tied, at)
                straight = _fixed_cameras(tied, fixed, at, sizes)
                tied = selection.transform(tied, _alignment(court, straight, clicks))
            marked = dict(zip(at, [clicks[name] for name in fixed], strict=True))
            sigmas = dict(zip(at, sigma_px, strict=True))
            yield replace(part, network=_adjusted(tied, court, marked, sigmas, click_loss))

    def adjusted_cameras(clicks: ClickedPoints) -> list[Camera]:
        part = next(adjusted(clicks, straightened=True))
        return _fixed_cameras(part.network, fixed, part.fixed, sizes)

    sfm_alignment.refuse_misplaced_cameras(court, cameras, clicks, adjusted_cameras)
    parts = list(adjusted(clicks, sfm_alignment.misses_court(court, cameras, clicks)))
    return _condensed(parts, tuple(fixed), sizes), parts


def strain(parts: Sequence[Part]) -> float:
    """Return by how much the ties fit worse for the clicks, from the parts of `condense`.

    Half the sum of squared residuals of the ties, in sigmas, after adjustment with the clicks, less
    that after adjustment without them; mean over the parts. Clicks that agree with the walk move
    the cameras only where ties leave them open.
    """
    return float(np.mean([_cost_of_clicks(part) for part in parts]))


def _cost_of_clicks(part: Part) -> float:
    freely = _adjusted_freely(part.network, part.fixed.tolist())
    return solver.cost(part.network) - solver.cost(freely)


def _fixed_cameras(network, names, at, sizes) -> list[Camera]:
    return conversion.fixed_cameras(network, dict(zip(names, map(int, at), strict=True)), sizes)


def _alignment(court, cameras, clicks) -> Sim3:
    return sfm_alignment.align(court, sfm_alignment.reconstruct(cameras, clicks))[0]


def _adjusted_freely(network: Network, fixed: Sequence[int]) -> Network:
    """Return a network adjusted without clicks, in its free frame."""
    network = _in_free_frame(network, fixed)
    network, _ = solver.adjust(network, max_iterations=MAX_ITERATIONS, tolerance=TOLERANCE)
    return _in_free_frame(network, fixed)  # which nothing held in place


def _adjusted(
    network: Network,
    court: Court,
    clicks: Mapping[int, NDArray],
    sigma_px: Mapping[int, float],
    click_loss: float,
) -> Network:
    """Return a network adjusted with clicks on court points, by image, without these points.

    Adjusted from two starts, the second with a wide loss first: a graduated loss (Blake &
    Zisserman 1987). The lower cost wins.
    """
    n_ties, n_seen = len(network.xyz), len(network.xy)

    def with_clicks(network: Network, widened: float) -> tuple[Network, float]:
        loss_scale = widened * click_loss
        both = selection.add_control_points(
            network, court.xyz, court.sigma_m, clicks, sigma_px=sigma_px, loss_scale=loss_scale
        )
        if not np.isfinite(solver.cost(both)):
            raise InputError(
                "court points: expected all before the cameras that saw them, found some behind "
                "after alignment; structure from motion went wrong: take more bridging images"
            )
        both, normal = solver.adjust(both, max_iterations=MAX_ITERATIONS, tolerance=TOLERANCE)
        ties = np.arange(len(both.xyz)) < n_ties, np.arange(len(both.xy)) < n_seen
        return selection.select(both, *ties), normal.cost

    starts = network, with_clicks(network, WIDE_LOSS)[0]
    return min((with_clicks(start, 1.0) for start in starts), key=lambda found: found[1])[0]


def condense_free(
    network: Network,
    fixed: Mapping[str, int],
    sizes: Mapping[str, tuple[int, int]],
    *,
    images_per_part: int,
    tie_sigma_px: float,
    tie_loss: float,
    **thinning: Any,
) -> tuple[Ties, list[Part]]:
    """Do as `condense` without a court, in the `selection.free_frame` of the first part."""
    names, parts = tuple(fixed), []
    network = _in_free_frame(network, list(fixed.values()))
    for part in walk_parts.split(network, list(fixed.values()), images_per_part):
        tied = _ties_of(part.network, tie_sigma_px, tie_loss, thinning)
        parts.append(replace(part, network=_adjusted_freely(tied, part.fixed.tolist())))
    parts = walk_parts.in_one_frame(parts, network)
    return _condensed(parts, names, sizes), parts


def _ties_of(network, sigma_px, loss_scale, thinning) -> Network:
    network = selection.thin(network, **thinning)
    return selection.weigh(network, sigma_px=sigma_px, loss_scale=loss_scale)


def _condensed(parts, names, sizes) -> Ties:
    constraints = [selection.marginalise(part.network, part.fixed) for part in parts]
    return Ties(names, tuple(sizes[name] for name in names), solver.mean(constraints))


def _in_free_frame(network: Network, fixed: Sequence[int]) -> Network:
    return selection.transform(network, selection.free_frame(network, fixed))


def free(ties: Ties) -> Solution:
    """Return the `Solution` of `condense_free`; its covariance leaves out frame and scale."""
    known = ties.knowledge
    # The reference is the minimum of the first part, not of the mean over the parts.
    network, _ = solver.adjust(known.reference, quadratic=known, max_iterations=SOLVE_ITERATIONS)
    poses = network.cam_from_world, known.reference.cam_from_world
    network = selection.transform(network, selection.between(*poses))  # nothing held the frame
    covariance = inverses.pseudo_inverse(known.information)
    cameras = conversion.cameras_of(network, ties.cameras, ties.sizes)
    return Solution(cameras, network, covariance, variance_components.none(len(cameras)))


def click_sigma(sigma_px_at_3840: float, size: tuple[int, int]) -> float:
    """Return the sigma of a click in a picture of this size, px."""
    return sigma_px_at_3840 * max(size) / UHD


def click_sigmas(sigma_px_at_3840: float, cameras: Sequence[Camera]) -> NDArray:
    """Return the sigma of a click in the pictures of each camera, (C,) px."""
    return np.array([click_sigma(sigma_px_at_3840, camera.size) for camera in cameras])


def found_click_sigmas(sigma_px_at_3840: float, solved: Solution) -> NDArray:
    """Do as `click_sigmas`, as the residuals have it of the camera whose clicks scatter most.

    Over both axes: the root of their mean variance.
    """
    factor = np.sqrt(solved.factors.clicks.mean(axis=1))
    return click_sigmas(sigma_px_at_3840, solved.cameras) * factor.max()


def solve(
    ties: Ties,
    clicks: ClickedPoints,
    court: Court,
    *,
    click_sigma_px: float,
    click_bias_px: float,
    click_loss: float,
    points: NDArray | None = None,
    max_iterations: int = 8,
    factors: Factors | None = None,
    start: Network | None = None,
    lines: solver.Quadratic | None = None,
) -> Solution:
    """Find the fixed cameras from their tie-point constraints and any clicks.

    Raises `InputError` if neither ties nor clicks place a camera.

    Parameters
    ----------
    click_sigma_px, click_loss : as for `condense`
    click_bias_px : bias that all clicks in one picture share, standard deviation per axis, at a
        longer side of 3840 px
    points : (P,) bool; court points to use; by default all
    factors : on the variances of clicks (scatter, by their edges, and bias) and ties; by default
        none
    start : network of another solution, where the search starts; by default the ties' own
    lines : from painted lines, `court_lines.walk_and_lines.LineConstraints.knowledge`
    """
    factors = factors or variance_components.none(len(ties.cameras))
    network = _with_bias(ties, click_bias_px, factors)
    if start is not None:
        network = replace(network, **{name: getattr(start, name) for name in STATE})
    use = np.ones(len(court.points), dtype=bool) if points is None else np.asarray(points)
    images = {
        at: np.where(use[:, None], clicks[name], np.nan) for at, name in enumerate(ties.cameras)
    }
    sigmas = {
        at: click_sigma(click_sigma_px, size) * np.sqrt(factors.clicks[at] * factors.edges[at])
        for at, size in enumerate(ties.sizes)
    }
    network = selection.add_control_points(
        network, court.xyz, court.sigma_m, images, sigma_px=sigmas, loss_scale=click_loss
    )
    known = knowledge(ties, factors, lines)
    network, normal = solver.adjust(
        network, quadratic=known, max_iterations=max_iterations, tolerance=1e-7
    )
    _check_placed(ties, normal)
    cameras = conversion.cameras_of(network, ties.cameras, ties.sizes)
    covariance = normal.covariance()
    shifts = variance_components.shift_columns(network)
    covariance[shifts], covariance[:, shifts] = 0.0, 0.0  # of the clicks, not of the cameras
    return Solution(cameras, network, covariance, factors)


def knowledge(
    ties: Ties, factors: Factors, lines: solver.Quadratic | None = None
) -> solver.Quadratic:
    """Return what is known besides clicks: of ties with their factor, and of painted lines."""
    known = [solver.scaled(ties.knowledge, 1 / factors.ties), *([lines] if lines else [])]
    return solver.total(known)


def solve_by_edges(ties: Ties, clicks: ClickedPoints, court: Court, **options: Any) -> Solution:
    """Do as `solve`, with clicks less certain along edges that cross flat in the picture.

    The edges are those that cameras see which `solve` found. `**options` are those of `solve`,
    without `factors`.
    """
    solved = solve(ties, clicks, court, **options)
    edges = np.stack([line_edges.click_variances(camera, court) for camera in solved.cameras])
    factors = replace(variance_components.none(len(ties.cameras)), edges=edges)
    options["start"] = solved.network
    return solve(ties, clicks, court, **options, factors=factors)


def solve_by_scatter(
    ties: Ties,
    clicks: ClickedPoints,
    court: Court,
    *,
    of_ties: bool = True,
    rounds: int = FACTOR_ROUNDS,
    **options: Any,
) -> Solution:
    """Do as `solve_by_edges`, with the weights of clicks, and `of_ties`, from their residuals.

    Their given sigmas are priors (`variance_components`). `**options` are those of `solve`, without
    `factors`.
    """
    solved = solve_by_edges(ties, clicks, court, **options)
    for _ in range(rounds):
        before = solved.factors
        knowledge = solver.scaled(ties.knowledge, 1 / before.ties)
        lines = options.get("lines")
        found = variance_components.estimate(solved.network, knowledge, before, lines)
        if not of_ties:
            found = replace(found, ties=1.0, ties_redundancy=0.0)
        solved = solve(ties, clicks, court, **options, factors=found, start=solved.network)
        change = np.append(found.clicks / before.clicks, found.ties / before.ties)
        if np.abs(np.log(change)).max() < FACTOR_TOLERANCE:
            break
    return solved


def solve_with_factors(ties: Ties, clicks: ClickedPoints, court: Court, **options: Any) -> Solution:
    """Do as `solve_by_scatter`, with a larger covariance (`Factors.widening`).

    A few clicks determine their scatter poorly.
    """
    solved = solve_by_scatter(ties, clicks, court, **options)
    return replace(solved, covariance=solved.covariance * solved.factors.widening)


def _with_bias(ties: Ties, click_bias_px: float, factors: Factors) -> Network:
    """Return the network of the fixed cameras with a free shift of their clicks.

    The flex parameters model the bias of the clicks; the marginalised ties do not use them.
    """
    network = ties.knowledge.reference
    flex_sigma = np.zeros((len(ties.cameras), len(FLEX)))
    flex_sigma[:, 3:] = [[click_sigma(click_bias_px, size)] for size in ties.sizes]
    flex_sigma *= np.sqrt(factors.bias)
    return replace(network, flex_sigma=flex_sigma)


def _check_placed(ties: Ties, normal: solver.Normal) -> None:
    of_images = normal.active[: IMAGE * len(ties.cameras)].reshape(-1, IMAGE)
    lost = [
        name
        for name, known in zip(ties.cameras, of_images, strict=True)
        if not known[: len(POSE)].all()
    ]
    if lost:
        raise InputError(
            f"camera {lost[0]}: expected matches with other images or clicked court points, found "
            "neither; click points in it, or film the walk closer to it"
        )
