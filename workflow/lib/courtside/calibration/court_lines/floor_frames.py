"""Directions of the floor and focal lengths that straight pieces of a picture agree on."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations

# ASSUME: all of these are tuned by hand on development sessions.
FOCAL_WIDTHS = 0.5 * 1.13 ** np.arange(14)  # of the picture: fields of view of 90 to 23 degrees
TRIALS, KEPT = 900, 3  # samples and frames per focal length
MOST_SEGMENTS = 350
TOLERANCE_RAD, END_PX = np.deg2rad(1.0), 0.7  # of a segment's direction, and of its ends
UPRIGHT, MOST_ROLL = 0.5, 0.35  # cosine of the most tilt; sine of the most roll
APART_RAD = np.deg2rad(2.0)


@dataclass(frozen=True, eq=False)
class FloorFrame:
    """Axes of the floor as a camera with a focal length sees them."""

    f_px: float
    axes: NDArray  # (3, 3): rows: the floor's two directions and up, in the camera's frame


@dataclass(frozen=True, eq=False)
class Pieces:
    """Straight pieces of lines, px about the principal point."""

    middle: NDArray  # (N, 2)
    tangent: NDArray  # (N, 2)
    length: NDArray  # (N,)

    @classmethod
    def of(cls, ends: NDArray) -> "Pieces":
        """Return the pieces between ends (N, 4)."""
        along = ends[:, 2:] - ends[:, :2]
        length = np.hypot(*along.T)
        return cls((ends[:, :2] + ends[:, 2:]) / 2, along / length[:, None], length)

    @property
    def tolerance(self) -> NDArray:
        """Tolerance of their directions, (N,) rad."""
        return TOLERANCE_RAD + END_PX / self.length

    def off(self, axes: NDArray, f_px: float) -> NDArray:
        """Return the sine (..., N) of each one's angle to axes (..., 3), seen at its middle."""
        towards = axes[..., None, :2] * f_px - axes[..., None, 2:] * self.middle
        sine = towards[..., 0] * self.tangent[:, 1] - towards[..., 1] * self.tangent[:, 0]
        return sine / (np.hypot(towards[..., 0], towards[..., 1]) + 1e-9)


def find(ends: NDArray, width: float, rng: np.random.Generator) -> list[FloorFrame]:
    """Find frames whose axes are parallel to many line segments, some for each focal length.

    `ends` (N, 4) px are relative to the principal point and without distortion. Three segments give
    a frame: two parallel ones give one direction, a third gives the other. Walls parallel to the
    court help.
    """
    ends = ends[:MOST_SEGMENTS]
    if len(ends) < 4:
        return []
    pieces, found = Pieces.of(ends), list[FloorFrame]()
    weight = np.minimum(pieces.length, 0.15 * width)
    for f_px in FOCAL_WIDTHS * width:
        one, other = (np.column_stack([xy, np.full(len(xy), f_px)]) for xy in np.hsplit(ends, 2))
        planes = np.cross(one, other)
        planes /= np.linalg.norm(planes, axis=1, keepdims=True)
        chosen = rng.choice(len(ends), (3, TRIALS), p=weight / weight.sum())
        axes = _upright(*(planes[row] for row in chosen))
        if not len(axes):
            continue
        agree = (np.abs(pieces.off(axes, f_px)) < pieces.tolerance).astype(float)
        fit = np.maximum(np.maximum(agree[:, 0], agree[:, 1]), 0.5 * agree[:, 2]) @ weight
        kept: list[NDArray] = []
        for at in np.argsort(-fit)[: 20 * KEPT]:
            polished = _polish(axes[at], f_px, pieces, weight)
            if all(_apart(polished, earlier) for earlier in kept):
                kept.append(polished)
            if len(kept) == KEPT:
                break
        found += [FloorFrame(float(f_px), axes) for axes in kept]
    return found


def _upright(one: NDArray, other: NDArray, third: NDArray) -> NDArray:
    """Return frames (M, 3, 3) of three pieces' planes through the camera, without upset cameras."""
    a = np.cross(one, other)
    b = np.cross(third, a)
    sizes = np.linalg.norm(a, axis=1), np.linalg.norm(b, axis=1)
    good = (sizes[0] > 0.01) & (sizes[1] > 0.02 * sizes[0])
    a, b = a[good] / sizes[0][good, None], b[good] / sizes[1][good, None]
    axes, row = np.stack([a, b, np.cross(a, b)], axis=1), np.arange(len(a))
    up = np.argmax(np.abs(axes[:, :, 1]), axis=1)
    z, x = axes[row, up], axes[row, (up + 1) % 3]
    z = -z * np.sign(z[:, 1:2])
    axes = np.stack([x, np.cross(z, x), z], axis=1)
    return axes[(-z[:, 1] > UPRIGHT) & (np.abs(z[:, 0]) < MOST_ROLL) & (z[:, 2] < 0.3)]


def _polish(axes: NDArray, f_px: float, pieces: Pieces, weight: NDArray) -> NDArray:
    """Turn a frame so that the pieces parallel to its axes fit best."""
    small = 1e-5
    for wide in (2.0, 1.5, 1.0):
        off = pieces.off(axes, f_px)
        scale = np.sqrt(weight) / pieces.tolerance * np.array([[1.0], [1.0], [0.7]])
        scale = np.where(np.abs(off) < wide * pieces.tolerance, scale, 0)
        turns = rotations.rotation_from_rodrigues(small * np.eye(3))
        slopes = [(pieces.off(axes @ turn.T, f_px) - off) / small * scale for turn in turns]
        columns = np.stack([slope.ravel() for slope in slopes], axis=1)
        normal = columns.T @ columns
        step = np.linalg.solve(
            normal + 1e-6 * (np.trace(normal) + 1) * np.eye(3), -columns.T @ (off * scale).ravel()
        )
        axes = axes @ rotations.rotation_from_rodrigues(step).T
    return axes


def _apart(one: NDArray, other: NDArray) -> bool:
    """Say whether frames differ by more than quarter turns about the vertical."""
    cosines, least = np.abs(one @ other.T), np.cos(APART_RAD)
    return bool(cosines[2, 2] < least or max(cosines[0, 0], cosines[0, 1]) < least)
