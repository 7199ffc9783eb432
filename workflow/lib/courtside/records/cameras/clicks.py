"""Court points clicked in the static pictures of the fixed cameras: one CSV row each."""

import csv
import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.records.user_tables import known, number, table
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import atomic

COLUMNS = ("camera", "point", "frame_idx", "x_px", "y_px")
STATIC = 0  # frame_idx of the static picture


def read(path: StrPath, cameras: Sequence[str], points: Sequence[str]) -> dict[str, NDArray]:
    """Read clicked court points, (P, 2) px for every camera, NaN where not clicked.

    The CSV has the columns camera, point, frame_idx (0, the static picture), x_px, y_px (px of the
    video's size, first pixel's centre at (0, 0)); a hidden point has no row. `points` are the P
    points of the court. An `InputError` if the file is no such table, a row names an unknown
    camera, point or frame, a position is not a number, or one camera has a point twice.
    """
    clicks = {camera: np.full((len(points), 2), np.nan) for camera in cameras}
    index = {point: at for at, point in enumerate(points)}
    seen: dict[tuple[str, str], int] = {}
    for line, row in table(path, COLUMNS):
        where = f"{path}: line {line}"
        camera = known(where, "camera", row["camera"], clicks)
        point = known(where, "point", row["point"], index)
        number(where, "frame_idx", row["frame_idx"], STATIC, f"{STATIC}, the static picture")
        if (camera, point) in seen:
            raise InputError(
                f"{where}: expected one click for point {point} in camera {camera}, found another "
                f"in line {seen[camera, point]}; delete one"
            )
        seen[camera, point] = line
        clicks[camera][index[point]] = [number(where, key, row[key]) for key in ("x_px", "y_px")]
    return clicks


def read_static(path: StrPath, cameras: Sequence[str]) -> tuple[list[str], NDArray]:
    """Read points at rest: their names (P,) and clicks (C, P, 2) px, NaN where not clicked.

    The table is as for `read`, with names of one's own. An `InputError` also if a point is clicked
    in one camera only, which nothing can check.
    """
    rows = table(path, COLUMNS)
    points = list(dict.fromkeys(row["point"] for _, row in rows))
    clicks = read(path, cameras, points)
    xy = np.stack([clicks[camera] for camera in cameras])
    for point, n_views in zip(points, np.isfinite(xy[..., 0]).sum(axis=0), strict=True):
        if n_views < 2:
            raise InputError(
                f"{path}: point {point}: expected clicks in two cameras or more, found one; click "
                "it in another or delete the line"
            )
    return points, xy


def write(path: StrPath, clicks: Mapping[str, NDArray], points: Sequence[str]) -> None:
    """Write clicked points, (P, 2) px by camera, as `read` takes them; NaN rows are left out."""
    for camera, xy in clicks.items():
        if np.shape(xy) != (len(points), 2):
            raise ValueError(
                f"camera {camera}: expected ({len(points)}, 2) px, found {np.shape(xy)}"
            )
    with atomic(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(COLUMNS)
        for camera, xy in clicks.items():
            for point, (x, y) in zip(points, np.asarray(xy, float).tolist(), strict=True):
                if math.isfinite(x) and math.isfinite(y):
                    writer.writerow([camera, point, STATIC, x, y])
