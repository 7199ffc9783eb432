"""Normal equations of cameras that see rigid bodies, with the bodies eliminated.

A body is a board or a wand in one place. The cost is linear in the number of bodies N, each with B
unknowns. Others than those of cameras and bodies, E of them, have the columns after the network's.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle import solver
from courtside.calibration.bundle.problem import Network

Known = tuple[NDArray, NDArray]  # information and gradient of what is known before


@dataclass(frozen=True, eq=False)
class Rows:
    """Residuals of a network's views, with their derivatives."""

    off: NDArray  # (M, 2) px
    by_camera: NDArray  # (M, 2, 19): as of `problem.linearised`
    by_others: NDArray  # (M, 2, E)
    by_body: NDArray  # (M, 2, B)
    body: NDArray  # (M,) int
    root: NDArray  # (M,): of the weight of a squared residual, 1 / px; 0: not used


@dataclass(frozen=True, eq=False)
class Normal:
    """Normal equations of the active columns."""

    information: NDArray  # (A, A)
    gradient: NDArray  # (A,)
    inverse: NDArray  # (N, B, B): of the bodies' information
    own: NDArray  # (N, B): gradient of the bodies
    coupling: NDArray  # (N, B, A)
    scores: NDArray  # (N, A): contribution of each body to the gradient

    def step(self, damping: float) -> tuple[NDArray, NDArray]:
        """Return the damped step of the active columns (A,), and that of the bodies (N, B)."""
        damped = self.information + damping * np.diag(np.diag(self.information) + 1e-12)
        part = -np.linalg.solve(damped, self.gradient)
        pull = self.own + np.einsum("bia,a->bi", self.coupling, part)
        return part, -np.einsum("bij,bj->bi", self.inverse, pull)


def normal_equations(
    network: Network, rows: Rows, active: NDArray, others: Known, bodies: Known, damping: float
) -> Normal:
    """Return the equations of the `active` columns (K + E,), with damped bodies.

    Of lenses the network says what is known before; of `others` (E,) and `bodies` (N, B) these do.
    """
    size, (count, n_own) = len(active), bodies[0].shape
    first = np.arange(network.n_columns, size)
    at = np.hstack([network.columns(), np.tile(first, (len(rows.off), 1))])
    by_column = np.concatenate([rows.by_camera, rows.by_others], axis=2)
    off, by_column, by_body = (_weighted(t, rows.root) for t in (rows.off, by_column, rows.by_body))
    pull, inverse = solver.prior(network)
    information = np.diag(np.append(inverse**2, others[0]))
    for seen in solver.by_image(network):
        side = by_column[seen].reshape(-1, at.shape[1])
        information[at[seen[0]][:, None], at[seen[0]]] += side.T @ side
    scores = _summed(at, np.einsum("mri,mr->mi", by_column, off), rows.body, count, size)
    coupling = np.einsum("mri,mrj->mij", by_body, by_column)
    coupling = _summed(at, coupling, _rows(rows.body, n_own), n_own * count, size)
    coupling = coupling.reshape(count, n_own, size)[:, :, active]
    own, of_bodies = _of_bodies(by_body, off, rows.body, bodies, damping)
    solved = of_bodies @ coupling
    scores = scores[:, active] - np.einsum("bia,bi->ba", solved, own)
    eliminated = np.einsum("bia,bic->ac", coupling, solved, optimize=True)
    gradient = np.append(pull * inverse, others[1])[active] + scores.sum(axis=0)
    information = information[np.ix_(active, active)] - eliminated
    return Normal(information, gradient, of_bodies, own, coupling, scores)


def _weighted(terms: NDArray, root: NDArray) -> NDArray:
    root = root.reshape(-1, *[1] * (terms.ndim - 1))
    return np.where(root > 0, terms, 0.0) * root


def _of_bodies(
    by_body: NDArray, off: NDArray, body: NDArray, known: Known, damping: float
) -> tuple[NDArray, NDArray]:
    """Return the gradient (N, B) of the bodies and the inverse (N, B, B) of their information."""
    count, size = known[0].shape
    at = np.tile(np.arange(size), (len(off), 1))
    square = np.einsum("mri,mrj->mij", by_body, by_body)
    square = _summed(at, square, _rows(body, size), size * count, size).reshape(count, size, size)
    own = _summed(at, np.einsum("mri,mr->mi", by_body, off), body, count, size) + known[1]
    diagonal = np.einsum("bii->bi", square)
    diagonal += known[0]
    diagonal *= 1 + damping
    diagonal += diagonal == 0  # of what nothing is seen
    return own, np.linalg.inv(square)


def _rows(body: NDArray, size: int) -> NDArray:
    """Return the rows (M, B) of each body's unknowns."""
    return size * body[:, None] + np.arange(size)


def _summed(at: NDArray, values: NDArray, rows: NDArray, n_rows: int, size: int) -> NDArray:
    """Return the sums (n_rows, size) of values (M, [R,] A) by rows (M, [R]) and columns (M, A)."""
    flat = rows[..., None] * size + (at[:, None] if rows.ndim > 1 else at)
    return np.bincount(flat.ravel(), values.ravel(), minlength=n_rows * size).reshape(n_rows, size)
