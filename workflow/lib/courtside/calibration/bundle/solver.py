"""Bundle adjustment of a `Network`: Levenberg-Marquardt on images and lenses, points eliminated."""

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.bundle import inverses, problem
from courtside.calibration.bundle.problem import Network

DENSE_ELEMENTS = 10_000_000  # 80 MB: up to this size, a dense product is faster than a sparse one
# Relative to a point's information along its best direction: less is rounding error, not depth.
MIN_INFORMATION = 1e-10
MAX_DAMPING = 1e6  # a step of the images is negligible then


@dataclass(frozen=True, eq=False)
class Quadratic:
    """A quadratic prior of image and lens parameters about a reference network."""

    reference: Network
    information: NDArray  # (K, K): second derivative, over all columns
    gradient: NDArray  # (K,): first derivative at the reference


def mean(knowledge: Sequence[Quadratic]) -> Quadratic:
    """Return the mean of several `Quadratic` of the same parameters, about the first's reference.

    The mean is as uncertain as one of them, because their errors may be the same.
    """
    return scaled(total(knowledge), 1 / len(knowledge))


def total(knowledge: Sequence[Quadratic]) -> Quadratic:
    """Return the sum of several independent `Quadratic`, about the first's reference."""
    reference = knowledge[0].reference
    gradients = [k.gradient + k.information @ reference.difference(k.reference) for k in knowledge]
    information = np.sum([k.information for k in knowledge], axis=0)
    return Quadratic(reference, information, np.sum(gradients, axis=0))


def scaled(knowledge: Quadratic, factor: float) -> Quadratic:
    """Return a `Quadratic` that weighs `factor` times as much."""
    return Quadratic(
        knowledge.reference, factor * knowledge.information, factor * knowledge.gradient
    )


@dataclass(frozen=True, eq=False)
class Normal:
    """Normal equations of a network with its points eliminated."""

    active: NDArray  # (K,) bool: parameters that are free and observed
    information: NDArray  # (A, A): of the active ones
    gradient: NDArray  # (A,)
    cost: float  # half the sum of squared, robustly weighted residuals
    back: Callable[[NDArray], NDArray]  # from a step of the active ones to that of points (N, 3)

    def covariance(self) -> NDArray:
        """Return the covariance (K, K) of all columns; 0 for those that are not active."""
        return inverses.of_columns(self.information, self.active)


def adjust(
    network: Network,
    *,
    quadratic: Quadratic | None = None,
    max_iterations: int = 30,
    tolerance: float = 1e-8,
) -> tuple[Network, Normal]:
    """Find the network of least cost, and its normal equations.

    Triggs et al. 2000. The Cauchy loss is applied by weights of Triggs's first order (IRLS).
    Without a prior on points or images the world frame is free: damping keeps it where it starts,
    and the information matrix is singular. `quadratic` is a prior besides the observations. The
    adjustment stops when the relative decrease of the cost is below `tolerance`.
    """
    damping = 1e-4
    state = _state(network, quadratic)
    normal = _normal(state, quadratic)
    for _ in range(max_iterations):
        moved, damping = _fall(state, normal, quadratic, damping)
        if moved is None:
            break
        gain = (state.cost - moved.cost) / max(moved.cost, 1e-300)
        state, damping = moved, max(damping / 10, 1e-9)
        normal = _normal(state, quadratic)
        if gain < tolerance:
            break
    return state.network, normal


def cost(network: Network, quadratic: Quadratic | None = None) -> float:
    """Return half the sum of squared residuals in sigmas, inf where a point is behind its image."""
    return _state(network, quadratic).cost


def normal_equations(network: Network) -> Normal:
    """Build the `Normal` of a network."""
    return _normal(_state(network, None), None)


@dataclass(frozen=True, eq=False)
class _State:
    """A network with the terms of its cost."""

    network: Network
    seen: problem.Seen
    off: NDArray  # (K,): (value - mean) / sigma of images and lenses; 0 without a prior
    inverse_sigma: NDArray  # (K,): 0 without a prior
    step: NDArray  # (K,): from the reference of the quadratic prior; empty without one
    cost: float


