"""What an error in millimetres is made of: round trips, rounded pixels, reprojection, true 3D error."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from courtside.evaluation import joints as joint_errors
from courtside.geometry import camera as camera_models
from courtside.geometry import triangulation
from courtside.study.errors import InputError

IDENTITY_MM = 1e-6  # an exact round trip returns the point; what is left is arithmetic
ROWS = ("exact", "rounded", "rounded_published", "reprojection", "left_out", "truth")
COLUMNS = [
    "person", "n_cameras", "cameras", "row", "joint", "unit", "mean", "sd", "n", "over",
]  # fmt: skip
ALL = "all"  # in place of a joint: means over the joints


@dataclass(frozen=True)
class Span:
    """Some frames of a take in a row.

    Attributes
    ----------
    frames : slice
    words : str
        For tables: how many frames from when.
    """

    frames: slice
    words: str


def distance_after(cameras, xyz, step_px=None):
    """Project points into all views, triangulate the projections plainly, and measure how far they moved.

    Parameters
    ----------
    cameras : list of Camera, length C
    xyz : (..., 3) float
        Metres; NaN where missing.
    step_px : (C,) float, optional
        Rounds the projections to the centres of square cells of this size in each picture; exact without.

    Returns
    -------
    distance_mm : (...) float
        NaN where missing or not seen by two views.

    Notes
    -----
    The two ways of the trip use the same cameras: whatever is wrong with these cancels. The triangulation
    is the linear one with equal weights (Hartley & Zisserman 2004, sec. 12.2), as in the paper's table 1.
    """
    flat = np.asarray(xyz, dtype=float).reshape(-1, 3)
    directions = []
    for at, camera in enumerate(cameras):
        xy = camera_models.project(camera, flat)
        if step_px is not None:
            xy = round_to_grid(xy, step_px[at])
        directions.append(camera_models.undistort(camera, xy))
    directions = np.stack(directions)
    matrices = np.stack([camera.cam_from_world for camera in cameras])
    found = triangulation.triangulate(directions, np.ones(directions.shape[:2]), matrices)
    return 1000 * np.linalg.norm(found - flat, axis=-1).reshape(np.shape(xyz)[:-1])


def round_to_grid(xy, step_px):
    """Round image points to the centres of cells.

    Parameters
    ----------
    xy : (..., 2) float
        px, first pixel centre at (0, 0).
    step_px : float
        Size of a cell, in px of this picture; 1 is the picture's own grid, 0.5 that of twice the width.

    Returns
    -------
    xy : (..., 2) float
    """
    return (np.rint((xy + 0.5) / step_px - 0.5) + 0.5) * step_px - 0.5


def span(points, n_frames, start_s=None):
    """Choose the frames of a table.

    Parameters
    ----------
    points : Keypoints3D
    n_frames : int or None
        Frames in a row; all where None or where the take has no more.
    start_s : float, optional
        Time of the first; the middle of the take is in the middle by default.

    Returns
    -------
    span : Span

    Raises
    ------
    InputError
        If fewer than `n_frames` follow `start_s`.
    """
    total = len(points.time_s)
    count = total if n_frames is None else min(n_frames, total)
    first = (total - count) // 2
    if start_s is not None:
        first = int(np.argmin(np.abs(points.time_s - start_s)))
        if first + count > total:
            raise InputError(
                f"table 1: expected {count} frames from {start_s:g} s on, found {total - first} up to "
                f"{points.time_s[-1]:.2f} s; choose an earlier start"
            )
    words = f"{count} frames from {points.time_s[first]:.3f} s"
    return Span(slice(first, first + count), words)


def table(points, cameras, joints, chosen, *, published_width=3840, truth=None, others=()):
    """Fill the rows of table 1 for one set of cameras.

    Parameters
    ----------
    points : Keypoints3D
        Made of the views `points.cameras`.
    cameras : list of Camera
        These views at least.
    joints : sequence of str
        Rows are made of those that `points` has.
    chosen : Span
        The frames.
    published_width : int
        Longer side, px, of the picture whose pixel grid the row `rounded_published` uses.
    truth : optional
        Has joints (J,), person_id (P,), time_s (T,), xyz (P, T, J, 3) m on the same clock and in world.
    others : sequence of (Camera, Keypoints2D, Clock or None)
        Views that `points` does not rest on; without a clock, on that of `points`.

    Returns
    -------
    rows : pandas.DataFrame
        `COLUMNS`. `row`: `exact` and `rounded`: distance after a round trip, exact or with projections
        rounded to whole pixels of the picture, and of one of the published width (`rounded_published`);
        `reprojection`: detection to reprojection in all views of the set, accepted or not; `left_out`: the
        same in the other views; `truth`: distance to the true joint of the same name. `mean` and `sd` are
        over what `over` says, and `n` says how many; of joint `all`, they are means over the joints.

    Raises
    ------
    InputError
        If a view has no camera, or no person is in the truth.
    ValueError
        If the exact round trip is none: then projection and triangulation contradict each other.
    """
    used = [_camera(cameras, name) for name in points.cameras]
    at = [list(points.joints).index(joint) for joint in joints if joint in points.joints]
    part = _part(points, chosen.frames, at)
    values = round_trips(used, part.xyz, published_width)
    values["reprojection"] = ("px", part.reproj_error_px)
    if others:
        left_out = [
            joint_errors.left_out(points, *other)[:, chosen.frames][:, :, at] for other in others
        ]
        values["left_out"] = ("px", np.stack(left_out, axis=-1))
    if truth is not None:
        values["truth"] = ("mm", joint_errors.true(part, truth))
    rows = []
    for person, name in enumerate(points.person_id):
        for row, (unit, of_all) in values.items():
            label = (str(name), len(used), "+".join(points.cameras), row)
            found = _statistics(of_all[person], part.joints, chosen.words)
            rows += [(*label, joint, unit, *numbers) for joint, *numbers in found]
    return pd.DataFrame(rows, columns=COLUMNS)


def round_trips(cameras, xyz, published_width):
    """Return the rows `exact`, `rounded` and `rounded_published`: (unit, distances (...)) by name.

    Parameters
    ----------
    cameras : list of Camera
    xyz : (..., 3) float
        Metres.
    published_width : int
        px.

    Raises
    ------
    ValueError
        If an exact round trip moves a point by more than `IDENTITY_MM`.
    """
    exact = distance_after(cameras, xyz)
    largest = float(np.nanmax(exact, initial=0.0))
    if largest > IDENTITY_MM:
        names = "+".join(camera.name for camera in cameras)
        raise ValueError(
            f"cameras {names}: expected projection and triangulation to be inverse within {IDENTITY_MM} mm, "
            f"found {largest:.3g} mm"
        )
    published = [max(camera.size) / published_width for camera in cameras]
    return {
        "exact": ("mm", exact),
        "rounded": ("mm", distance_after(cameras, xyz, np.ones(len(cameras)))),
        "rounded_published": ("mm", distance_after(cameras, xyz, published)),
    }


def _camera(cameras, name):
    for camera in cameras:
        if camera.name == name:
            return camera
    known = [camera.name for camera in cameras]
    raise InputError(
        f"camera {name}: expected one of the calibrated cameras {known}, found none of that name; "
        "triangulate and evaluate with the same calibration"
    )


def _part(points, frames, at):
    return replace(
        points,
        joints=points.joints[at],
        time_s=points.time_s[frames],
        xyz=points.xyz[:, frames][:, :, at],
        covariance_2d=points.covariance_2d[:, frames][:, :, at],
        covariance_camera=points.covariance_camera[:, frames][:, :, at],
        reproj_error_px=points.reproj_error_px[:, frames][:, :, at],
    )


def _statistics(values, joints, words):
    """Yield joint, mean, sd, n, over: of each joint, then of all joints; values (T, J) or (T, J, C)."""
    over = words if values.ndim == 2 else f"{words} x {values.shape[2]} cameras"
    found = []
    for at, joint in enumerate(joints):
        known = values[:, at][np.isfinite(values[:, at])]
        mean = known.mean() if len(known) else np.nan
        found.append((mean, known.std(ddof=1) if len(known) > 1 else np.nan))
        yield str(joint), *found[-1], len(known), over
    found = np.array(found).reshape(-1, 2)
    there = np.isfinite(found[:, 0])
    means = [_mean(column) for column in found.T]
    yield ALL, *means, int(there.sum()), f"joints, each: {over}"


def _mean(values):
    known = values[np.isfinite(values)]
    return known.mean() if len(known) else np.nan
