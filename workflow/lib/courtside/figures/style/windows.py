"""Long takes over time: what each window of some seconds has, in place of a band of ink."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from numpy.typing import NDArray
from pandas.core.groupby import SeriesGroupBy

LONGEST_S = 120.0  # of a take whose frames are all drawn
MOST = 60  # windows side by side
LENGTHS_S = (2, 5, 10, 15, 30, 60, 120, 300, 600)
LEAST_SEEN = 0.5  # of a window that is drawn


def length_s(time_s: NDArray) -> int:
    """Return how long the windows of a take are, s; 0 if all of its frames are drawn."""
    whole_s = float(time_s[-1] - time_s[0]) if len(time_s) else 0.0
    if whole_s <= LONGEST_S:
        return 0
    return next((each for each in LENGTHS_S if whole_s <= MOST * each), LENGTHS_S[-1])


def middles(time_s: NDArray, start_s: float, window_s: int) -> NDArray:
    """Return the middle (T,) of each time's window; one begins in the whole second of the start."""
    first_s = np.floor(start_s)
    return first_s + (np.floor((time_s - first_s) / window_s) + 0.5) * window_s


def known(time_s: NDArray, values: NDArray, window_s: int) -> SeriesGroupBy:
    """Return values (T,) grouped by window; NaN all of one of which less than half is known."""
    rows = pd.Series(values)
    by = middles(time_s, time_s[0], window_s)
    n_frames = window_s / float(np.median(np.diff(time_s)))
    enough = rows.groupby(by).transform("count") >= LEAST_SEEN * n_frames
    return rows.where(enough).groupby(by)


def draw(
    axis: Axes, time_s: NDArray, values: NDArray, window_s: int, *, colour: str, label: str
) -> None:
    """Draw the medians of windows as a line in the band from their 5 to their 95 % quantiles."""
    groups = known(time_s, values, window_s)
    low, median, high = (groups.quantile(share) for share in (0.05, 0.5, 0.95))
    axis.fill_between(median.index, low, high, color=colour, alpha=0.2, linewidth=0)
    axis.plot(median.index, median, color=colour, linewidth=0.9, label=label)


def a_minute(at_s: NDArray, time_s: NDArray, seen: NDArray, window_s: int) -> pd.Series:
    """Return how many of the events at `at_s` (N,) there are in a minute, by middle of a window.

    A minute counts the frames at `time_s` (T,) in which the person is `seen` (T,). NaN where this
    is less than half of the window.
    """
    n_seen = known(time_s, np.where(seen, 1.0, np.nan), window_s).sum(min_count=1)
    counts = pd.Series(middles(at_s, time_s[0], window_s)).value_counts()
    counts = counts.reindex(n_seen.index, fill_value=0)
    return 60 * counts / (n_seen * float(np.median(np.diff(time_s))))
