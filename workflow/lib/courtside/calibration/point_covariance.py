"""What uncertain cameras do to the points that they see: covariance of triangulated points."""

from dataclasses import replace

import numpy as np

from courtside.calibration.bundle import problem as networks

WITHIN_90 = 1.645  # standard deviations to either side hold 90 % of normal errors


def sensitivity(network, xyz):
    """Find how triangulated points move when image and lens parameters do.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
        Of the fixed cameras; its own points do not matter.
    xyz : (N, 3) float
        Places, m, that every image sees.

    Returns
    -------
    by_column : (N, 3, K) float
        Metres per unit of each column of the network. Pixels stay where they are.
    """
    n_images, n_points = len(network.cam_from_world), len(xyz)
    image_idx = np.repeat(np.arange(n_images), n_points)
    view = replace(
        network,
        xyz=np.asarray(xyz, dtype=float),
        xyz_mean=np.zeros((n_points, 3)),
        xyz_sigma=np.full(n_points, np.inf),
        image_idx=image_idx,
        point_idx=np.tile(np.arange(n_points), n_images),
        xy=np.zeros((len(image_idx), 2)),
        sigma_px=np.ones(len(image_idx)),
        loss_scale=np.full(len(image_idx), np.inf),
    )
    by_camera, by_point = networks.jacobians(view)
    full = np.zeros((len(image_idx), 2, network.n_columns))
    np.put_along_axis(full, view.columns()[:, None, :].repeat(2, axis=1), by_camera, axis=2)
    full = (
        full.reshape(n_images, n_points, 2, -1)
        .transpose(1, 0, 2, 3)
        .reshape(n_points, 2 * n_images, -1)
    )
    by_point = (
        by_point.reshape(n_images, n_points, 2, 3).transpose(1, 0, 2, 3).reshape(n_points, -1, 3)
    )
    return -np.linalg.pinv(by_point) @ full


def point_covariance(network, covariance, xyz):
    """Return the covariance of triangulated points that the cameras' own covariance causes.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
        Of the fixed cameras.
    covariance : (K, K) float
        Of its columns.
    xyz : (N, 3) float
        m.

    Returns
    -------
    covariance : (N, 3, 3) float
        m2; that of the keypoints' own noise comes on top.
    """
    by_column = sensitivity(network, xyz)
    return by_column @ covariance @ by_column.transpose(0, 2, 1)


def of_columns(normal):
    """Return the covariance (K, K) of all columns of a network from its `solver.Normal`; 0 of fixed ones."""
    size = len(normal.active)
    covariance = np.zeros((size, size))
    scale = 1 / np.sqrt(np.diag(normal.information))
    inverse = np.linalg.inv(normal.information * np.outer(scale, scale))
    covariance[np.ix_(normal.active, normal.active)] = inverse * np.outer(scale, scale)
    return covariance


def pseudo_inverse(information, n_free=7):
    """Return the covariance (K, K) of a network whose frame and scale are free, of least trace.

    Parameters
    ----------
    information : (K, K) float
        Zero for fixed columns.
    n_free : int
        Directions that nothing is known of: those of least information are left out.
    """
    scale = np.where(np.diag(information) > 0, np.diag(information), np.inf) ** -0.5
    extent, axes = np.linalg.eigh(information * np.outer(scale, scale))
    n_known = np.count_nonzero(scale) - n_free
    known = extent.argsort()[::-1][: max(n_known, 0)]
    root = scale[:, None] * axes[:, known] / np.sqrt(np.maximum(extent[known], 1e-300))
    return root @ root.T


def mahalanobis(error, covariance):
    """Return error.T @ inverse(covariance) @ error, (N,), of errors (N, 3) with covariances (N, 3, 3)."""
    return np.einsum("ni,ni->n", error, np.linalg.solve(covariance, error[..., None])[..., 0])
