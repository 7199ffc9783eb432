"""The made-up scene of `triangulate_points.py`: cameras around a court and a moving body.

The court is one for badminton.
"""

import numpy as np

JOINTS, RATE_HZ = 26, 60
SIZE, FOCAL_PX = (1920, 1080), 1200.0
CENTRE = np.array([3.05, 6.7, 1.0])  # m, above the middle of the court
NOISE_PX, OUTLIER_PX = 2.0, 80.0


def ring(count):
    """Return `count` cameras, (C, 3, 4), 2.5 m high around the court, all looking at its middle."""
    angles = 2 * np.pi * (np.arange(count) + 0.5) / count
    matrices = []
    for angle in angles:
        position = CENTRE + np.array([7.85 * np.cos(angle), 15.13 * np.sin(angle), 1.5])
        forward = CENTRE - position
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        rotation = np.stack([right, np.cross(forward, right), forward])
        matrices.append(np.c_[rotation, -rotation @ position])
    return np.array(matrices)


def body(frames, rng):
    """Return joints (frames * JOINTS, 3) that wander the court with a body's spread, metres."""
    time_s = np.arange(frames) / RATE_HZ
    path = np.stack(
        [1.5 * np.sin(time_s), 2.5 * np.cos(0.7 * time_s), 0.1 * np.sin(6 * time_s)], -1
    )
    offset = rng.normal(0, [0.25, 0.25, 0.5], (JOINTS, 3))
    swing = 0.1 * np.sin(3 * time_s[:, None, None] + rng.uniform(0, 2 * np.pi, (JOINTS, 3)))
    return (CENTRE + path[:, None] + offset + swing).reshape(-1, 3)


def observe(matrices, xyz, rng):
    """Return exact projections (C, N, 2) and their noise of NOISE_PX, apart."""
    camera_matrix = np.array([[FOCAL_PX, 0, SIZE[0] / 2], [0, FOCAL_PX, SIZE[1] / 2], [0, 0, 1]])
    in_cam = np.einsum("cij,nj->cni", matrices, np.c_[xyz, np.ones(len(xyz))])
    pixels = in_cam @ camera_matrix.T
    return (
        camera_matrix,
        pixels[..., :2] / pixels[..., 2:],
        rng.normal(0, NOISE_PX, (*in_cam.shape[:2], 2)),
    )


def spoiled(count=4, frames=1000, share=0.05, seed=0):
    """Return the scene with `share` of outliers (up to OUTLIER_PX per axis) and as many missing."""
    rng = np.random.default_rng(seed)
    xyz, matrices = body(frames, rng), ring(count)
    camera_matrix, exact, noise = observe(matrices, xyz, rng)
    outlier = rng.random(noise.shape[:2]) < share
    noise[outlier] += rng.uniform(-OUTLIER_PX, OUTLIER_PX, (outlier.sum(), 2))
    score = np.clip(rng.normal(0.85, 0.08, outlier.shape), 0.35, 1)
    score[outlier] = rng.uniform(0.32, 0.7, outlier.sum())  # detectors doubt some outliers, not all
    missing = rng.random(outlier.shape) < share
    xy = exact + noise
    xy[missing], score[missing] = np.nan, 0
    return packed(camera_matrix, matrices, xyz, xy, score)


def one_bad_view(count, frames=1000, seed=1):
    """Return the scene with nothing missing, one view of each point 150 px or more off per axis."""
    rng = np.random.default_rng(seed)
    xyz, matrices = body(frames, rng), ring(count)
    camera_matrix, exact, noise = observe(matrices, xyz, rng)
    bad = rng.integers(count, size=len(xyz))
    away = rng.choice([-1, 1], (len(xyz), 2)) * rng.uniform(150, 300, (len(xyz), 2))
    noise[bad, np.arange(len(xyz))] += away
    return packed(camera_matrix, matrices, xyz, exact + noise, np.ones(noise.shape[:2]))


def packed(camera_matrix, matrices, xyz, xy, score):
    """Return the arrays as the methods read them."""
    return {"K": camera_matrix, "cam_from_world": matrices, "size": np.array(SIZE), "xyz": xyz,
            "xy": xy, "score": score}  # fmt: skip
