"""The joints that vision and a skeleton share, and how well vision knows them."""

from dataclasses import dataclass

import numpy as np

from courtside.motion import body_segments
from courtside.records import reasons
from courtside.records.device_motion import DeviceMotion
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
    joints = [name for name in body_segments.LIMB_JOINTS if name in names and name in vision.joints]
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


def of_cameras(points, person):
    """Return one person's skeleton from several cameras as vision, and its standard deviations.

    Parameters
    ----------
    points : Keypoints3D
    person : str
        Its identifier.

    Returns
    -------
    vision : DeviceMotion
        On the reference clock, in the world.
    sigma_m : (T, J) float
        Per axis, root mean square over axes, of the keypoints' noise; NaN where the joint is missing.
    """
    row = list(points.person_id).index(person)
    reason = points.reason[row]
    xyz = np.where((reason == reasons.OK)[..., None], points.xyz[row], np.nan)
    variance = np.trace(points.covariance_2d[row], axis1=-2, axis2=-1) / 3
    sigma = np.sqrt(np.where(np.isfinite(xyz).all(axis=-1), variance, np.nan))
    every = np.ones(len(points.time_s), bool)
    vision = DeviceMotion("cameras", "cameras", points.joints, points.time_s, xyz, reason, every)
    return vision, sigma
