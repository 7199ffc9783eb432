"""Similarity transforms (rotation, translation, scale) between frames, fitted to points."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.camera import Camera

LINE = 1e-3  # ASSUME: points narrower than this part of their extent lie on a line


@dataclass(frozen=True, eq=False)
class Sim3:
    """A similarity `b_from_a`: x_in_b = scale * rotation @ x_in_a + translation."""

    scale: float  # units of b per unit of a
    rotation: NDArray  # (3, 3): orthonormal, right-handed
    translation: NDArray  # (3,): in units of b

    def points(self, x_in_a: ArrayLike) -> NDArray:
        """Return points (..., 3) of a in b."""
        return self.scale * np.asarray(x_in_a, float) @ self.rotation.T + self.translation

    def inverse(self) -> Sim3:
        """Return `a_from_b`."""
        rotation = self.rotation.T
        return Sim3(1 / self.scale, rotation, -rotation @ self.translation / self.scale)

    def camera(self, camera: Camera) -> Camera:
        """Return a camera known in a as a camera in b, lengths in units of b: the same picture."""
        rotation = camera.cam_from_world[:, :3] @ self.rotation.T
        shift = self.scale * camera.cam_from_world[:, 3] - rotation @ self.translation
        return replace(camera, cam_from_world=np.column_stack([rotation, shift]))


def umeyama(x_in_a: ArrayLike, x_in_b: ArrayLike, weight: ArrayLike | None = None) -> Sim3:
    """Fit `b_from_a` to the same points (N, 3) in both frames, by least squares.

    `weight` (N,) is that of the squared distances. Raises `ValueError` if fewer than three points,
    or only collinear ones, have weight, or a number is not finite.

    Umeyama 1991, eq. 40-42. Never a reflection: mirrored points get the best rotation.
    """
    x_in_a, x_in_b = np.asarray(x_in_a, float), np.asarray(x_in_b, float)
    weight = np.ones(len(x_in_a)) if weight is None else np.asarray(weight, float)
    finite = all(np.isfinite(values).all() for values in (x_in_a, x_in_b, weight))
    if x_in_a.shape != x_in_b.shape or x_in_a.shape != (len(weight), 3) or not finite:
        raise ValueError(
            f"expected finite points (N, 3) twice and weights (N,), found {x_in_a.shape}, "
            f"{x_in_b.shape}, {weight.shape}"
        )
    if is_collinear(x_in_a[weight > 0]) or is_collinear(x_in_b[weight > 0]):
        raise ValueError("expected three points or more that are not on one line, found fewer")
    scale, rotation, translation = fit_many(x_in_a, x_in_b, weight)
    return Sim3(float(scale), rotation, translation)


def rigid(x_in_a: ArrayLike, x_in_b: ArrayLike) -> Sim3:
    """Fit the rigid motion `b_from_a` to the same points (N, 3); errors are those of `umeyama`."""
    x_in_a, x_in_b = np.asarray(x_in_a, float), np.asarray(x_in_b, float)
    rotation = umeyama(x_in_a, x_in_b).rotation
    return Sim3(1.0, rotation, x_in_b.mean(axis=0) - rotation @ x_in_a.mean(axis=0))


def kabsch(products: NDArray) -> tuple[NDArray, NDArray]:
    """Return the rotations R nearest to matrices M (..., 3, 3), and the traces (...) of R'M.

    For M = sum of b a' over centred points a and b, R turns a nearest to b (Kabsch 1976). Never a
    reflection.
    """
    left, extent, right = np.linalg.svd(products)
    sign = np.ones_like(extent)
    sign[..., 2] = np.sign(np.linalg.det(left) * np.linalg.det(right))
    return (left * sign[..., None, :]) @ right, (extent * sign).sum(axis=-1)


def is_collinear(xyz: NDArray) -> bool:
    """Say whether points (N, 3) are fewer than three or on one line, to 0.1 % of their extent."""
    return len(xyz) < 3 or bool(flatness(xyz)[1] < LINE)


def flatness(xyz: NDArray) -> NDArray:
    """Return the extents (..., 3) of points (..., N, 3) along principal axes, over the first."""
    extent = np.linalg.svd(xyz - np.mean(xyz, axis=-2, keepdims=True), compute_uv=False)
    extent = np.concatenate([extent, np.zeros((*extent.shape[:-1], 3 - extent.shape[-1]))], axis=-1)
    return extent / np.maximum(extent[..., :1], np.finfo(float).tiny)


def fit_many(x_in_a: NDArray, x_in_b: NDArray, weight: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Fit similarities as `umeyama` to points (..., N, 3), which are not checked.

    Return scale (...), rotation (..., 3, 3) and shift (..., 3).
    """
    share = (weight / weight.sum(axis=-1, keepdims=True))[..., None]
    middle_a = (share * x_in_a).sum(axis=-2, keepdims=True)
    middle_b = (share * x_in_b).sum(axis=-2, keepdims=True)
    a, b = x_in_a - middle_a, x_in_b - middle_b
    rotation, trace = kabsch(np.swapaxes(share * b, -1, -2) @ a)
    scale = trace / (share * a * a).sum(axis=(-1, -2))
    turned = (middle_a @ np.swapaxes(rotation, -1, -2))[..., 0, :]
    return scale, rotation, middle_b[..., 0, :] - scale[..., None] * turned
