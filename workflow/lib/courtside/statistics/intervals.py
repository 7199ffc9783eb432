"""Intervals of averages over halls: what shares a hall, pictures or persons is not independent."""

import warnings
from collections.abc import Callable

import numpy as np
import pandas as pd
from numpy.typing import NDArray

REPLICATES = 1000
LEVEL = 0.95
SEED = 0  # any; fixed so that an interval is repeatable


def bootstrap(
    trials: pd.DataFrame,
    average: Callable[..., NDArray],
    *,
    level: float = LEVEL,
    replicates: int = REPLICATES,
) -> tuple[float, float]:
    """Return the interval of the average over halls of the averages within, by bootstrap.

    `trials` has `hall`, `structure` (trials of one share its pictures), `session` and `draw` (the
    person who clicks, the same for every structure of a session) and `value`; NaN are left out.
    `average` is `np.nanmean` or `np.nanmedian`. Halls are drawn with replacement (Davison & Hinkley
    1997, sec. 3.8), and within each its structures and, apart from them, its persons (Owen 2007).
    With one hall the interval holds for that hall only; few halls make it too narrow. NaN below two
    values.
    """
    known = trials[np.isfinite(trials["value"])]
    if len(known) < 2:
        return np.nan, np.nan
    grids = [
        hall.pivot(index="structure", columns=["session", "draw"], values="value").to_numpy()
        for _, hall in known.groupby("hall", dropna=False)
    ]
    rng = np.random.default_rng(SEED)
    picked = rng.integers(len(grids), size=(replicates, len(grids)))
    within = np.empty(picked.shape)
    with warnings.catch_warnings():  # of resamples in which every trial failed
        warnings.simplefilter("ignore", RuntimeWarning)
        for at, grid in enumerate(grids):
            drawn = _resampled(rng, grid, int((picked == at).sum()))
            within[picked == at] = average(drawn, axis=(1, 2))
        found = average(within, axis=1)
    low, high = np.nanquantile(found, [(1 - level) / 2, (1 + level) / 2])
    return float(low), float(high)


def _resampled(rng: np.random.Generator, grid: NDArray, count: int) -> NDArray:
    """Return resamples (count, S, P) of a grid (S, P) whose rows and columns are drawn again."""
    rows, columns = (rng.integers(n, size=(count, n)) for n in grid.shape)
    return grid[rows[:, :, None], columns[:, None, :]]
