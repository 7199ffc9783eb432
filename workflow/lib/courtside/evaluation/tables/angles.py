"""The table of joint angles: errors of simulated takes, both sides and all persons together."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from courtside.evaluation.tables import players
from courtside.records import tables
from courtside.study.errors import StrPath

ROW = [*players.KEY, "stage", "angle"]
MEASURES = ["bias_deg", "rmse_deg", "p95_deg", "sigma_deg", "within_90_percent"]


def read(paths: Sequence[StrPath]) -> pd.DataFrame:
    """Read tables of `evaluate_angles` into one."""
    return pd.concat([tables.read(path, "a table of errors") for path in paths], ignore_index=True)


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Summarise rows of `read`: one row per take, calibration, network, fusion, stage and angle.

    Both sides of a limb together, all persons: means are weighted with n, of squares for rmse_deg
    and sigma_deg; p95_deg is that of the worst person.
    """
    both = rows[~rows["angle"].str.startswith(("left_", "right_"))]
    found = [
        dict(zip(ROW, key, strict=True)) | _together(part)
        for key, part in both.groupby(ROW, sort=False)
    ]
    whole = pd.DataFrame(found, columns=[*ROW, "n_persons", "n", *MEASURES])
    return whole.assign(stage=whole["stage"].map(players.STAGES))


def _together(part: pd.DataFrame) -> dict:
    known = part[part["n"] > 0]
    row: dict = {"n_persons": len(part), "n": int(part["n"].sum())}
    if known.empty:
        return row
    weights = known["n"].to_numpy(dtype=float)
    for name in ("bias_deg", "within_90_percent"):
        row[name] = np.average(known[name], weights=weights)
    for name in ("rmse_deg", "sigma_deg"):
        row[name] = np.sqrt(np.average(known[name] ** 2, weights=weights))
    return row | {"p95_deg": known["p95_deg"].max()}
