"""Pictures for pages: no wider than a page shows them, with a palette where that is smaller."""

import io

import numpy as np
from PIL import Image

MAX_WIDTH_PX = 1200
N_COLOURS = 256
MAX_DIFFERENCE = 1.5  # a palette that changes more shows in photographs


def shrunk(png, max_width_px=MAX_WIDTH_PX):
    """Return a PNG no wider than a page needs, in as few bytes as a palette gives.

    Parameters
    ----------
    png : bytes
        A picture; transparent parts become white.
    max_width_px : int
        Wider ones are scaled down.

    Returns
    -------
    png : bytes
        As it was, where it is narrow enough and nothing makes it smaller.
    size_px : (int, int)
        Width and height.
    """
    picture = _opaque(Image.open(io.BytesIO(png)))
    scaled = picture.width > max_width_px
    if scaled:
        height = max(1, round(picture.height * max_width_px / picture.width))
        picture = picture.resize((max_width_px, height), Image.Resampling.LANCZOS)
    # Without dithering: it would put dots into the flat areas of drawings.
    flat = picture.quantize(N_COLOURS, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    made = [_bytes(picture)] if scaled else [png]
    made += [_bytes(flat)] if _differ(picture, flat) <= MAX_DIFFERENCE else []
    return min(made, key=len), picture.size


def _differ(picture, flat):
    """Return the root mean square difference of two pictures, in levels of 255."""
    off = np.asarray(picture, float) - np.asarray(flat.convert("RGB"), float)
    return float(np.sqrt(np.mean(off**2)))


def _opaque(picture):
    if picture.mode in ("RGBA", "LA", "P"):
        picture = picture.convert("RGBA")
        white = Image.new("RGBA", picture.size, "white")
        picture = Image.alpha_composite(white, picture)
    return picture.convert("RGB")


def _bytes(picture):
    held = io.BytesIO()
    picture.save(held, "PNG", optimize=True)
    return held.getvalue()
