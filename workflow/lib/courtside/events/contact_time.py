"""When a falling distance meets its floor: the corner of a hinge, between frames, with its uncertainty."""

from dataclasses import dataclass

import numpy as np
from scipy import special

FEWEST = 7
SMOOTHINGS_S = np.linspace(0.0, 0.06, 13)  # standard deviations of a Gaussian
USUAL_S = 0.01  # what they usually are
STEP_S = 0.001
SMALLEST = 1e-4  # metres: no device is better
LEAST_REBOUND = 0.3  # of the speed before: a filter swings over by less
BEND = (
    6.0  # ASSUME: m/s2, half the usual change of the closing speed; arms close within half a second
)
# ASSUME: skin and wrists give for some milliseconds after the first touch; until they rest, or turn back.
GIVE_S = {False: 0.003, True: 0.008}
MOST_MEMORY = 0.8


@dataclass(frozen=True)
class Noise:
    """Noise of a distance.

    Attributes
    ----------
    sd : float
        Standard deviation, metres.
    memory : float
        Correlation of neighbouring frames.
    """

    sd: float = 0.0
    memory: float = 0.0

    @classmethod
    def of(cls, still):
        """Return that of distances (n,) of a body that holds still, less a steady change."""
        still = np.asarray(still)[np.isfinite(still)]
        if len(still) < FEWEST:
            return cls()
        at = np.arange(len(still))
        rest = still - np.polyval(np.polyfit(at, still, 1), at)
        own = (rest**2).sum()
        ratio = (rest[1:] * rest[:-1]).sum() / own if own > 0 else 0.0
        # A short series looks less like itself than it is (Kendall 1954).
        ratio = (len(still) * ratio + 1) / (len(still) - 4)
        return cls(float(np.sqrt(own / (len(still) - 2))), float(np.clip(ratio, 0.0, MOST_MEMORY)))


@dataclass(frozen=True)
class Corner:
    """A corner.

    Attributes
    ----------
    time_s : float
    uncertainty_s : float
        Standard deviation; 90 % of errors should lie within 1.645 of it.
    floor : float
        What the distance falls to.
    slope : float
        By how much it falls per second when it gets there.
    smoothing_s : float
        Standard deviation of the Gaussian that rounds the corner, the mean of what the data allow.
    rises : bool
        The distance rises again at once: a rebound.
    residual : float
        Root mean square.
    """

    time_s: float
    uncertainty_s: float
    floor: float
    slope: float
    smoothing_s: float
    rises: bool
    residual: float


def fit(time_s, distance, near_s, reach_s, *, usual_s=USUAL_S, noise=Noise(), rebounds=True):
    """Fit a corner.

    Parameters
    ----------
    time_s, distance : (n,) float
        Of the fall and the floor behind it, or of the fall and the rebound's rise; metres.
    near_s, reach_s : float
        The corner is sought at `near_s`, give or take `reach_s`.
    usual_s : float
        Standard deviation of the Gaussian that stands for the device's own smoothing, as far as it is known:
        wider ones are less likely by a half-normal law of this scale.
    noise : Noise
        At least so large; larger where the hinge fits worse.
    rebounds : bool
        Whether the distance may rise again.

    Returns
    -------
    corner : Corner

    Raises
    ------
    ValueError
        If there are fewer than seven values, or nothing falls.

    Notes
    -----
    Before the corner a parabola, behind it a constant, or a parabola that rises; all convolved with a
    Gaussian. Every corner time and width of a grid is tried, the other numbers by least squares (Aitken's,
    for noise with memory; bends held by what arms can do); time and uncertainty are mean and standard
    deviation by the likelihood. A rise is preferred where it is likelier after its two extra numbers are
    paid for (Schwarz 1978).
    """
    known = np.isfinite(distance)
    time_s, distance = np.asarray(time_s)[known], np.asarray(distance)[known]
    if len(time_s) < FEWEST:
        raise ValueError(f"expected {FEWEST} distances or more, found {len(time_s)}")
    corners_s = near_s + np.arange(-reach_s, reach_s + STEP_S / 2, STEP_S)
    hinges = [
        _hinge(time_s, distance, corners_s, noise, rises) for rises in (False, True)[: 1 + rebounds]
    ]
    hinges = [hinge for hinge in hinges if hinge is not None]
    if not hinges:
        raise ValueError("expected a distance that falls to a floor, found none")
    # Both forms are judged by the noise that the better one leaves, or the device has at rest.
    scale = max(noise.sd, min(hinge.scale for hinge in hinges), SMALLEST)
    return max((_corner(hinge, scale, usual_s) for hinge in hinges), key=lambda one: one[0])[1]


@dataclass(frozen=True, eq=False)
class _Hinge:
    """Hinges of one form at every corner time and smoothing: squares (C, S), numbers (C, S, K)."""

    rises: bool
    corners_s: np.ndarray
    square: np.ndarray
    values: np.ndarray
    n: int

    @property
    def scale(self):
        freedom = max(self.n - self.values.shape[-1] - 1, 1)
        return float(np.sqrt(self.square.min() / freedom))


def _hinge(time_s, distance, corners_s, noise, rises):
    """Fit every hinge of one form; None where it has too many numbers or none falls."""
    count = 4 + 2 * rises
    if len(time_s) < count + 2:
        return None
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


def _corner(hinge, scale, usual_s):
    """Return (score, Corner) of the hinges of one form, with noise of a standard deviation `scale`."""
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
        residual=hinge.scale,
    )
    return score, corner


def _white(rows, memory):
    """Return rows (..., n, K) without what each has of the one before (Prais & Winsten 1954)."""
    white = rows.copy()
    white[..., 1:, :] -= memory * rows[..., :-1, :]
    white[..., 1:, :] /= np.sqrt(1 - memory**2)
    return white


def _design(left_s, sigma_s, rises):
    """Return columns (..., n, K): constant, fall and its bend before the corner, rise and its bend behind."""
    columns = [np.broadcast_to(1.0, np.broadcast_shapes(left_s.shape, sigma_s.shape))]
    columns += _ramps(left_s, sigma_s)
    if rises:
        columns += _ramps(-left_s, sigma_s)
    return np.stack(np.broadcast_arrays(*columns), axis=-1)


def _ramps(left_s, sigma_s):
    """Return the mean of max(u, 0) and of its square for u normal about `left_s`."""
    sigma_s = np.maximum(sigma_s, 1e-9)
    ratio = left_s / sigma_s
    below, density = special.ndtr(ratio), np.exp(-0.5 * ratio**2) / np.sqrt(2 * np.pi)
    first = left_s * below + sigma_s * density
    return [first, (left_s**2 + sigma_s**2) * below + left_s * sigma_s * density]
