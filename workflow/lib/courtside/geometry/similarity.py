"""Similarity transforms (rotation, translation, scale) between frames, fitted to points."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import combinations, islice

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

MOST_SUBSETS = 2000  # ASSUME: all subsets of up to 23 points, and an even choice of more
# Of the length of a normal vector in three dimensions with standard deviation 1 per axis.
MEDIAN = 1.538
QUANTILE_99 = 3.368
MIRRORED_RATIO = 4.0  # ASSUME: points are mirrored if their mirror image fits so much better
LINE = 1e-3  # ASSUME: points narrower than this part of their extent lie on a line
MAX_ROUNDS = 20  # ASSUME: the inliers settle in a few


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

    Umeyama 1991, eq. 40-42. Never a reflection: mirrored points get the best rotation. See
    `robust_umeyama`.
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
    scale, rotation, translation = _fit(x_in_a, x_in_b, weight)
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


def robust_umeyama(x_in_a: ArrayLike, x_in_b: ArrayLike, sigma: ArrayLike) -> tuple[Sim3, NDArray]:
    """Fit `b_from_a` to most of the same points (P, 3) in both frames, NaN where missing in one.

    Also return the inliers (P,) bool: points within the 99 % limit. `sigma`, one or (P,), is the
    standard deviation of a point per axis, in units of b. If the points scatter more, all sigmas
    are scaled up by one factor.

    Least median of squares (Rousseeuw & Leroy 1987) over all subsets of three points: no random
    numbers. Then weighted least squares on the inliers until they stay the same. Mirrored points
    that all lie in one plane fit a rotation as well: only the cameras' positions tell them apart,
    which are not known here. Raises `InputError` if the points are fewer than three, collinear, or
    mirrored.
    """
    x_in_a, x_in_b = np.asarray(x_in_a, float), np.asarray(x_in_b, float)
    sigma = np.broadcast_to(np.asarray(sigma, float), len(x_in_a))
    finite = np.isfinite(x_in_a).all(axis=1) & np.isfinite(x_in_b).all(axis=1)
    known = np.flatnonzero(finite)
    if is_collinear(x_in_a[known]) or is_collinear(x_in_b[known]):
        line = ", all on one line" if len(known) > 2 else ""
        raise _too_few(f"{len(known)} that two cameras see{line}")
    places = x_in_a[known], x_in_b[known], sigma[known]
    b_from_a, agree = _select(*places)
    if not agree.any():
        raise _too_few(f"{len(known)} of which those that agree are on one line")
    _refuse_mirrored(b_from_a, *places)
    accepted = np.zeros(len(x_in_a), dtype=bool)
    accepted[known[agree]] = True
    return b_from_a, accepted


def _too_few(found: str) -> InputError:
    return InputError(
        f"court points: expected three or more that are not on one line, found {found}; click more "
        "points, in two cameras or more each"
    )


def _refuse_mirrored(b_from_a: Sim3, x_in_a: NDArray, x_in_b: NDArray, sigma: NDArray) -> None:
    if len(x_in_a) < 4:
        return
    flipped = x_in_a * [1, 1, -1]
    mirrored, agree = _select(flipped, x_in_b, sigma)
    as_found = _distance(b_from_a, x_in_a, x_in_b, sigma)[agree]
    as_mirrored = _distance(mirrored, flipped, x_in_b, sigma)[agree]
    if np.sqrt(np.mean(as_found**2)) > MIRRORED_RATIO * max(1, np.sqrt(np.mean(as_mirrored**2))):
        raise InputError(
            "court points: expected a right-handed world (x along the short side, y along the long "
            "side, z up), found the points of its mirror image; exchange the names of the left and "
            "right points in all cameras, or undo the flip of the videos"
        )


def _select(x_in_a: NDArray, x_in_b: NDArray, sigma: NDArray) -> tuple[Sim3, NDArray]:
    """Return the similarity that most points agree on, and the inliers (P,) bool.

    There are no inliers where the points that agree are collinear in either frame.
    """
    n_points = len(x_in_a)
    subsets = triples(n_points, MOST_SUBSETS)
    weight = 1 / sigma**2
    scale, rotation, shift = _fit(x_in_a[subsets], x_in_b[subsets], weight[subsets])
    placed = scale[:, None, None] * (x_in_a @ rotation.transpose(0, 2, 1)) + shift[:, None]
    distance = np.sort(np.linalg.norm(placed - x_in_b, axis=-1) / sigma, axis=1)
    quorum = (n_points + 4) // 2 - 1
    # A rotation about the line of three collinear points is arbitrary.
    usable = np.isfinite(distance[:, quorum])
    for xyz in (x_in_a, x_in_b):
        usable &= flatness(xyz[subsets])[:, 1] >= LINE
    best = np.argmin(np.where(usable, distance[:, quorum], np.inf))
    fitted = Sim3(float(scale[best]), rotation[best], shift[best])
    found = _distance(fitted, x_in_a, x_in_b, sigma)
    # Three points fit themselves, which makes the scatter look small: start with a wide limit.
    now = found <= 2 * QUANTILE_99 * max(1, distance[best, quorum] / MEDIAN)
    agree = np.zeros(n_points, dtype=bool)
    for _ in range(MAX_ROUNDS):
        if (now == agree).all() or is_collinear(x_in_a[now]) or is_collinear(x_in_b[now]):
            break
        agree = now
        fitted = umeyama(x_in_a[agree], x_in_b[agree], weight[agree])
        found = _distance(fitted, x_in_a, x_in_b, sigma)
        now = found <= QUANTILE_99 * max(1, np.sort(found)[quorum] / MEDIAN)
    return fitted, agree


def triples(n: int, most: int) -> NDArray:
    """Return (N, 3) index: all triples of n points, or about `most` of them, evenly chosen."""
    step = -(-math.comb(n, 3) // most)
    return np.array(list(islice(combinations(range(n), 3), 0, None, step)))


def _distance(b_from_a: Sim3, x_in_a: NDArray, x_in_b: NDArray, sigma: NDArray) -> NDArray:
    return np.linalg.norm(b_from_a.points(x_in_a) - x_in_b, axis=1) / sigma


def _fit(x_in_a: NDArray, x_in_b: NDArray, weight: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Fit similarities to (..., N, 3) points: scale (...), rotation (..., 3, 3), shift (..., 3)."""
    share = (weight / weight.sum(axis=-1, keepdims=True))[..., None]
    middle_a = (share * x_in_a).sum(axis=-2, keepdims=True)
    middle_b = (share * x_in_b).sum(axis=-2, keepdims=True)
    a, b = x_in_a - middle_a, x_in_b - middle_b
    rotation, trace = kabsch(np.swapaxes(share * b, -1, -2) @ a)
    scale = trace / (share * a * a).sum(axis=(-1, -2))
    turned = (middle_a @ np.swapaxes(rotation, -1, -2))[..., 0, :]
    return scale, rotation, middle_b[..., 0, :] - scale[..., None] * turned
