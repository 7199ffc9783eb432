"""Bundle adjustment of a `Network`: Levenberg-Marquardt on images and lenses, points eliminated."""

import warnings
from dataclasses import dataclass, replace

import numpy as np
from scipy import linalg, sparse

from courtside.calibration.bundle import problem as networks

SMALL = 10_000  # elements of a matrix that is not worth the overhead of a sparse one
FLAT = 1e-10  # of a point's information along its best direction: no depth is known below it
MOST_DAMPING = 1e6  # the steps of images are nothing then


@dataclass(frozen=True, eq=False)
class Quadratic:
    """What else is known of the image and lens parameters: a parabola about a reference.

    Attributes
    ----------
    reference : courtside.calibration.bundle.problem.Network
    information : (K, K) float
        Second derivative, over all columns.
    gradient : (K,) float
        First derivative at the reference.
    """

    reference: networks.Network
    information: np.ndarray
    gradient: np.ndarray


def mean(knowledge):
    """Return the mean of what several `Quadratic` say of the same parameters, about the first's reference.

    It knows no more than they do one by one: their errors may be the same.
    """
    reference = knowledge[0].reference
    gradients = [k.gradient + k.information @ reference.difference(k.reference) for k in knowledge]
    information = np.mean([k.information for k in knowledge], axis=0)
    return Quadratic(reference, information, np.mean(gradients, axis=0))


@dataclass(frozen=True, eq=False)
class Normal:
    """Normal equations of a network with its points eliminated.

    Attributes
    ----------
    active : (K,) bool
        The parameters that are not fixed, and of which anything is known.
    information : (A, A) float
        Of the active ones.
    gradient : (A,) float
    cost : float
        Half the sum of squared, robustly weighted residuals.
    point_information : (N, 3, 3) float
    back : callable
        Step of the points (N, 3) from a step of the active parameters (A,).
    """

    active: np.ndarray
    information: np.ndarray
    gradient: np.ndarray
    cost: float
    point_information: np.ndarray
    back: object


def adjust(network, *, quadratic=None, max_iterations=30, tolerance=1e-8):
    """Find the network of least cost.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
        A start within the reach of Newton's method.
    quadratic : Quadratic, optional
        Knowledge that is not in the observations.
    max_iterations : int
    tolerance : float
        Stop when the cost falls by less than this fraction.

    Returns
    -------
    network : courtside.calibration.bundle.problem.Network
    normal : Normal
        At the solution.

    Notes
    -----
    Triggs et al. 2000. The Cauchy loss is kept by weights of Triggs's first order (IRLS). Without a prior on
    points or images the world frame is free: damping keeps it where it starts, and the information is
    singular.
    """
    damping = 1e-4
    normal = normal_equations(network, quadratic)
    for _ in range(max_iterations):
        moved, trial, damping = _fall(network, normal, quadratic, damping)
        if trial is None:
            break
        gain = (normal.cost - trial) / max(trial, 1e-300)
        network, damping = moved, max(damping / 10, 1e-9)
        normal = _normal(network, quadratic, trial)
        if gain < tolerance:
            break
    return network, normal


def _fall(network, normal, quadratic, damping):
    """Return the network after a step that lowers the cost, the cost, and the damping that it took.

    Points are not damped: a step may put one behind an image however small the images' steps are. Where
    no damping helps, such points stay where they were, because one alone would stop all others.
    """
    for hold in (False, True):
        tried = damping
        while tried <= MOST_DAMPING:
            moved, trial = _descend(network, normal, quadratic, tried, hold)
            if trial is not None:
                return moved, trial, tried
            tried *= 10
    return network, None, damping


