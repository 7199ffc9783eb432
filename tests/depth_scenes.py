"""Depth pictures of bodies made of balls and capsules, whose joints are known; used by several tests."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from courtside.geometry import depth_registration
from courtside.geometry.camera import Camera

WALL_M = 4.5
APART = np.column_stack(
    [
        Rotation.from_euler("xyz", [0.2, -0.4, 0.3], degrees=True).as_matrix(),
        [0.0148, 0.0002, 0.0004],
    ]
)
# A person before the camera, arms out to the sides: x right, y down, z forward, metres; facing the camera.
STANDING = {
    "left_shoulder": (0.19, -0.45, 2.5),
    "right_shoulder": (-0.19, -0.45, 2.5),
    "left_elbow": (0.47, -0.44, 2.48),
    "right_elbow": (-0.47, -0.44, 2.52),
    "left_wrist": (0.72, -0.43, 2.44),
    "right_wrist": (-0.72, -0.43, 2.55),
    "left_hip": (0.11, 0.06, 2.5),
    "right_hip": (-0.11, 0.06, 2.5),
    "left_knee": (0.12, 0.46, 2.47),
    "right_knee": (-0.12, 0.46, 2.5),
    "left_ankle": (0.13, 0.86, 2.5),
    "right_ankle": (-0.13, 0.86, 2.52),
}
RADIUS_M = {"shoulder": 0.055, "elbow": 0.042, "wrist": 0.028}
RADIUS_M |= {"hip": 0.085, "knee": 0.055, "ankle": 0.038}
BONES = (
    ("left_shoulder", "left_elbow"),
    ("left_elbow", "left_wrist"),
    ("right_shoulder", "right_elbow"),
    ("right_elbow", "right_wrist"),
    ("left_shoulder", "left_hip"),
    ("right_shoulder", "right_hip"),
    ("left_shoulder", "right_shoulder"),
    ("left_hip", "right_hip"),
    ("left_hip", "left_knee"),
    ("left_knee", "left_ankle"),
    ("right_hip", "right_knee"),
    ("right_knee", "right_ankle"),
)


@dataclass(frozen=True)
class Rig:
    """What `motion.depth_lift` needs of a recording."""

    colour: Camera
    depth: Camera
    colour_from_depth: np.ndarray
    depth_unit_m: float = 0.001


def rig(size=(424, 240), dist=(0, 0, 0, 0, 0)):
    """Return a D415-like rig: both cameras see 69.4 degrees across."""
    width, height = size
    focal = width / 2 / np.tan(np.radians(69.4) / 2)
    matrix = [[focal, 0, width / 2 - 0.3], [0, focal, height / 2 - 0.7], [0, 0, 1]]
    at_rest = np.eye(3, 4)
    depth = Camera("depth", size, matrix, np.zeros(5), at_rest)
    wide = (int(width * 1.5), int(height * 1.5))
    matrix = [[1.5 * focal, 0, wide[0] / 2], [0, 1.5 * focal, wide[1] / 2], [0, 0, 1]]
    return Rig(Camera("colour", wide, matrix, dist, at_rest), depth, APART)


def radius_of(joint):
    return RADIUS_M[joint.removeprefix("left_").removeprefix("right_")]


def capsules(joints, bones=BONES):
    """Return (start, end, radius at start, radius at end) of each bone, in the colour camera's axes."""
    return [
        (np.array(joints[a]), np.array(joints[b]), radius_of(a), radius_of(b)) for a, b in bones
    ]


def depth_of(depth_camera, shapes, colour_from_depth, wall_m=WALL_M, n_balls=40):
    """Return the depth (h, w) in metres of shapes before a wall: each a row of balls.

    Balls are met exactly by a quadratic equation, so that what is drawn at a joint is a ball's surface.
    """
    rays = depth_registration.rays(depth_camera)
    directions = np.concatenate([rays, np.ones((*rays.shape[:2], 1))], axis=-1)
    rotation, shift = colour_from_depth[:, :3], colour_from_depth[:, 3]
    depth = np.full(rays.shape[:2], wall_m)
    square = (directions**2).sum(axis=-1)
    for start, end, first, last in shapes:
        for share in np.linspace(0, 1, n_balls):
            centre = rotation.T @ ((1 - share) * start + share * end - shift)
            radius = (1 - share) * first + share * last
            along = directions @ centre
            inside = along**2 - square * (centre @ centre - radius**2)
            near = (along - np.sqrt(np.maximum(inside, 0))) / square
            depth = np.where((inside > 0) & (near > 0) & (near < depth), near, depth)
    return depth


def steps(depth_m, unit_m=0.001):
    """Return depth in metres as a camera stores it."""
    return np.rint(depth_m / unit_m).astype(np.uint16)
