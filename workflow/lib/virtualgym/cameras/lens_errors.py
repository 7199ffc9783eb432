"""What a lens does beyond the numbers that the calibration estimates: k3, and a bent prism."""

import numpy as np
from numpy.typing import NDArray

# ASSUME: terms of a phone's lens; no source is recorded. With random signs they leave 0.12 to
# 0.17 px root mean square at 1280 px width, 0.6 to 1.1 px in one corner, when all numbers that the
# calibration estimates (focal lengths, centre, k1 k2 p1 p2, a rotation) are fitted to them.
K3 = 0.15
PRISM = 0.006  # s2 and s4, which grow with the fourth power of the radius; s1, s3 act as a rotation


def added(dist: NDArray, strength: float, rng: np.random.Generator) -> NDArray:
    """Return a lens (5,) with further terms, (9,); as it is where the strength is 0."""
    if not strength:
        return dist
    signs = rng.choice([-1.0, 1.0], 3)
    k3, s2, s4 = strength * signs * [K3, PRISM, PRISM]
    return np.array([*dist[:4], dist[4] + k3, 0.0, s2, 0.0, s4])
