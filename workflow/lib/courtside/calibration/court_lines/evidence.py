"""The share of a court's lines that a picture shows where cameras predict them."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court_lines.ridges import Ridges, direction_off
from courtside.calibration.court_lines.views import Samples, Views

# ASSUME: all of these are tuned by hand on development sessions.
DIRECTIONS = 12
OFF_RAD = np.deg2rad(13.0)  # of a ridge from the direction that is expected
FARTHEST_PX = 14.0
MARGIN_PX = 6
SAMPLE_PX = 12.0  # more of a line between two points counts as this
RESOLVED_PX = 3.0  # lines of which half a metre across appears shorter count less
OWN_PX = 8.0  # of line whose evidence is independent
LEAST_WIDTHS = 0.35  # of the picture: less line in it is no evidence
AT_ONCE = 1000  # cameras


@dataclass(frozen=True, eq=False)
class Fields:
    """Distances to the ridges of a picture, by direction."""

    ridges: Ridges
    distance: NDArray  # (D, H, W): px to the nearest ridge of about this direction

    @property
    def width(self) -> int:
        """Width of the picture, px."""
        return self.distance.shape[2]

    def chance(self, tolerance_px: float) -> NDArray:
        """Return the mean closeness (D,) anywhere below the upper third."""
        lower = self.distance[:, self.distance.shape[1] // 3 :: 2, ::2]
        return np.maximum(0, 1 - lower / tolerance_px).mean(axis=(1, 2))


@dataclass(frozen=True, eq=False)
class Evidence:
    """Evidence for cameras (B)."""

    score: NDArray  # (B,): log likelihood ratio against chance; -1 where too little is in view
    weight: NDArray  # (B, N): px of line that each sample stands for
    close: NDArray  # (B, N): closeness of the nearest ridge at each sample, 0..1


def fields(ridges: Ridges) -> Fields:
    """Return the distances to ridges by direction, up to `FARTHEST_PX`."""
    distance = np.empty((DIRECTIONS, *ridges.on.shape), np.float32)
    for number in range(DIRECTIONS):
        near = direction_off(ridges.angle, number * np.pi / DIRECTIONS) < OFF_RAD
        mask = (~(ridges.on & near)).astype(np.uint8)
        distance[number] = np.minimum(
            cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE), FARTHEST_PX
        )
    return Fields(ridges, distance)


def score(seen: Fields, views: Views, along: Samples, tolerance_px: float) -> Evidence:
    """Score cameras by ridges at most `tolerance_px` from the court's lines, of their direction.

    The score is the log likelihood ratio of lines against chance. It compares the share of the
    lines in view that are close to ridges with the share of ridges of these directions anywhere.
    """
    parts = [
        _score(seen, views[at : at + AT_ONCE], along, tolerance_px)
        for at in range(0, len(views), AT_ONCE)
    ]
    rows = ("score", "weight", "close")
    return Evidence(*(np.concatenate([getattr(part, row) for part in parts]) for row in rows))


def _score(seen: Fields, views: Views, along: Samples, tolerance_px: float) -> Evidence:
    size = np.array(seen.distance.shape[:0:-1])
    place = views.project(along.place)
    tangent = views.project(along.place + along.half) - views.project(along.place - along.half)
    sideways = np.column_stack([along.half[:, 1], -along.half[:, 0]])
    sideways *= 0.25 / np.linalg.norm(sideways, axis=1, keepdims=True)
    across = views.project(along.place + sideways) - views.project(along.place - sideways)
    length = np.linalg.norm(tangent, axis=2)
    wide = np.abs(across[..., 0] * tangent[..., 1] - across[..., 1] * tangent[..., 0]) / (
        length + 1e-9
    )
    weight = np.minimum(length, SAMPLE_PX) * np.minimum(1, wide / RESOLVED_PX)
    inside = ((place > MARGIN_PX) & (place < size - 1 - MARGIN_PX)).all(axis=2)
    inside &= np.isfinite(weight)
    weight = np.where(inside, weight, 0.0)
    x, y = np.where(inside[..., None], place + 0.5, 0).astype(int).transpose(2, 0, 1)
    direction = np.round(np.arctan2(tangent[..., 1], tangent[..., 0]) * DIRECTIONS / np.pi)
    direction = np.where(inside, direction, 0).astype(int) % DIRECTIONS
    close = np.maximum(0, 1 - seen.distance[direction, y, x] / tolerance_px)
    total = weight.sum(axis=1)
    share = np.clip((weight * close).sum(axis=1) / np.maximum(total, 1e-9), 1e-6, 1 - 1e-6)
    by_chance = (weight * seen.chance(tolerance_px)[direction]).sum(axis=1)
    by_chance = np.clip(by_chance / np.maximum(total, 1e-9), 0.004, 0.9)
    ratio = share * np.log(share / by_chance) + (1 - share) * np.log((1 - share) / (1 - by_chance))
    ratio *= total / OWN_PX * 1280 / size[0]
    good = (total > LEAST_WIDTHS * size[0]) & (share > by_chance)
    return Evidence(np.where(good, ratio, -1.0), weight, close)
