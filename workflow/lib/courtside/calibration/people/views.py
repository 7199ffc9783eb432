"""What cameras see of people: joints at common times, cut into blocks of time, and bad input.

A row is one person in one frame. C cameras, T rows, J joints.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import triangulation
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

FEWEST_ROWS = 40  # ASSUME: with three views or more, of people who move; fewer say little
MOST_ROWS = 160  # neighbouring frames err alike: more rows take longer and say hardly more
LEAST_WAY_M = 0.25  # ASSUME: who stays within it shows a camera one direction only
ON_A_LINE = 0.02  # ASSUME: share of their extent by which cameras leave a line


@dataclass(frozen=True, eq=False)
class Seen:
    """People's joints as cameras see them, at common times."""

    xy: NDArray  # (C, T, J, 2): distorted px, NaN where unseen
    score: NDArray  # (C, T, J): 0..1, NaN where unseen
    height_px: NDArray  # (C, T): that the person, standing, has in each picture
    track: NDArray  # (T,) int: which person of which take; rows of a track are in order of time
    time_s: NDArray  # (T,): on the reference clock of the take
    offset_px: NDArray | None = None  # (C, T, J, 2): of a network's joints, subtracted from `xy`

    @property
    def detected_xy(self) -> NDArray:
        """Where the network places the joints, offsets included: (C, T, J, 2) px."""
        return self.xy if self.offset_px is None else self.xy + self.offset_px

    def of(self, rows: NDArray | slice) -> "Seen":
        """Return some rows, by number, as (T,) bool or a slice."""
        per_view = (self.xy[:, rows], self.score[:, rows], self.height_px[:, rows])
        offset_px = None if self.offset_px is None else self.offset_px[:, rows]
        return Seen(*per_view, self.track[rows], self.time_s[rows], offset_px)

    def thinned(self, most: int = MOST_ROWS) -> "Seen":
        """Return at most so many of the rows that two cameras see, or of all if none; evenly."""
        shared = np.isfinite(self.score).any(axis=2).sum(axis=0) >= 2
        rows = np.flatnonzero(shared | ~shared.any())
        steps = np.linspace(0, len(rows) - 1, min(len(rows), most))
        return self.of(rows[np.round(steps).astype(int)])

    def blocks(self, count: int) -> NDArray:
        """Return the block (T,) int of each row: each track's rows in so many parts of its time."""
        found = np.zeros(len(self.track), dtype=int)
        for number, track in enumerate(np.unique(self.track)):
            rows = np.flatnonzero(self.track == track)
            found[rows] = count * number + np.arange(len(rows)) * count // len(rows)
        return found

    def tracks(self) -> NDArray:
        """Return the track (N,) of each of the N = T J points of `flat`."""
        return np.repeat(self.track, self.score.shape[2])

    def flat(self) -> tuple[NDArray, NDArray, NDArray]:
        """Return joints (C, N, 2), scores (C, N) and heights (C, N) px of N = T J points."""
        n_joints = self.score.shape[2]
        height_px = np.repeat(self.height_px, n_joints, axis=1)
        score = self.score.reshape(len(self.score), -1)
        return self.xy.reshape(*score.shape, 2), score, height_px


@dataclass(frozen=True, eq=False)
class Limits:
    """Which views count: `score` least confidence; others in shares of the person's height."""

    score: float
    limit: float
    fade: float

    @classmethod
    def of(cls, views: Mapping[str, Any]) -> "Limits":
        """Return those of the step `triangulate` of the configuration."""
        return cls(views["min_score"], views["max_error_share"], views["fade_share"])

    @classmethod
    def wide(cls, score: float) -> "Limits":
        """Return limits for cameras that are a little wrong."""
        return cls(score, 0.2, 0.25)

    def times(self, factor: float) -> "Limits":
        """Return limits of views that are wider by a factor."""
        return replace(self, limit=factor * self.limit, fade=factor * self.fade)


def joined(parts: Sequence[Seen]) -> Seen:
    """Join what one network saw in several takes; the tracks of each are its own."""
    first, found = 0, []
    for part in parts:
        found.append(replace(part, track=part.track + first))
        first += int(part.track.max(initial=-1)) + 1
    offsets = [part.offset_px for part in found if part.offset_px is not None]
    if 0 < len(offsets) < len(found):
        raise ValueError("expected offsets subtracted in all takes or in none")
    return Seen(
        xy=np.concatenate([part.xy for part in found], axis=1),
        score=np.concatenate([part.score for part in found], axis=1),
        height_px=np.concatenate([part.height_px for part in found], axis=1),
        track=np.concatenate([part.track for part in found]),
        time_s=np.concatenate([part.time_s for part in found]),
        offset_px=np.concatenate(offsets, axis=1) if offsets else None,
    )


def placed(cameras: Sequence[Camera], seen: Seen, limits: Limits) -> triangulation.Triangulated:
    """Triangulate all joints robustly."""
    xy, score, height_px = seen.flat()
    return triangulation.triangulate_robust(
        cameras,
        xy,
        score,
        max_error_px=limits.limit * height_px,
        fade_px=limits.fade * height_px,
        min_score=limits.score,
    )


def check(cameras: Sequence[Camera], seen: Seen, min_score: float) -> None:
    """Raise an `InputError` where people cannot tell how cameras stand."""
    usable = (np.nan_to_num(seen.score) >= min_score).any(axis=2)
    showing = [camera.name for camera, one in zip(cameras, usable, strict=True) if one.any()]
    if len(showing) < 2:
        raise InputError(
            "people: expected them in two cameras or more, found them in "
            f"{', '.join(showing) or 'none'}; name takes that several cameras film"
        )
    centres = np.stack([camera.centre_in_world for camera in cameras])
    extents = np.linalg.svd(centres - centres.mean(axis=0), compute_uv=False)
    if len(cameras) < 3 or extents[1] < ON_A_LINE * extents[0]:
        line = " on a line" if len(cameras) > 2 else ""
        raise InputError(
            f"cameras: expected three or more that do not stand on one line, found {len(cameras)}"
            f"{line}; people do not tell how these stand: add a camera beside the line"
        )
    n_rows = int((usable.sum(axis=0) >= 2).sum())
    if n_rows < FEWEST_ROWS:
        raise InputError(
            f"people: expected {FEWEST_ROWS} frames or more with a person in two cameras, found "
            f"{n_rows}; name longer takes"
        )
    way_m = longest_way(cameras, seen, min_score)
    if way_m < LEAST_WAY_M:
        raise InputError(
            f"people: expected somebody who moves by {LEAST_WAY_M} m or more, found "
            f"{way_m:.2f} m; name takes in which people walk about"
        )


def longest_way(cameras: Sequence[Camera], seen: Seen, min_score: float) -> float:
    """Return how far apart the places of people are, m: the diagonal of their 90 % box.

    A place is the median of a row's joints; limits are wide, for cameras that are a little wrong.
    """
    found = placed(cameras, seen, Limits.wide(min_score))
    xyz = np.ma.masked_invalid(found.xyz.reshape(len(seen.track), -1, 3))
    middle = np.ma.median(xyz, axis=1).filled(np.nan)
    middle = middle[np.isfinite(middle).all(axis=1)]
    if not len(middle):
        return 0.0
    low, high = np.quantile(middle, [0.05, 0.95], axis=0)
    return float(np.linalg.norm(high - low))
