"""CSV: one row per frame and joint, for spreadsheets and statistics programs."""

from os import PathLike

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.records import tables
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D

# column: (unit, meaning, meaning of an empty cell)
DICTIONARY = {
    "frame_idx": ("", "frame, from 0", "never empty"),
    "time_s": ("s", "time on the reference clock", "never empty"),
    "person": ("", "the person's pseudonym", "never empty"),
    "joint": ("", "joint name of the network's skeleton", "never empty"),
    "x_m": (
        "m",
        "position in the world frame, x along the court's 6.1 m side",
        "missing, see reason",
    ),
    "y_m": (
        "m",
        "position in the world frame, y along the court's 13.4 m side",
        "missing, see reason",
    ),
    "z_m": ("m", "position in the world frame, height", "missing, see reason"),
    "sd_x_mm": ("mm", "standard deviation of x from the keypoints' own noise", "unknown"),
    "sd_y_mm": ("mm", "standard deviation of y from the keypoints' own noise", "unknown"),
    "sd_z_mm": ("mm", "standard deviation of z from the keypoints' own noise", "unknown"),
    "n_views": ("", "cameras that the point rests on", "never empty; 0 where missing"),
    "reproj_error_px": ("px", "mean distance to the keypoints of these cameras", "missing"),
    "reason": ("", f"one of {', '.join(missing_reason.WORDS.values())}", "never empty"),
}


def table(keypoints: Keypoints3D, person: int) -> pd.DataFrame:
    """Return one person, by index, as a table.

    Columns of `DICTIONARY`, T x J rows, joints within frames; rounded to 0.01 mm and 0.01 px.
    """
    n_frames, n_joints = keypoints.xyz.shape[1:3]
    xyz = keypoints.xyz[person].reshape(-1, 3)
    variances = np.diagonal(keypoints.covariance_2d[person], axis1=-2, axis2=-1)
    deviation_mm = np.sqrt(variances).reshape(-1, 3) * 1000
    columns = {
        "frame_idx": np.repeat(np.arange(n_frames), n_joints),
        "time_s": np.repeat(keypoints.time_s, n_joints).round(6),
        "person": str(keypoints.person_id[person]),
        "joint": np.tile(keypoints.joints, n_frames),
        **{f"{axis}_m": xyz[:, at].round(5) for at, axis in enumerate("xyz")},
        **{f"sd_{axis}_mm": deviation_mm[:, at].round(2) for at, axis in enumerate("xyz")},
        "n_views": keypoints.n_views[person].ravel(),
        "reproj_error_px": _mean_error(keypoints, person).round(2),
        "reason": pd.Series(keypoints.reason[person].ravel()).map(missing_reason.WORDS),
    }
    return pd.DataFrame(columns)


def _mean_error(keypoints: Keypoints3D, person: int) -> NDArray:
    accepted = keypoints.accepted[person].reshape(-1, len(keypoints.cameras))
    error = keypoints.reproj_error_px[person].reshape(accepted.shape)
    count = accepted.sum(axis=1)
    total = np.where(accepted, np.nan_to_num(error), 0.0).sum(axis=1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def write(path: str | PathLike, keypoints: Keypoints3D, person: int) -> None:
    """Write `table` as CSV."""
    tables.write(path, table(keypoints, person), float_format=None)
