"""Turn of an inertial skeleton against vision: one fixed rotation, and a heading that drifts."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from courtside.geometry import rotations

ROUNDS = 20
STARTS = 5
HARSH_M = 0.1  # a joint so far off counts half


@dataclass(frozen=True, eq=False)
class Alignment:
    """How vision's frame lies to the device's world.

    Attributes
    ----------
    vision_from_device : (3, 3) float
        Rotation.
    time_s, heading : (N,) float
        What the device's heading lacks, radians about `up`, zero at first; by the reference clock.
    """

    vision_from_device: np.ndarray
    time_s: np.ndarray
    heading: np.ndarray

    def heading_at(self, time_s):
        """Return the heading (T,) at times (T,); beyond the ends it stays."""
        return np.interp(time_s, self.time_s, self.heading)


def estimate(time_s, device_xyz, vision_xyz, up, *, window_s):
    """Find the rotation between two skeletons whose vertical stays and whose heading drifts.

    Parameters
    ----------
    time_s : (N,) float
    device_xyz, vision_xyz : (N, D, 3) float
        The same joints in both frames, metres; NaN where vision has none. Places do not matter: only
        the joints about their mean in each frame.
    up : (3,) float
        Vertical in the device's world.
    window_s : float
        Standard deviation of the window in time over which one heading is taken.

    Returns
    -------
    alignment : Alignment

    Notes
    -----
    Alternates the rotation (Kabsch 1976) and the headings, which have a closed form each; from several
    starts, because headings all around leave the mean without a direction.
    """
    weights = np.isfinite(vision_xyz).all(axis=2).astype(float)
    frames = max(window_s / np.median(np.diff(time_s)), 1e-3) if len(time_s) > 1 else 1.0
    for _ in range(3):
        products, device, vision = _products(device_xyz, vision_xyz, weights)
        smooth = gaussian_filter1d(products, frames, axis=0, mode="nearest")
        rotation, heading = _alternate(smooth, up)
        turned = device @ _about(up, heading).swapaxes(1, 2) @ rotation.T
        off = np.linalg.norm(np.nan_to_num(vision - turned), axis=2)
        weights = np.isfinite(vision_xyz).all(axis=2) / (1 + (off / HARSH_M) ** 2)
    heading = np.unwrap(heading)
    rotation = rotation @ rotations.matrices_from_vectors(heading[0] * np.asarray(up))
    return Alignment(rotation, np.asarray(time_s), heading - heading[0])


def turn_path(path, heading, up):
    """Turn every step of a path by a heading, from the same start.

    Parameters
    ----------
    path : (T, 3) float
    heading : (T,) float
        Radians about `up`.
    up : (3,) float
        Unit vector.

    Returns
    -------
    turned : (T, 3) float
    """
    steps = np.diff(path, axis=0)
    middle = (heading[1:] + heading[:-1]) / 2
    turned = np.einsum("tij,tj->ti", _about(up, middle), steps)
    return path[0] + np.concatenate([np.zeros((1, 3)), np.cumsum(turned, axis=0)])


def _products(device_xyz, vision_xyz, weights):
    total = np.maximum(weights.sum(axis=1), 1e-9)[:, None, None]
    vision = np.nan_to_num(vision_xyz)
    device = device_xyz - (weights[..., None] * device_xyz).sum(axis=1, keepdims=True) / total
    vision = vision - (weights[..., None] * vision).sum(axis=1, keepdims=True) / total
    return np.einsum("tj,tja,tjb->tab", weights, vision, device), device, vision


def _alternate(products, up):
    chosen = np.linspace(0, len(products) - 1, STARTS).astype(int)
    best = (-np.inf, None, None)
    for start in [products.sum(axis=0), *products[chosen]]:
        rotation = _nearest(start)
        for _ in range(ROUNDS):
            heading = _headings(rotation.T @ products, up)
            aligned = np.einsum("tij,tkj->ik", products, _about(up, heading))
            rotation = _nearest(aligned)
        score = np.sum(rotation * aligned)
        if score > best[0]:
            best = (score, rotation, heading)
    return best[1:]


def _headings(products, up):
    """Return the angle about `up` that best explains each product of vision and device (N, 3, 3)."""
    sine = np.sum(rotations.cross_matrices(up) * products, axis=(1, 2))
    cosine = np.trace(products, axis1=1, axis2=2) - np.einsum("i,nij,j->n", up, products, up)
    return np.arctan2(sine, cosine)


def _about(up, angles):
    return rotations.matrices_from_vectors(np.asarray(angles)[:, None] * np.asarray(up))


def _nearest(product):
    left, _, right = np.linalg.svd(product)
    return left @ np.diag([1, 1, np.sign(np.linalg.det(left @ right))]) @ right