def _state(network: Network, quadratic: Quadratic | None) -> _State:
    seen, (off, inverse) = problem.see(network), prior(network)
    step = np.zeros(0) if quadratic is None else network.difference(quadratic.reference)
    scaled = seen.residual / network.sigma_px
    if not np.isfinite(scaled).all():
        return _State(network, seen, off, inverse, step, np.inf)
    square = (scaled**2).sum(axis=1)
    scale = network.loss_scale**2
    robust = np.isfinite(scale)
    total = square[~robust].sum()
    total += (scale[robust] * np.log1p(square[robust] / scale[robust])).sum()
    total += (off**2).sum() + (_point_prior(network)[0] ** 2).sum()
    if quadratic is not None:
        total += step @ quadratic.information @ step + 2 * quadratic.gradient @ step
    return _State(network, seen, off, inverse, step, total / 2)


def _fall(
    state: _State, normal: Normal, quadratic: Quadratic | None, damping: float
) -> tuple[_State | None, float]:
    """Return the state after a step that lowers the cost, None without one, and the damping used.

    Points are not damped: however small the images' steps are, a step may move a point behind an
    image. If no damping helps, these points are not moved, because one of them alone would stop all
    others.
    """
    for hold in (False, True):
        tried = damping
        while tried <= MAX_DAMPING:
            moved = _state(_stepped(state.network, normal, tried, hold), quadratic)
            if moved.cost <= state.cost:
                return moved, tried
            tried *= 10
    return None, damping


def _stepped(network: Network, normal: Normal, damping: float, hold: bool) -> Network:
    """Return the network after a damped step; `hold` keeps points from going behind an image."""
    information = normal.information + damping * np.diag(np.diag(normal.information) + 1e-12)
    with warnings.catch_warnings():
        # Without its damping the information of a free frame is singular.
        warnings.simplefilter("ignore", scipy.linalg.LinAlgWarning)
        part = scipy.linalg.solve(information, -normal.gradient, assume_a="sym")
    step = np.zeros(len(normal.active))
    step[normal.active] = part
    moved = network.moved(step, normal.back(part))
    if hold:
        stay = moved.point_idx[~np.isfinite(problem.residuals(moved)).all(axis=1)]
        moved.xyz[stay] = network.xyz[stay]
    return moved


def _normal(state: _State, quadratic: Quadratic | None) -> Normal:
    network = state.network
    residual, by_camera, by_point = problem.linearised(network, state.seen)
    weight = _weight(network, residual)
    seen = weight > 0
    residual, by_camera, by_point = (
        np.where(_along(seen, terms), terms, 0.0) * _along(weight, terms)
        for terms in (residual, by_camera, by_point)
    )
    columns = network.columns()
    full, gradient = _camera_side(state, columns, by_camera, residual, quadratic)
    active = _active(network) & (np.diag(full) > 0)
    root, point_gradient = _point_side(network, by_point, residual)
    coupling = _coupling(network, columns, active, root, by_point, by_camera)
    scaled_gradient = np.einsum("nij,nj->ni", root, point_gradient)
    eliminated: Any = coupling.T @ coupling
    if scipy.sparse.issparse(eliminated):
        eliminated = eliminated.toarray()
    information = full[np.ix_(active, active)] - eliminated
    gradient = gradient[active] - coupling.T @ scaled_gradient.ravel()

    def back(step: NDArray) -> NDArray:
        pulled = (coupling @ step).reshape(-1, 3) + scaled_gradient
        return -np.einsum("nji,nj->ni", root, pulled)

    return Normal(active, information, gradient, state.cost, back)


def _along(values: NDArray, terms: NDArray) -> NDArray:
    """Return values (M, 2) shaped so that they apply to terms (M, 2, ...)."""
    return values.reshape(*values.shape, *[1] * (terms.ndim - 2))


def _weight(network: Network, residual: NDArray) -> NDArray:
    """Return the root of each axis's weight (M, 2); 0 where its point is behind its image."""
    sigma = network.sigma_px
    square = ((residual / sigma) ** 2).sum(axis=1)
    robust = 1 / np.sqrt(1 + square / network.loss_scale**2)
    return np.where(np.isfinite(square), robust, 0.0)[:, None] / sigma


def _active(network: Network) -> NDArray:
    flex = network.flex_sigma > 0
    pose = np.ones((len(flex), len(problem.POSE)), dtype=bool)
    images = np.concatenate([pose, flex], axis=1)
    return np.concatenate([images.ravel(), (network.lens_sigma > 0).ravel()])


def prior(network: Network) -> tuple[NDArray, NDArray]:
    """Return (value - mean) / sigma and 1 / sigma of images and lenses; 0 without a prior."""
    flex = np.concatenate(
        [np.full((len(network.flex), len(problem.POSE)), np.inf), network.flex_sigma], axis=1
    )
    sigma = np.concatenate([flex.ravel(), network.lens_sigma.ravel()])
    poses = np.zeros((len(network.flex), len(problem.POSE)))
    value = np.concatenate([poses, network.flex], axis=1)
    value = np.concatenate([value.ravel(), (network.lens - network.lens_mean).ravel()])
    inverse = np.divide(1.0, sigma, out=np.zeros_like(sigma), where=sigma > 0)
    return value * inverse, inverse


