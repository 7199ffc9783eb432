"""Rotation between an inertial skeleton and vision: a fixed one, and a heading that drifts."""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.geometry.similarity import kabsch

ROUNDS = 20  # ASSUME: of rotation and headings, each time
STARTS = 5  # ASSUME: frames whose own rotation is a start
HALF_WEIGHT_M = 0.1  # ASSUME: a joint this far off counts half


@dataclass(frozen=True, eq=False)
class Alignment:
    """Rotation between vision's frame and the device's world."""

    vision_from_device: NDArray  # (3, 3): rotation
    time_s: NDArray  # (N,): on the reference clock
    heading: NDArray  # (N,): to add to the device's heading, radians about `up`, zero at first

    def heading_at(self, time_s: NDArray) -> NDArray:
        """Return the heading (T,) at times (T,); constant beyond the ends."""
        return np.interp(time_s, self.time_s, self.heading)


def estimate(
    time_s: NDArray, device_xyz: NDArray, vision_xyz: NDArray, up: NDArray, *, window_s: float
) -> Alignment:
    """Find the rotation between two skeletons whose vertical stays and whose heading drifts.

    The same joints (N, D, 3) in both frames, metres; NaN where vision has none. Only the joints
    about their mean in each frame count, not the place. `up` (3,) is the vertical in the device's
    world; `window_s` the standard deviation of the window in time over which one heading is taken.

    Alternates the rotation (Kabsch 1976) and the headings, which have a closed form each; from
    several starts, because headings all around leave the mean without a direction.
    """
    weights = np.isfinite(vision_xyz).all(axis=2).astype(float)
    frames = max(window_s / np.median(np.diff(time_s)), 1e-3) if len(time_s) > 1 else 1.0
    for _ in range(3):
        products, device, vision = _products(device_xyz, vision_xyz, weights)
        smooth = scipy.ndimage.gaussian_filter1d(products, frames, axis=0, mode="nearest")
        rotation, heading = _alternate(smooth, up)
        turned = device @ _about(up, heading).swapaxes(1, 2) @ rotation.T
        off = np.linalg.norm(np.nan_to_num(vision - turned), axis=2)
        weights = np.isfinite(vision_xyz).all(axis=2) / (1 + (off / HALF_WEIGHT_M) ** 2)
    heading = np.unwrap(heading)
    rotation = rotation @ rotations.rotation_from_rodrigues(heading[0] * np.asarray(up))
    return Alignment(rotation, np.asarray(time_s), heading - heading[0])


def turn_path(path: NDArray, heading: NDArray, up: NDArray) -> NDArray:
    """Turn every step of a path (T, 3) by a heading (T,), radians about `up`; the start stays."""
    steps = np.diff(path, axis=0)
    middle = (heading[1:] + heading[:-1]) / 2
    turned = np.einsum("tij,tj->ti", _about(up, middle), steps)
    return path[0] + np.concatenate([np.zeros((1, 3)), np.cumsum(turned, axis=0)])


def _products(
    device_xyz: NDArray, vision_xyz: NDArray, weights: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    total = np.maximum(weights.sum(axis=1), 1e-9)[:, None, None]
    vision = np.nan_to_num(vision_xyz)
    device = device_xyz - (weights[..., None] * device_xyz).sum(axis=1, keepdims=True) / total
    vision = vision - (weights[..., None] * vision).sum(axis=1, keepdims=True) / total
    return np.einsum("tj,tja,tjb->tab", weights, vision, device), device, vision


def _alternate(products: NDArray, up: NDArray) -> tuple[NDArray, NDArray]:
    chosen = np.linspace(0, len(products) - 1, STARTS).astype(int)
    highest = -np.inf
    for start in [products.sum(axis=0), *products[chosen]]:
        rotation, _ = kabsch(start)
        for _ in range(ROUNDS):
            heading = _headings(rotation.T @ products, up)
            rotation, score = kabsch(np.einsum("tij,tkj->ik", products, _about(up, heading)))
        if score > highest:
            highest, best = float(score), (rotation, heading)
    return best


def _headings(products: NDArray, up: NDArray) -> NDArray:
    """Return the angle about `up` that best explains each product of both frames (N, 3, 3)."""
    sine = np.sum(rotations.cross_matrices(up) * products, axis=(1, 2))
    cosine = np.trace(products, axis1=1, axis2=2) - np.einsum("i,nij,j->n", up, products, up)
    return np.arctan2(sine, cosine)


def _about(up: NDArray, angles: NDArray) -> NDArray:
    return rotations.rotation_from_rodrigues(np.asarray(angles)[:, None] * np.asarray(up))
