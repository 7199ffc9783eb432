"""Size, colours and patterns in which one hall differs from another."""

from dataclasses import dataclass

import numpy as np

# ASSUME: how much halls differ; no source is recorded. Cameras stand in the hall whatever its size.
LARGER = 0.25  # greatest addition to half the width and depth, as a share
HEIGHT = 0.25  # greatest change of the height, as a share
TINT = 35.0  # greatest change of a colour, 8-bit levels
PATTERN = 0.4  # greatest change of the size of planks, panels and window gaps, natural logarithm


@dataclass(frozen=True)
class Look:
    """What a hall looks like; the default is the development halls'.

    Attributes
    ----------
    room : (float, float, float)
        Factors on half the width, half the depth, and the height.
    floor, wall, panel : (float, float, float)
        Added to the colours, BGR.
    plank, panels, windows : float
        Factors on the width of planks and panels, and on the distance of windows.
    """

    room: tuple[float, ...] = (1.0, 1.0, 1.0)
    floor: tuple[float, ...] = (0.0, 0.0, 0.0)
    wall: tuple[float, ...] = (0.0, 0.0, 0.0)
    panel: tuple[float, ...] = (0.0, 0.0, 0.0)
    plank: float = 1.0
    panels: float = 1.0
    windows: float = 1.0


USUAL = Look()


def draw(strength: float, rng: np.random.Generator) -> Look:
    """Draw the look of a hall, which differs from the usual one the more the stronger."""
    if not strength:
        return USUAL
    wide, deep = 1 + strength * LARGER * rng.uniform(0, 1, 2)
    tall = 1 + strength * HEIGHT * rng.uniform(-1, 1)
    tints = strength * TINT * rng.uniform(-1, 1, (3, 3))
    floor, wall, panel = (tuple(map(float, tint)) for tint in tints)
    plank, panels, windows = np.exp(strength * PATTERN * rng.uniform(-1, 1, 3)).tolist()
    room = (float(wide), float(deep), float(tall))
    return Look(room, floor, wall, panel, plank, panels, windows)
