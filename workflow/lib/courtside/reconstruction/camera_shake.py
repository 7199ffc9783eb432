"""Camera shake and knocks: quantified per frame, and taken off the keypoints."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from courtside.study.execution import log

LONGEST_GAP_S = 0.2  # frames without a measurement that are bridged by a line
SAME_FRAME = 0.25  # of a frame: a time that agrees with a row of the table
PROBE_PX = 20.0  # how far from the centre the turn of the content is read
N_STEPS = 6
DONE_RAD = 1e-10


def camera_turns(camera, table):
    """Return how the camera had turned in each frame.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
        As calibrated, standing as in its static picture.
    table : DataFrame
        Of `courtside.records.cameras.shake_table`.

    Returns
    -------
    shaken_from_still : (T, 3) float
        Rotation vector, radians, from the axes of the camera as calibrated to those it has in the frame; NaN
        where the shake is unknown.

    Notes
    -----
    A fixed camera turns about itself: when its picture moves by ten pixels, its centre moves by about
    a millimetre. The rotation is the one that moves the picture's centre, and turns the content there, as
    measured (Newton's method through the lens). Zoom is left out: an angle of view does not shake.
    """
    measured = np.column_stack(
        [table.shift_x_px, table.shift_y_px, np.radians(table.rotation_deg)]
    ).astype(float)
    found = np.full(measured.shape, np.nan)
    known = np.isfinite(measured).all(axis=1)
    if known.any():
        found[known] = _solve(camera, measured[known])
    return found


def steady(view, camera, table):
    """Move keypoints from the shaken pictures of a camera to where its static picture has them.

    Parameters
    ----------
    view : courtside.records.keypoints.keypoints.Keypoints2D
    camera : courtside.geometry.camera.Camera
        As calibrated.
    table : DataFrame
        Of `courtside.records.cameras.shake_table`, with a row for each frame of the view.

    Returns
    -------
    steadied : courtside.records.keypoints.keypoints.Keypoints2D
        With `xy` and `xyz_in_body` turned back. Frames whose shake is unknown for longer than 0.2 s are left
        as they are, which the log says. Keypoints that the lens model cannot have seen stay, too.

    Raises
    ------
    InputError
        If the camera was calibrated at another size, or a frame is not in the table.

    Notes
    -----
    The measured shake is used as it is, not smoothed: its noise is far below a keypoint's, and smoothing
    would take more from the tremor than from the noise.
    """
    cameras.check_size(camera, view.size, f"keypoints of camera {view.camera}")
    turned = _bridged(table.time_s.to_numpy(float), camera_turns(camera, table))
    turned = turned[_rows(view, table)]
    unknown = np.isnan(turned).any(axis=1)
    if unknown.any():
        log.logger.warning(
            "camera %s: shake unknown in %d of %d frames, keypoints left as they are there",
            view.camera,
            unknown.sum(),
            len(unknown),
        )
    still_from_shaken = Rotation.from_rotvec(np.where(unknown[:, None], 0.0, -turned)).as_matrix()
    xy = _project(camera, _directions(camera, view.xy) @ still_from_shaken.mT)
    kept = unknown[:, None, None] | np.isnan(xy)
    return replace(
        view,
        xy=np.where(kept, view.xy, xy),
        xyz_in_body=view.xyz_in_body @ still_from_shaken.mT,
    )


def _solve(camera, measured):
    """Return the rotation vectors (T, 3) that move the picture's centre, and turn it there, as measured."""
    centre = (np.array(camera.size) - 1) / 2
    arms = PROBE_PX * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    directions = _directions(camera, centre + arms)
    f = np.diag(camera.K)[:2]
    x, y, turn = measured.T
    # Near the axis: what a small turn about the axes right, down and forward moves.
    vectors = np.column_stack([-y / f[1], x / f[0], turn])
    for _ in range(N_STEPS):
        moved = _project(camera, directions @ Rotation.from_rotvec(vectors).as_matrix().mT)
        shift = moved[:, 0] - centre
        across, down = moved[:, 1] - moved[:, 2], moved[:, 3] - moved[:, 4]
        curl = np.arctan2(across[:, 1] - down[:, 0], across[:, 0] + down[:, 1])
        off = measured - np.column_stack([shift, curl])
        step = np.column_stack([-off[:, 1] / f[1], off[:, 0] / f[0], off[:, 2]])
        vectors = vectors + step
        if np.abs(step).max() < DONE_RAD:
            break
    return vectors


def _bridged(time_s, vectors):
    """Fill short gaps of (T, 3) with lines, not before the first and after the last value."""
    known = np.flatnonzero(np.isfinite(vectors).all(axis=1))
    filled = vectors.copy()
    for last, following in pairwise(known):
        gap = slice(last + 1, following)
        ends_s = time_s[[last, following]]
        if following > last + 1 and ends_s[1] - ends_s[0] <= LONGEST_GAP_S:
            share = ((time_s[gap] - ends_s[0]) / (ends_s[1] - ends_s[0]))[:, None]
            filled[gap] = (1 - share) * vectors[last] + share * vectors[following]
    return filled


def _rows(view, table):
    """Return the row of the table of each frame of a view, (T,) int."""
    time_s = table.time_s.to_numpy(float)
    wanted = np.asarray(view.time_s, float)
    rows = np.searchsorted((time_s[:-1] + time_s[1:]) / 2, wanted)
    step_s = np.median(np.diff(time_s)) if len(time_s) > 1 else 0.01
    off_s = np.abs(time_s[rows] - wanted)
    if len(wanted) and off_s.max() > SAME_FRAME * step_s:
        at = wanted[off_s.argmax()]
        raise InputError(
            f"camera {view.camera}: expected the shake of every frame, found none at {at:.3f} s: "
            "measure the shake of the same recording, trimmed alike"
        )
    return rows


def _directions(camera, xy):
    """Return where pixels look, (..., 3), in the camera's axes, z = 1."""
    seen = cameras.undistort(camera, xy)
    return np.concatenate([seen, np.ones((*seen.shape[:-1], 1))], axis=-1)


def _project(camera, xyz_in_cam):
    """Project points that are given in the camera's axes."""
    return cameras.project(replace(camera, cam_from_world=np.eye(3, 4)), xyz_in_cam)


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
        Of `courtside.records.cameras.shake_table`.

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
    turns = camera_turns(camera, table)
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
        Of `courtside.records.cameras.shake_table`.
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
        Of `courtside.records.cameras.shake_table`. The shift is that of the picture's centre.
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
        Of `courtside.records.cameras.shake_table`.
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
