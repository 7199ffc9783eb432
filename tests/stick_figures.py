"""People made of sticks who walk about, as trackers with the usual faults would see them."""

import itertools

import numpy as np

import scene

NAMES = [
    f"{side}_{joint}"
    for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    for side in ("left", "right")
]
TRUNK = [0, 1, 6, 7]
HEIGHTS_M = [1.45, 1.45, 1.15, 1.15, 0.95, 0.95, 0.95, 0.95, 0.5, 0.5, 0.08, 0.08]
HALF_WIDTHS_M = [0.2, 0.2, 0.25, 0.25, 0.28, 0.28, 0.15, 0.15, 0.14, 0.14, 0.14, 0.14]
SWINGS_M = [0, 0, 0.1, -0.1, 0.3, -0.3, 0, 0, -0.2, 0.2, -0.35, 0.35]


def body(place, time_s, size=1.0, stride_hz=1.0, phase=0.0):
    """Return the joints (T, 12, 3) of a person who walks along places (T, 2), metres."""
    velocity = np.gradient(place, time_s, axis=0)
    heading = np.arctan2(velocity[:, 1], velocity[:, 0])
    forward = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    left = np.stack([-forward[:, 1], forward[:, 0]], axis=1)
    swing = np.sin(2 * np.pi * (stride_hz * time_s + phase))
    side = np.tile([1.0, -1.0], 6) * HALF_WIDTHS_M * size
    joints = np.empty((len(time_s), 12, 3))
    joints[..., :2] = place[:, None] + side[:, None] * left[:, None]
    joints[..., :2] += (swing[:, None] * np.array(SWINGS_M) * size)[..., None] * forward[:, None]
    joints[..., 2] = np.array(HEIGHTS_M) * size
    return joints


def seen(cameras, people, rng, *, noise_px=4.0, dropout=0.03, gap_px=25.0, swaps=1.0):
    """Return tracklet rows and who they are.

    Parameters
    ----------
    cameras : list of Camera
    people : (P, T, 12, 3) float
    rng : numpy.random.Generator
    noise_px : float
        Half of it is common to all joints of a frame for some frames, as networks do.
    dropout : float
        Share of frames in which a row is empty.
    gap_px : float
        Of two people whose centres are closer, the further one is hidden.
    swaps : float
        Probability that a meeting in a view exchanges the rows from there on.

    Returns
    -------
    xy : list of (P, T, 12, 2) float
    truth : list of (P, T) int
        Person of each row, -1 where it is empty.
    """
    xy, truth = [], []
    for camera in cameras:
        flat = scene.opencv_projection(camera, people.reshape(-1, 3))
        exact = flat.reshape(*people.shape[:3], 2)
        depth = people.mean(axis=2) @ camera.cam_from_world[2, :3]
        rows, who = _track(exact, depth, rng, gap_px, swaps)
        common = rng.normal(0, noise_px / 2, (*rows.shape[:2], 1, 2))
        rows = rows + rng.normal(0, noise_px, rows.shape) + common
        empty = rng.random(who.shape) < dropout
        rows[empty], who[empty] = np.nan, -1
        xy.append(rows)
        truth.append(who)
    return xy, truth


def _track(exact, depth, rng, gap_px, swaps):
    """Return rows (P, T, J, 2) and persons (P, T) of a tracker that loses the hidden one of a pair."""
    count, n_frames = exact.shape[:2]
    middle = exact.mean(axis=2)
    order = rng.permutation(count)
    rows, who = np.empty_like(exact), np.empty((count, n_frames), int)
    meeting = np.zeros((count, count), bool)
    for t in range(n_frames):
        apart = np.linalg.norm(middle[:, None, t] - middle[None, :, t], axis=-1)
        close = (apart < gap_px) & ~np.eye(count, dtype=bool)
        for one, other in np.argwhere(np.triu(close & ~meeting)):
            if rng.random() < swaps:
                a, b = np.flatnonzero(order == one)[0], np.flatnonzero(order == other)[0]
                order[a], order[b] = other, one
        meeting = close
        rows[:, t], who[:, t] = exact[order, t], order
        for row, person in enumerate(order):
            if (close[person] & (depth[:, t] < depth[person, t])).any():
                rows[row, t], who[row, t] = np.nan, -1
    return rows, who


def right(index, truth, persons):
    """Return the share of (frame, camera, person) seen that are named right, best order of persons."""
    best = 0.0
    for order in itertools.permutations(range(len(index[0])), len(persons)):
        good = total = 0
        for own, who in zip(index, truth, strict=True):
            for label, person in zip(order, persons, strict=True):
                row = np.where((who == person).any(axis=0), np.argmax(who == person, axis=0), -1)
                good += (own[label] == row).sum()
                total += row.size
        best = max(best, good / total)
    return best


def path(rng, time_s, ends, sway_m=0.3):
    """Return places (T, 2) from one end to the other with some sway."""
    share = (time_s - time_s[0]) / (time_s[-1] - time_s[0])
    line = np.outer(1 - share, ends[0]) + np.outer(share, ends[1])
    for axis in range(2):
        line[:, axis] += sway_m * np.sin(
            2 * np.pi * rng.uniform(0.15, 0.4) * time_s + rng.uniform(0, 6)
        )
    return line
