"""Contact time of a closing distance, between frames: the corner of a hinge, with uncertainty."""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

# ASSUME: values that a fit needs. A rebound has as many parameters; what is assumed of its bends
# and its smoothing counts, too.
FEWEST = 7
SMOOTHINGS_S = np.linspace(0.0, 0.06, 13)  # standard deviations of the Gaussians tried
USUAL_S = 0.01  # ASSUME: their usual size
STEP_S = 0.001  # grid of contact times: small against their uncertainty
SMALLEST = 1e-4  # metres: no device is more precise
LEAST_REBOUND = 0.3  # ASSUME: of the speed before; the overshoot of a filter is less
# ASSUME: m/s2, half the usual change of the closing speed; arms close within half a second.
BEND = 6.0
# ASSUME: skin and wrists yield for some milliseconds after the first touch, until they rest
# (False) or rebound (True).
GIVE_S = {False: 0.003, True: 0.008}
MOST_MEMORY = 0.8  # ASSUME: limit of the correlation, estimated from short series


@dataclass(frozen=True)
class Noise:
    """Noise of a distance: standard deviation `sd`, m, and correlation of neighbouring frames."""

    sd: float = 0.0
    memory: float = 0.0

    @classmethod
    def of(cls, still: NDArray) -> "Noise":
        """Return the noise of distances (n,) of a body that holds still, minus a linear trend."""
        still = np.asarray(still)[np.isfinite(still)]
        if len(still) < FEWEST:
            return cls()
        at = np.arange(len(still))
        rest = still - np.polyval(np.polyfit(at, still, 1), at)
        own = (rest**2).sum()
        ratio = (rest[1:] * rest[:-1]).sum() / own if own > 0 else 0.0
        # The autocorrelation of a short series is biased low (Kendall 1954).
        ratio = (len(still) * ratio + 1) / (len(still) - 4)
        return cls(float(np.sqrt(own / (len(still) - 2))), float(np.clip(ratio, 0.0, MOST_MEMORY)))


@dataclass(frozen=True)
class Corner:
    """The corner of a hinge."""

    time_s: float
    uncertainty_s: float  # standard deviation; 90 % of errors should be within 1.645 of it
    floor: float  # distance at contact, metres
    slope: float  # closing speed at contact, m/s
    smoothing_s: float  # standard deviation of the Gaussian that smooths the corner, on average
    rises: bool  # whether the distance rises again at once: a rebound


def fit(
    time_s: NDArray,
    distance: NDArray,
    near_s: float,
    reach_s: float,
    *,
    usual_s: float = USUAL_S,
    noise: Noise = Noise(),
    rebounds: bool = True,
) -> Corner:
    """Fit a corner within `reach_s` of `near_s`.

    `time_s` and `distance` (n,) m are of the fall and the floor after it, or of the fall and the
    rebound's rise, which `rebounds` allows. `usual_s` is the usual standard deviation of the
    device's own smoothing: the scale of a half-normal prior. `noise` is a lower limit; larger where
    the hinge fits worse. A `ValueError` if there are fewer than seven values, or nothing falls.

    Before the corner a parabola, after it a constant or a rising parabola, all convolved with a
    Gaussian. Every corner time and width of a grid is tried, with the other parameters by least
    squares (Aitken's, for correlated noise; bends limited to what arms can do). Time and
    uncertainty are mean and standard deviation under the likelihood. A rise is preferred if its
    likelihood pays for its two extra parameters (Schwarz 1978).
    """
    known = np.isfinite(distance)
    time_s, distance = np.asarray(time_s)[known], np.asarray(distance)[known]
    if len(time_s) < FEWEST:
        raise ValueError(f"expected {FEWEST} distances or more, found {len(time_s)}")
    corners_s = near_s + np.arange(-reach_s, reach_s + STEP_S / 2, STEP_S)
    forms = (False, True)[: 1 + rebounds]
    tried = [_hinge(time_s, distance, corners_s, noise, rises) for rises in forms]
    hinges = [hinge for hinge in tried if hinge is not None]
    if not hinges:
        raise ValueError("expected a distance that falls to a floor, found none")
    # Both models are judged by the residuals of the better one, or the device's noise at rest.
    scale = max(noise.sd, min(hinge.scale for hinge in hinges), SMALLEST)
    return max((_corner(hinge, scale, usual_s) for hinge in hinges), key=lambda one: one[0])[1]