def _point_prior(network: Network) -> tuple[NDArray, NDArray]:
    known = np.isfinite(network.xyz_sigma)
    inverse = np.divide(1.0, network.xyz_sigma, out=np.zeros(len(known)), where=known)
    return np.where(known[:, None], network.xyz - network.xyz_mean, 0.0) * inverse[:, None], inverse


def _camera_side(
    state: _State,
    columns: NDArray,
    by_camera: NDArray,
    residual: NDArray,
    quadratic: Quadratic | None,
) -> tuple[NDArray, NDArray]:
    """Return information (K, K) and gradient (K,) of images and lenses before elimination."""
    size = state.network.n_columns
    information, gradient = np.zeros((size, size)), np.zeros(size)
    for seen in by_image(state.network):
        own = columns[seen[0]]
        rows = by_camera[seen].reshape(-1, len(own))
        information[own[:, None], own] += rows.T @ rows
        gradient[own] += rows.T @ residual[seen].ravel()
    information[np.diag_indices(size)] += state.inverse_sigma**2
    gradient += state.off * state.inverse_sigma
    if quadratic is not None:
        information += quadratic.information
        gradient += quadratic.gradient + quadratic.information @ state.step
    return information, gradient


def by_image(network: Network) -> list[NDArray]:
    """Return the observations (M',) of each image that has some."""
    order = np.argsort(network.image_idx, kind="stable")
    _, first = np.unique(network.image_idx[order], return_index=True)
    return np.split(order, first[1:]) if len(order) else []


def _point_side(network, by_point, residual) -> tuple[NDArray, NDArray]:
    """Return the points' root, root.T @ root = covariance (N, 3, 3), and gradient."""
    n_points = len(network.xyz)
    blocks = np.einsum("mri,mrj->mij", by_point, by_point).reshape(-1, 9)
    information = _sum_by(network.point_idx, blocks, n_points).reshape(-1, 3, 3)
    gradient = _sum_by(network.point_idx, np.einsum("mri,mr->mi", by_point, residual), n_points)
    off, inverse = _point_prior(network)
    information = information + (inverse**2)[:, None, None] * np.eye(3)
    gradient = gradient + off * inverse[:, None]
    extent, axes = np.linalg.eigh(information)
    most = extent[:, -1:]
    extent = np.maximum(extent, MIN_INFORMATION * most + (most == 0))
    root = axes.transpose(0, 2, 1) / np.sqrt(extent)[:, :, None]
    return root, gradient


def _sum_by(index: NDArray, values: NDArray, length: int) -> NDArray:
    sums = [np.bincount(index, column, minlength=length) for column in values.T]
    return np.stack(sums, axis=1).astype(float)  # int of nothing


def _coupling(
    network: Network,
    columns: NDArray,
    active: NDArray,
    root: NDArray,
    by_point: NDArray,
    by_camera: NDArray,
) -> "NDArray | scipy.sparse.csr_matrix":
    """Return root @ by_point.T @ by_camera of the active columns, summed by point: (3 N, A).

    Sparse where it is large.
    """
    along = by_point @ root[network.point_idx].transpose(0, 2, 1)
    block = (
        along[:, 0, :, None] * by_camera[:, 0, None, :]
        + along[:, 1, :, None] * by_camera[:, 1, None, :]
    )
    rows = 3 * network.point_idx[:, None, None] + np.arange(3)[None, :, None]
    n_rows, n_columns = 3 * len(network.xyz), np.count_nonzero(active)
    # A last column takes what is not active.
    place = np.where(active, np.cumsum(active) - 1, n_columns)[columns][:, None, :]
    shape = (n_rows, n_columns + 1)
    if n_rows * shape[1] <= DENSE_ELEMENTS:
        whole = np.bincount(
            (rows * shape[1] + place).ravel(), block.ravel(), minlength=n_rows * shape[1]
        )
        return whole.reshape(shape)[:, :n_columns]
    at = (np.broadcast_to(rows, block.shape).ravel(), np.broadcast_to(place, block.shape).ravel())
    return scipy.sparse.csr_matrix((block.ravel(), at), shape=shape)[:, :n_columns]
