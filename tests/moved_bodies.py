"""A body of mocopi's build in smooth motion, known errors put into it, and vision of it."""

from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.hierarchy import Hierarchy, PosedHierarchy, forward
from courtside.records.keypoints.skeleton import JOINTS as LIMB_JOINTS

RATE_HZ = 60.0
UP = np.array([0.0, 1.0, 0.0])
BONES = [  # joint, parent, offset in metres; the left side's is mirrored
    ("root", None, (0, 0.95, 0)),
    ("torso_1", "root", (0, 0.10, 0)),
    ("torso_2", "torso_1", (0, 0.20, -0.01)),
    ("torso_3", "torso_2", (0, 0.20, 0.01)),
    ("head", "torso_3", (0, 0.15, 0)),
    ("clavicle", "torso_3", (0.02, -0.06, 0.03)),
    ("shoulder", "clavicle", (0.14, 0.03, -0.03)),
    ("elbow", "shoulder", (0.29, 0, 0)),
    ("wrist", "elbow", (0.25, 0, 0)),
    ("hip", "root", (0.09, -0.05, 0)),
    ("knee", "hip", (0, -0.41, 0)),
    ("ankle", "knee", (0, -0.42, -0.03)),
    ("toes", "ankle", (0, -0.08, 0.13)),
]
SWING = {"shoulder": 0.8, "hip": 0.35, "torso_2": 0.1}  # radians
HINGES = {"elbow": (0, -1, 0), "knee": (1, 0, 0)}  # axis about which the left one bends
VISION_FROM_WORLD = Rotation.from_rotvec([0.1, 2.5, 0.05]).as_matrix()
BEFORE_CAMERA = np.array([0.2, 0.9, 4.0])


def hierarchy():
    """Return the body's joints and bones."""
    names, parents, offsets = [], [], []
    middle = {"root", "torso_1", "torso_2", "torso_3", "head"}
    for side in ("", "left_", "right_"):
        for joint, parent, offset in BONES:
            if (joint in middle) != (side == ""):
                continue
            above = parent if parent in middle else f"{side}{parent}"
            names.append(side + joint)
            parents.append(-1 if parent is None else names.index(above))
            offsets.append(np.array(offset) * [-1 if side == "right_" else 1, 1, 1])
    return Hierarchy(tuple(names), np.array(parents), np.array(offsets, float))


def smooth(rng, n_frames, shape, memory_s=0.35):
    """Return smooth noise (T, *shape) of standard deviation 1."""
    frames = memory_s * RATE_HZ
    pad = int(4 * frames)
    noise = rng.standard_normal((n_frames + 2 * pad, *shape))
    found = gaussian_filter1d(noise, frames, axis=0)[pad : pad + n_frames]
    return found / found.std(axis=0)


def moving(seed=0, seconds=15.0):
    """Return a body that swings its limbs, turns and walks about."""
    rng = np.random.default_rng(seed)
    body, n = hierarchy(), int(seconds * RATE_HZ)
    size = [SWING.get(name.split("_", 1)[-1], SWING.get(name, 0.05)) for name in body.joints]
    turns = smooth(rng, n, (len(body.joints), 3)) * np.array(size)[:, None]
    local = Rotation.from_rotvec(turns.reshape(-1, 3)).as_matrix().reshape(n, -1, 3, 3)
    for joint, axis in HINGES.items():  # bends one way only
        for side, sign in (("left", 1), ("right", -1)):
            bend = (
                1.0 + 0.5 * smooth(rng, n, (1,))
                if joint == "elbow"
                else 0.5 + 0.25 * smooth(rng, n, (1,))
            )
            vector = bend * np.array(axis) * (sign if joint == "elbow" else 1)
            local[:, body.joints.index(f"{side}_{joint}")] = Rotation.from_rotvec(
                vector
            ).as_matrix()
    local[:, 0] = about_up(smooth(rng, n, (1,), 1.5)[:, 0]) @ local[:, 0]
    translation = np.repeat(body.offsets[None], n, axis=0)
    translation[:, 0] += smooth(rng, n, (3,), 1.0) * [1.0, 0.04, 1.0]
    return PosedHierarchy(body, np.arange(n) / RATE_HZ, translation, local)


def about_up(angles):
    """Return rotations (T, 3, 3) about the vertical."""
    return Rotation.from_rotvec(np.asarray(angles)[:, None] * UP).as_matrix()


