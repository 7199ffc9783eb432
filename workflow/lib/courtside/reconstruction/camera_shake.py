"""Camera shake and knocks: removed from keypoints, put back for pictures, found and described.

Tables are those of `courtside.records.cameras.shake_table`. Cameras have their calibrated pose,
which is that of their static picture.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray
from pandas import DataFrame

from courtside.geometry import camera as camera_models
from courtside.geometry import epipolar, interpolation, rotations
from courtside.geometry.camera import Camera
from courtside.records.cameras import footage, shake_table
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import keypoints
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log

# ASSUME: over gaps up to this, s, the tremor of a mounted camera is nearly linear.
LONGEST_GAP_S = 0.2
SAME_FRAME = 0.25  # share of a frame: a keypoint time this close to a row's time is that row
PROBE_PX = 20.0  # distance from the centre at which the rotation is read: small against the lens
N_STEPS = 6  # Newton steps; DONE_RAD is usually reached earlier
DONE_RAD = 1e-10  # far below any measurement


def camera_turns(camera: Camera, table: DataFrame) -> NDArray:
    """Return the rotation vector (T, 3), radians, of the camera in each frame.

    It rotates the calibrated camera axes to those of the frame, and is NaN where the shake is
    unknown. The model is a pure rotation: when the picture moves by ten pixels, the camera's centre
    moves by about a millimetre. The rotation is the one that moves the picture's centre, and turns
    the content there, as measured (Newton's method through the lens). Zoom is ignored; `say` tells
    of it.
    """
    measured = np.column_stack(
        [table.shift_x_px, table.shift_y_px, np.radians(table.rotation_deg)]
    ).astype(float)
    found = np.full(measured.shape, np.nan)
    known = np.isfinite(measured).all(axis=1)
    if known.any():
        found[known] = _solve(camera, measured[known])
    return found


def steady(view: Keypoints2D, camera: Camera, table: DataFrame) -> Keypoints2D:
    """Move keypoints from a camera's shaken frames to their place in its static picture.

    `table` has a row for each frame of the view. `xy` and `xyz_in_body` are turned back. Where the
    shake is unknown, a camera turns evenly from the known frame before to the one after, and stands
    at the ends of a take: knocks are taken out there, too. The tremor stays where this lasts more
    than 0.2 s, which the log reports. Keypoints outside the lens model stay. The measured shake is
    not smoothed: its noise is far below a keypoint's, and smoothing would remove more tremor than
    noise.

    An `InputError` if the camera was calibrated at another size, or a frame is not in the table.
    """
    camera_models.check_size(
        camera, (int(view.size[0]), int(view.size[1])), f"keypoints of camera {view.camera}"
    )
    turned = frame_turns(camera, table, view.time_s)
    hidden = _hidden(table)[_rows(camera.name, view.time_s, table)]
    if hidden.any():
        log.logger.warning(
            "camera %s: shake unknown for longer than %g s, in %d of %d frames: tremor stays there",
            view.camera,
            LONGEST_GAP_S,
            hidden.sum(),
            len(hidden),
        )
    if not turned.any():
        return view
    xy = camera_models.turned_back(camera, view.xy, turned)
    still_from_shaken = rotations.rotation_from_rodrigues(-turned)
    return replace(
        view,
        xy=np.where(np.isnan(xy), view.xy, xy),
        xyz_in_body=view.xyz_in_body @ still_from_shaken.mT,
    )


def still(time_s: NDArray) -> DataFrame:
    """Return the shake table of a camera at rest, for frames at times (T,) of its own clock."""
    whole = DataFrame({"frame_idx": np.arange(len(time_s)), "time_s": np.asarray(time_s, float)})
    return whole.assign(**dict.fromkeys(shake_table.MEASURED, 0.0), n_matches=0)


def knocked(camera: Camera, table: DataFrame, knocks: Sequence[tuple[float, NDArray]]) -> DataFrame:
    """Return a table with knocks added to its shake: times, s, and rotations (3,), radians.

    Knocks are in the order in which they were found: each was measured without those before it.
    """
    if not knocks:
        return table
    vectors, time_s = camera_turns(camera, table), table.time_s.to_numpy(float)
    turned = np.broadcast_to(np.eye(3), (len(time_s), 3, 3))
    for at_s, turn in knocks:
        turned = turned @ rotations.rotation_from_rodrigues(np.outer(time_s >= at_s, turn))
    known = np.isfinite(vectors).all(axis=1)
    whole = rotations.rotation_from_rodrigues(vectors[known]) @ turned[known]
    moved = _moved(camera, rotations.rodrigues_from_rotation(whole))
    table = table.copy()
    table.loc[known, ["shift_x_px", "shift_y_px", "rotation_deg"]] = moved * [1, 1, 180 / np.pi]
    return table


def frame_turns(camera: Camera, table: DataFrame, time_s: NDArray) -> NDArray:
    """Return the rotation of a camera that `steady` removed, for frames at times (T,) of its clock.

    Rotation vectors (T, 3), radians, from the camera as calibrated; where the shake is unknown,
    from the known frames beside, and 0 if there are none. Raises `InputError` if a frame is not in
    the table.
    """
    vectors, all_s = camera_turns(camera, table), table.time_s.to_numpy(float)
    known, rows = np.isfinite(vectors).all(axis=1), _rows(camera.name, time_s, table)
    if not known.any():
        return np.zeros((len(rows), 3))
    turned = [np.interp(all_s, all_s[known], axis) for axis in vectors[known].T]
    return np.column_stack(turned)[rows]


def put_back(seen: Sequence[Footage], tables: Mapping[str, DataFrame]) -> list[Footage]:
    """Return footage whose cameras have the shake of their pictures again, from `tables` by name.

    Skeletons then project onto the persons in the shaken pictures. A camera without a table did not
    move.
    """
    return [
        replace(one, turns=frame_turns(one.camera, tables[one.camera.name], one.view.time_s))
        if one.camera.name in tables
        else one
        for one in seen
    ]


def read_as_filmed(
    cameras_toml: StrPath,
    pose2d_npz: Sequence[StrPath],
    people_npz: StrPath,
    sync_json: StrPath,
    shake_csv: Sequence[StrPath],
    videos: Sequence[StrPath] = (),
    wanted: Sequence[str] | None = None,
) -> list[Footage]:
    """Read footage as `footage.read` does, with the shake of the pictures in the cameras."""
    seen = footage.read(cameras_toml, pose2d_npz, people_npz, sync_json, videos, wanted)
    return put_back(seen, shake_table.read_all(shake_csv))


def _solve(camera: Camera, measured: NDArray) -> NDArray:
    """Return rotation vectors (T, 3) that move and turn the picture's centre as measured."""
    f = np.diag(camera.K)[:2]
    x, y, turn = measured.T
    # Start: small rotations about the axes right, down and forward, near the optical axis.
    vectors = np.column_stack([-y / f[1], x / f[0], turn])
    for _ in range(N_STEPS):
        off = measured - _moved(camera, vectors)
        step = np.column_stack([-off[:, 1] / f[1], off[:, 0] / f[0], off[:, 2]])
        vectors = vectors + step
        if np.abs(step).max() < DONE_RAD:
            break
    return vectors


def _moved(camera: Camera, vectors: NDArray) -> NDArray:
    """Return how rotation vectors (T, 3) move (px) and turn (rad) the picture's centre, (T, 3)."""
    centre = (np.array(camera.size) - 1) / 2
    arms = PROBE_PX * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    probes = np.broadcast_to(centre + arms, (len(vectors), *arms.shape))
    moved = camera_models.turned_back(camera, probes, -vectors)
    across, down = moved[:, 1] - moved[:, 2], moved[:, 3] - moved[:, 4]
    curl = np.arctan2(across[:, 1] - down[:, 0], across[:, 0] + down[:, 1])
    return np.column_stack([moved[:, 0] - centre, curl])


def _hidden(table: DataFrame) -> NDArray:
    """Return (T,) which frames' shake is unknown in gaps too long for the tremor."""
    unknown, time_s = table.shift_x_px.isna().to_numpy(), table.time_s.to_numpy(float)
    ends_s = np.r_[-np.inf, time_s[~unknown], np.inf]
    after = np.searchsorted(ends_s, time_s)
    return unknown & (ends_s[after] - ends_s[after - 1] > LONGEST_GAP_S)


def _rows(camera: str, wanted_s: NDArray, table: DataFrame) -> NDArray:
    """Return the row of the table of each frame of a camera, (T,) int."""
    time_s = table.time_s.to_numpy(float)
    wanted = np.asarray(wanted_s, float)
    rows = interpolation.nearest(time_s, wanted, "left")
    step_s = np.median(np.diff(time_s)) if len(time_s) > 1 else 0.01
    off_s = np.abs(time_s[rows] - wanted)
    if len(wanted) and off_s.max() > SAME_FRAME * step_s:
        at = wanted[off_s.argmax()]
        raise InputError(
            f"camera {camera}: expected the shake of every frame, found none at {at:.3f} s: "
            "measure the shake of the same recording, trimmed alike"
        )
    return rows


# ASSUME: thresholds that separate simulated knocks from tremor (docs/measured/joints.md).
WINDOW_S = 1.0  # before and after a knock: medians over this time are compared
LEAST_S = 0.4  # of it must be known on both sides, to tell that the new pose is kept
LEAST_PX = 1.0  # of a knock
LEAST_RATIO = 5.0  # of a knock to the same comparison at the other frames
LEAST_SPREADS = 3.0  # of a knock to the root mean square of the tremor beside it
# A knock makes this share of its step within this time, s; tremor is slower.
ABRUPT_S, ABRUPT_SHARE = 0.15, 0.6
MOST = 30  # knocks reported per take
LEAST_ZOOM_PERCENT = 0.2  # reported; as `max_zoom_percent` of takes whose cameras must stand still


@dataclass(frozen=True)
class Knock:
    """A camera was knocked and stayed in its new pose."""

    time_s: float  # of the first frame that shows it, on the camera's own clock
    shift_px: NDArray  # (2,): movement of the content at the picture's centre: right, down
    turn_deg: float  # angle by which the camera turned, about any axis


def find(camera: Camera, table: DataFrame) -> list[Knock]:
    """Find the times at which a camera was knocked, in order.

    A step counts if the median rotations of the second before and after differ by more than 1 px at
    the picture's centre, by five times their uncertainty, five times their typical difference in
    this take, and three times the root mean square of the tremor beside it. Only knocks that exceed
    the tremor are found, and none within 0.4 s of the ends of a take.
    """
    table = table[np.isfinite(table.shift_x_px)]
    if len(table) < 2:
        return []
    turns = camera_turns(camera, table)
    level = turns * epipolar.focal_px(camera)
    step_s = np.median(np.diff(table.time_s))
    n, least = (max(2, interpolation.window(length, 1 / step_s)) for length in (WINDOW_S, LEAST_S))
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
        sudden = _sudden(before, after, step, max(2, interpolation.window(ABRUPT_S, 1 / step_s)))
        if not (sudden and np.linalg.norm(step) > noise):
            break
        splits.append(split)
    return [_knock(table, turns, split, n) for split in sorted(splits)]


def tremor_px(table: DataFrame, knocks: Sequence[Knock]) -> float:
    """Return the root mean square, px per axis, of the shift about its median between knocks."""
    parts = _parts(table, knocks)
    off = [part - np.median(part, axis=0) for part in parts]
    return float(np.sqrt(np.mean(np.concatenate(off) ** 2))) if off else np.nan


def mm_at(camera: Camera, xyz: NDArray, table: DataFrame) -> NDArray:
    """Return the shift (T,) of the picture's centre in mm at a place `xyz` (3,) m in world."""
    shift_px = np.hypot(table.shift_x_px, table.shift_y_px).to_numpy(float)
    return mm_per_px(camera, xyz) * shift_px


def mm_per_px(camera: Camera, xyz: NDArray) -> float:
    """Return the length, mm, of a pixel at a place (3,) m in world: depth / focal length."""
    depth = camera.cam_from_world[2] @ np.r_[np.asarray(xyz, float), 1.0]
    return float(1000 * depth / epipolar.focal_px(camera))


def say(camera: Camera, table: DataFrame, xyz: NDArray) -> list[str]:
    """Describe a camera's shake in plain lines, with its size at a player at `xyz` (3,) m in world.

    One line is about tremor, one more if the camera did not stand as in its static picture, one
    about each knock, and one if it zoomed. NaN for `xyz` means an unknown place.
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
            f"{name} was {start_px:.1f} px off its static picture at the start of the take"
            f"{_at_player(scale * start_px)}: steady its keypoints, "
            "or film the static picture again"
        )
    for knock in knocks:
        size_px = np.hypot(*knock.shift_px)
        lines.append(
            f"{name} knocked at {knock.time_s:.1f} s by {size_px:.2g} px ({knock.turn_deg:.2g} deg"
            f"{_at_player(scale * size_px)}): steady its keypoints from then on, or leave it out"
        )
    return lines + _zoom_lines(camera, table)


def _zoom_lines(camera: Camera, table: DataFrame) -> list[str]:
    """Return a line about the second of a take in which a camera's zoom is furthest off, if any.

    A turn also enlarges the picture, by about 0.75 of its square (by 0.3 % for 3.5 degrees).
    """
    turn = np.hypot(table.shift_x_px, table.shift_y_px) / epipolar.focal_px(camera)
    second = table.time_s // WINDOW_S * WINDOW_S
    zoom = table.zoom_percent.groupby(second).median()
    beyond = (table.zoom_percent.abs() - 100 * turn**2).groupby(second).median()
    zoom = zoom[beyond > LEAST_ZOOM_PERCENT]
    if zoom.empty:
        return []
    at_s = zoom.abs().idxmax()
    return [
        f"camera {camera.name}: zoomed by {zoom[at_s]:+.2f} % against its static picture at "
        f"{at_s:.0f} s, which `steady` does not take out: calibrate it with the zoom of the take, "
        "end the take before it zooms with `trim_s`, or leave it out"
    ]


def _at_player(length_mm: float) -> str:
    digits = 0 if length_mm >= 10 else 1
    return f", {length_mm:.{digits}f} mm at the player" if np.isfinite(length_mm) else ""


def _steps(level: NDArray, n: int, least: int) -> NDArray:
    """Return the median over the next n frames minus that over the last n, (T, 3).

    It is NaN where fewer than `least` frames are known.
    """
    pad = np.full((n, level.shape[1]), np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(np.concatenate([pad, level, pad]), n, axis=0)
    medians = np.full(windows.shape[:2], np.nan)
    for at in keypoints.blocks(len(windows)):  # all at once need much memory
        enough = np.isfinite(windows[at, 0]).sum(axis=-1) >= least
        medians[at][enough] = np.nanmedian(windows[at][enough], axis=-1)
    return medians[n : n + len(level)] - medians[: len(level)]


def _sudden(before: NDArray, after: NDArray, step: NDArray, n: int) -> bool:
    """Return whether the n frames next to a split show most of its step (3,)."""
    ends = np.array([np.median(after[:n], axis=0), np.median(before[-n:], axis=0)])
    return bool((ends[0] - ends[1]) @ step > ABRUPT_SHARE * (step @ step))


def _split(level: NDArray, near: int, n: int) -> int:
    """Return the frame near another that best separates the level before from the level after."""
    first, stop = max(near - n, 0), min(near + n, len(level))
    before = np.median(level[first:near], axis=0)
    after = np.median(level[near:stop], axis=0)
    part = level[max(near - n // 2, 0) : min(near + n // 2 + 1, len(level))]
    gain = np.linalg.norm(part - after, axis=1) - np.linalg.norm(part - before, axis=1)
    # A frame nearer to the level before adds to the sum, one nearer to the level after subtracts.
    total = np.concatenate([[0.0], np.cumsum(gain)])
    return max(near - n // 2, 0) + int(total.argmax())


def _knock(table: DataFrame, turns: NDArray, split: int, n: int) -> Knock:
    shift = table[["shift_x_px", "shift_y_px"]].to_numpy(float)
    ends = [slice(max(split - n, 0), split), slice(split, split + n)]
    before, after = (
        scipy.spatial.transform.Rotation.from_rotvec(np.median(turns[end], axis=0)) for end in ends
    )
    moved = [np.median(shift[end], axis=0) for end in ends]
    turn = np.degrees((after * before.inv()).magnitude())
    return Knock(float(table.time_s.iloc[split]), moved[1] - moved[0], float(turn))


def _parts(table: DataFrame, knocks: Sequence[Knock]) -> list[NDArray]:
    """Return the known shifts (n, 2) px of each non-empty span between knocks."""
    known = table[np.isfinite(table.shift_x_px)]
    shift = known[["shift_x_px", "shift_y_px"]].to_numpy(float)
    cuts = np.searchsorted(known.time_s, [knock.time_s for knock in knocks])
    return [part for part in np.split(shift, cuts) if len(part)]
