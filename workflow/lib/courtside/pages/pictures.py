"""Pictures for pages: no wider than a page shows them, with a colour palette if that is smaller."""

import io

import numpy as np
from PIL import Image

MAX_WIDTH_PX = 1200  # ASSUME: as wide as the text column of a page
N_COLOURS = 256  # the most that a PNG palette holds
# ASSUME: root mean square, of 255; a palette that changes more is visible in photographs.
MAX_DIFFERENCE = 1.5


def shrunk(png: bytes, max_width_px: int = MAX_WIDTH_PX) -> tuple[bytes, tuple[int, int]]:
    """Return a PNG no wider than a page needs, in few bytes, and its width and height.

    Transparent parts become white. The PNG is unchanged if it is narrow enough and a palette does
    not make it smaller.
    """
    picture = _opaque(Image.open(io.BytesIO(png)))
    scaled = picture.width > max_width_px
    if scaled:
        height = max(1, round(picture.height * max_width_px / picture.width))
        picture = picture.resize((max_width_px, height), Image.Resampling.LANCZOS)
    # Without dithering: it would put dots into the flat areas of drawings.
    flat = picture.quantize(N_COLOURS, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    made = [_bytes(picture)] if scaled else [png]
    off = np.asarray(picture, float) - np.asarray(flat.convert("RGB"), float)
    made += [_bytes(flat)] if np.sqrt(np.mean(off**2)) <= MAX_DIFFERENCE else []
    return min(made, key=len), picture.size


def _opaque(picture: Image.Image) -> Image.Image:
    if picture.mode in ("RGBA", "LA", "P"):
        picture = picture.convert("RGBA")
        white = Image.new("RGBA", picture.size, "white")
        picture = Image.alpha_composite(white, picture)
    return picture.convert("RGB")


def _bytes(picture: Image.Image) -> bytes:
    held = io.BytesIO()
    picture.save(held, "PNG", optimize=True)
    return held.getvalue()
