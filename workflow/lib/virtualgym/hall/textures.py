"""Procedural textures of a sports hall: floor, walls, posters, crates, cloth."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from virtualgym.hall.look import USUAL, Look

# ASSUME: sizes and colours chosen to look like a sports hall; they change pictures only.
FLOOR_BGR = (98, 146, 188)
PLANK_M = 0.075
PLANK_LENGTH_M = (0.9, 2.4)
WALL_BGR = (196, 206, 210)
PANEL_BGR = (112, 150, 176)
PANEL_TOP_M = 2.6
PANEL_WIDTH_M = 1.25
WINDOW_M = (2.4, 2.2)  # width and height
WINDOW_SPACING_M = 4.6
WINDOW_SILL_M = 5.4
LETTERS = list("ABCDEFGHKLMNPRSTUVXYZ0123456789")
FONTS = (cv2.FONT_HERSHEY_SIMPLEX, cv2.FONT_HERSHEY_DUPLEX, cv2.FONT_HERSHEY_TRIPLEX)
DECAY = 0.6  # of amplitudes of noise, from one scale to the next


def multiscale_noise(
    shape: tuple[int, int], cells: Sequence[int], rng: np.random.Generator
) -> NDArray:
    """Return smooth noise of several scales, (h, w) float32, mean about 0, std about 0.5.

    Parameters
    ----------
    shape : (int, int)
        Height and width.
    cells : sequence of int
        Number of noise cells along the longer side, for each scale.
    """
    total = np.zeros(shape, np.float32)
    weights = DECAY ** np.arange(len(cells))
    for count, weight in zip(cells, weights / weights.sum(), strict=True):
        size = [max(2, round(count * length / max(shape))) for length in shape]
        coarse = rng.standard_normal(size, dtype=np.float32)
        total += weight * cv2.resize(coarse, shape[::-1], interpolation=cv2.INTER_CUBIC)
    return total


def scale_contrast(texture: NDArray, contrast: float) -> NDArray:
    """Return a texture with its contrast about its own mean colour multiplied."""
    mean = np.array(cv2.sumElems(texture)[:3]) / texture[..., 0].size
    levels = np.arange(256, dtype=np.float32)[:, np.newaxis]
    return cv2.LUT(texture, to_bytes(mean + (levels - mean) * contrast)[np.newaxis])


def to_bytes(values: NDArray) -> NDArray:
    """Return values rounded and limited to 0..255, uint8."""
    values = np.rint(values)
    return np.clip(values, 0, 255, out=values).astype(np.uint8)


def paint(
    image: NDArray, corners: NDArray | Sequence[float], colour: ArrayLike, *, cover: float = 1.0
) -> None:
    """Fill a rectangle in place; pixels on its edges are mixed by the covered area.

    Parameters
    ----------
    image : (h, w, 3) uint8
    corners : (x0, y0, x1, y1) of float
        Px; the first pixel reaches from 0 to 1.
    colour : (3,) float
        BGR.
    cover : float
        Opacity.
    """
    low, high = np.minimum(corners[:2], corners[2:]), np.maximum(corners[:2], corners[2:])
    start = np.maximum(np.floor(low).astype(int), 0)
    stop = np.minimum(np.ceil(high).astype(int), image.shape[1::-1])
    if (stop <= start).any():
        return
    across, down = (
        np.minimum(np.arange(a, b) + 1, hi) - np.maximum(np.arange(a, b), lo)
        for a, b, lo, hi in zip(start, stop, low, high, strict=True)
    )
    share = cover * (down[:, None] * across)[..., None]
    part = image[start[1] : stop[1], start[0] : stop[0]]
    part[:] = to_bytes(part * (1 - share) + np.asarray(colour, dtype=float) * share)


def planks(
    size_m: Iterable[float],
    texel_m: float,
    contrast: float,
    n_scuffs: int,
    rng: np.random.Generator,
    look: Look = USUAL,
) -> NDArray:
    """Return a wooden floor, (h, w, 3) uint8.

    Parameters
    ----------
    size_m : (float, float)
        Width (across the planks) and height (along them).
    n_scuffs : int
        Number of dark scuff marks.
    """
    width, height = (round(length / texel_m) for length in size_m)
    base = FLOOR_BGR + np.array(look.floor)
    plank = (np.arange(width) * texel_m / (PLANK_M * look.plank)).astype(np.intp)
    tone = _plank_tones(plank[-1] + 1, height, texel_m, rng).T.take(plank, axis=1)
    gap = np.flatnonzero(np.diff(plank)) + 1
    tone[:, gap] -= 9
    grain = rng.standard_normal((height // 6 + 2, width), dtype=np.float32) * 7
    _add(tone, grain)
    stains = multiscale_noise((height // 8 + 1, width // 8 + 1), (5, 11, 23, 47, 95, 190), rng) * 22
    _add(tone, stains)
    step = np.arange(-128, 128)[:, None] * contrast * np.array([0.8, 0.95, 1.0])
    palette = to_bytes(base + step)
    level = np.bitwise_xor(tone.view(np.uint8), 0x80)  # from 0 for the darkest
    texture = cv2.LUT(cv2.merge([level] * 3), palette[np.newaxis])
    for _ in range(n_scuffs):
        start = rng.uniform(0, (width, height))
        end = start + rng.normal(0, 0.15 / texel_m, 2)
        shade = base * (1 - contrast * rng.uniform(0.3, 0.7))
        first, last = (tuple(map(int, point)) for point in (start, end))
        thickness = int(rng.integers(1, 4))
        cv2.line(texture, first, last, shade.tolist(), thickness, cv2.LINE_AA)
    return texture


def _add(tone: NDArray, coarse: NDArray) -> None:
    """Add enlarged coarse noise to tones (h, w) in place; int8, as a floor is large."""
    shifted = to_bytes(coarse + 128)
    fine = cv2.resize(shifted, tone.shape[::-1], interpolation=cv2.INTER_LINEAR)
    fine ^= 0x80
    tone += fine.view(np.int8)


def _plank_tones(n_planks: int, height: int, texel_m: float, rng: np.random.Generator) -> NDArray:
    """Return the tone along each plank, (n_planks, height) int8: boards of random length."""
    tones = np.empty((n_planks, height), np.int8)
    for row in tones:
        start = -rng.uniform(0, PLANK_LENGTH_M[0]) / texel_m
        while start < height:
            stop = start + rng.uniform(*PLANK_LENGTH_M) / texel_m
            row[max(0, int(start)) : int(stop)] = np.clip(rng.normal(0, 8), -24, 24)
            if start >= 0:
                row[int(start)] -= 14
            start = stop
    return tones


def wall(
    size_m: tuple[float, float],
    texel_m: float,
    contrast: float,
    same_windows: bool,
    rng: np.random.Generator,
    look: Look = USUAL,
) -> NDArray:
    """Return a wall (h, w, 3) uint8: wooden panels below, paint above, a row of windows.

    Parameters
    ----------
    size_m : (float, float)
        Width and height.
    same_windows : bool
        Whether all windows look alike and all gaps are equal.
    """
    width, height = (round(length / texel_m) for length in size_m)
    texture = (
        WALL_BGR
        + np.array(look.wall)
        + (multiscale_noise((height, width), (6, 17, 41, 97), rng) * 26)[..., None]
    )
    panel_px = round(PANEL_TOP_M / texel_m)
    panel_width_px = PANEL_WIDTH_M * look.panels / texel_m
    texture[-panel_px:] = _panels((panel_px, width), panel_width_px, rng) + look.panel
    course = max(3, round(0.5 / texel_m))
    texture[: height - panel_px : course] -= 14
    texture = scale_contrast(to_bytes(texture), contrast)
    first = window((WINDOW_M[0], WINDOW_M[1]), texel_m, rng)
    spacing_m = max(WINDOW_SPACING_M * look.windows, 1.05 * WINDOW_M[0])
    x_m = WINDOW_SPACING_M / 2
    while x_m + WINDOW_M[0] < size_m[0]:
        pane = first if same_windows else window(WINDOW_M, texel_m, rng)
        top = height - round((WINDOW_SILL_M + WINDOW_M[1]) / texel_m)
        left = round(x_m / texel_m)
        if top > 0:
            texture[top : top + pane.shape[0], left : left + pane.shape[1]] = scale_contrast(
                pane, contrast
            )
        x_m += spacing_m * (1 if same_windows else rng.uniform(0.75, 1.25))
    return texture


def _panels(shape: tuple[int, int], width_px: float, rng: np.random.Generator) -> NDArray:
    """Return upright wooden panels with seams, (h, w, 3) float."""
    number = (np.arange(shape[1]) / width_px).astype(np.intp)
    tone = rng.normal(0, 9, number[-1] + 1)[number]
    tone = tone + cv2.resize(
        rng.standard_normal((2 + shape[0] // 30, shape[1])), shape[::-1],
        interpolation=cv2.INTER_LINEAR
    ) * 8  # fmt: skip
    tone += multiscale_noise(shape, (20, 60), rng) * 14
    seams = np.flatnonzero(np.diff(number))
    tone[:, seams] -= 45
    tone[: max(1, shape[0] // 40)] -= 30
    return np.array(PANEL_BGR) + tone[..., None]


def window(size_m: tuple[float, float], texel_m: float, rng: np.random.Generator) -> NDArray:
    """Return a window of several panes with a bright, cloudy outside, (h, w, 3) uint8."""
    width, height = (round(length / texel_m) for length in size_m)
    sky = multiscale_noise((height, width), (2, 5, 11), rng) * 30
    texture = np.array([236, 226, 214]) + sky[..., None] * np.array([0.4, 0.8, 1.0])
    trees = height * (0.75 + 0.5 * multiscale_noise((1, width), (3, 9), rng)[0])
    texture[np.arange(height)[:, None] > trees] = (88, 118, 96)
    bar = max(1, round(0.06 / texel_m))
    for share in (0.0, 1 / 3, 2 / 3, 1.0):
        x = round(share * (width - bar))
        texture[:, x : x + bar] = (70, 72, 76)
    for share in (0.0, 0.5, 1.0):
        y = round(share * (height - bar))
        texture[y : y + bar] = (70, 72, 76)
    return to_bytes(texture)


def poster(shape: tuple[int, int], rng: np.random.Generator) -> NDArray:
    """Return shapes and letters on a coloured ground, (h, w, 3) uint8."""
    height, width = shape
    image = np.empty((height, width, 3), np.uint8)
    image[:] = rng.integers(70, 240, 3)
    for _ in range(rng.integers(5, 12)):
        colour = rng.integers(10, 250, 3).tolist()
        x, y = rng.uniform(0, (width, height))
        size = min(shape) * rng.uniform(0.08, 0.35)
        corners = np.array([x, y]) + rng.uniform(-size, size, (int(rng.integers(3, 6)), 2))
        hull = cv2.convexHull(corners.astype(np.int32))
        cv2.fillPoly(image, [hull], colour, cv2.LINE_AA)
    for _ in range(rng.integers(1, 4)):
        text = "".join(rng.choice(LETTERS, rng.integers(3, 9)))
        place = int(rng.uniform(0, width / 4)), int(rng.uniform(0.25, 0.95) * height)
        scale = max(0.3, height / 90 * rng.uniform(0.6, 1.2))
        font = FONTS[rng.integers(len(FONTS))]
        thick = max(1, height // 50)
        cv2.putText(
            image, text, place, font, scale, rng.integers(0, 255, 3).tolist(), thick, cv2.LINE_AA
        )
    return image


def crate(shape: tuple[int, int], rng: np.random.Generator) -> NDArray:
    """Return the side of a box, bag or mat: colour, stains, straps, at times a label."""
    height, width = shape
    colour = rng.uniform(50, 215) + rng.uniform(-45, 45, 3)
    image = colour + (multiscale_noise(shape, (4, 9, 21), rng) * 30)[..., None]
    for _ in range(rng.integers(0, 4)):
        strap = max(1, round(height * rng.uniform(0.03, 0.1)))
        y = int(rng.uniform(0, height - strap + 1))
        image[y : y + strap] = rng.integers(20, 235, 3)
    image = to_bytes(image)
    if rng.uniform() < 0.6 and min(shape) >= 12:
        label = poster((max(6, height // 2), max(6, width // 2)), rng)
        y, x = (
            int(rng.uniform(0, free)) for free in (height - label.shape[0], width - label.shape[1])
        )
        image[y : y + label.shape[0], x : x + label.shape[1]] = label
    cv2.rectangle(image, (0, 0), (width - 1, height - 1), (35, 35, 35), 1)
    return image


def cloth(
    shape: tuple[int, int], colour: ArrayLike, rng: np.random.Generator, *, folds: int = 14
) -> NDArray:
    """Return a cloth of one BGR colour with about so many vertical folds, (h, w, 3) uint8."""
    tone = (
        multiscale_noise((1, shape[1]), (folds, 3 * folds), rng) * 45
        + multiscale_noise(shape, (5, 15), rng) * 10
    )
    return to_bytes(np.array(colour) + tone[..., None])
