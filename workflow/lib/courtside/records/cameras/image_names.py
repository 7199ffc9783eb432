"""Names of a session's images in COLMAP's databases and models: paths from the image root."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def static(camera: str) -> str:
    """Return the name of a fixed camera's static picture."""
    return f"static/{camera}.png"


def frame(walk: str, name: str) -> str:
    """Return the name of a walk's frame."""
    return f"frames/{walk}/{name}"


def are_static(names: Sequence[str] | NDArray) -> NDArray:
    """Return for names (V,) whether each is of a static picture, (V,) bool."""
    return np.char.startswith(np.asarray(names, dtype=str), "static/")
