"""Thin lines of a picture: pixels on bright or dark ridges, and straight pieces of them."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

# ASSUME: all of these are tuned by hand on development sessions.
SIGMAS_PX = (0.9, 1.6, 2.8)  # of blur, for lines of 1 to 8 px
CONTRAST = 2.5  # of a ridge, in means around it
AROUND_PX = 61
LEAST_PX = 10  # extent of connected pixels of a ridge
PIECE_PX, PIECE_RMS_PX = 14, 0.8  # length of a straight piece, and how straight it is
DIRECTIONS = 12  # in which straight pieces are looked for
# Faint lines: length and width of filters, standard deviations; how many; contrast and extent.
FAINT_PX, FAINT_DIRECTIONS, FAINT_CONTRAST, FAINT_LEAST_PX = (7.0, 1.0), 48, 1.8, 24
FLOOR_PX, CLIP = 4.0, 1.5  # blur that removes lines; clipped, in deviations of the noise


@dataclass(frozen=True, eq=False)
class Ridges:
    """Where a picture has thin lines."""

    on: NDArray  # (H, W) bool
    angle: NDArray  # (H, W): of the line's direction there, radians, 0 to pi


def find(image: NDArray, lines: str) -> Ridges:
    """Find the ridges of a picture (H, W, 3) uint8: "light" ones, "dark" ones, or "any".

    Ridges by the Hessian at several scales, relative to the mean around them, so that
    faint lines on a plain floor count as much as strong ones.
    """
    channels = {
        "light": [image.min(axis=2)],  # white paint raises every channel
        "dark": [image.mean(axis=2)],
        "any": [image[..., at] for at in range(3)],
    }[lines]
    shape = image.shape[:2]
    best, angle = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    for channel in channels:
        for sigma in SIGMAS_PX:
            response, along = _response(channel.astype(np.float32), sigma, lines)
            relative = response / (
                cv2.blur(response, (AROUND_PX, AROUND_PX)) + 0.25 * np.median(response) + 0.15
            )
            angle = np.where(relative > best, along, angle)
            best = np.maximum(relative, best)
    return _long(_thin(best, angle) & (best > CONTRAST), angle, LEAST_PX)


def find_faint(image: NDArray, lines: str) -> Ridges:
    """Find the ridges of a picture (H, W, 3) uint8 that are too faint for `find`.

    Long filters of many directions add up the brightness along a line. They find lines much thinner
    than a pixel, but no curved ones. `lines` is "light" or "dark".
    """
    fine = contrast(image, lines)
    best, angle = np.zeros(fine.shape, np.float32), np.zeros(fine.shape, np.float32)
    for direction in np.arange(FAINT_DIRECTIONS) * np.pi / FAINT_DIRECTIONS:
        response = cv2.filter2D(fine, cv2.CV_32F, _filter(direction), borderType=cv2.BORDER_REFLECT)
        angle = np.where(response > best, np.float32(direction), angle)
        best = np.maximum(response, best)
    around = cv2.blur(best, (AROUND_PX, AROUND_PX)) + 0.25 * np.median(best) + 0.15
    relative = best / around
    return _long(_thin(relative, angle) & (relative > FAINT_CONTRAST), angle, FAINT_LEAST_PX)


def contrast(image: NDArray, lines: str) -> NDArray:
    """Return thin structures of a picture (H, W, 3) uint8, with a root mean square of 1.

    Light lines are positive with `lines` "light", dark ones with "dark". Values are clipped at
    little more than the noise, so that a net's tape counts no more than a faint line of its size.
    """
    # White paint raises every channel; dark paint lowers their mean.
    grey = -image.mean(axis=2) if lines == "dark" else image.min(axis=2)
    fine = grey.astype(np.float32)
    fine -= cv2.GaussianBlur(fine, (0, 0), FLOOR_PX)
    noise = max(1.4826 * float(np.median(np.abs(fine))), 0.25)
    fine = np.clip(fine / noise, -CLIP, CLIP)
    return fine / max(float(np.sqrt(np.mean(fine**2))), 1e-6)


def _filter(direction: float) -> NDArray:
    """Return a filter for lines of one direction (rad), of unit norm and without mean."""
    long, wide = FAINT_PX
    reach = int(np.ceil(2.5 * long))
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1].astype(float)
    along = x * np.cos(direction) + y * np.sin(direction)
    across = y * np.cos(direction) - x * np.sin(direction)
    piece = np.exp(-0.5 * (along / long) ** 2)
    line = piece * (1 - (across / wide) ** 2) * np.exp(-0.5 * (across / wide) ** 2)
    floor = piece * np.exp(-0.5 * (across / (2 * wide)) ** 2)
    line -= floor * line.sum() / floor.sum()
    return (line / np.linalg.norm(line)).astype(np.float32)


def _long(keep: NDArray, angle: NDArray, least_px: float) -> Ridges:
    """Return the connected ridges of at least some extent."""
    _, label, stats, _ = cv2.connectedComponentsWithStats(keep.astype(np.uint8), connectivity=8)
    long = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) >= least_px
    long[0] = False
    return Ridges(long[label], np.mod(angle, np.pi))


def _response(grey: NDArray, sigma: float, lines: str) -> tuple[NDArray, NDArray]:
    """Return the strength of ridges of one width, and the angle along them."""
    soft = cv2.GaussianBlur(grey, (0, 0), sigma)
    xx, yy, xy = (cv2.Sobel(soft, cv2.CV_32F, *by, ksize=3) / 4 for by in ((2, 0), (0, 2), (1, 1)))
    half, middle = np.sqrt(((xx - yy) / 2) ** 2 + xy**2), (xx + yy) / 2
    low, high = middle - half, middle + half
    flat = 0.5 * np.arctan2(2 * xy, xx - yy)  # of least curvature downwards: along a bright ridge
    bright, dark = -low - np.abs(high), high - np.abs(low)
    if lines == "light":
        response, along = bright, flat
    elif lines == "dark":
        response, along = dark, flat + np.pi / 2
    else:
        response = np.maximum(bright, dark)
        along = flat + np.where(high > -low, np.pi / 2, 0)
    return np.maximum(response, 0) * sigma**1.5, along


def _thin(strength: NDArray, angle: NDArray) -> NDArray:
    """Return the pixels that are strongest across their ridge, (H, W) bool."""
    rows, columns = np.indices(strength.shape, dtype=np.float32)
    dx, dy = -np.sin(angle).astype(np.float32), np.cos(angle).astype(np.float32)
    beside = [
        cv2.remap(strength, columns + by * dx, rows + by * dy, cv2.INTER_LINEAR) for by in (1, -1)
    ]
    return (strength >= beside[0]) & (strength >= beside[1])


def segments(ridges: Ridges) -> NDArray:
    """Return the ends (N, 4) x0 y0 x1 y1 px of straight pieces of ridges, longest first."""
    y, x = np.nonzero(ridges.on)
    angle, found = ridges.angle[ridges.on], []
    width = np.pi / DIRECTIONS
    for number in range(DIRECTIONS):
        chosen = direction_off(angle, number * width) < 0.9 * width
        mask = np.zeros(ridges.on.shape, np.uint8)
        mask[y[chosen], x[chosen]] = 1
        n, label = cv2.connectedComponents(mask, connectivity=8)
        place = np.column_stack([x[chosen], y[chosen]]).astype(float)
        found.append(_straight(place, label[y[chosen], x[chosen]], n))
    ends = np.concatenate(found)
    return ends[np.argsort(-np.hypot(*(ends[:, 2:] - ends[:, :2]).T), kind="stable")]


def direction_off(angle: NDArray, direction: NDArray | float) -> NDArray:
    """Return by how much directions of lines differ from others, radians in 0..pi/2."""
    return np.abs((angle - direction + np.pi / 2) % np.pi - np.pi / 2)


def _straight(place: NDArray, label: NDArray, n: int) -> NDArray:
    """Fit a straight piece to the pixels (M, 2) of each label; return the good ones' ends."""
    count = np.maximum(np.bincount(label, minlength=n), 1)
    middle = np.column_stack([np.bincount(label, axis, n) / count for axis in place.T])
    dx, dy = (place - middle[label]).T
    xx, xy, yy = (np.bincount(label, value, n) for value in (dx * dx, dx * dy, dy * dy))
    turn = 0.5 * np.arctan2(2 * xy, xx - yy)
    tangent = np.column_stack([np.cos(turn), np.sin(turn)])
    along = dx * tangent[label, 0] + dy * tangent[label, 1]
    across = dy * tangent[label, 0] - dx * tangent[label, 1]
    low, high = np.zeros(n), np.zeros(n)
    np.minimum.at(low, label, along)
    np.maximum.at(high, label, along)
    rms = np.sqrt(np.bincount(label, across**2, n) / count)
    good = (high - low >= PIECE_PX) & (rms < PIECE_RMS_PX)
    ends = np.column_stack([middle + low[:, None] * tangent, middle + high[:, None] * tangent])
    return ends[good]
