"""A made-up badminton player's neck: from the base to the corners and back, with truth at any rate."""

import numpy as np

import walker
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D

CORNERS = np.array([[0.8, 0.9], [5.3, 0.9], [0.7, 5.9], [5.4, 5.8], [0.7, 3.2], [5.4, 3.3]])
BASE = np.array([3.05, 3.0])
HEIGHT_M = 1.45
HOP_M = 0.04


def neck(rate_hz, seconds, seed=0):
    """Return times (T,) and positions (T, 3): runs with minimum jerk, rests, hops, crouches."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(round(seconds * rate_hz) + 1) / rate_hz
    places, now, at, away = np.tile(BASE, (len(time_s), 1)), 0.0, BASE, False
    height = np.full(len(time_s), HEIGHT_M)
    while now < seconds:
        away = not away
        goal = CORNERS[rng.integers(len(CORNERS))] if away else BASE + rng.normal(0, 0.15, 2)
        lasts = max(0.7, np.linalg.norm(goal - at) / rng.uniform(1.8, 2.4))
        rests = rng.uniform(0.25, 0.5)
        share = np.clip((time_s - now) / lasts, 0, 1)
        blend = share**3 * (10 - 15 * share + 6 * share**2)
        later = time_s >= now
        places[later] = at + blend[later, None] * (goal - at)
        dip = 0.25 if away else 0.05
        height -= dip * np.exp(-0.5 * ((time_s - now - lasts) / 0.18) ** 2)
        height += HOP_M * np.sin(2 * np.pi * np.clip((time_s - now) / 0.45, 0, 1)) ** 2
        at, now = goal, now + lasts + rests
    return time_s, np.column_stack([places, height])


def noise(n_frames, rate_hz, sigma_m, memory_s, rng):
    """Return (T, 3) noise of a standard deviation per axis whose correlation falls to 1/e in a time."""
    ratio = np.exp(-1 / (rate_hz * memory_s)) if memory_s > 0 else 0.0
    made = rng.normal(0, 1, (n_frames, 3)) * np.asarray(sigma_m)
    for at in range(1, n_frames):
        made[at] = ratio * made[at - 1] + np.sqrt(1 - ratio**2) * made[at]
    return made


def body(neck_xyz, time_s):
    """Return (T, 33, 3) of a player under a neck's path who faces +y, and the angles of the pose in degrees.

    The trunk leans, knees and elbows bend in planes of constant x.
    """
    lean = np.radians(15 + 10 * np.sin(2 * np.pi * 0.6 * time_s))
    knee = np.radians(50 + 25 * np.sin(2 * np.pi * 0.8 * time_s))
    elbow = np.radians(70 + 30 * np.sin(2 * np.pi * 0.9 * time_s + 1))
    left = np.array([-1.0, 0.0, 0.0])

    def towards(angle):  # forwards from straight down
        return np.stack([0 * angle, np.sin(angle), -np.cos(angle)], axis=-1)

    places = {}
    middle = neck_xyz + 0.50 * towards(-lean)
    for side, sign in (("left_", 1), ("right_", -1)):
        places[side + "shoulder"] = neck_xyz + sign * 0.19 * left
        places[side + "elbow"] = places[side + "shoulder"] + 0.28 * towards(0 * lean + 0.3)
        places[side + "wrist"] = places[side + "elbow"] + 0.27 * towards(elbow + 0.3)
        places[side + "hip"] = middle + sign * 0.12 * left
        places[side + "knee"] = places[side + "hip"] + 0.42 * towards(knee / 2)
        places[side + "ankle"] = places[side + "knee"] + 0.44 * towards(-knee / 2)
        for hand in ("pinky", "index", "thumb"):
            places[side + hand] = places[side + "wrist"] + 0.08 * towards(elbow + 0.3)
        places[side + "heel"] = places[side + "ankle"] - [0, 0.05, 0.05]
        places[side + "foot_index"] = places[side + "ankle"] + [0, 0.17, -0.05]
        for part in ("eye_inner", "eye", "eye_outer", "ear", "mouth"):
            ahead = 0.0 if part == "ear" else 0.08
            places[side + part] = neck_xyz + sign * 0.05 * left + [0, ahead, 0.22]
    places["nose"] = neck_xyz + np.array([0, 0.1, 0.2])
    known = {"trunk_lean_forward": lean, "knee_flexion": knee, "elbow_flexion": elbow}
    xyz = np.stack([places[joint] for joint in walker.SKELETON.joints], axis=1)
    return xyz, {name: np.degrees(value) for name, value in known.items()}


def record(xyz, time_s, sigma_m, memory_s, rng):
    """Return a Keypoints3D of one player (T, 33, 3) with noise of its stated covariance."""
    shape = (1, *xyz.shape[:2])
    measured = xyz + np.stack(
        [
            noise(len(xyz), 1 / (time_s[1] - time_s[0]), sigma_m, memory_s, rng)
            for _ in range(xyz.shape[1])
        ],
        axis=1,
    )
    spread = np.diag(np.broadcast_to(np.asarray(sigma_m, dtype=float) ** 2, 3))
    return Keypoints3D(
        cameras=np.array(["a", "b"]),
        model="blazepose-full",
        joints=np.array(walker.SKELETON.joints),
        person_id=np.array(["p1"]),
        time_s=time_s,
        xyz=measured[None],
        covariance_2d=np.broadcast_to(spread, (*shape, 3, 3)).copy(),
        covariance_camera=np.broadcast_to(np.eye(3) * 1e-4, (*shape, 3, 3)).copy(),
        n_views=np.full(shape, 2),
        reproj_error_px=np.zeros((*shape, 2)),
        accepted=np.ones((*shape, 2), dtype=bool),
        reason=np.full(shape, missing_reason.OK, dtype=np.uint8),
    )
