"""A made-up hall with cameras around a person, for tests: exact truth, no code of the library but Camera."""

import numpy as np

from courtside.geometry.camera import Camera

SIZE = (1920, 1080)
FOCAL_PX = 1400.0


def look_at(centre, target):
    """Return cam_from_world (3, 4) of a camera at `centre` that looks at `target`, upright, z up."""
    forward = np.subtract(target, centre) / np.linalg.norm(np.subtract(target, centre))
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(forward, right), forward])
    return np.column_stack([rotation, -rotation @ np.asarray(centre, float)])


def ring(count, radius_m=6.0, dist=(0, 0, 0, 0, 0), height_m=2.0):
    """Return `count` cameras on a circle that look at the origin, 1 m above the floor."""
    matrix = np.array([[FOCAL_PX, 0, 959.5], [0, FOCAL_PX, 539.5], [0, 0, 1]])
    angles = 2 * np.pi * np.arange(count) / count + 0.3
    centres = [(radius_m * np.cos(a), radius_m * np.sin(a), height_m) for a in angles]
    return [
        Camera(f"c{at}", SIZE, matrix, np.array(dist, float), look_at(centre, (0, 0, 1.0)))
        for at, centre in enumerate(centres)
    ]


def points(count, seed=0):
    """Return points (N, 3) where a person moves, metres."""
    rng = np.random.default_rng(seed)
    return rng.uniform([-1, -1, 0], [1, 1, 2], (count, 3))


def opencv_projection(camera, xyz):
    """Project with OpenCV, the independent truth of our own projection."""
    import cv2

    rotation, _ = cv2.Rodrigues(camera.cam_from_world[:, :3])
    xy, _ = cv2.projectPoints(xyz, rotation, camera.cam_from_world[:, 3], camera.K, camera.dist)
    return xy[:, 0]


def views(cameras, xyz):
    """Project points (N, 3) into all cameras, (C, N, 2) px."""
    return np.stack([opencv_projection(camera, xyz) for camera in cameras])
