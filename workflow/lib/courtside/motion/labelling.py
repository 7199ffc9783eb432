"""Rows of 2D tracklets named frame by frame by the persons whose paths they follow."""

import numpy as np

from courtside.geometry import camera as camera_models

NOBODY = 6.0  # cost of a frame that belongs to none of the persons
FAR = 14.0  # a frame costs no more than this, however far off
CHANGE = 15.0  # cost of a change of owner within an uncut piece
CHANGE_AT_CUT = 0.7
DRIFT_MS2 = 3.0  # how fast the path of a person becomes uncertain away from a triangulated instant
BELIEVED_S = 0.4  # further away from one a path says nothing


def along(time_s, at_s, xyz):
    """Return a path at all frames, and how uncertain it is.

    Parameters
    ----------
    time_s : (T,) float
    at_s : (N,) float
        Instants with a place, at least one, increasing.
    xyz : (N, 3) float
        Metres.

    Returns
    -------
    path : (T, 3) float
        Linear between instants, constant before the first and after the last.
    sigma_m : (T,) float
        0 at an instant, inf where too far from any.
    """
    path = np.stack([np.interp(time_s, at_s, column) for column in xyz.T], axis=1)
    right = np.clip(np.searchsorted(at_s, time_s), 0, len(at_s) - 1)
    left = np.maximum(right - 1, 0)
    away = np.minimum(np.abs(time_s - at_s[left]), np.abs(time_s - at_s[right]))
    return path, np.where(away <= BELIEVED_S, DRIFT_MS2 * away**2, np.inf)


def costs(camera, rows, path, sigma_m, wanted):
    """Return what it costs to give each frame of each row to each person.

    Parameters
    ----------
    camera : Camera
    rows : courtside.motion.tracklet_pieces.Rows
        P rows of T frames.
    path : (S, T, 3) float
        Metres; NaN for a person without any place.
    sigma_m : (S, T) float
        From `along`.
    wanted : (S,) bool
        Persons who get what nobody else explains while only this view sees them.

    Returns
    -------
    cost : (P, T, S + 1) float
        The last column is nobody's; zero throughout where the row is absent.
    """
    count = len(path)
    cost = np.zeros((*rows.present.shape, count + 1))
    for person in range(count):
        expected = camera_models.project(camera, path[person])
        depth_m = path[person] @ camera.cam_from_world[2, :3] + camera.cam_from_world[2, 3]
        drift_px = sigma_m[person] * camera.K[0, 0] / np.maximum(depth_m, 0.1)
        sigma_px = np.hypot(rows.sigma_px[:, None], drift_px)
        with np.errstate(invalid="ignore"):
            off = np.linalg.norm(rows.centre - expected, axis=-1) / sigma_px
        spread = np.log(np.maximum(sigma_px, 1e-9) / np.maximum(rows.sigma_px, 1e-9)[:, None])
        value = np.minimum(0.5 * np.nan_to_num(off, nan=np.inf) ** 2 + 2 * spread, FAR)
        lost = NOBODY - 0.5 if wanted[person] else NOBODY + 0.5
        value = np.where(np.isfinite(sigma_m[person]), value, lost)
        cost[..., person] = value
    cost[..., -1] = NOBODY
    cost[~rows.present] = 0.0
    return cost


def follow(cost, cut, present):
    """Return the cheapest owners of rows over time.

    Parameters
    ----------
    cost : (R, T, S + 1) float
        The last column is nobody's.
    cut : (R, T) bool
        Where changing the owner is cheap.
    present : (R, T) bool

    Returns
    -------
    owner : (R, T) int
        0 to S - 1, or -1 for nobody and where absent.

    Notes
    -----
    Viterbi 1967, over all rows at once; rows do not know of one another.
    """
    change = np.where(cut | ~present, CHANGE_AT_CUT, CHANGE)
    total, back = cost[:, 0].copy(), np.zeros(cost.shape, dtype=np.int16)
    stay = np.arange(cost.shape[2])
    for t in range(1, cost.shape[1]):
        best = np.argmin(total, axis=1)
        moved = np.take_along_axis(total, best[:, None], axis=1) + change[:, t, None]
        moves = moved < total
        back[:, t] = np.where(moves, best[:, None], stay)
        total = np.where(moves, moved, total) + cost[:, t]
    owner = np.empty(present.shape, dtype=int)
    state = np.argmin(total, axis=1)
    for t in range(cost.shape[1] - 1, -1, -1):
        owner[:, t] = state
        state = back[np.arange(len(state)), t, state]
    nobody = cost.shape[2] - 1
    return np.where(present & (owner != nobody), owner, -1)


def one_row_each(owner, cost):
    """Give each person at most one row of a camera in each frame: the one that fits best.

    Parameters
    ----------
    owner : (P, T) int
        From `follow`.
    cost : (P, T, S + 1) float

    Returns
    -------
    index : (S, T) int
        Row of each person, -1 for none.
    """
    count = cost.shape[2] - 1
    index = np.full((count, owner.shape[1]), -1)
    for person in range(count):
        own = np.where(owner == person, _smoothed(cost[..., person]), np.inf)
        best = np.argmin(own, axis=0)
        index[person] = np.where(np.isfinite(own.min(axis=0)), best, -1)
    return index


def _smoothed(cost, half=5):
    """Return the mean over neighbouring frames, so that two rows do not take turns."""
    total = np.cumsum(np.pad(cost, ((0, 0), (half + 1, half)), mode="edge"), axis=1)
    return (total[:, 2 * half + 1 :] - total[:, : -2 * half - 1]) / (2 * half + 1)
