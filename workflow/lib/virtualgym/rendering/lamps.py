"""Light that changes from row to row and frame to frame: lamps on mains, automatic exposure."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LAMP_HZ = 120.0  # twice the mains of western Japan
# ASSUME: of lamps and phones; no source is recorded.
DEPTH = 0.3  # share of the light that comes and goes with the mains
STOPS = 0.15  # standard deviation of the exposure, in powers of two
PERIODS_S = 6.1, 2.3  # of its changes, as bright and dark things come into the picture
READOUT_FACTOR = 2.0  # a camera reads its rows up to so many times faster or slower


@dataclass(frozen=True, eq=False)
class Light:
    """What one camera makes of the lamps.

    Attributes
    ----------
    strength : float
    phases : (3,) float
        Of the lamps and of two waves of the exposure, radians.
    """

    strength: float
    phases: np.ndarray

    def rows(self, time_s: float, height: int, readout_s: float, exposure_s: float) -> NDArray:
        """Return the factor on the light of each row of a picture, (height,) float32.

        The middle row is exposed at `time_s`, for `exposure_s`, of which lamps show their mean.
        """
        own_s = time_s + ((np.arange(height) + 0.5) / height - 0.5) * readout_s
        depth = self.strength * DEPTH * np.sinc(LAMP_HZ * exposure_s)
        lamps = 1 + depth * np.cos(2 * np.pi * LAMP_HZ * own_s + self.phases[0])
        waves = np.sin(2 * np.pi * time_s / np.array(PERIODS_S) + self.phases[1:])
        return (lamps * 2 ** (self.strength * STOPS * waves.sum())).astype(np.float32)


def light(strength: float, rng: np.random.Generator) -> Light | None:
    """Return the light of one camera; None where the strength is 0."""
    return Light(strength, rng.uniform(0, 2 * np.pi, 3)) if strength else None


def lit(picture: NDArray, rows: NDArray) -> NDArray:
    """Return a picture (H, W, 3) uint8 in the light of its rows (H,)."""
    return np.clip(np.rint(picture * rows[:, None, None]), 0, 255).astype(np.uint8)


def readout(readout_s: float, strength: float, rng: np.random.Generator) -> float:
    """Return the readout time of one camera: at strength 1 between half and twice the usual."""
    if not strength:
        return readout_s
    return float(readout_s * READOUT_FACTOR ** (strength * rng.uniform(-1, 1)))
