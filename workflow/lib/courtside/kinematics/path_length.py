"""Length of a noisy path, its bias, and the uncertainty of both."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.kinematics import filtering, noise_propagation
from courtside.kinematics.noise_propagation import Noise

N_NODES = 48  # ASSUME: enough for the quadrature; the tests compare it with closed forms
SLOWER = 2.0  # the true speed is taken from a path filtered at the cut-off divided by this
SUBTRACTED = 0.5  # share of the noise's variance taken from the square of that speed: `measure`
MEMORIES_S = (0.0, 0.01, 0.02, 0.04, 0.08, 0.16)  # ASSUME: tried for the largest bias
LEAST_WINDOWS = 3  # as long as a gap, not overlapping: with fewer its detour is unknown
INDEPENDENT_AFTER = 4.0  # memories: the correlation is below exp(-4) = 2 %
GROUND = slice(0, 2)  # x and y
SPACE = slice(0, 3)


def mean_norm(mean: NDArray, covariance: NDArray) -> NDArray:
    """Return the expected length (N,) of normal vectors of mean (N, d) and covariance (N, d, d).

    |x| = (1 / sqrt pi) integral over t > 0 of (1 - exp(-t^2 |x|^2)) / t^2 dt, and the expectation
    of the exponential is prod_i (1 + 2 t^2 l_i)^(-1/2) exp(-t^2 m_i^2 / (1 + 2 t^2 l_i)) with the
    variances l_i and means m_i along the covariance's axes. With t = tan(angle) / size the
    integrand is smooth between 0 and 90 degrees: Gauss-Legendre quadrature.
    """
    variance, axes = np.linalg.eigh(covariance)
    variance = np.maximum(variance, 0.0)
    squares = np.einsum("nij,ni->nj", axes, mean) ** 2
    size = np.sqrt((variance + squares).sum(axis=1))
    size = np.where(size > 0, size, 1.0)
    nodes, node_weights = np.polynomial.legendre.leggauss(N_NODES)
    variance, squares = variance / size[:, None] ** 2, squares / size[:, None] ** 2
    angle = (nodes + 1) * np.pi / 4
    left = np.empty((N_NODES, len(mean)))
    for of_node, t2 in zip(left, np.tan(angle) ** 2, strict=True):
        spread = 1 + 2 * t2 * variance
        exponent = (t2 * squares / spread).sum(axis=-1)
        of_node[:] = 1 - np.exp(-exponent) / np.sqrt(spread.prod(axis=-1))
    integral = (node_weights * np.pi / 4 / np.sin(angle) ** 2) @ left
    return integral * size / np.sqrt(np.pi)


@dataclass(frozen=True)
class Distance:
    """Length of a path from its first to its last known frame."""

    measured_m: float  # of the filtered path as it is, without its gaps
    bias_m: float  # expected lengthening by noise; NaN where no covariance is known
    bias_sigma_m: float  # standard deviation of `bias_m`
    bias_most_m: float  # the largest lengthening by noise of the stated covariance, for any memory
    # Measured, less the bias, and the path in gaps; NaN where a gap is too long. What the filter
    # cuts off corners and hops is not added.
    corrected_m: float
    sigma_m: float  # standard deviation of `corrected_m`, those of the bias and the gaps included
    camera_sigma_m: float  # from the calibration; NaN: unknown
    seconds: float  # from the first to the last known frame
    gaps_m: float = 0.0  # what gaps contribute to `corrected_m`
    gaps_sigma_m: float = 0.0  # standard deviation of `gaps_m`


@dataclass(frozen=True, eq=False)
class Others:
    """Errors of a path besides the keypoints' noise, which do not lengthen it on average."""

    parts: Mapping[float, NDArray]  # raw covariance (T, 3, 3) by cut-off, as for `measure`
    noise: Noise  # of these parts
    field: NDArray  # (T, 3, R): derivative of what each cause that all frames share moves, m/s


UNKNOWN = Distance(*(float("nan") for _ in fields(Distance)))


