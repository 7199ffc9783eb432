"""The shift of a painted line from its expected position, with its uncertainty."""

from dataclasses import dataclass

import cv2
import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.click_proposals.line_profiles import LEAST_SAMPLES, STEP_PX, Stretch

SLOPE_PX = 3.0  # ASSUME: by which a stretch may be turned, at its ends
NEAR_PX = 8.0  # ASSUME: samples nearer than this to a point are those beside it
ROUNDS = 4  # ASSUME: linearisations after which the shift stays
SEEN = (0.35, 2.6)  # ASSUME: contrast of a sample in which the line is seen, in medians of all
HUBER = 1.5  # standard deviations; 95 % efficiency for normal errors is at 1.345


@dataclass(frozen=True)
class Shift:
    """The shift of a line from its expected position."""

    low_px: float  # of its lower edge, along the normal, at the origin
    high_px: float  # of its higher edge; the same where the line is too thin to separate them
    slope: float  # rotation of the line: px across per px along
    sigma_px: float  # standard deviation of the shift at the origin
    share: float  # of the samples in which the line is seen, 0..1
    near_share: float  # the same of those near the origin
    score: float  # mean correlation of what is seen with what is expected there
    rival: float  # the best score over two widths away, relative to it: near 1 if ambiguous


def shift(stretch: Stretch, *, polarity: int = 1, blur_px: float = 0.8) -> Shift | None:
    """Measure the shift of a line; None if the line is not found.

    First the best place and slope by correlation summed along the line, then linearised least
    squares: in each sample the floor's brightness and its gradient, the contrast of the expected
    paint, and that paint's derivative, which gives the shift. The two edges are shifted separately
    where the line is 3 px wide.

    `polarity` is 1 where paint is brighter than floor, -1 where darker, 0 where that may change
    along the line; samples up to `NEAR_PX` from the nearest one count as near the origin.
    """
    match = _correlations(stretch, polarity)
    offset, slope, score, rival = _best_line(match, stretch.along_px, stretch.width_px)
    if score <= 0:
        return None
    low = high = offset
    sides = 2 if stretch.width_px >= 3 else 1
    for _ in range(ROUNDS):
        found = _refine(stretch, (low + high) / 2, slope, polarity, sides, blur_px)
        if found is None:
            return None
        moves, turn, sigma, kept = found
        middle, slope = (low + high) / 2, slope + turn
        low, high = middle + moves[0], middle + moves[-1]
    nearest = np.abs(stretch.along_px) <= np.abs(stretch.along_px).min() + NEAR_PX
    shares = kept.mean(), kept[nearest].mean()
    return Shift(low, high, slope, sigma, *shares, score, rival)


def _correlations(stretch: Stretch, polarity: int) -> NDArray:
    """Return the correlation of each sample with its expectation at every shift, (N, shifts)."""
    width = stretch.paint.shape[1]
    windows = np.lib.stride_tricks.sliding_window_view(stretch.seen, width, axis=1)
    t = np.linspace(-1, 1, width)
    basis = np.stack([np.ones(width) / np.sqrt(width), t / np.linalg.norm(t)])
    paint = stretch.paint - stretch.paint @ basis.T @ basis
    size = np.linalg.norm(paint, axis=1)
    inner = np.einsum("nsw,nw->ns", windows, paint)
    level = np.einsum("nsw,bw->nsb", windows, basis)
    energy = np.einsum("nsw,nsw->ns", windows, windows) - np.sum(level**2, axis=2)
    # The sensor's and the codec's noise must not look like a perfect match.
    match = inner / np.maximum(size[:, None], 1e-9) / np.sqrt(np.maximum(energy, 0) + width)
    if polarity:
        return match * polarity
    # Noise, too, correlates with one sign or the other: by so much on average over that many
    # pixels.
    return np.abs(match) - np.sqrt(2 / np.pi / max(width * STEP_PX - 2, 1))


def _best_line(match, along_px, width_px) -> tuple[float, float, float, float]:
    """Return shift at the origin, slope, mean correlation there and the best rival's share."""
    n, shifts = match.shape
    middle = (shifts - 1) / 2
    centre, extent = along_px.mean(), max(np.ptp(along_px) / 2, 1.0)
    turns = np.arange(-SLOPE_PX, SLOPE_PX + 1e-9, 0.5)
    turns = turns[np.abs(turns) <= max(0.15 * extent, 0.5)]
    scores = np.empty((len(turns), shifts))
    rows = np.arange(n)
    for at, turn in enumerate(turns):
        moved = np.round(turn * (along_px - centre) / extent / STEP_PX).astype(int)
        columns = np.arange(shifts)[:, np.newaxis] + moved
        valid = (columns >= 0) & (columns < shifts)
        scores[at] = np.where(valid, match[rows, np.clip(columns, 0, shifts - 1)], 0).mean(axis=1)
    turn, best = np.unravel_index(np.argmax(scores), scores.shape)
    score = scores[turn, best]
    away = np.abs(np.arange(shifts) - best) * STEP_PX > max(2 * width_px, 2.0)
    rival = scores[:, away].max(initial=0.0) / max(score, 1e-9)
    slope = turns[turn] / extent
    offset = (best - middle) * STEP_PX - slope * centre
    return float(offset), float(slope), float(score), float(rival)


