"""How a picture moves when its fixed camera turns, and the fit of that to tracked points."""

from dataclasses import dataclass

import cv2
import numpy as np

from courtside.devices import movement

MOST_OFF_PX = 3.0  # of an inlier, before the model is bent to the lens
SCALE_PX = (0.03, 1.0)  # least and most noise of a tracked corner that is believed, per axis
TUKEY = 4.685  # standard deviations beyond which a corner counts nothing
N_STEPS = 8
LEAST_SHARE = 0.25  # of the corners in the picture: fewer that agree may be a person
# How the lens bends the movement, k and p of `moved`: mean and standard deviation over usual lenses, 45 to
# 80 degrees across.
LENS_MEAN, LENS_SIGMA = np.array([0.0, 0.35]), np.array([0.12, 0.25])


def moved(places, model):
    """Return how far a turn of the camera moves each place, all with half of the longer side as unit.

    Parameters
    ----------
    places : (N, 2) float
        From the picture's centre.
    model : (6,) float
        Shift of the centre x, y; linear change a - 1 and b of the similarity [[a, -b], [b, a]]; and of the
        lens, k and p: the centre's shift t is (1 + k r^2) t + p x (x . t) at x. A pinhole has k = 0 and
        p = (that half / focal length)^2, distortion k1 adds k1 p0 and 2 k1 p0 of that p0, to third order.

    Returns
    -------
    by : (N, 2) float
    """
    shift, (scale, turn, k, p) = model[:2], model[2:]
    x, y = places.T
    along = places @ shift
    radius2 = x * x + y * y
    return np.column_stack(
        [
            (1 + k * radius2) * shift[0] + p * x * along + scale * x - turn * y,
            (1 + k * radius2) * shift[1] + p * y * along + scale * y + turn * x,
        ]
    )


def _jacobian(places, model):
    """Return the derivative of `moved` by the model, (N, 2, 6)."""
    shift, (k, p) = model[:2], model[4:]
    x, y = places.T
    radius2 = x * x + y * y
    along = places @ shift
    even, mixed = 1 + k * radius2, p * x * y
    rows = [
        [even + p * x * x, mixed, x, -y, radius2 * shift[0], x * along],
        [mixed, even + p * y * y, y, x, radius2 * shift[1], y * along],
    ]
    return np.array(rows).transpose(2, 0, 1)


@dataclass(frozen=True)
class Fit:
    """A movement that tracked points agree about.

    Attributes
    ----------
    model : (6,) float
        As `moved` takes it; NaN where too few agree.
    sigma : float
        Standard deviation of the shift per axis, half of the longer side as unit; NaN as `model`.
    n_matches : int
        Points that agree.
    """

    model: np.ndarray
    sigma: float
    n_matches: int

    @property
    def known(self):
        """Whether enough points agree."""
        return bool(np.isfinite(self.sigma))


def unknown_turn(n_matches=0):
    """Return the fit of which nothing can be said."""
    return Fit(np.full(6, np.nan), np.nan, n_matches)


def fit_turn(places, moved_px, shape, n_corners):
    """Find the movement that tracked points agree about.

    Parameters
    ----------
    places : (N, 2) float
        From the picture's centre, half of its longer side as unit.
    moved_px : (N, 2) float
        By how much each was found to have moved, px.
    shape : (int, int)
        Height and width of the picture, px.
    n_corners : int
        How many were looked for.

    Returns
    -------
    found : Fit
        Unknown where fewer than `movement.MIN_MATCHES` points or a quarter of those looked for agree, or
        those do not spread over the picture.

    Notes
    -----
    Random samples of a similarity (RANSAC, Fischler & Bolles 1981) start it, weighted least squares with
    Tukey's weights finish it.
    """
    if len(places) < movement.MIN_MATCHES:
        return unknown_turn()
    half = max(shape) / 2
    places_px = (places * half).astype(np.float32)
    cv2.setRNGSeed(0)
    matrix, mask = cv2.estimateAffinePartial2D(
        places_px,
        places_px + moved_px.astype(np.float32),
        ransacReprojThreshold=MOST_OFF_PX,
        maxIters=500,
        refineIters=2,
    )
    if matrix is None:
        return unknown_turn()
    start = np.r_[matrix[:, 2] / half, matrix[0, 0] - 1, matrix[1, 0], LENS_MEAN]
    limits = np.array(SCALE_PX) / half
    model, sigma, inliers = _refine(places, moved_px / half, start, mask[:, 0] > 0, limits)
    n_matches = int(inliers.sum())
    enough = max(movement.MIN_MATCHES, LEAST_SHARE * n_corners)
    least_spread = movement.MIN_SPREAD * min(shape) / half
    if n_matches < enough or places[inliers].std(axis=0).min() < least_spread:
        return unknown_turn(n_matches)
    return Fit(model, float(sigma), n_matches)


def _refine(places, tracked, model, inliers, scale_limits):
    """Finish a fit by iterated weights; return model, sigma of the shift per axis, inliers (N,)."""
    scale = scale_limits[1]
    weights = inliers.astype(float)
    for _ in range(N_STEPS):
        jacobian = _jacobian(places, model)
        residuals = tracked - moved(places, model)
        normal = np.einsum("nai,n,naj->ij", jacobian, weights, jacobian, optimize=True) / scale**2
        gradient = np.einsum("nai,n,na->i", jacobian, weights, residuals, optimize=True) / scale**2
        normal[[4, 5], [4, 5]] += LENS_SIGMA**-2.0
        gradient[4:] += (LENS_MEAN - model[4:]) / LENS_SIGMA**2
        model = model + np.linalg.solve(normal + 1e-9 * np.eye(6), gradient)
        off = tracked - moved(places, model)
        distance = np.hypot(*off.T)
        near = distance < TUKEY * scale
        if near.any():
            scale = np.clip(1.4826 * np.median(np.abs(off[near])), *scale_limits)
        weights = np.clip(1 - (distance / (TUKEY * scale)) ** 2, 0, None) ** 2
    covariance = np.linalg.inv(normal + 1e-9 * np.eye(6))
    return model, np.sqrt(np.trace(covariance[:2, :2]) / 2), weights > 0
