"""Bundle adjustment of all cameras and all positions of a wand, with covariance.

A body is the wand in one frame, or a single point: a marker whose partners are hidden, or a clicked
point. Bodies are eliminated from the normal equations, so that the cost is linear in frames. One
more unknown is the ratio of the true length of the wand to the stated one; the uncertainty of the
stated length is its prior. Residuals have Cauchy weights; their scale is wide at first. Clicks keep
their own sigma and scale.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle import elimination, inverses, problem
from courtside.calibration.bundle.elimination import Normal
from courtside.calibration.bundle.problem import Network
from courtside.geometry import rotations
from courtside.statistics import normal_errors

BODY = 5  # unknowns: position of its origin (3), rotation of its direction (2)
WIDENED = (8.0, 4.0, 2.0, 1.0)  # factors of the Cauchy scale: initial cameras are rough
CAUCHY = 2.5  # ASSUME: sigmas at which a residual has half its weight
ROUNDS = 6  # of estimating sigma again, after the last widening
STEPS, CONVERGED = 12, 1e-4  # most steps of a round; relative decrease of the cost at its end
# Variance of a position with these weights and normal errors in two dimensions, divided by the one
# that the sum of weights gives: E[w] E[w^2 s] / (2 E[w^2]^2), w the weight, s the squared error in
# sigmas.
EFFICIENCY = 0.84
WRONG_SIGMAS = 4.0  # a marker with a larger residual is another spot
LEAST_SIGMA_PX = 0.01  # no program finds markers better
BLOCKS = 40  # ASSUME: parts of the time whose errors are independent
RIGID = 6  # position and orientation of a world that only the wand defines


@dataclass(frozen=True, eq=False)
class Bodies:
    """The wand in N frames, and points at known positions."""

    origin: NDArray  # (N, 3) m
    direction: NDArray  # (N, 3): unit vectors along the wand; arbitrary for a point
    known: NDArray  # (N, 3) m: the stated position of a point
    sigma_m: NDArray  # (N,): its standard deviation; inf for the wand
    body: NDArray  # (P,): the body of each point of the network
    along_m: NDArray  # (P,): its stated distance from the origin of its body
    block: NDArray  # (N,): the part of the time


@dataclass(frozen=True, eq=False)
class State:
    """Cameras, bodies, and the logarithm of the ratio of the true length to the stated one."""

    network: Network  # its points follow from the bodies
    bodies: Bodies
    length: float = 0.0
    length_sigma: float = 0.0

    def placed(self) -> "State":
        """Return the state with the points of the network at the positions given by the bodies."""
        each = self.bodies
        away = (np.exp(self.length) * each.along_m)[:, None] * each.direction[each.body]
        return replace(self, network=replace(self.network, xyz=each.origin[each.body] + away))


@dataclass(frozen=True, eq=False)
class Adjusted:
    """The result of the adjustment."""

    state: State
    covariance: NDArray  # (K, K): of the network's columns
    sigma_px: float  # of a marker, per axis
    factor: float  # of the covariance, from the scatter of the parts of the time


def adjust(state: State, active: NDArray, of_wand: NDArray) -> Adjusted:
    """Adjust the `active` columns (K,) of the cameras, and all bodies.

    `of_wand` (M,) selects the views whose sigma is estimated from residuals. Others keep theirs,
    and their loss, which is wide at first, too.
    """
    columns = np.append(active, state.length_sigma > 0)
    redundancy = _redundancy(state.bodies, int(columns.sum()), int(of_wand.sum()))
    sigma_px = _sigma(state, of_wand, redundancy)
    loss = np.where(of_wand, CAUCHY, state.network.loss_scale)
    for widened in (*WIDENED, *[1.0] * ROUNDS):
        state = _minimised(_weighted(state, of_wand, sigma_px, loss * widened), columns)
        last, sigma_px = sigma_px, _sigma(state, of_wand, redundancy)
        if widened == 1.0 and abs(sigma_px - last) <= 1e-3 * sigma_px:
            break
    state = _weighted(state, of_wand, sigma_px, loss)
    factor = _factor_of_blocks(state, columns)
    wide = float(np.sqrt(EFFICIENCY * factor))
    loss = np.where(of_wand, loss / wide, loss)
    normal = _normal(_weighted(state, of_wand, wide * sigma_px, loss), columns, 0.0)
    covariance = np.zeros((len(columns), len(columns)))
    covariance[np.ix_(columns, columns)] = _inverse(state, normal)
    return Adjusted(state, covariance[:-1, :-1], sigma_px, factor)


def with_lens_errors(found: Adjusted, active: NDArray, sigma: NDArray) -> NDArray:
    """Return the covariance (K, K) with errors of lenses that were kept.

    `active` (K,) are the columns that were adjusted, `sigma` (K,) the standard deviations of those
    that were kept, 0 where exact. What was adjusted follows a wrong lens by the normal equations.
    """
    state, kept = found.state, np.append(sigma > 0, False)
    columns = np.append(active, state.length_sigma > 0)
    both = columns | kept
    normal = _normal(state, both, 0.0)
    of, by = columns[both], kept[both]
    own = replace(normal, information=normal.information[np.ix_(of, of)])
    follow = np.zeros((len(both), kept.sum()))
    follow[columns] = -_inverse(state, own) @ normal.information[np.ix_(of, by)]
    follow[kept] = np.eye(kept.sum())
    follow = follow[:-1] * sigma[kept[:-1]]
    return found.covariance + follow @ follow.T


def _redundancy(bodies: Bodies, of_cameras: int, views: int) -> float:
    """Return the share of the wand's measurements above the number of unknowns."""
    swung = bodies.sigma_m == np.inf
    turned = np.unique(bodies.body[bodies.along_m != 0])
    unknown = 3 * int(swung.sum()) + 2 * len(turned) + of_cameras
    return max(1.0, 2 * views - unknown) / (2 * views)


