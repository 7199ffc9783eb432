"""Textured pictures, and pictures moved by a known similarity."""

import cv2
import numpy as np


def moved(image, shift_px, zoom=1.0, rotation_deg=0.0):
    """Move a picture's content by a similarity about its centre."""
    height, width = image.shape[:2]
    centre = (np.array([width, height]) - 1) / 2
    c, s = np.cos(np.radians(rotation_deg)), np.sin(np.radians(rotation_deg))
    linear = zoom * np.array([[c, -s], [s, c]])
    matrix = np.column_stack([linear, centre + shift_px - linear @ centre])
    options = {"flags": cv2.INTER_CUBIC, "borderMode": cv2.BORDER_REFLECT}
    return cv2.warpAffine(image, matrix, (width, height), **options)


def texture(seed, size=(640, 360)):
    noise = np.random.default_rng(seed).normal(0, 1, (size[1], size[0])).astype(np.float32)
    smooth = cv2.GaussianBlur(noise, (0, 0), 3)
    image = 120 + 40 * smooth / smooth.std()
    return np.dstack([np.clip(image, 0, 255).astype(np.uint8)] * 3)
