"""Variance factors of clicks and tie points, estimated from their residuals.

Förstner 1979; Koch 1999, sec. 3.6: the weighted sum of squared residuals of a group, divided by the
redundancy of the group, estimates the factor by which its stated variances are wrong. A few
redundant observations determine the factor poorly. Therefore it has a prior: a scaled inverse
chi-squared distribution, as if `*_PRIOR` more redundant observations had shown a factor of 1. The
scale of the posterior is the mean of prior and estimate, weighted by their redundancy; its degrees
of freedom are the sum of both. With a poorly known variance, errors follow Student's t.
`Factors.widening` is the ratio of its 90 % ellipsoid to that of a normal distribution of the same
scale.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.bundle import inverses, problem, solver
from courtside.calibration.bundle.problem import IMAGE, POSE, Network
from courtside.statistics import normal_errors

# Redundant observations that the priors count for. The first was chosen on small halls
# (docs/measured/calibration_by_walk.md); ASSUME: the two others, which were not varied.
CLICKS_PRIOR = 1.0  # of all clicks together, about the stated sigma
CAMERA_PRIOR = 4.0  # of one camera's clicks along one axis, about the factor of all clicks
TIES_PRIOR = 6.0  # of the ties, about the spread of their residuals
LIMITS = 0.05, 400.0  # ASSUME: no variance is farther off; keeps a start far off from running away
LEVEL = 0.9  # of the ellipsoids that `Factors.widening` makes right
AXES = 3  # of a point's error
GAUGE = 7  # rotation, translation and scale of the frame, which ties leave open


@dataclass(frozen=True, eq=False)
class Factors:
    """Factors on the variances that clicks and ties were stated to have.

    Attributes
    ----------
    clicks : (V, 2) float; of the scatter of each image's clicks along x and y
    ties : of all ties
    clicks_redundancy : (V, 2) float; redundancy of the clicks; 0: the prior alone
    ties_redundancy : the same for the ties
    edges : (V, P, 2) or (V, 1, 2) float; besides, of each click, because its edges may cross flat:
        `court.line_edges.click_variances`; not estimated
    """

    clicks: NDArray
    ties: float
    clicks_redundancy: NDArray
    ties_redundancy: float
    edges: NDArray

    @property
    def bias(self) -> float:
        """Factor of the clicks' bias, which residuals hardly show: the mean of the scatter's."""
        return float(np.mean(self.clicks))

    @property
    def widening(self) -> float:
        """Factor on the covariance of the cameras, because the scatter of the clicks is uncertain.

        The 90 % ellipsoid of Student's t with as many degrees of freedom as the clicks' prior and
        redundancy, over that of a normal distribution: 4 at 1.2 redundant observations, 1.1 at 20.
        """
        freedom = CLICKS_PRIOR + float(self.clicks_redundancy.sum())
        student = AXES * scipy.special.fdtri(AXES, freedom, LEVEL)
        return float(student / normal_errors.ellipsoid(LEVEL))


def none(n_images: int) -> Factors:
    """Return factors that change nothing."""
    alike = np.ones((n_images, 2)), 1.0, np.zeros((n_images, 2)), 0.0
    return Factors(*alike, np.ones((n_images, 1, 2)))


def estimate(
    network: Network,
    quadratic: solver.Quadratic,
    factors: Factors,
    lines: solver.Quadratic | None = None,
) -> Factors:
    """Estimate the factors of a network of clicks adjusted with the `quadratic` of its ties.

    `factors` are those already contained in the network's sigmas and in the quadratic; `lines` is
    additional information, whose weight stays.
    """
    sigma = network.sigma_px
    residual, rows = _rows(network)
    known = [quadratic] if lines is None else [quadratic, lines]
    covariance = _covariance(network, solver.total(known), rows)
    square = (residual / sigma) ** 2
    weight = 1 / (1 + square.sum(axis=1) / network.loss_scale**2)
    rows = rows * np.sqrt(weight)[:, None, None]
    used = 1 - np.einsum("mrk,mrk->mr", rows @ covariance, rows)
    square *= (weight / _consistency(network.loss_scale))[:, None]
    squares, redundancy = (_by_image(network, terms) for terms in (square, used))
    squares, redundancy = squares * factors.clicks, np.maximum(redundancy, 0.0)
    pooled = _posterior(squares.sum(), redundancy.sum(), CLICKS_PRIOR, 1.0)
    misfit, left = _of_ties(network, quadratic, covariance)
    return Factors(
        _posterior(squares, redundancy, CAMERA_PRIOR, pooled),
        float(_posterior(misfit * factors.ties, left, TIES_PRIOR, 1.0)),
        redundancy,
        left,
        factors.edges,
    )


def _posterior(square, redundancy, prior: float, mean: float | NDArray) -> NDArray:
    """Return the posterior scale of factors: the squares are in stated variances."""
    return np.clip((prior * mean + square) / (prior + redundancy), *LIMITS)


def _by_image(network: Network, terms: NDArray) -> NDArray:
    """Return the sums of terms (M, 2) by image, (V, 2)."""
    found = np.zeros((len(network.cam_from_world), 2))
    np.add.at(found, network.image_idx, terms)
    return found


def _rows(network: Network) -> tuple[NDArray, NDArray]:
    """Return the residuals (M, 2) px and their derivatives (M, 2, K + 3 N), in sigmas."""
    residual, by_camera, by_point = problem.linearised(network)
    size = network.n_columns
    rows = np.zeros((len(residual), 2, size + 3 * len(network.xyz)))
    rows[:, :, :size] = network.over_columns(by_camera)
    places = size + 3 * network.point_idx[:, None, None] + np.arange(3)
    np.put_along_axis(rows, places.repeat(2, axis=1), by_point, axis=2)
    return residual, rows / network.sigma_px[:, :, None]


def _covariance(network: Network, quadratic: solver.Quadratic, rows: NDArray) -> NDArray:
    """Return the covariance of images, lenses and points together; 0 for fixed columns."""
    size, flat = network.n_columns, rows.reshape(-1, rows.shape[2])
    information = flat.T @ flat
    information[:size, :size] += quadratic.information
    diagonal = np.zeros(len(information))
    diagonal[size:] = np.repeat(network.xyz_sigma**-2.0, 3)
    diagonal[shift_columns(network)] = _shift_information(network)
    information += np.diag(diagonal)
    moves = np.concatenate([np.ones((len(network.flex), len(POSE))), network.flex_sigma], axis=1)
    free = np.diag(information) > 0
    free[: moves.size] &= moves.ravel() > 0
    return inverses.of_columns(information[np.ix_(free, free)], free)


def shift_columns(network: Network) -> NDArray:
    """Return the columns of each image's shift, (V, 2)."""
    images = np.arange(len(network.cam_from_world))
    return IMAGE * images[:, None] + [IMAGE - 2, IMAGE - 1]