def _descend(network, normal, quadratic, damping, hold):
    """Return the network after a damped step with its cost, None if the cost does not fall."""
    information = normal.information + damping * np.diag(np.diag(normal.information) + 1e-12)
    with (
        warnings.catch_warnings()
    ):  # a free frame leaves the information singular but for the damping
        warnings.simplefilter("ignore", linalg.LinAlgWarning)
        part = linalg.solve(information, -normal.gradient, assume_a="sym")
    step = np.zeros(len(normal.active))
    step[normal.active] = part
    moved = network.moved(step, normal.back(part))
    if hold:
        moved = _in_front(moved, network)
    trial = cost(moved, quadratic)
    return moved, trial if trial <= normal.cost else None


def _in_front(moved, network):
    """Return a moved network whose points stay where they were if they would be behind an image."""
    behind = ~np.isfinite(networks.residuals(moved)).all(axis=1)
    xyz = moved.xyz.copy()
    stay = np.unique(moved.point_idx[behind])
    xyz[stay] = network.xyz[stay]
    return replace(moved, xyz=xyz)


def cost(network, quadratic=None):
    """Return half the sum of squares of all residuals in sigmas, inf where a point is behind its image."""
    scaled = networks.residuals(network) / network.sigma_px[:, None]
    if not np.isfinite(scaled).all():
        return np.inf
    square = (scaled**2).sum(axis=1)
    scale = network.loss_scale**2
    robust = np.isfinite(scale)
    total = square[~robust].sum()
    total += (scale[robust] * np.log1p(square[robust] / scale[robust])).sum()
    off, _ = _prior(network)
    total += (off**2).sum() + (_point_prior(network)[0] ** 2).sum()
    if quadratic is not None:
        step = network.difference(quadratic.reference)
        total += step @ quadratic.information @ step + 2 * quadratic.gradient @ step
    return total / 2


def normal_equations(network, quadratic=None):
    """Build the `Normal` of a network.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
    quadratic : Quadratic, optional
    """
    return _normal(network, quadratic, cost(network, quadratic))


def _normal(network, quadratic, total):
    """Return the `Normal` of a network whose cost is known."""
    residual, by_camera, by_point = networks.linearised(network)
    weight = _weight(network, residual)
    seen = weight > 0
    residual, by_camera, by_point = (
        np.where(_along(seen, terms), terms, 0.0) * _along(weight, terms)
        for terms in (residual, by_camera, by_point)
    )
    full, gradient = _camera_side(network, by_camera, residual, quadratic)
    active = _active(network) & (np.diag(full) > 0)
    root, point_gradient, point_information = _point_side(network, by_point, residual)
    coupling = _coupling(network, root, by_point, by_camera)[:, active]
    scaled_gradient = np.einsum("nij,nj->ni", root, point_gradient)
    information = full[np.ix_(active, active)] - _dense(coupling.T @ coupling)
    gradient = gradient[active] - coupling.T @ scaled_gradient.ravel()

    def back(step):
        pulled = (coupling @ step).reshape(-1, 3) + scaled_gradient
        return -np.einsum("nji,nj->ni", root, pulled)

    return Normal(active, information, gradient, total, point_information, back)


def _along(values, terms):
    """Return values (M,) shaped so that they apply to terms (M, ...)."""
    return values.reshape(-1, *[1] * (terms.ndim - 1))


def _weight(network, residual):
    """Return the square root of each observation's weight (M,); 0 where its point is behind its image."""
    square = (residual**2).sum(axis=1) / network.sigma_px**2
    robust = 1 / np.sqrt(1 + square / network.loss_scale**2)
    return np.where(np.isfinite(square), robust, 0.0) / network.sigma_px


def _active(network):
    flex = network.flex_sigma > 0
    pose = np.ones((len(flex), len(networks.POSE)), dtype=bool)
    images = np.concatenate([pose, flex], axis=1)
    return np.concatenate([images.ravel(), (network.lens_sigma > 0).ravel()])


