"""Colours of clothes as evidence of identity.

Cameras show the same shirt in different colours (light, exposure, white balance). These differences
between cameras, and the scatter of one person's colours, are learned from positions where the
geometry is unambiguous. If people dress alike, colours have no effect.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.reconstruction.association.candidates import Candidates
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
FEWEST = 20  # sure places, from which colours can be learned
LEAST_SIGMA = 2.0  # of a colour's channel, L*a*b*
ROUNDS = 5  # of means and offsets in turns
MEDIAN_VARIANCE = np.pi / 2  # of the median of many normal values, in shares of their mean's
WEIGHT = 0.5  # of a channel: lightness and colour of one part do not err independently
# Share of parts that show something else: an arm, a net, another body in front, a shadow.
HIDDEN = 0.35
GAINED = 0.75  # limit of the log-likelihood ratio that one part speaks for the same person


@dataclass(frozen=True)
class Looks:
    """Colours of the rows of C cameras: K channels, L*a*b* of some parts of the body."""

    colours: list[NDArray]  # of each camera (P, T, K), without its own offset; NaN where unknown
    instants: NDArray  # (N,): frames that candidates are numbered by
    sigma: NDArray  # (K,): standard deviation of one person's colour in one view
    spread: NDArray  # (K,): that of the colours of different people

    def of(self, instant: NDArray, row: NDArray) -> NDArray:
        """Return the colours (M, C, K) of rows (M, C) at instants (M,); NaN for none."""
        return _of_rows(self.colours, self.instants[instant], row)

    def middle(self, found: Candidates) -> NDArray:
        """Return the colours (M, K) of candidates, the median of their views; NaN where unknown."""
        return _median(self.of(found.instant, found.row), axis=1)

    def worn(self, chosen: NDArray, found: Candidates) -> NDArray:
        """Return the colours (S, K) of people whose candidates are `chosen` (S, N), -1 for none."""
        middle = self.middle(found)
        seen = np.where((chosen >= 0)[..., None], middle[chosen], np.nan)
        return _median(seen, axis=1)

    def cost(self, off: NDArray, more: NDArray | float = 0.0) -> NDArray:
        """Return negative log-likelihood ratios (...) of one person against two.

        `off` (..., K) are differences of colours, NaN where unknown; `more` is the variance of what
        is compared with, in shares of one view's.
        """
        same = self.sigma**2 * (1 + np.asarray(more)[..., None])
        other = same + 2 * self.spread**2
        each = off**2 * (1 / same - 1 / other) - np.log(other / same)
        parts = 0.5 * WEIGHT * np.nan_to_num(each).reshape(*off.shape[:-1], -1, 3).sum(axis=-1)
        known = np.isfinite(off).reshape(*off.shape[:-1], -1, 3).all(axis=-1)
        ratio = np.exp(np.clip(-parts, -50.0, GAINED))
        return np.where(known, -np.log((1 - HIDDEN) * ratio + HIDDEN), 0.0).sum(axis=-1)

    def view_cost(self, instant: NDArray, row: NDArray, start: int = 0) -> NDArray:
        """Return the cost (M, C) of each view of a candidate against its other views.

        Instants (M,) are counted from `start`.
        """
        seen = self.of(instant + start, row)
        total, count = np.zeros(row.shape), np.zeros(row.shape)
        for c in range(row.shape[1]):
            for d in range(c + 1, row.shape[1]):
                pair = self.cost(seen[:, c] - seen[:, d], 1.0)
                for view in (c, d):
                    total[:, view] += pair
                    count[:, view] += (row[:, c] >= 0) & (row[:, d] >= 0)
        # Each pair speaks for two views; n views have n - 1 independent differences.
        return total / (np.maximum(count, 1) + 1)

    def row_cost(self, camera: int, worn: NDArray) -> NDArray:
        """Return the cost (P, T, S + 1) of each row of a camera for people of colours (S, K).

        The last column is nobody's: zero.
        """
        seen = self.colours[camera]
        cost = [self.cost(seen - one) for one in worn]
        return np.stack([*cost, np.zeros(seen.shape[:2])], axis=-1)


def learn(clothing: Sequence[NDArray], instants: NDArray, sure: Candidates) -> Looks | None:
    """Learn how the colours (P, T, 2, 3) of cameras differ, from candidates that are sure.

    None where there are too few to learn from.
    """
    colours = [seen.reshape(*seen.shape[:2], -1) for seen in clothing]
    whole = _of_rows(colours, instants[sure.instant], sure.row)
    whole = whole[np.isfinite(whole).all(axis=2).sum(axis=1) >= 2]
    if len(whole) < FEWEST:
        return None
    offset = np.zeros(whole.shape[1:])
    for _ in range(ROUNDS):
        middle = _median(whole - offset, axis=1)
        away = _median(whole - middle[:, None], axis=0)
        offset = np.nan_to_num(away - np.nanmean(away, axis=0))
    left = np.abs(whole - offset - middle[:, None])
    sigma = np.maximum(
        MEDIAN_TO_SIGMA * _median(left.reshape(-1, left.shape[2]), axis=0), LEAST_SIGMA
    )
    n_views = np.isfinite(whole).all(axis=2).sum(axis=1).mean()
    scatter = MEDIAN_VARIANCE * sigma**2 / n_views  # of a median of views: it is no spread
    return Looks(
        colours=[seen - offset[c] for c, seen in enumerate(colours)],
        instants=instants,
        sigma=sigma,
        spread=np.sqrt(np.maximum(np.nanvar(middle, axis=0) - scatter, 0.0)),
    )


def _of_rows(colours: Sequence[NDArray], frame: NDArray, row: NDArray) -> NDArray:
    """Return the colours (M, C, K) of rows (M, C) in frames (M,); NaN for none."""
    each = [
        np.where((row[:, c] >= 0)[:, None], seen[np.maximum(row[:, c], 0), frame], np.nan)
        for c, seen in enumerate(colours)
    ]
    return np.stack(each, axis=1)


def _median(values: NDArray, axis: int) -> NDArray:
    """Return medians of the values that are known, NaN where none is."""
    known = np.isfinite(values).any(axis=axis, keepdims=True)
    middle = np.nanmedian(np.where(known, values, 0.0), axis=axis)
    return np.where(known.squeeze(axis), middle, np.nan)
