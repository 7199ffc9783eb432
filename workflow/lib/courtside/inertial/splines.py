"""Smooth functions of time: B-splines whose coefficients follow a prior, and the linear system they give.

A correction that is a spline with a knot every half second or so cannot follow the fast noise of the data
it is fitted to. Its prior is that of an Ornstein-Uhlenbeck process: a standard deviation, and a time over
which it forgets; so a stretch without data falls back to no correction.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import cho_factor, cho_solve, cholesky_banded, lapack

DEGREE = 3
REACH = DEGREE + 1  # basis functions that are not zero at a time
GAUSS = 4  # points per knot interval: exact for products of two cubics


@dataclass(frozen=True)
class Basis:
    """Cubic B-splines on equally spaced knots that cover a span of time.

    Attributes
    ----------
    start_s, spacing_s : float
        First knot, and the distance from knot to knot.
    n_intervals : int
    """

    start_s: float
    spacing_s: float
    n_intervals: int

    @property
    def n(self):
        """Number of basis functions."""
        return self.n_intervals + DEGREE

    def at(self, time_s):
        """Return the first of the four functions at each time (T,) int, and their values (T, 4).

        Times outside the span are taken as its ends.
        """
        first, local = self._place(time_s)
        return first, _pieces()(local)

    def evaluate(self, coefficients, time_s):
        """Return the splines (T, ...) with coefficients (K, ...) at times (T,)."""
        first, values = self.at(time_s)
        picked = coefficients[first[:, None] + np.arange(REACH)]
        return np.einsum("tk,tk...->t...", values, picked)

    def _place(self, time_s):
        u = (np.asarray(time_s, float) - self.start_s) / self.spacing_s
        u = np.clip(u, 0, self.n_intervals)
        first = np.minimum(u.astype(int), self.n_intervals - 1)
        return first, u - first


def basis_over(start_s, stop_s, spacing_s):
    """Return the `Basis` over a span of time.

    Parameters
    ----------
    start_s, stop_s : float
    spacing_s : float
        The knots lie at most so far apart.
    """
    n_intervals = max(1, int(np.ceil((stop_s - start_s) / spacing_s)))
    return Basis(start_s, max(stop_s - start_s, 1e-6) / n_intervals, n_intervals)


def _pieces():
    knots = np.arange(-DEGREE, REACH + 1.0)
    return BSpline(knots, np.eye(REACH), DEGREE)


def precision(basis, memory_s):
    """Return the prior precision of a process of unit variance, as the blocks of a band.

    Parameters
    ----------
    basis : Basis
    memory_s : float
        Time over which the correlation falls to 1/e.

    Returns
    -------
    band : (K, 4) float
        Entry (k, l) of the matrix between coefficients k and k + l; 0 beyond the last.

    Notes
    -----
    The squared norm of the process's reproducing kernel space (Rasmussen & Williams 2006, sec. 6.1):
    half of tau times the integral of the squared slope, plus that of the square over tau, plus the squares
    at both ends.
    """
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS)
    local = (nodes + 1) / 2
    value, slope = _pieces()(local), _pieces().derivative()(local) / basis.spacing_s
    step = weights / 2 * basis.spacing_s
    per_interval = memory_s * np.einsum("g,ga,gb->ab", step, slope, slope)
    per_interval += np.einsum("g,ga,gb->ab", step, value, value) / memory_s
    blocks = np.repeat(per_interval[None] / 2, basis.n_intervals, axis=0)
    for place, interval in ((0.0, 0), (1.0, -1)):
        end = _pieces()(place)
        blocks[interval] += np.outer(end, end) / 2
    band = np.zeros((basis.n, REACH))
    for a in range(REACH):
        for b in range(a, REACH):
            band[a : a + basis.n_intervals, b - a] += blocks[:, a, b]
    return band


def gather(basis, first, values, per_frame, vector):
    """Sum normal equations of every frame's own values into those of the coefficients.

    Parameters
    ----------
    basis : Basis
    first, values : (T,) int, (T, 4) float
        From `Basis.at`.
    per_frame : (T, P, P) float
        Normal matrix of each frame in the P functions' values there.
    vector : (T, P, ...) float
        Right-hand side, or the matrix to border parameters.

    Returns
    -------
    blocks : (K, 4, P, P) float
        Block (k, l): rows of coefficients k, columns of coefficients k + l.
    right : (K, P, ...) float
    """
    blocks = np.zeros((basis.n, REACH, *per_frame.shape[1:]))
    right = np.zeros((basis.n, *vector.shape[1:]))
    order = np.argsort(first, kind="stable")
    intervals, starts = np.unique(first[order], return_index=True)
    per_frame, vector, values = per_frame[order], vector[order], values[order]
    spread = (-1,) + (1,) * (vector.ndim - 1)
    for a in range(REACH):
        right[intervals + a] += np.add.reduceat(values[:, a].reshape(spread) * vector, starts)
        for b in range(a, REACH):
            both = (values[:, a] * values[:, b])[:, None, None]
            blocks[intervals + a, b - a] += np.add.reduceat(both * per_frame, starts)
    return blocks, right


def to_band(blocks):
    """Return the lower band (4 P, K P) that LAPACK reads, of `gather`'s blocks."""
    n, _, size, _ = blocks.shape
    band = np.zeros((REACH * size, n * size))
    row, column = np.meshgrid(np.arange(size), np.arange(size), indexing="ij")
    for step in range(REACH):
        below = step * size + column - row  # the block is above the diagonal: its transpose is kept
        keep = below >= 0
        at = np.arange(n)[:, None] * size + row[keep]
        band[np.broadcast_to(below[keep], at.shape), at] = blocks[:, step][:, keep]
    return band


