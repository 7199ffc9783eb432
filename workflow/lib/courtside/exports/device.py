"""The skeleton of an inertial suit for other programs: as it moved, without any correction.

TRC, C3D and CSV hold the frames that were performed, turned upright (z up), on the suit's own
clock. The BVH holds the rotations, with every row of the suit's file.
"""

from dataclasses import replace

import numpy as np

from courtside.records.devices import device_motion
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.hierarchy import PosedHierarchy
from courtside.records.keypoints.keypoints import Keypoints3D, unknown_errors
from courtside.records.keypoints.skeleton import Skeleton


def points(motion: DeviceMotion, person: str) -> Keypoints3D:
    """Return the performed frames of a device as 3D keypoints of one person.

    Nothing is known of their errors; the one view is the device itself. The times are even if the
    device's are.
    """
    kept = np.asarray(motion.performed, dtype=bool)
    xyz = device_motion.upright(motion)[None, kept]
    views = (*xyz.shape[:3], 1)
    return Keypoints3D(
        cameras=np.array([motion.source]),
        model=motion.source,
        joints=np.asarray(motion.joints),
        person_id=np.array([person]),
        time_s=motion.time_s[kept],
        xyz=xyz,
        **unknown_errors(xyz),
        n_views=np.zeros(xyz.shape[:3], dtype=np.int64),
        reproj_error_px=np.full(views, np.nan),
        accepted=np.zeros(views, dtype=bool),
        swapped=np.zeros(views, dtype=bool),
        reason=motion.reason[None, kept],
    )


def performed(motion: DeviceMotion) -> PosedHierarchy:
    """Return the rotations of the performed frames of a device that gives rotations."""
    posed = motion.posed
    if posed is None:
        raise ValueError(f"{motion.source}: expected rotations")
    kept = np.asarray(motion.performed, dtype=bool)
    moved = {"translation": posed.translation[kept]}
    moved |= {"parent_from_joint": posed.parent_from_joint[kept]}
    return replace(posed, time_s=posed.time_s[kept], **moved)


def named(posed: PosedHierarchy, skeleton: Skeleton) -> PosedHierarchy:
    """Return rotations whose joints have the names of the device's own files."""
    called = dict(zip(skeleton.joints, skeleton.device_names(), strict=True))
    joints = tuple(called[joint] for joint in posed.hierarchy.joints)
    ends = {called[joint]: tip for joint, tip in posed.hierarchy.ends.items()}
    return replace(posed, hierarchy=replace(posed.hierarchy, joints=joints, ends=ends))
