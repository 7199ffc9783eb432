"""Say what a fixed camera's shake amounts to: tremor, knocks, and millimetres at the player."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from courtside.motion import steadying

WINDOW_S = 1.0  # before and after: medians over that are compared
LEAST_S = 0.4  # of it must be known on both sides, to say that a knock stays
LEAST_PX = 1.0  # of a knock
LEAST_RATIO = 5.0  # of a knock to the same comparison at the other frames
LEAST_SPREADS = 3.0  # of a knock to the tremor about the medians beside it, root mean square
ABRUPT_S, ABRUPT_SHARE = (
    0.15,
    0.6,
)  # within that, a knock does that share of its work: tremor swings slower
MOST = 30  # knocks of one take that are named


@dataclass(frozen=True)
class Knock:
    """A camera was knocked, and stayed as it then stood.

    Attributes
    ----------
    time_s : float
        Of the first frame that shows it, on the camera's own clock.
    shift_px : (2,) float
        By how much the content of the picture's centre moved: right, down.
    turn_deg : float
        By how much the camera turned, about whatever axis.
    """

    time_s: float
    shift_px: np.ndarray
    turn_deg: float


def find(camera, table):
    """Find the times at which a camera was knocked.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
    table : DataFrame
        Of `courtside.records.shake_table`.

    Returns
    -------
    knocks : list of Knock
        In order of time. A step counts where the median turns of the second before and after differ by
        more than 1 px at the picture's centre, by five times their uncertainty, five times what they
        typically differ by in this take, and three times the tremor's root mean square beside it: of a
        trembling camera only what stands out is found, and nothing within 0.4 s of the ends of a take.
    """
    table = table[np.isfinite(table.shift_x_px)]
    if len(table) < 2:
        return []
    turns = steadying.turns(camera, table)
    level = turns * np.diag(camera.K)[:2].mean()
    step_s = np.median(np.diff(table.time_s))
    n, least = (max(2, round(length / step_s)) for length in (WINDOW_S, LEAST_S))
    sigma_px = np.median(table.sigma_px)
    splits = []
    for _ in range(MOST):
        steps = np.linalg.norm(_steps(level, n, least), axis=1)
        if np.isnan(steps).all():
            break
        split = _split(level, int(np.nanargmax(steps)), n)
        before, after = np.split(level, [split])
        step = np.median(after[:n], axis=0) - np.median(before[-n:], axis=0)
        level = np.concatenate([before, after - step])
        rest = np.nanmedian(np.linalg.norm(_steps(level, n, least), axis=1))
        near = level[max(split - n, 0) : split + n]
        spread = np.sqrt(np.mean(np.sum((near - np.median(near, axis=0)) ** 2, axis=1)))
        noise = max(LEAST_PX, LEAST_RATIO * max(rest, sigma_px), LEAST_SPREADS * spread)
        sudden = _sudden(before, after, step, max(2, round(ABRUPT_S / step_s)))
        if not (sudden and np.linalg.norm(step) > noise):
            break
        splits.append(split)
    return [_knock(table, turns, split, n) for split in sorted(splits)]


def tremor_px(table, knocks=()):
    """Return the root mean square, per axis, of the shift about its median between knocks, px.

    Parameters
    ----------
    table : DataFrame
        Of `courtside.records.shake_table`.
    knocks : list of Knock
    """
    parts = _parts(table, knocks)
    off = [part - np.median(part, axis=0) for part in parts]
    return float(np.sqrt(np.mean(np.concatenate(off) ** 2))) if off else np.nan


def mm_at(camera, xyz, table):
    """Return how far the shake moves the picture's content at a player, (T,) mm.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
    xyz : (3,) float
        Where the player is, m, in the world.
    table : DataFrame
        Of `courtside.records.shake_table`. The shift is that of the picture's centre.
    """
    shift_px = np.hypot(table.shift_x_px, table.shift_y_px).to_numpy(float)
    return mm_per_px(camera, xyz) * shift_px


def mm_per_px(camera, xyz):
    """Return the length that a pixel covers at a place (3,) m in the world: depth over focal length, mm."""
    depth = camera.cam_from_world[2] @ np.r_[np.asarray(xyz, float), 1.0]
    return float(1000 * depth / np.diag(camera.K)[:2].mean())


def say(camera, table, xyz):
    """Say in plain lines what a camera's shake amounts to.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
    table : DataFrame
        Of `courtside.records.shake_table`.
    xyz : (3,) float
        Where the player is, m, in the world; NaN where unknown.

    Returns
    -------
    lines : list of str
        One about tremor; one more if the camera did not stand as in its static picture; one per knock.
    """
    knocks, scale = find(camera, table), mm_per_px(camera, xyz)
    tremor = tremor_px(table, knocks)
    unknown = int(table.shift_x_px.isna().sum())
    name = f"camera {camera.name}:"
    if unknown == len(table):
        return [f"{name} no frame shows enough background to tell whether it shook"]
    lines = [f"{name} trembles by {tremor:.2f} px rms per axis{_at_player(scale * tremor)}"]
    if unknown:
        lines[0] += f"; {unknown} of {len(table)} frames show too little background to tell"
    parts = _parts(table, knocks)
    start_px = np.hypot(*np.median(parts[0], axis=0))
    if start_px > max(LEAST_PX, tremor):
        lines.append(
            f"{name} stood {start_px:.1f} px off its static picture when the take began"
            f"{_at_player(scale * start_px)}: steady its keypoints, or film the static picture again"
        )
    for knock in knocks:
        size_px = np.hypot(*knock.shift_px)
        lines.append(
            f"{name} knocked at {knock.time_s:.1f} s by {size_px:.2g} px ({knock.turn_deg:.2g} deg"
            f"{_at_player(scale * size_px)}): steady its keypoints from then on, or leave it out"
        )
    return lines


def _at_player(length_mm):
    digits = 0 if length_mm >= 10 else 1
    return f", {length_mm:.{digits}f} mm at the player" if np.isfinite(length_mm) else ""


def _steps(level, n, least):
    """Return the median over the next n frames less that over the last n, (T, 3); NaN where too few known."""
    pad = np.full((n, level.shape[1]), np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(np.concatenate([pad, level, pad]), n, axis=0)
    enough = np.isfinite(windows[:, 0]).sum(axis=-1) >= least
    medians = np.full(windows.shape[:2], np.nan)
    medians[enough] = np.nanmedian(windows[enough], axis=-1)
    return medians[n : n + len(level)] - medians[: len(level)]


def _sudden(before, after, step, n):
    """Tell whether the n frames next to a split show most of its step (3,)."""
    ends = np.array([np.median(after[:n], axis=0), np.median(before[-n:], axis=0)])
    return bool((ends[0] - ends[1]) @ step > ABRUPT_SHARE * (step @ step))


def _split(level, near, n):
    """Return the frame near another that best parts what is before from what is after."""
    first, stop = max(near - n, 0), min(near + n, len(level))
    before = np.median(level[first:near], axis=0)
    after = np.median(level[near:stop], axis=0)
    part = level[max(near - n // 2, 0) : min(near + n // 2 + 1, len(level))]
    gain = np.linalg.norm(part - after, axis=1) - np.linalg.norm(part - before, axis=1)
    # A frame nearer to what is before adds to the sum, one nearer to what is after takes away.
    total = np.concatenate([[0.0], np.cumsum(gain)])
    return max(near - n // 2, 0) + int(total.argmax())


def _knock(table, turns, split, n):
    shift = table[["shift_x_px", "shift_y_px"]].to_numpy(float)
    ends = [slice(max(split - n, 0), split), slice(split, split + n)]
    before, after = (Rotation.from_rotvec(np.median(turns[end], axis=0)) for end in ends)
    moved = [np.median(shift[end], axis=0) for end in ends]
    turn = np.degrees((after * before.inv()).magnitude())
    return Knock(float(table.time_s.iloc[split]), moved[1] - moved[0], float(turn))


def _parts(table, knocks):
    """Return the known shifts (n, 2) px between knocks, those that are not empty."""
    known = table[np.isfinite(table.shift_x_px)]
    shift = known[["shift_x_px", "shift_y_px"]].to_numpy(float)
    cuts = np.searchsorted(known.time_s, [knock.time_s for knock in knocks])
    return [part for part in np.split(shift, cuts) if len(part)]
