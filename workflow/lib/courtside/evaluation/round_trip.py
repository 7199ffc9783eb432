"""Parts of an error in mm: round trips, rounded pixels, reprojection, true 3D error."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.evaluation import joints as joint_errors
from courtside.geometry import camera as camera_models
from courtside.geometry import triangulation
from courtside.geometry.camera import Camera
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints.keypoints import Keypoints2D, Keypoints3D
from courtside.study.errors import InputError

IDENTITY_MM = 1e-6  # an exact round trip returns the point up to rounding errors
COLUMNS = [
    "person", "n_cameras", "cameras", "row", "joint", "unit", "mean", "sd", "n", "over",
]  # fmt: skip
ALL = "all"  # in place of a joint: means over the joints


@dataclass(frozen=True)
class Span:
    """Consecutive frames of a take; in words, for tables, how many frames from when."""

    frames: slice
    words: str


def distance_after(
    cameras: list[Camera], xyz: NDArray, step_px: NDArray | Sequence[float] | None = None
) -> NDArray:
    """Return how far points move when they are projected into all views and triangulated again.

    The distance (...) mm of points (..., 3) m, NaN where missing or not seen by two views.
    `step_px` (C,) rounds the projections to the centres of square cells of this size in each
    picture; they are exact if None.

    Projection and triangulation use the same cameras, so that errors of these cancel. The
    triangulation is the linear one with equal weights (Hartley & Zisserman 2004, sec. 12.2), as in
    the paper's table 1.
    """
    flat = np.asarray(xyz, dtype=float).reshape(-1, 3)
    directions = []
    for at, camera in enumerate(cameras):
        xy = camera_models.project(camera, flat)
        if step_px is not None:
            xy = round_to_grid(xy, step_px[at])
        directions.append(camera_models.undistort(camera, xy))
    stacked = np.stack(directions)
    matrices = np.stack([camera.cam_from_world for camera in cameras])
    found = triangulation.triangulate(stacked, np.ones(stacked.shape[:2]), matrices)
    return 1000 * np.linalg.norm(found - flat, axis=-1).reshape(np.shape(xyz)[:-1])


def round_to_grid(xy: NDArray, step_px: float) -> NDArray:
    """Round image points (..., 2) px to the centres of cells of `step_px` in this picture.

    A step of 1 px is the picture's own grid, 0.5 px that of a picture twice as wide.
    """
    return (np.rint((xy + 0.5) / step_px - 0.5) + 0.5) * step_px - 0.5


def span(
    points: Keypoints3D, n_frames: int | None, start_s: float | None = None, stated: str = "start_s"
) -> Span:
    """Choose `n_frames` consecutive frames of a table; all if None or if the take has fewer.

    They start at `start_s`, or are the middle of the take. `InputError` if too few follow
    `start_s`; it begins with `stated`: where the configuration has `start_s`.
    """
    total = len(points.time_s)
    count = total if n_frames is None else min(n_frames, total)
    first = (total - count) // 2
    if start_s is not None:
        first = int(np.argmin(np.abs(points.time_s - start_s)))
        if first + count > total:
            raise InputError(
                f"{stated}: expected {count} frames from {start_s:g} s on, found {total - first} "
                f"up to {points.time_s[-1]:.2f} s; choose an earlier start"
            )
    words = f"{count} frames from {points.time_s[first]:.3f} s"
    return Span(slice(first, first + count), words)


def table(
    points: Keypoints3D,
    cameras: list[Camera],
    joints: Sequence[str],
    chosen: Span,
    *,
    published_width: int,
    truth: joint_errors.Truth | None = None,
    others: Sequence[tuple[Camera, Keypoints2D, Clock | None]] = (),
) -> pd.DataFrame:
    """Fill the rows of table 1 for one set of cameras.

    Rows `rounded` and `rounded_published` have projections rounded to whole pixels of the picture,
    and of one of the published width; `reprojection` is of all views of the set, accepted or not,
    `left_out` of the other views; `truth` is the distance to the true joint of the same name.

    `cameras` are at least the views that `points` rests on, `others` views that it does not rest
    on, with the persons of `points`; without a clock, they are on that of `points`. Rows are for
    those `joints` that `points` has. `published_width` is the longer side, px, of the picture whose
    pixel grid the row `rounded_published` uses.

    `InputError` if a view has no camera, or no person is in the truth; `ValueError` if the exact
    round trip moves a point: projection and triangulation are then inconsistent.
    """
    known = {camera.name: camera for camera in cameras}
    for name in points.cameras:
        if name not in known:
            raise InputError(
                f"camera {name}: expected one of the calibrated cameras {list(known)}, found none "
                "of that name; triangulate and evaluate with the same calibration"
            )
    used = [known[name] for name in points.cameras]
    at = [list(points.joints).index(joint) for joint in joints if joint in points.joints]
    part = points.frames(chosen.frames).some_joints(at)
    values = round_trips(used, part.xyz, published_width)
    values["reprojection"] = ("px", part.reproj_error_px)
    if others:
        left_out = [
            joint_errors.distance_to_unused_view(points, *other)[:, chosen.frames][:, :, at]
            for other in others
        ]
        values["left_out"] = ("px", np.stack(left_out, axis=-1))
    if truth is not None:
        values["truth"] = ("mm", joint_errors.distance_to_truth(part, truth))
    rows = []
    for person, name in enumerate(points.person_id):
        for row, (unit, of_all) in values.items():
            label = (str(name), len(used), "+".join(points.cameras), row)
            found = _statistics(of_all[person], part.joints, chosen.words)
            rows += [(*label, joint, unit, *numbers) for joint, *numbers in found]
    return pd.DataFrame(rows, columns=COLUMNS)


def round_trips(
    cameras: list[Camera], xyz: NDArray, published_width: int
) -> dict[str, tuple[str, NDArray]]:
    """Return the rows `exact`, `rounded` and `rounded_published`: (unit, distances (...)) by name.

    `xyz` is (..., 3) m. `ValueError` if an exact round trip moves a point by more than
    `IDENTITY_MM`.
    """
    exact = distance_after(cameras, xyz)
    largest = float(np.nanmax(exact, initial=0.0))
    if largest > IDENTITY_MM:
        names = "+".join(camera.name for camera in cameras)
        raise ValueError(
            f"cameras {names}: expected projection and triangulation to be inverse within "
            f"{IDENTITY_MM} mm, found {largest:.3g} mm"
        )
    published = [max(camera.size) / published_width for camera in cameras]
    return {
        "exact": ("mm", exact),
        "rounded": ("mm", distance_after(cameras, xyz, np.ones(len(cameras)))),
        "rounded_published": ("mm", distance_after(cameras, xyz, published)),
    }


def _statistics(values: NDArray, joints: NDArray, words: str) -> Iterator[tuple]:
    """Yield joint, mean, sd, n, over: of each joint, then of all; values (T, J) or (T, J, C)."""
    over = words if values.ndim == 2 else f"{words} x {values.shape[2]} cameras"
    found = []
    for at, joint in enumerate(joints):
        known = values[:, at][np.isfinite(values[:, at])]
        mean = known.mean() if len(known) else np.nan
        found.append((mean, known.std(ddof=1) if len(known) > 1 else np.nan))
        yield str(joint), *found[-1], len(known), over
    columns = pd.DataFrame(found, columns=["mean", "sd"])
    yield ALL, *columns.mean(), columns["mean"].count(), f"joints, each: {over}"