@dataclass(frozen=True, eq=False)
class _Hinge:
    """Hinges of one form at every corner time and smoothing: squares (C, S), values (C, S, K)."""

    rises: bool
    corners_s: NDArray
    square: NDArray
    values: NDArray
    n: int

    @property
    def scale(self) -> float:
        freedom = max(self.n - self.values.shape[-1] - 1, 1)
        return float(np.sqrt(self.square.min() / freedom))


def _hinge(time_s, distance, corners_s, noise, rises) -> _Hinge | None:
    """Fit every hinge of one form; None if none falls."""
    count = 4 + 2 * rises
    design = _design(corners_s[:, None, None] - time_s, SMOOTHINGS_S[:, None], rises)
    design, wanted = _white(design, noise.memory), _white(distance[:, None], noise.memory)[:, 0]
    held = np.zeros((count - 1, count - 1))
    bends = [2] if not rises else [2, 4]
    held[bends, bends] = max(noise.sd, SMALLEST) / BEND
    normal = np.swapaxes(design, -1, -2) @ design + held**2
    moments = np.swapaxes(design, -1, -2) @ wanted
    size = np.sqrt(np.einsum("...ii->...i", normal)) + SMALLEST
    scaled = normal / (size[..., :, None] * size[..., None, :]) + 1e-10 * np.eye(count - 1)
    values = np.linalg.solve(scaled, (moments / size)[..., None])[..., 0] / size
    rest = wanted - (design @ values[..., None])[..., 0]
    square = (rest**2).sum(axis=-1) + ((values @ held) ** 2).sum(axis=-1)
    falls = values[..., 1] > 0
    if rises:
        falls &= values[..., 3] > LEAST_REBOUND * values[..., 1]
    if not falls.any():
        return None
    return _Hinge(rises, corners_s, np.where(falls, square, np.inf), values, len(time_s))


def _corner(hinge: _Hinge, scale: float, usual_s: float) -> tuple[float, Corner]:
    """Return score and corner of the hinges of one form, with noise of sigma `scale`."""
    log = -0.5 * hinge.square / scale**2 - 0.5 * (SMOOTHINGS_S / usual_s) ** 2
    weight = np.exp(log - log.max())
    weight /= weight.sum()
    at_s = float((weight.sum(axis=1) * hinge.corners_s).sum())
    variance = (weight.sum(axis=1) * (hinge.corners_s - at_s) ** 2).sum()
    score = 2 * log.max() - 2 * hinge.rises * np.log(hinge.n)
    corner = Corner(
        time_s=at_s,
        uncertainty_s=float(np.sqrt(variance + STEP_S**2 / 12 + GIVE_S[hinge.rises] ** 2)),
        floor=float((weight * hinge.values[..., 0]).sum()),
        slope=float((weight * hinge.values[..., 1]).sum()),
        smoothing_s=float((weight.sum(axis=0) * SMOOTHINGS_S).sum()),
        rises=hinge.rises,
    )
    return score, corner


def _white(rows: NDArray, memory: float) -> NDArray:
    """Return rows (..., n, K), decorrelated from the one before (Prais & Winsten 1954)."""
    white = rows.copy()
    white[..., 1:, :] -= memory * rows[..., :-1, :]
    white[..., 1:, :] /= np.sqrt(1 - memory**2)
    return white


def _design(left_s: NDArray, sigma_s: NDArray, rises: bool) -> NDArray:
    """Return columns (..., n, K): constant, fall and its bend, perhaps rise and its bend."""
    columns = [np.broadcast_to(1.0, np.broadcast_shapes(left_s.shape, sigma_s.shape))]
    columns += _ramps(left_s, sigma_s)
    if rises:
        columns += _ramps(-left_s, sigma_s)
    return np.stack(np.broadcast_arrays(*columns), axis=-1)


def _ramps(left_s: NDArray, sigma_s: NDArray) -> list[NDArray]:
    """Return the mean of max(u, 0) and of its square for u normal about `left_s`."""
    sigma_s = np.maximum(sigma_s, 1e-9)
    ratio = left_s / sigma_s
    below, density = scipy.special.ndtr(ratio), np.exp(-0.5 * ratio**2) / np.sqrt(2 * np.pi)
    first = left_s * below + sigma_s * density
    return [first, (left_s**2 + sigma_s**2) * below + left_s * sigma_s * density]
