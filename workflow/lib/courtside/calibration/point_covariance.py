"""Covariance of triangulated points that the uncertainty of the cameras causes."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.bundle import problem
from courtside.calibration.bundle.problem import Network
from courtside.geometry.camera import Camera, in_picture, project

PLACES = 4096  # at once, for the memory that their derivatives need
# ASSUME: a direction that the views of a place leave open counts as seen by this share of the best
# seen one, as if rays met at 0.1 degrees: of a badminton hall between two cameras that face each
# other, 101 cm are then predicted, and 85 come out.
LEAST = 1e-3


def shown(cameras: Sequence[Camera], xyz: NDArray) -> NDArray:
    """Return which places (N, 3) m are in which camera's picture, (N, cameras) bool."""
    return np.stack([in_picture(c, project(c, xyz)) for c in cameras], axis=1)


def views(cameras: Sequence[Camera], xyz: NDArray) -> NDArray:
    """Return the cameras that may place points (N, 3) m, (N, cameras) bool: those that show them.

    Where fewer than two do, such as for points between the frames that show them, all cameras.
    """
    seen = shown(cameras, xyz)
    seen[seen.sum(axis=1) < 2] = True
    return seen


def sensitivity(network: Network, xyz: ArrayLike, seen: NDArray | None = None) -> NDArray:
    """Find how triangulated points move when image and lens parameters do, while pixels stay.

    The images of the network, whose own points do not matter, see the places `xyz` (N, 3) m that
    are before them, or those of them in `seen` (N, images) bool. The result (N, 3, K) is metres
    per unit of each column of the network; NaN where fewer than two images see a place. Where the
    images leave a direction open, as two cameras that face each other do, it is large (`LEAST`).
    """
    xyz = np.asarray(xyz, dtype=float)
    n_images, n_points = len(network.cam_from_world), len(xyz)
    image_idx = np.repeat(np.arange(n_images), n_points)
    point_idx = np.tile(np.arange(n_points), n_images)
    view = problem.with_points(network, xyz, image_idx, point_idx, np.zeros((len(image_idx), 2)))
    residual, by_camera, by_point = problem.linearised(view)
    unseen = np.isnan(residual[:, 0])
    if seen is not None:
        unseen |= ~seen.T.ravel()
    by_camera[unseen], by_point[unseen] = 0, 0
    full, by_point = (  # by image and point -> by point, all images together
        of_views.reshape(n_images, n_points, 2, of_views.shape[2])
        .transpose(1, 0, 2, 3)
        .reshape(n_points, 2 * n_images, of_views.shape[2])
        for of_views in (view.over_columns(by_camera), by_point)
    )
    left, extent, right = np.linalg.svd(by_point, full_matrices=False)
    extent = np.maximum(extent, LEAST * extent[:, :1])
    extent[extent == 0] = np.inf  # nothing sees the place
    found = -(right.mT / extent[:, None]) @ (left.mT @ full)
    found[(~unseen).reshape(n_images, n_points).sum(axis=0) < 2] = np.nan
    return found


def point_covariance(
    network: Network, covariance: NDArray, xyz: NDArray, seen: NDArray | None = None
) -> NDArray:
    """Return the covariance (N, 3, 3) m2 of triangulated points due to that of the cameras.

    The covariance of the keypoints' noise must be added. `covariance` (K, K) is that of the columns
    of the `network` of the fixed cameras, `xyz` (N, 3) are m. `seen` and NaN as for `sensitivity`.
    """
    parts = _parts(xyz)
    who = [None] * len(parts) if seen is None else np.array_split(seen, len(parts))
    found = (sensitivity(network, part, one) for part, one in zip(parts, who, strict=True))
    return np.concatenate([by @ covariance @ by.transpose(0, 2, 1) for by in found])


def field(
    network: Network, covariance: NDArray, cameras: Sequence[Camera] | None = None
) -> Callable[[NDArray], NDArray]:
    """Return a function from places (N, 3) m to how far errors of the cameras move points there.

    With the `cameras` of the network, points are placed by those that show them (`views`). The
    result is (N, 3, R) m. The R errors are independent, each of one standard deviation, and the
    same for all places: those at two places are correlated as the covariance says. Parameters as
    for `point_covariance`, which is the product of the result with its transpose.
    """
    scale = np.sqrt(np.diag(covariance))
    unit = np.where(scale > 0, scale, 1.0)
    extent, axes = np.linalg.eigh(covariance / np.outer(unit, unit))
    root = unit[:, None] * (axes * np.sqrt(np.maximum(extent, 0.0)))[:, extent > 0]

    def at(xyz: NDArray) -> NDArray:
        found = []
        for part in _parts(xyz):
            seen = None if cameras is None else views(cameras, part)
            found.append(sensitivity(network, part, seen) @ root)
        return np.concatenate(found)

    return at


def _parts(xyz: NDArray) -> list[NDArray]:
    """Split places (N, 3) so that at most `PLACES` are worked on at once."""
    return np.array_split(xyz, len(xyz) // PLACES + 1)
