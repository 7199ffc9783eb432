"""Shares of frames with an honest interval: neighbouring frames are no independent trials."""

import numpy as np
from scipy.stats import norm

LEVEL = 0.95


def runs(hits):
    """Return how many frames in a row count as one independent trial.

    Parameters
    ----------
    hits : (T,) bool
        By time.

    Returns
    -------
    frames : float
        1 + 2 * the sum of the autocorrelations up to the first pair of lags whose sum is not positive, at
        least 1 and at most T; 1 where all frames are alike, which shows no correlation.

    Notes
    -----
    Geyer 1992, initial positive sequence.
    """
    hits = np.asarray(hits, dtype=float)
    centred = hits - hits.mean()
    if len(hits) < 4 or not centred.any():
        return 1.0
    full = np.correlate(centred, centred, mode="full")[len(hits) - 1 :]
    correlation = full / full[0]
    pairs = correlation[: len(hits) // 2 * 2].reshape(-1, 2).sum(axis=1)
    last = int(np.argmax(pairs <= 0)) if (pairs <= 0).any() else len(pairs)
    return float(np.clip(2 * pairs[:last].sum() - 1, 1, len(hits)))


def interval(share, n_effective, level=LEVEL):
    """Return the limits of Wilson's interval of a share.

    Parameters
    ----------
    share : float
        0 to 1.
    n_effective : float
        Independent trials.
    level : float

    Returns
    -------
    low, high : float

    Notes
    -----
    Wilson 1927, J. Am. Stat. Assoc. 22, 209. It holds near 0 and 1 as well, where the usual one has no width.
    """
    if not n_effective > 0:
        return 0.0, 1.0
    z = norm.ppf((1 + level) / 2)
    middle = share + z**2 / (2 * n_effective)
    half = z * np.sqrt(share * (1 - share) / n_effective + z**2 / (4 * n_effective**2))
    scale = 1 + z**2 / n_effective
    # Rounding must not put a share of 0 or 1 outside its own interval.
    return max(0.0, min(share, (middle - half) / scale)), min(
        1.0, max(share, (middle + half) / scale)
    )


def share(hits, least_frames=1.0, level=LEVEL):
    """Return a share of frames with its interval.

    Parameters
    ----------
    hits : (T,) bool
        By time.
    least_frames : float
        Frames in a row that count as one trial at least: how long a pose lasts, for hits so alike that their
        correlation cannot be seen.
    level : float

    Returns
    -------
    found : dict
        n_frames, n_effective, share, low, high.
    """
    hits = np.asarray(hits, dtype=bool)
    count = len(hits)
    if not count:
        return {"n_frames": 0, "n_effective": 0.0, "share": np.nan, "low": 0.0, "high": 1.0}
    effective = count / min(max(runs(hits), least_frames), count)
    low, high = interval(hits.mean(), effective, level)
    found = {"n_frames": count, "n_effective": effective, "share": hits.mean()}
    return {**found, "low": low, "high": high}