def _prior(network):
    """Return (value - mean) / sigma and 1 / sigma of image and lens parameters, 0 where nothing is known."""
    flex = np.concatenate(
        [np.full((len(network.flex), len(networks.POSE)), np.inf), network.flex_sigma], axis=1
    )
    sigma = np.concatenate([flex.ravel(), network.lens_sigma.ravel()])
    poses = np.zeros((len(network.flex), len(networks.POSE)))
    value = np.concatenate([poses, network.flex], axis=1)
    value = np.concatenate([value.ravel(), (network.lens - network.lens_mean).ravel()])
    inverse = np.divide(1.0, sigma, out=np.zeros_like(sigma), where=sigma > 0)
    return value * inverse, inverse


def _point_prior(network):
    known = np.isfinite(network.xyz_sigma)
    inverse = np.divide(1.0, network.xyz_sigma, out=np.zeros(len(known)), where=known)
    return np.where(known[:, None], network.xyz - network.xyz_mean, 0.0) * inverse[:, None], inverse


def _camera_side(network, by_camera, residual, quadratic):
    """Return information (K, K) and gradient (K,) of the image and lens parameters before elimination."""
    size, columns = network.n_columns, network.columns()
    blocks = np.einsum("mri,mrj->mij", by_camera, by_camera)
    rows = np.broadcast_to(columns[:, :, None], blocks.shape).ravel()
    flat = rows * size + np.broadcast_to(columns[:, None, :], blocks.shape).ravel()
    information = np.bincount(flat, blocks.ravel(), minlength=size * size).reshape(size, size)
    pull = np.einsum("mri,mr->mi", by_camera, residual)
    gradient = np.bincount(columns.ravel(), pull.ravel(), minlength=size)
    off, inverse = _prior(network)
    information[np.diag_indices(size)] += inverse**2
    gradient += off * inverse
    if quadratic is not None:
        step = network.difference(quadratic.reference)
        information += quadratic.information
        gradient += quadratic.gradient + quadratic.information @ step
    return information, gradient


def _point_side(network, by_point, residual):
    """Return of the points root (N, 3, 3), root.T @ root being their covariance, gradient and information."""
    n_points = len(network.xyz)
    blocks = np.einsum("mri,mrj->mij", by_point, by_point).reshape(-1, 9)
    information = _sum_by(network.point_idx, blocks, n_points).reshape(-1, 3, 3)
    gradient = _sum_by(network.point_idx, np.einsum("mri,mr->mi", by_point, residual), n_points)
    off, inverse = _point_prior(network)
    information = information + (inverse**2)[:, None, None] * np.eye(3)
    gradient = gradient + off * inverse[:, None]
    extent, axes = np.linalg.eigh(information)
    most = extent[:, -1:]
    extent = np.maximum(extent, FLAT * most + (most == 0))
    root = axes.transpose(0, 2, 1) / np.sqrt(extent)[:, :, None]
    return root, gradient, information


def _sum_by(index, values, length):
    return np.stack([np.bincount(index, column, minlength=length) for column in values.T], axis=1)


def _coupling(network, root, by_point, by_camera):
    """Return root @ by_point.T @ by_camera, summed by point: (3 N, K), sparse where it is large."""
    block = np.einsum("mij,mrj,mrk->mik", root[network.point_idx], by_point, by_camera)
    rows = 3 * network.point_idx[:, None, None] + np.arange(3)[None, :, None]
    columns = network.columns()[:, None, :]
    n_rows, n_columns = 3 * len(network.xyz), network.n_columns
    if n_rows * n_columns <= SMALL:
        at = (rows * n_columns + columns).ravel()
        whole = np.bincount(at, block.ravel(), minlength=n_rows * n_columns)
        return whole.reshape(n_rows, n_columns)
    at = (np.broadcast_to(rows, block.shape).ravel(), np.broadcast_to(columns, block.shape).ravel())
    return sparse.csr_matrix((block.ravel(), at), shape=(n_rows, n_columns))


def _dense(matrix):
    return matrix.toarray() if sparse.issparse(matrix) else matrix