def measure(
    position: NDArray,
    parts: Mapping[float, NDArray],
    rate_hz: float,
    noise: Noise,
    order: int,
    axes: slice,
    model_bias: tuple[float, float],
    others: Others,
) -> Distance:
    """Return the length of a filtered path.

    `position` (T, 3) m is filtered with `order`, NaN in open gaps. `parts` are, for each cut-off
    (Hz) of the zero-lag filter, the raw covariance (T, 3, 3) of the joints that were filtered at
    it, weighted as in the path; NaN where unknown. `axes` is `SPACE`, or `GROUND` for the path's
    projection on the floor; `model_bias` the mean and standard deviation of the true bias over the
    expected one; `others` errors of which only the scatter counts.

    The length is the integral of the speed by the trapezoidal rule, and that of the gaps
    (`bridged`). Noise e with covariance S lengthens a velocity v to E|v + e|, by about the variance
    across v over 2 |v| where the noise is small and by E|e| at rest. |v| is not known: the speed of
    the path filtered again at half the lowest cut-off, where the velocity's noise is several times
    smaller, stands for it. Half of that noise's variance is subtracted from its square. None would
    leave too much speed in rests, and all of it too little, for negative squares are cut at 0; a
    half left 0.1 % of the length on made-up footwork where noise had added 4 %.
    """
    velocity = noise_propagation.differentiate(position, rate_hz)
    speed = np.linalg.norm(velocity[:, axes], axis=1)
    runs = filtering.runs(np.isfinite(speed))
    if not runs:
        return replace(UNKNOWN, measured_m=0.0, seconds=0.0)
    known = _between_gaps(
        position, velocity, runs, parts, rate_hz, noise, order, axes, model_bias, others
    )
    share = known.corrected_m / known.measured_m if known.measured_m else 1.0
    gaps = bridged(position[:, axes], share * speed, runs, rate_hz)
    longer = 1 + gaps.length_m / known.measured_m if known.measured_m else 1.0
    return replace(
        known,
        corrected_m=known.corrected_m + gaps.length_m,
        sigma_m=float(np.hypot(known.sigma_m, gaps.sigma_m)),
        camera_sigma_m=known.camera_sigma_m * longer,
        gaps_m=gaps.length_m,
        gaps_sigma_m=gaps.sigma_m,
    )


def _between_gaps(
    position, velocity, runs, parts, rate_hz, noise, order, axes, model_bias, others
) -> Distance:
    """Measure the path without its gaps: its known `runs`."""
    known = np.isfinite(position).all(axis=1)
    weight_s = _weights_s(runs, len(known), rate_hz)
    seconds = (runs[-1][1] - 1 - runs[0][0]) / rate_hz
    used = weight_s > 0
    weight_s = weight_s[used]
    measured = float(np.linalg.norm(velocity[used][:, axes], axis=1) @ weight_s)
    filters = rate_hz, order
    spreads = _velocity_spreads(parts, known, noise, *filters)
    spreads = {cutoff_hz: spread[used] for cutoff_hz, spread in spreads.items()}
    spread = np.sum(list(spreads.values()), axis=0)[:, axes, axes]
    if not np.isfinite(spread).any():
        return replace(UNKNOWN, measured_m=measured, seconds=seconds)
    spread = _filled(spread)
    slow, slow_spread = _slower(position, parts, known, rate_hz, noise, order)
    true = true_velocity(slow[used][:, axes], _filled(slow_spread[used][:, axes, axes]))
    bias, bias_sigma = float(_lengthening(true, spread) @ weight_s) * np.array(model_bias)
    of_noise = _Filters(_shares(spreads), *filters)
    scatter = variance(true, spread, weight_s, of_noise.correlation(len(known), noise), used)
    scatter += _scatter_of_others(others, true, known, used, weight_s, axes, filters)
    most = spread * of_noise.largest_variance_ratio(noise)
    return Distance(
        measured_m=measured,
        bias_m=float(bias),
        bias_sigma_m=float(bias_sigma),
        bias_most_m=float(_lengthening(true, most) @ weight_s),
        corrected_m=float(measured - bias),
        sigma_m=float(np.hypot(np.sqrt(scatter), bias_sigma)),
        camera_sigma_m=_camera_sigma(others, velocity[used], weight_s, used, axes),
        seconds=seconds,
    )


@dataclass(frozen=True)
class Gaps:
    """The path in gaps."""

    length_m: float  # expected; NaN if the known path has no stretches as long as a gap
    sigma_m: float  # standard deviation; its 90 % interval is right for few stretches, too


