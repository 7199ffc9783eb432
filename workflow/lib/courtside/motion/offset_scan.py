"""Offsets of several cameras from loss curves over all offsets: placed one after another, surest first."""

from dataclasses import dataclass

import numpy as np

from courtside.statistics import autocorrelation

SEPARATE_S = 0.25  # minima closer than this are one
DISTINCT = 3.0  # standard deviations by which the best offset must beat another one
FEWEST = 0.15  # share of the times of a pair that must overlap at an offset
MOST_CANDIDATES = 5  # as many other offsets as this: nothing is known


@dataclass(frozen=True)
class Placed:
    """Where one camera came to lie.

    Attributes
    ----------
    offset_s : float
        To the step of the scan.
    candidates_s : tuple of float
        Other offsets that the recording does not rule out.
    distinct : float
        Standard deviations between the best offset and the next one.
    through : tuple of int
        Cameras that it was compared with.
    """

    offset_s: float
    candidates_s: tuple
    distinct: float
    through: tuple


def place(scan, n_cameras, max_offset_s, step_s):
    """Place all cameras against camera 0.

    Parameters
    ----------
    scan : callable
        `scan(a, b, lags_s)` returns the loss (N, L) of camera b against a, at N times of camera a and
        offsets of b's clock against a's; NaN where the two share nothing.
    n_cameras : int
    max_offset_s, step_s : float
        The offsets tried.

    Returns
    -------
    placed : dict of int to Placed
        In the order of placing, camera 0 first. A camera that no other can be compared with lacks.
    """
    count = int(np.ceil(max_offset_s / step_s))
    offsets_s = step_s * np.arange(-count, count + 1)
    placed = {0: Placed(0.0, (), np.inf, ())}
    losses = {camera: {} for camera in range(1, n_cameras)}
    while losses:
        for camera, known in losses.items():
            for other in _sure(placed):
                if other not in known:
                    known[other] = scan(other, camera, offsets_s - placed[other].offset_s)
        choices = {camera: choose(offsets_s, known) for camera, known in losses.items()}
        surest = max(choices, key=lambda camera: choices[camera].distinct)
        if np.isfinite(choices[surest].offset_s):
            placed[surest] = choices[surest]
        del losses[surest]
    return placed


def _sure(placed):
    return [camera for camera, at in placed.items() if not at.candidates_s]


def choose(offsets_s, losses):
    """Choose the offset of one camera.

    Parameters
    ----------
    offsets_s : (L,) float
        Uniform.
    losses : dict of int to (N, L) float
        Against each camera that is placed; NaN where nothing is compared.

    Returns
    -------
    placed : Placed
        With an offset of NaN where nothing overlaps.
    """
    loss = np.concatenate(list(losses.values()))
    curve = _curve(loss)
    if not np.isfinite(curve).any():
        return Placed(np.nan, (), -np.inf, tuple(losses))
    order = minima(curve, max(1, round(SEPARATE_S / (offsets_s[1] - offsets_s[0]))))
    best, others = order[0], order[1 : 2 * MOST_CANDIDATES + 1]
    margins = np.array([_margin(loss[:, best], loss[:, other]) for other in others])
    near = [other for other, margin in zip(others, margins, strict=True) if margin < DISTINCT]
    return Placed(
        float(offsets_s[best]),
        tuple(float(offsets_s[at]) for at in near[:MOST_CANDIDATES]),
        float(margins.min(initial=99.0)),
        tuple(losses),
    )


def _curve(loss):
    """Return the mean loss (L,), drawn to that of an arbitrary offset where little overlaps."""
    known = np.isfinite(loss)
    count = known.sum(axis=0)
    few = FEWEST * max(count.max(), 1)
    usual = np.median(loss[known]) if known.any() else 0.0
    curve = (np.where(known, loss, 0.0).sum(axis=0) + few * usual) / (count + few)
    return np.where(count >= max(few, 3), curve, np.nan)


def minima(curve, apart):
    """Return the places of local minima of a curve (L,), lowest first, none within `apart` of a lower one."""
    filled = np.where(np.isfinite(curve), curve, np.inf)
    padded = np.pad(filled, 1, constant_values=np.inf)
    local = (filled <= padded[:-2]) & (filled <= padded[2:]) & np.isfinite(curve)
    kept = []
    for at in sorted(np.flatnonzero(local), key=lambda place: filled[place]):
        if all(abs(at - other) > apart for other in kept):
            kept.append(int(at))
    return kept


def _margin(best, other):
    """Return by how many standard deviations the loss `other` (N,) is above `best` (N,)."""
    both = np.isfinite(best) & np.isfinite(other)
    if both.sum() >= max(10, 0.3 * np.isfinite(best).sum()):
        return autocorrelation.distinct((other - best)[both])
    best, other = best[np.isfinite(best)], other[np.isfinite(other)]
    spread = [
        autocorrelation.covariance_of_sum((x - x.mean())[:, None])[0, 0] / len(x) ** 2
        for x in (best, other)
    ]
    return float((other.mean() - best.mean()) / np.sqrt(max(sum(spread), 1e-300)))
