"""Effects of lens and sensor: motion blur, optical blur, vignette, noise, quantisation."""

import cv2
import numpy as np
from numpy.typing import NDArray

VIGNETTE = 0.25  # ASSUME: loss of light in the corners, of a phone's camera
OPTICS_PX = 0.5  # ASSUME: standard deviation of the lens's blur, of a phone's camera
SHARP_PX = 0.25  # shorter motion leaves no visible blur


def develop(
    picture: NDArray,
    xy: NDArray,
    *,
    motion_px: tuple[float, float] = (0.0, 0.0),
    noise: float = 0.0,
    rng: np.random.Generator | None = None,
) -> NDArray:
    """Turn light into a camera's picture.

    Parameters
    ----------
    picture : (H, W, 3) float32
        0..255, changed in place.
    xy : (2, H, W) float32
        Point of the z = 1 plane that each pixel sees.
    motion_px : (2,) float
        Movement of the picture during the exposure, px to the right and down.
    noise : float
        Standard deviation, 8-bit levels.
    rng : numpy.random.Generator or None
        Needed for noise.

    Returns
    -------
    picture : (H, W, 3) uint8
    """
    if np.hypot(*motion_px) > SHARP_PX:
        picture = cv2.filter2D(picture, -1, line_kernel(motion_px), borderType=cv2.BORDER_REPLICATE)
    picture = cv2.GaussianBlur(picture, (5, 5), OPTICS_PX, borderType=cv2.BORDER_REPLICATE)
    square = xy[0] ** 2 + xy[1] ** 2
    square *= -VIGNETTE / square.max()
    square += 1
    for channel in range(3):  # in a third of the time of all at once
        picture[..., channel] *= square
    if noise > 0:
        if rng is None:
            raise ValueError("expected a random generator for the noise, found none")
        grain = rng.standard_normal(picture.shape, dtype=np.float32)
        grain *= np.float32(noise)
        picture += grain
    picture += 0.5
    return np.clip(picture, 0, 255, out=picture).astype(np.uint8)


def line_kernel(motion_px: tuple[float, float]) -> NDArray:
    """Return the blur kernel (k, k) float32 of a straight, even motion (2,), px right and down."""
    half = int(np.ceil(np.abs(motion_px).max() / 2))
    n_points = int(16 * np.hypot(*motion_px)) + 2
    share = (np.arange(n_points) + 0.5) / n_points - 0.5
    x, y = (share * step + half for step in motion_px)
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    kernel = np.zeros((2 * half + 2, 2 * half + 2))
    for down in (0, 1):
        for right in (0, 1):
            weight = np.abs(1 - right - x + left) * np.abs(1 - down - y + top)
            np.add.at(kernel, (top + down, left + right), weight)
    return (kernel[:-1, :-1] / n_points).astype(np.float32)
