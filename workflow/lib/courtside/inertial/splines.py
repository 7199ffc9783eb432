"""Smooth functions of time: B-splines whose coefficients have a prior, and their linear system.

A correction that is a spline with a knot every half second or so cannot follow the fast noise of
the data it is fitted to. Its prior is an Ornstein-Uhlenbeck process with a standard deviation and a
memory time: where data are missing, the correction returns to zero.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

DEGREE = 3
REACH = DEGREE + 1  # basis functions that are not zero at a time
GAUSS = 4  # points per knot interval: exact for products of two cubics


@dataclass(frozen=True)
class Basis:
    """Cubic B-splines on equally spaced knots that cover a span of time."""

    start_s: float  # first knot
    spacing_s: float  # between knots
    n_intervals: int

    @property
    def n(self) -> int:
        """Number of basis functions."""
        return self.n_intervals + DEGREE

    def at(self, time_s: NDArray) -> tuple[NDArray, NDArray]:
        """Return the first of the four functions at each time (T,) int, and their values (T, 4).

        Times outside the span are taken as its ends.
        """
        place = (time_s - self.start_s) / self.spacing_s
        place = np.clip(place, 0, self.n_intervals)
        first = np.minimum(place.astype(int), self.n_intervals - 1)
        return first, _pieces()(place - first)

    def evaluate(self, coefficients: NDArray, time_s: NDArray) -> NDArray:
        """Return the splines (T, ...) with coefficients (K, ...) at times (T,)."""
        first, values = self.at(time_s)
        picked = coefficients[first[:, None] + np.arange(REACH)]
        return np.einsum("tk,tk...->t...", values, picked)


def basis_over(start_s: float, stop_s: float, spacing_s: float) -> Basis:
    """Return the `Basis` over a span of time, with knots at most `spacing_s` apart."""
    n_intervals = max(1, int(np.ceil((stop_s - start_s) / spacing_s)))
    return Basis(start_s, max(stop_s - start_s, 1e-6) / n_intervals, n_intervals)


def _pieces() -> "scipy.interpolate.BSpline":
    knots = np.arange(-DEGREE, REACH + 1.0)
    return scipy.interpolate.BSpline(knots, np.eye(REACH), DEGREE)


def precision(basis: Basis, memory_s: float) -> NDArray:
    """Return the prior precision of a process of unit variance, as a band (K, 4).

    Entry (k, l) of the band belongs to coefficients k and k + l; 0 beyond the last. The correlation
    of the process falls to 1/e within `memory_s`.

    The squared norm of the process's reproducing kernel space (Rasmussen & Williams 2006, sec.
    6.1): half of tau times the integral of the squared slope, plus that of the square over tau,
    plus the squares at both ends.
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


def gather(
    blocks: NDArray,
    right: NDArray,
    first: NDArray,
    values: NDArray,
    per_frame: NDArray,
    vector: NDArray,
) -> None:
    """Add the normal equations of frames to those of the coefficients, in place.

    `first` and `values` are of `Basis.at`; `per_frame` (T, P, P) is the normal matrix of each frame
    in the values of the P functions there, `vector` (T, P, ...) its right-hand side or the matrix
    to border parameters. In `blocks` (K, 4, P, P), block (k, l) has the rows of coefficients k and
    the columns of coefficients k + l; `right` (K, P, ...) is the right side. Only the coefficients
    that the frames reach are touched.
    """
    reached = slice(first.min(), first.max() + REACH)
    order = np.argsort(first, kind="stable")
    intervals, starts = np.unique(first[order] - reached.start, return_index=True)
    per_frame, vector, values = per_frame[order], vector[order], values[order]
    spread = (-1,) + (1,) * (vector.ndim - 1)
    added, added_right = np.zeros_like(blocks[reached]), np.zeros_like(right[reached])
    for a in range(REACH):
        added_right[intervals + a] += np.add.reduceat(values[:, a].reshape(spread) * vector, starts)
        for b in range(a, REACH):
            both = (values[:, a] * values[:, b])[:, None, None]
            added[intervals + a, b - a] += np.add.reduceat(both * per_frame, starts)
    blocks[reached] += added
    right[reached] += added_right


def _to_band(blocks: NDArray) -> NDArray:
    """Return the lower band (4 P, K P) of `gather`'s blocks, as LAPACK reads it."""
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
    """Solution of a bordered banded system."""

    inner: NDArray  # (K, P): coefficients of the splines
    border: NDArray  # (Q,): the other parameters
    factor: NDArray  # (4 P, K P): lower Cholesky factor of the banded part
    border_covariance: NDArray  # (Q, Q)

    def samples(self, n: int, rng: np.random.Generator) -> NDArray:
        """Draw deviations (n, K, P) of the coefficients from their estimate, given the border."""
        size = self.factor.shape[1]
        drawn, _ = scipy.linalg.lapack.dtbtrs(
            self.factor, rng.standard_normal((size, n)), uplo="L", trans="T", diag="N"
        )
        return drawn.T.reshape(n, *self.inner.shape)


def solve(
    blocks: NDArray, right: NDArray, border: NDArray, border_matrix: NDArray, border_right: NDArray
) -> Solution:
    """Solve the normal equations of splines and a few further (border) parameters.

    `blocks` and `right` (K, P) are of `gather`, with the priors added, positive definite; `border`
    (K, P, Q) is between both kinds of parameters; the border's own are (Q, Q) and (Q,).
    """
    n, size = right.shape
    factor = scipy.linalg.cholesky_banded(_to_band(blocks), lower=True, overwrite_ab=True)
    sides = np.column_stack([border.reshape(n * size, -1), right.reshape(-1)])
    done, _ = scipy.linalg.lapack.dpbtrs(factor, sides, lower=1)
    schur = border_matrix - sides[:, :-1].T @ done[:, :-1]
    rest = border_right - sides[:, :-1].T @ done[:, -1]
    outer = scipy.linalg.cho_factor((schur + schur.T) / 2)
    found = scipy.linalg.cho_solve(outer, rest)
    inner = done[:, -1] - done[:, :-1] @ found
    return Solution(
        inner.reshape(n, size), found, factor, scipy.linalg.cho_solve(outer, np.eye(len(rest)))
    )


def times(band: NDArray, coefficients: NDArray) -> NDArray:
    """Return a symmetric band (K, 4, P), one matrix per function, times coefficients (K, P)."""
    product = band[:, 0] * coefficients
    for step in range(1, REACH):
        product[:-step] += band[:-step, step] * coefficients[step:]
        product[step:] += band[:-step, step] * coefficients[:-step]
    return product
