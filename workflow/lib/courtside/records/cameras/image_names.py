"""What the images of a session are called in COLMAP's databases and models: paths from the image root."""

import numpy as np


def static(camera):
    """Return the name of a fixed camera's static picture."""
    return f"static/{camera}.png"


def frame(walk, name):
    """Return the name of a frame of a walk."""
    return f"frames/{walk}/{name}"


def are_static(names):
    """Return which of the names (V,) are of static pictures, (V,) bool."""
    return np.char.startswith(np.asarray(names, dtype=str), "static/")
