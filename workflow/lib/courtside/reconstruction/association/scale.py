"""Check the scale of a calibration from the size of the people whom the cameras see.

In a calibration in feet, or without a scale, only lengths are wrong: all views still agree.
"""

from collections.abc import Sequence
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from courtside.geometry.camera import Camera, project
from courtside.geometry.camera_fields import METRES
from courtside.geometry.triangulation import triangulate_all
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

# ASSUME: lengths of trunks of people from children on, and the one that a unit is guessed by; a
# median over many views is nearer to the true one than the limits are.
TRUNK_M = (0.25, 0.9)
USUAL_M = 0.5
MOST_INSTANTS = 60
AGREE = 0.05  # ASSUME: views of one person meet within this share of the trunk in the picture
LEAST_FOUND = 10  # ASSUME: pairs of views; fewer say nothing


def trunks(cameras: Sequence[Camera], xy: Sequence[NDArray], names: Sequence[str]) -> NDArray:
    """Return lengths (n,) of trunks that pairs of views agree on, in the cameras' unit.

    `xy` has the tracklets (P, T, J, 2) of each camera at common times, distorted px, NaN where
    missing; `names` are those of the joints.
    """
    ends = [names.index(name) for name in skeleton.TRUNK]
    at = np.unique(np.linspace(0, xy[0].shape[1] - 1, MOST_INSTANTS).astype(int))
    found: list[NDArray] = []
    for one, other in combinations(range(len(cameras)), 2):
        for first, second in product(xy[one], xy[other]):
            pair = np.stack([_ends(first[at], ends), _ends(second[at], ends)])
            views = [cameras[one], cameras[other]]
            xyz = triangulate_all(views, pair.reshape(2, -1, 2)).reshape(-1, 2, 3)
            seen = np.stack([project(camera, xyz) for camera in views])
            off_px = np.linalg.norm(seen - pair, axis=-1).max(axis=2)
            size_px = np.linalg.norm(pair[:, :, 0] - pair[:, :, 1], axis=-1)
            good = (off_px <= AGREE * size_px).all(axis=0)
            found.append(np.linalg.norm(xyz[good, 0] - xyz[good, 1], axis=-1))
    return np.concatenate(found) if found else np.empty(0)


def _ends(joints: NDArray, ends: Sequence[int]) -> NDArray:
    """Return the middles of shoulders and of hips, (T, 2, 2) px; `ends` are of `skeleton.TRUNK`."""
    return joints[:, list(ends)].reshape(len(joints), 2, 2, 2).mean(axis=2)


def check(cameras: Sequence[Camera], xy: Sequence[NDArray], names: Sequence[str]) -> None:
    """Raise `InputError` if the people of a take are too small or too large; as for `trunks`."""
    found = trunks(cameras, xy, names)
    middle = float(np.median(found)) if len(found) >= LEAST_FOUND else USUAL_M
    if TRUNK_M[0] <= middle <= TRUNK_M[1]:
        return
    fits = {unit: middle * metres for unit, metres in METRES.items()}
    unit, size_m = min(fits.items(), key=lambda pair: abs(np.log(pair[1] / USUAL_M)))
    mend = "calibrate again with a known length"
    if TRUNK_M[0] <= size_m <= TRUNK_M[1]:
        mend = (
            f"its lengths are likely in {unit} ({size_m:.2f} m): write `unit: {unit}` under "
            "calibration in the session file"
        )
    raise InputError(
        f"cameras {', '.join(camera.name for camera in cameras)}: expected people with trunks of "
        f"{TRUNK_M[0]:g} to {TRUNK_M[1]:g} m, found {middle:.3g} m, the median of {len(found)} "
        f"pairs of views; the scale of the calibration is wrong: {mend}"
    )