def drifted(posed, heading):
    """Return a body whose world turns about the vertical by angles (T,): pose and every step."""
    local, translation = posed.parent_from_joint.copy(), posed.translation.copy()
    turn = about_up(heading)
    local[:, 0] = turn @ local[:, 0]
    steps = np.einsum("tij,tj->ti", turn[1:], np.diff(translation[:, 0], axis=0))
    translation[1:, 0] = translation[0, 0] + np.cumsum(steps, axis=0)
    return replace(posed, parent_from_joint=local, translation=translation)


def stretched(posed, factors):
    """Return a body with the bones that end at some joints longer by factors, dict of joint name."""
    translation = posed.translation.copy()
    for name, factor in factors.items():
        translation[:, posed.hierarchy.joints.index(name)] *= factor
    return replace(posed, translation=translation)


def swivelled(posed, side, angle):
    """Return a body whose elbow is turned about the line from shoulder to wrist; the wrist stays."""
    joints = list(posed.hierarchy.joints)
    at = {
        part: joints.index(f"{side}_{part}") for part in ("clavicle", "shoulder", "elbow", "wrist")
    }
    xyz, world = forward(posed)
    axis = xyz[:, at["wrist"]] - xyz[:, at["shoulder"]]
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    turn = Rotation.from_rotvec(axis * angle).as_matrix()
    local = posed.parent_from_joint.copy()
    turned = turn @ world[:, at["shoulder"]]
    local[:, at["shoulder"]] = world[:, at["clavicle"]].swapaxes(1, 2) @ turned
    return replace(posed, parent_from_joint=local)


def limbs(posed):
    """Return the places (T, 12, 3) of the limbs' joints."""
    return forward(posed)[0][:, [posed.hierarchy.joints.index(joint) for joint in LIMB_JOINTS]]


def seen(posed, seed=0, *, sd_m=(0.02, 0.02, 0.035), bias_m=0.0, memory_s=0.1, outliers=0.02, missing=0.05,
         rate_hz=30.0, late_s=0.0):  # fmt: skip
    """Return vision of a body: noise per axis of the camera that lasts, outliers of 0.3 m, missing joints."""
    rng = np.random.default_rng(1000 + seed)
    time_s = np.arange(posed.time_s[0] + 0.1, posed.time_s[-1] - 0.1, 1 / rate_hz)
    true = limbs(posed)
    places = [np.searchsorted(posed.time_s, time_s), (time_s * RATE_HZ) % 1]
    before = places[0] - 1
    share = ((time_s - posed.time_s[before]) * RATE_HZ)[:, None, None]
    xyz = true[before] * (1 - share) + true[before + 1] * share
    keep = np.exp(-1 / (rate_hz * memory_s))
    noise = rng.standard_normal(xyz.shape)
    for frame in range(1, len(noise)):
        noise[frame] = keep * noise[frame - 1] + np.sqrt(1 - keep**2) * noise[frame]
    xyz = xyz @ VISION_FROM_WORLD.T + BEFORE_CAMERA + noise * sd_m
    xyz += bias_m * rng.standard_normal(xyz.shape[1:])
    wild = rng.uniform(size=xyz.shape[:2]) < outliers
    xyz[wild] += 0.3 * rng.standard_normal((wild.sum(), 3))
    xyz[rng.uniform(size=xyz.shape[:2]) < missing] = np.nan
    reason = np.isnan(xyz).any(axis=2).astype(np.uint8)
    every = np.ones(len(time_s), bool)
    return DeviceMotion(
        "d415-depth", "rgbd", np.array(LIMB_JOINTS), time_s + late_s, xyz, reason, every
    )


def in_vision(posed, report):
    """Return the limbs' joints of a corrected body (T, 12, 3) in vision's frame, by its report."""
    transform = np.array(report.vision_from_device)
    return limbs(posed) @ transform[:, :3].T + transform[:, 3]


def true_in_vision(posed):
    """Return the limbs' joints of the true body (T, 12, 3) in vision's frame."""
    return limbs(posed) @ VISION_FROM_WORLD.T + BEFORE_CAMERA


def aligned(xyz, true):
    """Return points (T, D, 3) turned and moved as one to lie on the true ones (Kabsch 1976)."""
    flat, wanted = xyz.reshape(-1, 3), true.reshape(-1, 3)
    turn, _ = Rotation.align_vectors(wanted - wanted.mean(axis=0), flat - flat.mean(axis=0))
    return (xyz - flat.mean(axis=0)) @ turn.as_matrix().T + wanted.mean(axis=0)
