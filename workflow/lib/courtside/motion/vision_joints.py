"""The joints that vision and a skeleton share, and how well vision knows them."""

from dataclasses import dataclass

import numpy as np

from courtside.records import limbs
from courtside.study.errors import InputError

LEAST_FRAMES = 30
LEAST_JOINTS = 6


@dataclass(frozen=True, eq=False)
class Seen:
    """What vision tells of the joints that it shares with a skeleton.

    Attributes
    ----------
    source : str
    joints : tuple of str, length D
    time_s : (N,) float
    xyz : (N, D, 3) float
        Metres, in vision's frame; NaN where missing.
    sigma_m : (N, D) float
    """

    source: str
    joints: tuple
    time_s: np.ndarray
    xyz: np.ndarray
    sigma_m: np.ndarray


def observe(posed, vision, sigma_m):
    """Pick what vision tells of a skeleton's limbs while it moves.

    Parameters
    ----------
    posed : PosedHierarchy
    vision : DeviceMotion
        On the same clock.
    sigma_m : float or (T, J) float
        Standard deviation per axis; joints where it is not a positive number are not used.

    Returns
    -------
    seen : Seen

    Raises
    ------
    InputError
        If vision has no place in space, or too little in common with the skeleton.
    """
    if vision.kind == "rgb":
        raise InputError(
            f"{vision.source}: expected joints with a place in space, found a skeleton about its own "
            "hips (kind rgb); correct by a depth camera or by several cameras"
        )
    names = list(posed.hierarchy.joints)
    joints = [name for name in limbs.JOINTS if name in names and name in vision.joints]
    columns = [list(vision.joints).index(name) for name in joints]
    inside = (vision.time_s >= posed.time_s[0]) & (vision.time_s <= posed.time_s[-1])
    inside &= vision.performed
    sigma = np.broadcast_to(np.asarray(sigma_m, float), vision.xyz.shape[:2])[inside][:, columns]
    xyz = vision.xyz[inside][:, columns]
    usable = np.isfinite(xyz).all(axis=2) & np.isfinite(sigma) & (sigma > 0)
    frames = (usable.sum(axis=1) >= LEAST_JOINTS).sum()
    if frames < LEAST_FRAMES:
        raise InputError(
            f"{vision.source}: expected {LEAST_FRAMES} frames with {LEAST_JOINTS} limb joints during "
            f"the inertial recording, found {frames}; check the clocks and what the camera saw"
        )
    xyz, sigma = np.where(usable[..., None], xyz, np.nan), np.where(usable, sigma, 1.0)
    return Seen(vision.source, tuple(joints), vision.time_s[inside], xyz, sigma)
