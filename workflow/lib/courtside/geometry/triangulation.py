"""Triangulation from several cameras: plain DLT, least squares, and robust selection of views.

C cameras, N points. `xy` is (C, N, 2) px, distorted as in the pictures, NaN where unseen. `score`
is (C, N), the detector's confidence 0 to 1. `xyz` is (N, 3) m in the world, NaN where missing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.camera import Camera, picture_slopes, project, undistort

FADE = 4 / 3  # default of `fade_px`, in units of the limit
# ASSUME: the schedule of the robust kernel; outliers of 80 to 400 px are left out (tests).
START = 12.0  # the first kernel, in units of the last
GRADUATION = 1.6  # each round narrows the kernel by this factor
SETTLING = 5  # steps with the last kernel
WIDEST = 2.0  # beyond this many limits a view is never used
# Of points that need the views of low scores, too (`weak_m`). ASSUME: chosen on the players of the
# development sessions (docs/measured/joints.md): there keypoints are 0.02 of the person's height
# off, 0.4 of the limit, and their squared error grows with the inverse root of the score.
USUAL = 0.4  # standard deviation of a keypoint, in units of the limit
WIDER = 0.125  # the limit grows with the score to the power of minus this
LEAST_SCORE = 1e-4  # for the limit, lower scores count as this
BETTER = 0.9  # of its standard deviation: a point solved again is kept if its own is smaller
BATCH = 5000  # points at a time: keeps the working set in the cache and memory flat


@dataclass(frozen=True)
class Triangulated:
    """Triangulated points."""

    xyz: NDArray  # (N, 3): NaN where too few views are usable or agree
    # (N, 3, 3) m2; NaN where missing: of keypoints with a standard deviation per axis, at score 1,
    # of the limit `max_error_px`, or of 1 px without limits
    covariance: NDArray
    accepted: NDArray  # (C, N): views that the point rests on
    error_px: NDArray  # (C, N): from keypoint, accepted or not, to projection; NaN without either
    weight: NDArray  # (C, N): of the views before any of them fades, 1 for score 1; 0 if not used


def triangulate(xy: NDArray, weight: NDArray, cam_from_world: NDArray) -> NDArray:
    """Triangulate points (N, 3) by weighted DLT.

    `xy` (C, N, 2) lie on the undistorted, normalised image plane (z = 1, no unit). `weight` (C, N)
    is that of a camera's two rows; points with fewer than two positive weights become NaN.
    `cam_from_world` is (C, 3, 4).

    Hartley & Zisserman 2004, sec. 12.2, inhomogeneous form: points lie at finite distance.
    Minimises an algebraic error: report the reprojection error beside it.
    """
    used = (weight > 0) & np.isfinite(xy).all(axis=-1)
    places = np.where(used[:, None], xy.transpose(0, 2, 1), 0.0)
    rows = places[:, :, None] * cam_from_world[:, None, 2, :, None] - cam_from_world[:, :2, :, None]
    normal = _normal(rows, np.where(used, weight, 0.0) ** 2)
    xyz = solve_3x3(normal[:, :3, :3], -normal[:, :3, 3])
    xyz[used.sum(axis=0) < 2] = np.nan
    return xyz


def triangulate_all(cameras: Sequence[Camera], xy: NDArray) -> NDArray:
    """Triangulate points (..., 3) by least squares of the pixel errors in all views (C, ..., 2).

    NaN where fewer than two cameras see the point, or where it lies behind one that does.
    """
    shape, xy = xy.shape[1:-1], xy.reshape(len(xy), -1, 2)
    views = Views(cameras, xy, np.isfinite(xy).all(axis=-1).astype(float))
    found = np.full((xy.shape[1], 3), np.nan)
    at = np.flatnonzero((views.weight > 0).sum(axis=0) >= 2)
    if len(at):
        views = views.of(at)
        xyz = _linear(views)
        for _ in range(SETTLING):
            xyz = views.stepped(xyz, views.weight)
        fine = views.residuals(xyz).in_front(views.weight > 0)
        found[at[fine]] = xyz[fine]
    return found.reshape(*shape, 3)


def triangulate_robust(
    cameras: Sequence[Camera],
    xy: NDArray,
    score: NDArray,
    *,
    max_error_px: ArrayLike,
    min_views: int = 2,
    min_score: float = 0.0,
    fade_px: ArrayLike | None = None,
    weak_m: float | None = None,
) -> Triangulated:
    """Triangulate points, leaving out views that disagree.

    The start is a weighted DLT. Points with a view beyond the limit are solved again by graduated
    non-convexity (Blake & Zisserman 1987; Yang et al. 2020): Gauss-Newton with Geman-McClure
    weights whose scale shrinks from 12 times its last value, so that an outlier loses its weight
    before the views that agree are chosen. All points then settle with the last kernel, `fade_px`
    wide: a view fades as it disagrees instead of switching off, which keeps a point from jumping
    between frames when a view is near the limit (a slightly wrong calibration causes this). Views
    beyond twice the limit have no weight. Accepted are the views within the limit, and where these
    are fewer than `min_views`, the closest ones within twice the limit.

    Views along nearly one line, such as two cameras that face each other, leave a point uncertain
    along it. If its standard deviation exceeds `weak_m` and three views show it, it is solved again
    with the views below `min_score`, too, weighted by the root of their scores, and kept if it is
    less uncertain.

    Raises `ValueError` if the inputs disagree on the number of cameras or points, or `min_views` is
    below 2.

    Parameters
    ----------
    score : (C, N) float; the weight of a view's squared error
    max_error_px : float or (C, N) float; the limit: a view is accepted if its keypoint lies this
        close to the projected point. The N values may have several axes, such as frames and joints:
        broadcast over joints, they need no memory
    min_views : fewest accepted views of a point, at least 2
    min_score : keypoints below it are not used, except where `weak_m` needs them
    fade_px : as `max_error_px`; a view with this reprojection error has a quarter of its
        weight; 4/3 of the limit by default
    weak_m : metres, from keypoints with a standard deviation of 0.4 of the limit; None solves no
        point again
    """
    _check(cameras, xy, score, min_views)
    limit_px = _by_camera(max_error_px, score)
    fading_px = None if fade_px is None else _by_camera(fade_px, score)

    def solved(at: slice) -> Triangulated:
        limit = _some(limit_px, at)
        return _solve(
            cameras,
            xy[:, at],
            score[:, at],
            min_views=min_views,
            min_score=min_score,
            limit_px=limit,
            fade_px=FADE * limit if fading_px is None else _some(fading_px, at),
            weak_m=np.inf if weak_m is None else weak_m,
        )

    return _in_batches(score.shape, solved)


def _in_batches(shape: tuple[int, ...], solved: Callable[[slice], Triangulated]) -> Triangulated:
    """Triangulate the points of scores of this `shape`, (C, N), some at a time."""
    found = Triangulated(
        xyz=np.empty((shape[1], 3)),
        covariance=np.empty((shape[1], 3, 3)),
        accepted=np.empty(shape, dtype=bool),
        error_px=np.empty(shape),
        weight=np.empty(shape),
    )
    for start in range(0, shape[1], BATCH):
        at = slice(start, start + BATCH)
        part = solved(at)
        found.xyz[at], found.covariance[at] = part.xyz, part.covariance
        found.accepted[:, at], found.error_px[:, at] = part.accepted, part.error_px
        found.weight[:, at] = part.weight
    return found


def _by_camera(px: ArrayLike, score: NDArray) -> NDArray:
    """Return an array (C, ...) with a number for each point of scores (C, N)."""
    px = np.asarray(px, dtype=float)
    return px if px.ndim > 2 else np.broadcast_to(px, score.shape)


def _some(px: NDArray, at: slice) -> NDArray:
    """Return the numbers (C, n) of some points from those of all, (C, ...)."""
    return np.stack([of_camera.flat[at] for of_camera in px])


def _check(cameras: Sequence[Camera], xy: NDArray, score: NDArray, min_views: int) -> None:
    """Raise `ValueError` where the inputs of a triangulation contradict each other."""
    if score.ndim != 2 or len(score) != len(cameras) or xy.shape != (*score.shape, 2):
        raise ValueError(
            f"expected xy (C, N, 2) and score (C, N) with C = {len(cameras)} cameras, "
            f"found {xy.shape} and {score.shape}"
        )
    if min_views < 2:
        raise ValueError(f"expected min_views of 2 or more, found {min_views}")


def _solve(
    cameras: Sequence[Camera],
    xy: NDArray,
    score: NDArray,
    *,
    min_views: int,
    min_score: float,
    limit_px: NDArray,
    fade_px: NDArray,
    weak_m: float,
) -> Triangulated:
    seen = np.isfinite(xy).all(axis=-1) & np.isfinite(score) & (score > 0)
    weight = np.where(seen & (score >= min_score), score, 0.0)
    found = _weighted(cameras, xy, weight, min_views, limit_px, fade_px, limit_px)
    spread_m = spread(found)
    weak = np.flatnonzero((spread_m > weak_m) & (seen.sum(axis=0) > 2))
    if not len(weak):
        return found
    root = np.sqrt(np.where(seen, score, 0.0)[:, weak])
    wider = np.clip(np.nan_to_num(score[:, weak]), LEAST_SCORE, 1.0) ** -WIDER
    limits_px = limit_px[:, weak] * wider, fade_px[:, weak] * wider
    again = _weighted(cameras, xy[:, weak], root, min_views, *limits_px, limit_px[:, weak])
    better = spread(again) < BETTER * spread_m[weak]
    return _replaced(found, weak[better], again, better)


def _weighted(
    cameras: Sequence[Camera],
    xy: NDArray,
    weight: NDArray,
    min_views: int,
    limit_px: NDArray,
    fade_px: NDArray,
    sigma_px: NDArray,
) -> Triangulated:
    """Triangulate with these weights (C, N), 0 for a view that is not used.

    `sigma_px` (C, N) is the standard deviation of a keypoint of weight 1, for the covariance.
    """
    views = Views(cameras, xy, weight)
    xyz = np.full((xy.shape[1], 3), np.nan)
    accepted = np.zeros(weight.shape, dtype=bool)
    at = np.flatnonzero((weight > 0).sum(axis=0) >= min_views)
    if len(at):
        found = _select_and_refine(views.of(at), limit_px[:, at], fade_px[:, at], min_views)
        xyz[at], accepted[:, at] = found
    covariance = _noise_covariance(views, xyz, accepted, sigma_px)
    return Triangulated(xyz, covariance, accepted, _reprojection_px(cameras, xy, xyz), weight)


def spread(found: Triangulated) -> NDArray:
    """Return the standard deviation (N,) m of points by keypoints of the usual error.

    NaN where missing; infinite where the views leave a direction open.
    """
    spread_m = USUAL * np.sqrt(np.trace(found.covariance, axis1=1, axis2=2))
    return np.where(np.isnan(spread_m) & np.isfinite(found.xyz[:, 0]), np.inf, spread_m)


def _replaced(
    found: Triangulated, at: NDArray, other: Triangulated, which: NDArray
) -> Triangulated:
    """Put the points `which` of another triangulation at the indices `at`."""
    result = {name: values.copy() for name, values in vars(found).items()}
    for name in ("xyz", "covariance"):
        result[name][at] = getattr(other, name)[which]
    for name in ("accepted", "error_px", "weight"):
        result[name][:, at] = getattr(other, name)[:, which]
    return Triangulated(**result)


def _select_and_refine(
    views: Views, limit_px: NDArray, fade_px: NDArray, min_views: int
) -> tuple[NDArray, NDArray]:
    """Return points (N, 3), NaN where views disagree, and accepted views (C, N).

    `limit_px` and `fade_px` are (C, N).
    """
    xyz, usable, widest_px = _linear(views), views.weight > 0, WIDEST * limit_px
    bad = np.flatnonzero(((views.residuals(xyz).distance > limit_px) & usable).any(axis=0))
    if len(bad):
        worst, last_px, times = views.of(bad), fade_px[:, bad], START
        while times > 1:
            xyz[bad] = _faded_step(worst, xyz[bad], times * last_px, np.inf)
            times /= GRADUATION
    for _ in range(SETTLING):
        xyz = _faded_step(views, xyz, fade_px, widest_px)
    there = views.residuals(xyz)
    accepted = _accept(there.distance, usable, limit_px, min_views)
    fine = (accepted.sum(axis=0) >= min_views) & there.in_front(accepted)
    xyz[~fine] = np.nan
    return xyz, accepted & fine


def _linear(views: Views) -> NDArray:
    """Return points (N, 3) by weighted DLT, then one step of least squares."""
    slopes = views.px_per_plane
    area_px2 = np.abs(slopes[:, 0, 0] * slopes[:, 1, 1] - slopes[:, 0, 1] * slopes[:, 1, 0])
    xyz = triangulate(views.xy.mT, np.sqrt(views.weight * area_px2), views.matrix)
    return views.stepped(xyz, views.weight)


def _accept(error: NDArray, usable: NDArray, limit_px: NDArray, min_views: int) -> NDArray:
    """Accept views within the limit; where these are too few, the closest up to `WIDEST` limits."""
    limits = np.where(usable, error / limit_px, np.inf)
    enough = np.sort(limits, axis=0)[min_views - 1]
    return limits <= np.clip(enough, 1.0, WIDEST)


def _faded_step(
    views: Views, xyz: NDArray, scale_px: NDArray, widest_px: NDArray | float
) -> NDArray:
    """Return points after a step with Geman-McClure weights: at `scale_px` a quarter is left."""
    there = views.residuals(xyz)
    square = there.distance**2
    weight = views.weight / (1 + square / scale_px**2) ** 2 * (there.distance <= widest_px)
    return views.stepped(xyz, weight, there)


def _noise_covariance(
    views: Views, xyz: NDArray, accepted: NDArray, sigma_px: NDArray | float
) -> NDArray:
    """Return the covariance (N, 3, 3) m2 of points by the noise of their `accepted` views (C, N).

    `sigma_px` is that of a keypoint of weight 1, per axis. It may differ between views: weights are
    by score alone, and a point follows the near view with its larger errors.
    """
    rows, depth = views.jacobians(views.residuals(np.nan_to_num(xyz)).in_cam)
    weight = views.weight * accepted / depth**2
    # A camera that never sees a person may have no limit for it.
    variance = np.where(accepted, weight * np.square(sigma_px), 0.0)
    inverse = inverse_3x3(_normal(rows, weight))
    return inverse @ _normal(rows, variance) @ inverse


def _reprojection_px(cameras: Sequence[Camera], xy: NDArray, xyz: NDArray) -> NDArray:
    """Return the distance (C, N) px of keypoints to projected points."""
    projected = np.stack([project(camera, xyz) for camera in cameras])
    return np.linalg.norm(projected - xy, axis=-1)


@dataclass(frozen=True)
class Residuals:
    """How keypoints of C cameras differ from N points. Points come last: sums run along them."""

    px: NDArray  # (C, 2, N)
    in_cam: NDArray  # (C, 3, N) m: the points in each camera

    @cached_property
    def distance(self) -> NDArray:
        """Distance (C, N) px of keypoints to the projected points."""
        return np.sqrt(self.px[:, 0] ** 2 + self.px[:, 1] ** 2)

    def in_front(self, which: NDArray) -> NDArray:
        """Return which points (N,) are in front of all cameras that `which` (C, N) names."""
        return ((self.in_cam[:, 2] > 0) | ~which).all(axis=0)


class Views:
    """Views of N points by C cameras, of keypoints (C, N, 2) px.

    Their `weight` (C, N) is in px^-2, 1 for score 1.

    Residuals are on the undistorted plane, times the slopes of the lens at the keypoint: to first
    order they are px of the picture, as the noise of keypoints is.
    """

    def __init__(self, cameras: Sequence[Camera], xy: NDArray, weight: NDArray) -> None:
        plane = np.stack([undistort(c, points) for c, points in zip(cameras, xy, strict=True)])
        self.weight = np.where(np.isfinite(plane).all(axis=-1), weight, 0.0)
        plane = np.nan_to_num(plane)
        self.xy = np.ascontiguousarray(plane.mT)  # (C, 2, N) on the undistorted plane
        self.matrix = np.stack([camera.cam_from_world for camera in cameras])
        slopes = [picture_slopes(*pair) for pair in zip(cameras, plane, strict=True)]
        # (C, 2, 2, N) px: the derivative of places in the picture by those on the plane.
        self.px_per_plane = np.ascontiguousarray(np.moveaxis(np.stack(slopes), 1, -1))

    def of(self, at: NDArray) -> Views:
        """Return the same views of some of the points only."""
        part = object.__new__(Views)
        part.xy, part.weight, part.matrix = self.xy[..., at], self.weight[:, at], self.matrix
        part.px_per_plane = self.px_per_plane[..., at]
        return part

    def residuals(self, xyz: NDArray) -> Residuals:
        """Return the residuals of points (N, 3)."""
        in_cam = self.matrix[:, :, :3] @ xyz.T + self.matrix[:, :, 3:]
        depth = np.where(np.abs(in_cam[:, 2:]) < 1e-9, 1e-9, in_cam[:, 2:])
        plane = in_cam[:, :2] / depth - self.xy
        return Residuals(self._in_picture(plane[:, :, None])[:, :, 0], in_cam)

    def jacobians(self, in_cam: NDArray) -> tuple[NDArray, NDArray]:
        """Return the derivative of residuals by points, times depth, and the depth (C, N) m.

        The derivative is (C, 2, 3, N) px. NaN for a point at a camera, where two cameras in one
        place put it.
        """
        depth = np.where(in_cam[:, 2] == 0, np.nan, in_cam[:, 2])
        ratio = (in_cam[:, :2] / depth[:, None])[:, :, None]
        rows = ratio * -self.matrix[:, None, 2, :3, None]
        rows += self.matrix[:, :2, :3, None]
        return self._in_picture(rows), depth

    def _in_picture(self, plane: NDArray) -> NDArray:
        """Return columns (C, 2, K, N) of small steps on the undistorted plane in px."""
        steps = self.px_per_plane[:, :, 0, None] * plane[:, :1]
        steps += self.px_per_plane[:, :, 1, None] * plane[:, 1:]
        return steps

    def stepped(self, xyz: NDArray, weight: NDArray, there: Residuals | None = None) -> NDArray:
        """Return points (N, 3) after a Gauss-Newton step; one whose system is singular stays.

        `there` are their residuals, if they are known.
        """
        there = there or self.residuals(xyz)
        rows, depth = self.jacobians(there.in_cam)
        by_depth = weight / depth
        right = np.einsum("cikn,cin->nk", rows, there.px * by_depth[:, None])
        step = solve_3x3(_normal(rows, by_depth / depth), right)
        return xyz - np.where(np.isfinite(step), step, 0.0)


def _normal(rows: NDArray, weight: NDArray) -> NDArray:
    """Return the normal matrices (N, K, K) of rows (C, 2, K, N) and weights (C, N)."""
    size, weighted = rows.shape[2], rows * weight[:, None, None]
    square = np.empty((size, size, rows.shape[-1]))
    for i in range(size):
        for j in range(i, size):
            square[i, j] = square[j, i] = np.einsum("cin,cin->n", rows[:, :, i], weighted[:, :, j])
    return square.transpose(2, 0, 1)


def triangulate_plain(
    cameras: Sequence[Camera],
    xy: NDArray,
    score: NDArray,
    *,
    min_views: int = 2,
    min_score: float = 0.0,
) -> Triangulated:
    """Triangulate points by a DLT over all views that see them, without weights.

    The parameters are those of `triangulate_robust`, but `score` selects views and does not weigh
    them: `accepted` are all views used, and `covariance` is for 1 px of noise in each.

    [Shishido2020, section 2]; Hartley & Zisserman 2004, sec. 12.2. The covariance is that of the
    least-squares point in the pictures, to which a DLT is close if the cameras are about equally
    far.
    """
    _check(cameras, xy, score, min_views)
    return _in_batches(
        score.shape, lambda at: _plain(cameras, xy[:, at], score[:, at], min_views, min_score)
    )


def _plain(
    cameras: Sequence[Camera], xy: NDArray, score: NDArray, min_views: int, min_score: float
) -> Triangulated:
    used = np.isfinite(xy).all(axis=-1) & np.isfinite(score) & (score >= min_score) & (score > 0)
    used &= used.sum(axis=0) >= min_views
    views = Views(cameras, xy, used.astype(float))
    xyz = triangulate(views.xy.mT, views.weight, views.matrix)
    return Triangulated(
        xyz=xyz,
        covariance=_noise_covariance(views, xyz, used, 1.0),
        accepted=(views.weight > 0) & np.isfinite(xyz[:, 0]),
        error_px=_reprojection_px(cameras, xy, xyz),
        weight=views.weight,
    )


def solve_3x3(matrix: NDArray, right: NDArray) -> NDArray:
    """Solve symmetric (N, 3, 3) systems for (N, 3) right sides; NaN where singular."""
    return np.einsum("nij,nj->ni", inverse_3x3(matrix), right)


def inverse_3x3(matrix: NDArray) -> NDArray:
    """Invert symmetric (N, 3, 3) matrices by cofactors; NaN where singular."""
    a, b, c = matrix[:, 0, 0], matrix[:, 0, 1], matrix[:, 0, 2]
    d, e, f = matrix[:, 1, 1], matrix[:, 1, 2], matrix[:, 2, 2]
    cofactor = np.empty_like(matrix)
    cofactor[:, 0, 0], cofactor[:, 1, 1] = d * f - e * e, a * f - c * c
    cofactor[:, 2, 2] = a * d - b * b
    cofactor[:, 0, 1] = cofactor[:, 1, 0] = c * e - b * f
    cofactor[:, 0, 2] = cofactor[:, 2, 0] = b * e - c * d
    cofactor[:, 1, 2] = cofactor[:, 2, 1] = b * c - a * e
    determinant = a * cofactor[:, 0, 0] + b * cofactor[:, 0, 1] + c * cofactor[:, 0, 2]
    scale = (a + d + f) / 3
    singular = ~(np.abs(determinant) > 1e-12 * scale**3)
    return cofactor / np.where(singular, np.nan, determinant)[:, None, None]