def _sigma(state: State, of_wand: NDArray, redundancy: float) -> float:
    """Return the sigma of a marker per axis, px, from residuals without those of wrong markers.

    Residuals of markers that two cameras see are nearly zero along one axis. Therefore the median
    of the residuals' lengths only decides which markers are wrong; sigma is the root mean square of
    the others.
    """
    off = problem.residuals(state.network)[of_wand]
    length = np.linalg.norm(off, axis=1)
    typical = float(np.nanmedian(length)) / normal_errors.MEDIAN_2D / np.sqrt(redundancy)
    inside = length < WRONG_SIGMAS * max(LEAST_SIGMA_PX, typical)
    found = float(np.sqrt(np.mean(off[inside] ** 2) / redundancy)) if inside.any() else typical
    return max(LEAST_SIGMA_PX, found)


def _weighted(state: State, of_wand: NDArray, sigma_px: float, loss: NDArray) -> State:
    """Return the state with this sigma of markers, and these Cauchy scales (M,) of all views."""
    sigma = np.where(of_wand[:, None], sigma_px, state.network.sigma_px)
    network = replace(state.network, sigma_px=sigma, loss_scale=loss)
    return replace(state, network=network)


def _minimised(state: State, columns: NDArray) -> State:
    """Return the state at the minimum of the cost, by the method of Levenberg and Marquardt."""
    damping, cost = 1e-4, _cost(state)
    for _ in range(STEPS):
        moved = _moved(state, columns, damping)
        trial = _cost(moved)
        while not trial <= cost and damping < 1e6:
            damping *= 10
            moved = _moved(state, columns, damping)
            trial = _cost(moved)
        if not trial <= cost:
            break
        fell, state, cost, damping = cost - trial, moved, trial, max(damping / 10, 1e-9)
        if fell <= CONVERGED * cost:
            break
    return state


def _scaled(state: State) -> tuple[NDArray, NDArray]:
    """Return squared residuals (M,) in sigmas, NaN behind a camera, and robust weights (M,)."""
    off = problem.residuals(state.network) / state.network.sigma_px
    square = (off**2).sum(axis=1)
    return square, np.nan_to_num(1 / (1 + square / state.network.loss_scale**2))


