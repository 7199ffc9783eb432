"""What uncertain cameras do to the skeletons measured with them: an error common to all frames."""

from dataclasses import replace

import numpy as np

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection


def with_cameras(points, cameras, covariance):
    """Add the covariance that the cameras' own causes to a record.

    Parameters
    ----------
    points : Keypoints3D
    cameras : list of Camera
        Those of `points.cameras`.
    covariance : (K, K) float
        Of the columns of the network of these cameras, as
        `courtside.calibration.records.covariance.CameraCovariance.of_columns` returns it.

    Returns
    -------
    points : Keypoints3D
        With `covariance_camera`: that of a person's middle in each frame, the same for all joints; NaN
        where the person is missing.

    Notes
    -----
    # ASSUME: the error of a calibration changes little within the reach of a body, and little when single
    joints rest on fewer views than the person does.
    """
    placed = np.isfinite(points.xyz)
    count = placed.sum(axis=2)
    middle = np.where(placed, points.xyz, 0).sum(axis=2) / np.where(count, count, np.nan)
    flat = middle.reshape(-1, 3)
    known = np.isfinite(flat).all(axis=1)
    found = np.full((len(flat), 3, 3), np.nan)
    network = selection.of_cameras(cameras)
    found[known] = point_covariance.point_covariance(network, covariance, flat[known])
    found = found.reshape(*middle.shape, 3)[:, :, None]
    there = placed.all(axis=-1)[..., None, None]
    return replace(points, covariance_camera=np.where(there, found, np.nan))
