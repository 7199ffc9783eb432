"""Intervals of statistics over halls: what lies in one hall is not independent."""

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

REPLICATES = 1000
LEVEL = 0.95


def bootstrap(
    trials: pd.DataFrame,
    statistic: Callable[[Sequence[NDArray]], float],
    *,
    replicates: int = REPLICATES,
    seed: int = 0,
) -> tuple[float, float]:
    """Return the 95 % interval of a statistic of trials, by bootstrap of nested clusters.

    `trials` has `hall`, `structure` (trials of one share its pictures) and `value`; NaN are left
    out. `statistic` takes the values of each hall. Halls, then the structures within each, then the
    trials within each are drawn with replacement (Davison & Hinkley 1997, sec. 3.8). With one hall
    the interval holds for that hall only; few halls make it too narrow. NaN below two values.
    """
    known = trials[np.isfinite(trials["value"])]
    if len(known) < 2:
        return np.nan, np.nan
    halls = [
        [part["value"].to_numpy(dtype=float) for _, part in hall.groupby("structure", dropna=False)]
        for _, hall in known.groupby("hall", dropna=False)
    ]
    rng = np.random.default_rng(seed)
    found = [
        statistic([_resample(rng, halls[at]) for at in rng.integers(len(halls), size=len(halls))])
        for _ in range(replicates)
    ]
    low, high = np.quantile(found, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return float(low), float(high)


def _resample(rng: np.random.Generator, structures: Sequence[NDArray]) -> NDArray:
    drawn = [structures[at] for at in rng.integers(len(structures), size=len(structures))]
    return np.concatenate([of[rng.integers(len(of), size=len(of))] for of in drawn])


def mean(halls: Sequence[NDArray]) -> float:
    """Return the mean over halls of the means within."""
    return float(np.mean([values.mean() for values in halls]))


def median(halls: Sequence[NDArray]) -> float:
    """Return the median over halls of the medians within."""
    return float(np.median([np.median(values) for values in halls]))