def _cost(state: State) -> float:
    """Return twice the robust cost; inf if a point is behind a camera that sees it."""
    network, bodies = state.network, state.bodies
    square, _ = _scaled(state)
    if not np.isfinite(square).all():
        return np.inf
    loss = network.loss_scale**2
    total = float((loss * np.log1p(square / loss)).sum())
    lens, _ = _in_sigmas(network.lens - network.lens_mean, network.lens_sigma)
    place, _ = _in_sigmas(bodies.origin - bodies.known, bodies.sigma_m[:, None])
    length, _ = _in_sigmas(np.array(state.length), np.array(state.length_sigma))
    return total + float((lens**2).sum() + (place**2).sum() + length**2)


def _in_sigmas(off: NDArray, sigma: NDArray) -> tuple[NDArray, NDArray]:
    """Return differences from a prior in sigmas, and 1 / sigma; both 0 where sigma is 0 or inf."""
    inverse = np.divide(1.0, sigma, out=np.zeros_like(sigma), where=sigma > 0)
    return off * inverse, inverse


def _normal(state: State, columns: NDArray, damping: float) -> Normal:
    """Return the normal equations of the active `columns` (K + 1,): of cameras, then the length."""
    network, bodies = state.network, state.bodies
    off, by_camera, by_point = problem.linearised(network)
    body = bodies.body[network.point_idx]
    reach = (np.exp(state.length) * bodies.along_m[network.point_idx])[:, None, None]
    by_turn = reach * by_point @ _perpendicular(bodies.direction)[body]
    by_length = reach * by_point @ bodies.direction[body][:, :, None]
    by_body = np.concatenate([by_point, by_turn], axis=2)
    root = np.sqrt(_scaled(state)[1]) / network.sigma_px[:, 0]  # of both axes
    rows = elimination.Rows(off, by_camera, by_length, by_body, body, root)
    length, of_length = _in_sigmas(np.array([state.length]), np.array([state.length_sigma]))
    place, inverse = _in_sigmas(bodies.origin - bodies.known, bodies.sigma_m[:, None])
    information, pull = np.zeros((2, len(bodies.origin), BODY))
    information[:, :3], pull[:, :3] = inverse**2, inverse * place
    known = (of_length**2, of_length * length), (information, pull)
    return elimination.normal_equations(network, rows, columns, *known, damping)


def _perpendicular(direction: NDArray) -> NDArray:
    """Return two unit vectors (N, 3, 2) perpendicular to each direction (N, 3)."""
    axis = np.eye(3)[np.abs(direction).argmin(axis=1)]
    first = rotations.unit(np.cross(direction, axis))
    return np.stack([first, np.cross(direction, first)], axis=2)


def _moved(state: State, columns: NDArray, damping: float) -> State:
    """Return the state after a damped step."""
    part, own = _normal(state, columns, damping).step(damping)
    step = np.zeros(len(columns))
    step[columns] = part
    bodies = state.bodies
    turn = np.einsum("bij,bj->bi", _perpendicular(bodies.direction), own[:, 3:])
    bodies = replace(
        bodies,
        origin=bodies.origin + own[:, :3],
        direction=rotations.unit(bodies.direction + turn),
    )
    network = state.network.moved(step[:-1], np.zeros_like(state.network.xyz))
    length = state.length + float(step[-1])
    return replace(state, network=network, bodies=bodies, length=length).placed()


def _inverse(state: State, normal: Normal) -> NDArray:
    """Return the covariance (A, A) of the active columns."""
    free = 0 if np.isfinite(state.bodies.sigma_m).any() else RIGID
    return inverses.pseudo_inverse(normal.information, n_free=free)


def _factor_of_blocks(state: State, columns: NDArray) -> float:
    """Return the scatter of blocks of time relative to that of single frames, 1 or more.

    Errors of neighbouring frames are correlated if cameras are not synchronised, or if a tracker
    follows another spot. The scores of blocks then scatter more than those of single frames. The
    mean ratio over all unknowns multiplies the covariance (a sandwich estimate with one number).
    """
    normal = _normal(state, columns, 0.0)
    inverse = _inverse(state, normal)
    block = np.unique(state.bodies.block, return_inverse=True)[1]
    sums = np.zeros((block.max() + 1, len(inverse)))
    np.add.at(sums, block, normal.scores)
    alone, together = (
        float(np.einsum("ba,ac,bc", one, inverse, one, optimize=True))
        for one in (normal.scores, sums)
    )
    return max(1.0, together / max(alone, 1e-300))