def _refine(stretch, offset, slope, polarity, sides, blur_px):
    """Return the edges' shifts at the origin, slope, sigma, and which samples fit; None if lost."""
    n, width = stretch.paint.shape
    moved_px = (offset + slope * stretch.along_px)[:, None]
    columns = (stretch.seen.shape[1] - 1) / 2 + moved_px / STEP_PX
    columns = columns + np.arange(width) - (width - 1) / 2
    seen = _at(stretch.seen, columns)
    t = (np.arange(width) - (width - 1) / 2) * STEP_PX
    rate = np.gradient(stretch.paint, STEP_PX, axis=1)
    floor = [np.ones(width), t / t[-1]]
    if stretch.width_px > 2:
        floor.append(scipy.special.erf(t / blur_px / np.sqrt(2)))  # floors of two colours
    contrast, noise = _contrast(seen, np.array(floor), stretch.paint)
    median = np.median(np.abs(contrast) if polarity == 0 else contrast)
    typical = median if polarity == 0 else max(polarity * median, 0)
    if typical <= 0:
        return None
    if polarity:
        relative = polarity * contrast / typical
        kept = (relative > SEEN[0]) & (relative < SEEN[1])
        used = np.full(n, polarity * typical)
    else:
        kept, used = np.abs(contrast) > 0.5 * typical, contrast
    if kept.sum() < LEAST_SAMPLES - 2:
        return None
    parts = [rate] if sides == 1 else [np.where(t < 0, rate, 0), np.where(t >= 0, rate, 0)]
    moved, spread = _moves(seen, np.array(floor), stretch.paint, parts, used, noise)
    moves, turn, sigma = _line(moved, spread, stretch.along_px, kept)
    return moves, turn, sigma, kept


def _at(values: NDArray, columns: NDArray) -> NDArray:
    """Return values between columns by linear interpolation, (N, W)."""
    rows = np.repeat(np.arange(len(values), dtype=np.float32)[:, None], columns.shape[1], axis=1)
    return cv2.remap(
        values.astype(np.float32), columns.astype(np.float32), rows, cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(float)  # fmt: skip


def _contrast(seen: NDArray, floor: NDArray, paint: NDArray) -> tuple[NDArray, NDArray]:
    """Return each sample's contrast, and its noise per step, (N,)."""
    columns = np.concatenate(
        [np.broadcast_to(floor, (len(paint), *floor.shape)), paint[:, None]], axis=1
    )
    fitted = np.linalg.pinv(np.swapaxes(columns, 1, 2)) @ seen[..., None]
    rest = seen - np.einsum("nkw,nk->nw", columns, fitted[..., 0])
    noise = np.sqrt(np.mean(rest**2, axis=1) / STEP_PX)  # neighbouring steps share their pixels
    return fitted[:, -1, 0], noise


def _moves(seen, floor, paint, parts, contrast, noise):
    """Return each sample's shift of each edge (N, E) and its sigma, by linear least squares."""
    n = len(seen)
    columns = [np.broadcast_to(row, paint.shape) for row in floor]
    columns += [paint] + [-contrast[:, None] * part for part in parts]
    design = np.stack(columns, axis=2)
    solver = np.linalg.pinv(design)
    fitted = (solver @ seen[..., None])[:, -len(parts) :, 0]
    spread = np.linalg.norm(solver[:, -len(parts) :], axis=2) * noise[:, None]
    return fitted.reshape(n, -1), np.maximum(spread, 1e-3)


def _line(moved, spread, along_px, kept) -> tuple[NDArray, float, float]:
    """Fit one shift per edge and a slope to shifts (N, E); also return the first shift's sigma."""
    n, sides = moved.shape
    extent = max(np.abs(along_px).max(), 1.0)
    design = np.zeros((n, sides, sides + 1))
    design[:, np.arange(sides), np.arange(sides)] = 1
    design[:, :, -1] = (along_px / extent)[:, None]
    flat, target = design.reshape(n * sides, -1), moved.ravel()
    scale = np.maximum(spread.ravel(), 0.05)
    weight = np.repeat(kept, sides) / scale**2
    for _ in range(6):
        # A stretch is known to run as expected within 1 px.
        normal = flat.T @ (weight[:, None] * flat) + np.diag([1e-6] * sides + [1.0])
        found = np.linalg.solve(normal, flat.T @ (weight * target))
        off = np.abs(target - flat @ found) / scale
        scatter = max(np.median(off[np.repeat(kept, sides)]) * 1.48, 0.3)
        robust = np.minimum(1, HUBER * scatter / np.maximum(off, 1e-9))
        weight = np.repeat(kept, sides) / scale**2 * robust
    sigma = max(scatter, 1.0) * np.sqrt(np.linalg.inv(normal)[0, 0])
    return found[:-1], float(found[-1] / extent), float(sigma)
