"""Whether cameras are better than others: by people and points that their fit did not see.

People count by blocks of time, points (clicked court points, points at rest) by their root mean
square. Cameras are better only where both say so.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.file_check import residuals
from courtside.calibration.people.adjustment import Clicks
from courtside.calibration.people.views import Limits, Seen, placed
from courtside.geometry.camera import Camera, project

BLOCKS = 8  # of each track, in turn to fit and to score
SURE = 2.0  # standard errors
LEAST_CHANGE = 0.02  # ASSUME: of a root mean square; less is no difference
FEWEST = {"court": 6, "static": 4}  # points; fewer say nothing

Fit = Callable[[Seen, Clicks | None], Sequence[Camera]]


@dataclass(frozen=True, eq=False)
class Points:
    """Points that tell of cameras what people do not."""

    static: NDArray | None = None  # (C, P, 2) px: of points at rest, never fitted
    court: Clicks | None = None  # that the cameras' calibration was not fitted to
    fitted: bool = False  # whether the court's clicks are part of the fit; folds leave half out


@dataclass(eq=False)
class Score:
    """How cameras do where they were not fitted; filled block by block, fold by fold."""

    share: dict[int, float] = field(default_factory=dict)  # by block: heights, per axis, median
    accepted: list[NDArray] = field(default_factory=list)  # (C, N) 0, 1; NaN where not shared
    squares: dict[str, list[NDArray]] = field(default_factory=dict)  # px^2 per axis, by kind

    def typical(self) -> float:
        """Return the median over blocks of how far joints disagree, in heights of the person.

        Blocks in which no joint is shared do not count.
        """
        return float(np.nanmedian(list(self.share.values())))

    def of(self, blocks: Collection[int]) -> "Score":
        """Return the joints of some blocks."""
        return Score({block: share for block, share in self.share.items() if block in blocks})

    def rms_px(self, kind: str) -> float:
        """Return the root mean square of points of a kind, px per axis; NaN of too few."""
        found = np.concatenate(self.squares.get(kind, [np.zeros(0)]))
        return float(np.sqrt(found.mean())) if len(found) else float("nan")

    def accepted_percent(self) -> NDArray:
        """Return the accepted share of each camera's shared views (C,), percent."""
        return 100 * np.nanmean(np.concatenate(self.accepted, axis=1), axis=1)


def score(fit: Fit, seen: Seen, points: Points, limits: Limits) -> Score:
    """Score a way to find cameras: fitted to every second block, judged by the others, and back.

    A `fit` that returns the same cameras every time is only judged.
    """
    found, block = Score(), seen.blocks(BLOCKS)
    fewest = FEWEST["court"] / (2 if points.fitted else 1)
    for odd in (0, 1):
        held, clicks = block % 2 != odd, points.court if points.fitted else None
        left = None if points.court is None else points.court.clicked.any(axis=0)
        if clicks is not None and left is not None:
            turn = np.cumsum(left) % 2 == odd
            clicks, left = clicks.of(left & ~turn), left & turn
        cameras = fit(seen.of(~held), clicks)
        _people(found, cameras, seen.of(held), block[held], limits)
        if points.static is not None and points.static.shape[1] >= FEWEST["static"]:
            found.squares.setdefault("static", []).append(
                _known(residuals.Rays(points.static).residuals(cameras) ** 2)
            )
        if points.court is not None and left is not None and left.sum() >= fewest:
            there = np.stack([project(camera, points.court.xyz) for camera in cameras])
            off = (there - points.court.xy)[:, left]
            found.squares.setdefault("court", []).append(_known(off**2))
    return found


def _known(squares: NDArray) -> NDArray:
    return squares[np.isfinite(squares)]


def _people(found: Score, cameras, seen: Seen, block: NDArray, limits: Limits) -> None:
    xy, score, height_px = seen.flat()
    shares = residuals.Rays(xy).residuals(cameras) / height_px[..., None]
    of_point = np.repeat(block, seen.score.shape[2])
    for one in np.unique(block):
        found.share[int(one)] = residuals.typical_px(shares[:, of_point == one])
    accepted = placed(cameras, seen, limits).accepted
    usable = np.nan_to_num(score) >= limits.score
    shared = usable & (usable.sum(axis=0) >= 2)  # no other view can agree with a single one
    found.accepted.append(np.where(shared, accepted, np.nan))


def change(before: Score, after: Score) -> tuple[float, float]:
    """Return the mean over blocks of the logarithm of the ratio of joints, and how sure it is."""
    known = [{b for b, share in one.share.items() if np.isfinite(share)} for one in (before, after)]
    blocks = sorted(set.intersection(*known))
    ratio = np.log([after.share[b] / before.share[b] for b in blocks])
    sure = SURE * ratio.std(ddof=1) / np.sqrt(len(ratio)) if len(ratio) > 1 else np.inf
    return float(ratio.mean()) if len(ratio) else 0.0, float(sure)


def verdicts(before: Score, after: Score) -> dict[str, str]:
    """Return by `joints`, `court`, `static`: whether the second is better, worse or neither.

    Joints by their `change`, which must be 2 standard errors from 0. What nothing is known of is
    left out.
    """
    found = {"joints": _word(*change(before, after))}
    for kind in ("court", "static"):
        old, new = before.rms_px(kind), after.rms_px(kind)
        if np.isfinite([old, new]).all():
            found[kind] = _word(float(np.log(max(new, 1e-9) / max(old, 1e-9))), LEAST_CHANGE)
    return found


def _word(change: float, sure: float) -> str:
    return "better" if change < -sure else "worse" if change > sure else "not better"


def better(found: dict[str, str]) -> bool:
    """Say whether all verdicts are that cameras are better."""
    return all(word == "better" for word in found.values())
