"""CSV: one row per frame and joint, for spreadsheets and statistics programs."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.records import tables
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import StrPath

# The data dictionary, docs/results.md, describes them.
COLUMNS = (
    "frame_idx", "time_s", "person", "joint", "x_m", "y_m", "z_m", "sd_x_mm", "sd_y_mm", "sd_z_mm",
    "sd_keypoints_mm", "sd_cameras_mm", "sd_network_mm", "outlier", "n_views", "reproj_error_px",
    "reason",
)  # fmt: skip


def table(keypoints: Keypoints3D, person: int) -> pd.DataFrame:
    """Return one person, by index, as a table.

    `COLUMNS`, T x J rows, joints within frames; rounded to 0.01 mm and 0.01 px.
    """
    n_frames, n_joints = keypoints.xyz.shape[1:3]
    xyz = keypoints.xyz[person].reshape(-1, 3)
    variances = np.diagonal(keypoints.covariance[person], axis1=-2, axis2=-1)
    deviation_mm = np.sqrt(variances).reshape(-1, 3) * 1000
    parts = {
        "keypoints": keypoints.covariance_2d,
        "cameras": keypoints.covariance_camera,
        "network": keypoints.covariance_network,
    }
    deviations = {name: _deviation_mm(part[person]) for name, part in parts.items()}
    columns = {
        "frame_idx": np.repeat(np.arange(n_frames), n_joints),
        "time_s": np.repeat(keypoints.time_s, n_joints).round(6),
        "person": str(keypoints.person_id[person]),
        "joint": np.tile(keypoints.joints, n_frames),
        **{f"{axis}_m": xyz[:, at].round(5) for at, axis in enumerate("xyz")},
        **{f"sd_{axis}_mm": deviation_mm[:, at].round(2) for at, axis in enumerate("xyz")},
        **{f"sd_{name}_mm": deviation.round(2) for name, deviation in deviations.items()},
        "outlier": keypoints.outlier[person].ravel().round(3),
        "n_views": keypoints.n_views[person].ravel(),
        "reproj_error_px": _mean_error(keypoints, person).round(2),
        "reason": pd.Series(keypoints.reason[person].ravel()).map(missing_reason.WORDS),
    }
    return pd.DataFrame(columns, columns=list(COLUMNS))


def _deviation_mm(covariance: NDArray) -> NDArray:
    """Return the root-mean-square standard deviation over the axes, by row of the table."""
    return 1000 * np.sqrt(np.trace(covariance, axis1=-2, axis2=-1) / 3).ravel()


def _mean_error(keypoints: Keypoints3D, person: int) -> NDArray:
    accepted = keypoints.accepted[person].reshape(-1, len(keypoints.cameras))
    error = keypoints.reproj_error_px[person].reshape(accepted.shape)
    count = accepted.sum(axis=1)
    total = np.where(accepted, np.nan_to_num(error), 0.0).sum(axis=1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def write(path: StrPath, keypoints: Keypoints3D, person: int) -> None:
    """Write `table` as CSV."""
    tables.write(path, table(keypoints, person), float_format=None)