def bridged(
    position: NDArray, speed: NDArray, runs: Sequence[tuple[int, int]], rate_hz: float
) -> Gaps:
    """Return the expected length of a path in the gaps between its known runs.

    `position` (T, d) m and `speed` (T,) m/s are known in `runs`, (start, stop) in order. A gap is
    as long as the straight line over it and a detour: how much longer the same person's known path
    is than the straight line, on average over all windows that last as long as the gap. Their
    scatter is the error, with Student's t for the number of windows that do not overlap.
    """
    gaps = [(before[1] - 1, after[0]) for before, after in pairwise(runs)]
    stretches = [(position[a:b], _along(speed[a:b], rate_hz)) for a, b in runs]
    detours = {n: _detours(stretches, n) for n in {first - last for last, first in gaps}}
    length, variance, common = 0.0, 0.0, 0.0
    for last, first in gaps:
        detour, scatter, n_windows = detours[first - last]
        length += float(np.linalg.norm(position[first] - position[last])) + detour
        variance += scatter**2
        common += scatter / np.sqrt(n_windows)
    return Gaps(length, float(np.sqrt(variance + common**2)))


def _along(speed: NDArray, rate_hz: float) -> NDArray:
    """Return the length (T,) m of a path from its first frame to each, from its speed (T,)."""
    return np.concatenate([[0.0], np.cumsum((speed[:-1] + speed[1:]) / (2 * rate_hz))])