@dataclass(frozen=True, eq=False)
class Solution:
    """Solution of a bordered banded system.

    Attributes
    ----------
    inner : (K, P) float
        Coefficients of the splines.
    border : (Q,) float
        The other parameters.
    factor : (4 P, K P) float
        Lower Cholesky factor of the banded part.
    border_covariance : (Q, Q) float
    """

    inner: np.ndarray
    border: np.ndarray
    factor: np.ndarray
    border_covariance: np.ndarray

    def samples(self, n, rng):
        """Draw deviations (n, K, P) of the coefficients about their estimate, the border held."""
        size = self.factor.shape[1]
        drawn, _ = lapack.dtbtrs(
            self.factor, rng.standard_normal((size, n)), uplo="L", trans="T", diag="N"
        )
        return drawn.T.reshape(n, *self.inner.shape)


def solve(blocks, right, border, border_matrix, border_right):
    """Solve the normal equations of splines and a few further parameters.

    Parameters
    ----------
    blocks : (K, 4, P, P) float
        As `gather` gives them, with the priors added; positive definite.
    right : (K, P) float
    border : (K, P, Q) float
        Between the coefficients and the further parameters.
    border_matrix, border_right : (Q, Q), (Q,) float

    Returns
    -------
    solution : Solution
    """
    n, size = right.shape
    factor = cholesky_banded(to_band(blocks), lower=True, overwrite_ab=True)
    sides = np.column_stack([border.reshape(n * size, -1), right.reshape(-1)])
    done, _ = lapack.dpbtrs(factor, sides, lower=1)
    schur = border_matrix - sides[:, :-1].T @ done[:, :-1]
    rest = border_right - sides[:, :-1].T @ done[:, -1]
    outer = cho_factor((schur + schur.T) / 2)
    found = cho_solve(outer, rest)
    inner = done[:, -1] - done[:, :-1] @ found
    return Solution(inner.reshape(n, size), found, factor, cho_solve(outer, np.eye(len(rest))))


def times(band, coefficients):
    """Return a symmetric band (K, 4, P), one matrix per function, times coefficients (K, P)."""
    product = band[:, 0] * coefficients
    for step in range(1, REACH):
        product[:-step] += band[:-step, step] * coefficients[step:]
        product[step:] += band[:-step, step] * coefficients[:-step]
    return product
