"""Proposed court points, one CSV row each; a person confirms them before anything uses them."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from courtside.records import tables
from courtside.records.cameras.clicks import STATIC
from courtside.study.errors import StrPath

COLUMNS = (
    "camera", "point", "frame_idx", "x_px", "y_px", "sigma_px", "confidence", "reason",
)  # fmt: skip
NUMBERS = ("x_px", "y_px", "sigma_px")
WHAT = "a table of proposed court points"
EITHER = "either end of the court fits: one click in this picture says which"


def write(path: StrPath, proposals: Mapping[str, Any], points: Sequence[str]) -> None:
    """Write proposals of court points, and why there are none for the other points.

    `proposals` has a `courtside.calibration.click_proposals.proposals.Proposals` for each camera,
    untyped here, for `calibration` stands above this room.
    """
    rows = [
        [camera, point, STATIC, *found.xy[at], found.sigma_px[at], found.confidence[at], reason]
        for camera, found in proposals.items()
        for at, (point, reason) in enumerate(zip(points, found.reason, strict=True))
    ]
    tables.write(path, pd.DataFrame(rows, columns=COLUMNS))


def read(
    path: StrPath, cameras: Sequence[str], points: Sequence[str]
) -> dict[str, dict[str, dict[str, float | bool]]]:
    """Read proposals as the page for clicking shows them: `x`, `y`, `sigma_px` by camera and point.

    Points without a proposal are left out. `either` is true where the point may as well be the one
    that half a turn of the court brings to its place. An `InputError` if the file is no such table,
    or names unknown cameras or points.
    """

    def fault(table: pd.DataFrame) -> str:
        if list(table.columns) != list(COLUMNS):
            return f"found the columns {', '.join(table.columns)}"
        table[list(NUMBERS)].astype(float)  # raises for others
        # An empty cell is NaN.
        odd = ({*table["camera"]} - {*cameras}) | ({*table["point"]} - {*points})
        return f"found unknown cameras or points: {', '.join(sorted(map(str, odd)))}" if odd else ""

    table = tables.read(path, WHAT, fault, dtype={"camera": str, "point": str})
    table = table.astype(dict.fromkeys(NUMBERS, float))
    given = table[np.isfinite(table["x_px"]) & np.isfinite(table["y_px"])]
    found: dict[str, dict[str, dict[str, float | bool]]] = {camera: {} for camera in cameras}
    for row in given.itertuples():
        place = {"x": row.x_px, "y": row.y_px, "sigma_px": row.sigma_px}
        found[row.camera][row.point] = place | ({"either": True} if row.reason == EITHER else {})
    return found