def _shift_information(network: Network) -> NDArray:
    """Return the information of the prior of each image's shift, (V, 2); 0 where it is fixed."""
    sigma = network.flex_sigma[:, 3:]
    return np.divide(1.0, sigma**2, out=np.zeros_like(sigma), where=sigma > 0)


def _consistency(loss_scale: NDArray) -> NDArray:
    """Return the robustly weighted square of a normal residual over that without the loss.

    Of two axes: s = x^2 + y^2 is exponential with mean 2; E[s / (1 + s / k^2)] / 2.
    """
    half = np.minimum(loss_scale, 30.0) ** 2 / 2  # beyond, the loss changes nothing
    return half * (1 - half * np.exp(half) * scipy.special.exp1(half))


def _of_ties(network, quadratic, covariance) -> tuple[float, float]:
    """Return the ties' squared distance from their own minimum, in sigmas, and their redundancy."""
    information = quadratic.information
    size = len(information)
    own = inverses.pseudo_inverse(information, GAUGE)
    step = network.difference(quadratic.reference)
    slope = quadratic.gradient + information @ step
    known = np.count_nonzero(np.diag(information) > 0) - GAUGE
    used = np.sum(information * covariance[:size, :size])
    return float(slope @ own @ slope), max(float(known - used), 0.0)
