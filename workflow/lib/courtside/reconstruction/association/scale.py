"""Check the scale of a calibration from the size of the people whom the cameras see.

In a calibration in feet, or without a scale, only lengths are wrong: all views still agree.
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from courtside.geometry.camera import Camera, project
from courtside.geometry.camera_fields import METRES
from courtside.geometry.triangulation import triangulate_all
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
from courtside.study.methods import ALONE, Calibration

# ASSUME: lengths of trunks of people from children on, and the one that a unit is guessed by; a
# median over many views is nearer to the true one than the limits are.
TRUNK_M = (0.25, 0.9)
USUAL_M = 0.5
MOST_INSTANTS = 60
AGREE = 0.05  # ASSUME: views of one person meet within this share of the trunk in the picture
# What defines the scale, by the kind of a calibration; of others the court does.
LENGTHS = {
    "board": "`square_m` of the board",
    "dlt": "the places of the points in the court's file",
    "known": "the places of the points (x_m, y_m and z_m, or those of the court's file)",
    "wand": "`length_m` of the wand",
    ALONE: "`height_m` of the subjects, or `known_lengths`",
}
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
        views = [cameras[one], cameras[other]]
        # Each row of one camera with each of the other, (2, P, Q, n, 2, 2).
        first, second = _ends(xy[one][:, at], ends), _ends(xy[other][:, at], ends)
        pair = np.stack(np.broadcast_arrays(first[:, None], second[None]))
        xyz = triangulate_all(views, pair)
        seen = np.stack([project(camera, xyz) for camera in views])
        off_px = np.linalg.norm(seen - pair, axis=-1).max(axis=-1)
        size_px = np.linalg.norm(pair[..., 0, :] - pair[..., 1, :], axis=-1)
        good = (off_px <= AGREE * size_px).all(axis=0)
        found.append(np.linalg.norm(xyz[good][:, 0] - xyz[good][:, 1], axis=-1))
    return np.concatenate(found) if found else np.empty(0)


def _ends(joints: NDArray, ends: Sequence[int]) -> NDArray:
    """Return the middles of shoulders and of hips, (P, n, 2, 2) px; `ends` as `skeleton.TRUNK`."""
    return joints[:, :, list(ends)].reshape(*joints.shape[:2], 2, 2, 2).mean(axis=3)


def check(
    cameras: Sequence[Camera],
    xy: Sequence[NDArray],
    names: Sequence[str],
    calibration: str | None,
    unit: str | None = None,
) -> None:
    """Raise `InputError` if the people of a take are too small or too large; as for `trunks`.

    `calibration` is the name of that by which the cameras were found, if it is to be mended, and
    `unit` the one that the session states for its file.
    """
    found = trunks(cameras, xy, names)
    middle = float(np.median(found)) if len(found) >= LEAST_FOUND else USUAL_M
    if TRUNK_M[0] <= middle <= TRUNK_M[1]:
        return
    raise InputError(
        f"cameras {', '.join(camera.name for camera in cameras)}: expected people with trunks of "
        f"{TRUNK_M[0]:g} to {TRUNK_M[1]:g} m, found {middle:.3g} m, the median of {len(found)} "
        f"pairs of views; the scale of the calibration is wrong: {_mend(middle, calibration, unit)}"
    )


def apart(cameras: Sequence[Camera], calibration: str | None, unit: str | None = None) -> str:
    """Return how far apart cameras stand, and what to check where that is wrong."""
    centres = np.array([camera.centre_in_world for camera in cameras])
    apart_m = np.linalg.norm(centres[:, None] - centres, axis=-1).max()
    stated = "their unit" if unit is None else f"`unit: {unit}` under calibration"
    lengths = _lengths(calibration) or stated
    return f"the cameras stand up to {apart_m:.1f} m apart: if that is wrong, correct {lengths}"


def _mend(trunk: float, calibration: str | None, stated: str | None) -> str:
    """Return what to do about trunks of such a length, read in the unit `stated`, or in m."""
    lengths = _lengths(calibration)
    in_file = trunk if lengths or stated is None else trunk / METRES[stated]
    fits = {unit: in_file * metres for unit, metres in METRES.items()}
    unit, size_m = min(fits.items(), key=lambda pair: abs(np.log(pair[1] / USUAL_M)))
    in_unit = TRUNK_M[0] <= size_m <= TRUNK_M[1]
    if lengths:
        times = trunk / USUAL_M
        size = f"{times:.2g} times too large" if times > 1 else f"{1 / times:.2g} times too small"
        return f"correct {lengths}, about {size}{f', as if in {unit}' * in_unit}"
    if in_unit and calibration is not None:
        instead = "" if stated is None else f" instead of `unit: {stated}`"
        return (
            f"its lengths are likely in {unit} ({size_m:.2f} m): write `unit: {unit}`{instead} "
            "under calibration in the session file"
        )
    return "calibrate again with a known length"


def _lengths(calibration: str | None) -> str:
    """Return the lengths that a calibration takes its scale from; empty for those of a file."""
    way = None if calibration is None else Calibration.parse(calibration)
    way = Calibration.parse(way.base) if way and way.base else way
    return "" if way is None or way.kind == "file" else LENGTHS.get(way.kind, LENGTHS["dlt"])