def _detours(stretches: Sequence[tuple[NDArray, NDArray]], n: int) -> tuple[float, float, int]:
    """Return mean and scatter of the detours of windows of `n` frames, and how many lie apart.

    `stretches` have places (T, d) m and the length (T,) m of the path up to each.
    """
    long = [(place, along) for place, along in stretches if len(along) > n]
    apart = sum((len(along) - 1) // n for _, along in long)
    if apart < LEAST_WINDOWS:
        return float("nan"), float("nan"), 1
    detours = np.concatenate(
        [
            np.maximum(along[n:] - along[:-n] - np.linalg.norm(place[n:] - place[:-n], axis=1), 0.0)
            for place, along in long
        ]
    )
    wider = scipy.special.stdtrit(apart - 1, 0.95) / scipy.special.ndtri(0.95)
    return float(detours.mean()), float(detours.std() * wider), apart


def _velocity_spreads(parts, known, noise, rate_hz, order) -> dict[float, NDArray]:
    """Return the covariance (T, 3, 3) of the velocity's noise by cut-off."""
    return {
        cutoff_hz: noise_propagation.filtered_covariance(
            part, known, noise, rate_hz, cutoff_hz, order, 1
        )
        for cutoff_hz, part in parts.items()
    }


def _scatter_of_others(others, true, known, used, weight_s, axes, filters) -> float:
    """Return the variance, m2, of a path's length by the noise of `others`."""
    if not any(np.any(part[known] > 0) for part in others.parts.values()):
        return 0.0
    spreads = _velocity_spreads(others.parts, known, others.noise, *filters)
    spreads = {at: np.nan_to_num(spread[used]) for at, spread in spreads.items()}
    spread = np.sum(list(spreads.values()), axis=0)[:, axes, axes]
    along_time = _Filters(_shares(spreads), *filters).correlation(len(known), others.noise)
    return variance(true, spread, weight_s, along_time, used)


def _camera_sigma(others, velocity, weight_s, used, axes) -> float:
    """Return the standard deviation, m, of a path's length by what all its frames share."""
    if not others.field.shape[-1]:
        return float("nan")
    velocity, field = velocity[:, axes], others.field[used][:, axes]
    size = np.linalg.norm(velocity, axis=1, keepdims=True)
    direction = velocity / np.where(size > 0, size, 1.0)
    return float(np.linalg.norm(np.einsum("n,ni,nir->r", weight_s, direction, field)))


def _slower(
    position: NDArray,
    parts: Mapping[float, NDArray],
    known: NDArray,
    rate_hz: float,
    noise: Noise,
    order: int,
) -> tuple[NDArray, NDArray]:
    """Return the velocity of the path filtered at half its lowest cut-off, and its covariance."""
    slow_hz = min(parts) / SLOWER
    path = filtering.zero_lag(position, rate_hz, slow_hz, order)
    whole = np.sum(list(parts.values()), axis=0)
    spread = noise_propagation.filtered_covariance(whole, known, noise, rate_hz, slow_hz, order, 1)
    return noise_propagation.differentiate(path, rate_hz), spread


def _shares(spreads: Mapping[float, NDArray]) -> dict[float, float]:
    """Return the share of each part's variance in that of the sum."""
    found = {at: float(np.nanmean(np.trace(s, axis1=1, axis2=2))) for at, s in spreads.items()}
    return {at: value / sum(found.values()) for at, value in found.items()}


def _weights_s(runs: Sequence[tuple[int, int]], n_frames: int, rate_hz: float) -> NDArray:
    """Return trapezoidal weights (T,) in seconds, 0 outside of the runs."""
    weights = np.zeros(n_frames)
    for start, stop in runs:
        weights[start:stop] = 1 / rate_hz
        weights[[start, stop - 1]] /= 2
    return weights


def _filled(spread: NDArray) -> NDArray:
    """Return covariances with the mean one where none is known."""
    known = np.isfinite(spread).all(axis=(1, 2))
    return np.where(known[:, None, None], spread, spread[known].mean(axis=0))


def _lengthening(velocity: NDArray, spread: NDArray) -> NDArray:
    return mean_norm(velocity, spread) - np.linalg.norm(velocity, axis=1)


@dataclass(frozen=True)
class _Filters:
    """The filters of a path's parts."""

    shares: Mapping[float, float]  # of the variance of the velocity's noise, by cut-off in Hz
    rate_hz: float
    order: int

    def correlation(self, n_frames: int, noise: Noise) -> NDArray:
        """Return the velocity noise's correlation at 0, 1, ... frames, for as long as it lasts."""
        seconds = noise_propagation.EDGE_PERIODS / min(self.shares)
        seconds += INDEPENDENT_AFTER * noise.memory_s
        n_lags = min(n_frames, int(np.ceil(seconds * self.rate_hz)) + 1)
        total = np.zeros(n_lags)
        for cutoff_hz, share in self.shares.items():
            total += share * noise_propagation.autocorrelation(
                n_lags, self.rate_hz, cutoff_hz, self.order, noise, 1
            )
        return total

    def largest_variance_ratio(self, noise: Noise) -> float:
        """Return the velocity noise's largest variance for any memory, over that for its own."""
        others = [Noise(float(memory), scale=noise.scale) for memory in MEMORIES_S]
        return max(
            sum(
                share * self._gain(cutoff_hz, one) / self._gain(cutoff_hz, noise)
                for cutoff_hz, share in self.shares.items()
            )
            for one in (noise, *others)
        )

    def _gain(self, cutoff_hz: float, noise: Noise) -> float:
        found = noise_propagation.gains(10**3, self.rate_hz, cutoff_hz, self.order, noise, 1)
        return float(found[500])


def true_velocity(velocity: NDArray, spread: NDArray) -> NDArray:
    """Return velocities (N, d) shortened to their expected length without noise.

    `spread` (N, d, d) is the covariance of their noise.
    """
    squared = np.sum(velocity**2, axis=1)
    less = squared - SUBTRACTED * np.trace(spread, axis1=1, axis2=2)
    share = np.maximum(less, 0.0) / np.where(squared > 0, squared, 1.0)
    return velocity * np.sqrt(share)[:, None]


def variance(
    velocity: NDArray, spread: NDArray, weight_s: NDArray, correlation: NDArray, used: NDArray
) -> float:
    """Return the variance, m2, of the length of a path.

    `velocity` (N, d) is without noise, `spread` (N, d, d) the covariance of its noise, `weight_s`
    (N,) the time that each velocity stands for, and `correlation` (L,) that of the noise at 0, 1,
    ... L - 1 frames; 1 first. `used` (T,) says which of the take's frames these N are.

    Noise along the path changes its length linearly; on a straight path these changes cancel except
    at both ends. Noise across it changes the length by its square, whose correlation is the square
    of the noise's. Both are scaled to the exact variance of |v + e|, which is less than their sum
    near rest.
    """
    size = np.linalg.norm(velocity, axis=1)
    direction = velocity / np.where(size > 0, size, 1.0)[:, None]
    along = np.einsum("ni,nij,nj->n", direction, spread, direction)
    whole = np.trace(spread, axis1=1, axis2=2)
    across = np.maximum(whole - along, 0.0)
    # |e|^2 / (2 |v|) has this variance for equal noise in two directions, and less for more
    # unequal.
    square = across**2 / (4 * np.maximum(size**2, across))
    exact = np.maximum(size**2 + whole - mean_norm(velocity, spread) ** 2, 0.0)
    share = exact / np.where(along + square > 0, along + square, 1.0)
    squares, signed = np.zeros(len(used)), np.zeros((len(used), velocity.shape[1]))
    squares[used] = np.sqrt(share * square) * weight_s
    signed[used] = direction * (np.sqrt(share * along) * weight_s)[:, None]
    total = 0.0
    for lag, value in enumerate(correlation):
        end = len(used) - lag
        pair = (
            value * np.sum(signed[:end] * signed[lag:]) + value**2 * squares[:end] @ squares[lag:]
        )
        total += pair if lag == 0 else 2 * pair
    return max(float(total), 0.0)
