"""Candidate positions of a person: agreeing rows of two cameras or more, rays of single rows."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry import epipolar, triangulation
from courtside.geometry.camera import Camera
from courtside.geometry.rotations import cross_matrices

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
GATE = 4.0  # standard deviations: a view further off does not see this person
VIEW_GAIN = 3.0  # log-likelihood gained by one more view that agrees
SURE = -4.0  # places of three or more views with a lower cost explain their rows
RAY_GAIN = 1.0  # log-likelihood gained by a row that no other view confirms
SIZE_SPREAD = 0.2  # standard deviation of body heights from several views, as log ratio
# Standard deviations: limit, so that size alone does not part views. A camera above sees bodies
# shorter than a level one does.
SIZE_MOST = 2.0
BODY_M = (0.4, 2.8)  # heights of bodies from crouching to arms up, lengths of those who lie
# Less certain places are dropped: views from opposite sides hardly measure depth.
LOOSEST_M = 0.5
WORST = 4.5  # limit of a view's cost, so that one bad view costs little more than it can gain

# Centres (P, N, 2) and standard deviations (P,) of the rows of each camera.
ViewRows = Sequence[tuple[NDArray, NDArray]]
# Distances (P, Q, N) by pair of cameras.
PairDistances = dict[tuple[int, int], NDArray]
# From instants (M,) and rows (M, C), -1 for none, to costs (M, C) of views against the others.
ViewCost = Callable[[NDArray, NDArray], NDArray]


@dataclass(frozen=True)
class Candidates:
    """M places and rays, ordered by instant."""

    instant: NDArray  # (M,) int
    xyz: NDArray  # (M, 3): the place, or the origin of the ray, metres
    direction: NDArray  # (M, 3): unit vector along the ray; zero for a place
    row: NDArray  # (M, C): row of each camera that shows it; -1 for none
    # (M,): standard deviation of the place, all axes together; of a ray, across it per metre
    sigma_m: NDArray
    # (M, C): negative log-likelihood against nobody being there, per view; 0 without one
    view_cost: NDArray

    def subset(self, kept: NDArray) -> "Candidates":
        """Return only the candidates of an index or mask."""
        return Candidates(**{name: value[kept] for name, value in vars(self).items()})

    @property
    def is_ray(self) -> NDArray:
        """Whether each one is a ray, (M,) bool."""
        return np.any(self.direction, axis=1)


def concatenate(parts: Sequence[Candidates]) -> Candidates:
    """Concatenate candidates, ordered by instant."""
    every = {
        name: np.concatenate([getattr(part, name) for part in parts]) for name in vars(parts[0])
    }
    return Candidates(**every).subset(np.argsort(every["instant"], kind="stable"))


def find(
    cameras: Sequence[Camera],
    xy: Sequence[NDArray],
    rows: ViewRows,
    height_px: Sequence[NDArray],
    mirror: Sequence[int] | None = None,
    more: ViewCost | None = None,
) -> Candidates:
    """Find all positions where rows of two or more views meet.

    `xy` has keypoints (P, N, J, 2) of each camera at N instants, distorted px, NaN where missing;
    `rows` and `height_px` the centres and standard deviations, and heights (P, N), of `rows.Rows`
    there. With `mirror` (J,), the same joint of the other side, confused sides are still one
    person. `more` gives costs of views besides those of geometry.

    Seeds are pairs of rows of two views whose median distance from joint to epipolar line is within
    the gate. Other views join if they show a body at the projected centre. The effort grows with
    the square of the number of cameras, not with the number of combinations of rows.
    """
    plane = [
        camera_models.undistort(camera, points) for camera, points in zip(cameras, xy, strict=True)
    ]
    pairs = pair_distances(cameras, plane, [sigma for _, sigma in rows], mirror)
    instant, row = _seeds(pairs, len(cameras))
    centres = [centre for centre, _ in rows]
    views = _Views(cameras, centres, [sigma for _, sigma in rows], height_px)
    found = _judge(views, pairs, instant, views.joined(instant, row), more)
    # Without the views that contradict a place, the rest may be somebody hidden in those views.
    better = np.where(found.view_cost < 0, found.row, -1)
    less = (better != found.row).any(axis=1) & ((better >= 0).sum(axis=1) >= 2)
    if not less.any():
        return found
    return _judge(
        views,
        pairs,
        np.concatenate([found.instant, found.instant[less]]),
        np.concatenate([found.row, better[less]]),
        more,
    )


def _judge(
    views: "_Views", pairs: PairDistances, instant: NDArray, row: NDArray, more: ViewCost | None
) -> Candidates:
    """Return the candidates of rows (M, C), each once."""
    code = np.unique(np.column_stack([instant, row]), axis=0)
    instant, row = code[:, 0], code[:, 1:]
    xyz = views.place(instant, row)
    error, size_m = views.compare(instant, row, xyz)
    row = np.where(error <= GATE, row, -1)
    sigma_m = views.spread(row, xyz)
    kept = ((row >= 0).sum(axis=1) >= 2) & np.isfinite(xyz).all(axis=1) & (sigma_m < LOOSEST_M)
    size = np.where((row >= 0) & kept[:, None], np.maximum(size_m, 1e-3), np.nan)
    count = np.maximum(np.isfinite(size).sum(axis=1), 1)
    middle = np.nansum(np.log(size), axis=1) / count
    kept &= (middle >= np.log(BODY_M[0])) & (middle <= np.log(BODY_M[1]))
    bend = np.nan_to_num((np.log(size) - middle[:, None]) / SIZE_SPREAD)
    bend = np.clip(bend, -SIZE_MOST, SIZE_MOST)
    agree = error**2 + bend**2 + view_distances(pairs, instant, row, 2 * GATE) ** 2
    cost = np.minimum(0.5 * agree, WORST) - VIEW_GAIN + (more(instant, row) if more else 0.0)
    cost = np.where(row >= 0, cost, 0.0)
    return Candidates(instant, xyz, np.zeros_like(xyz), row, sigma_m, cost).subset(kept)


def is_sure(places: Candidates) -> NDArray:
    """Return the positions (M,) on which three views or more agree, bool."""
    return ((places.row >= 0).sum(axis=1) >= 3) & (places.view_cost.sum(axis=1) < SURE)


def rays(cameras: Sequence[Camera], rows: ViewRows, places: Candidates) -> Candidates:
    """Return as rays all rows that no position from three or more views explains."""
    parts = []
    sure = places.subset(is_sure(places))
    for c, (camera, (centre, sigma_px)) in enumerate(zip(cameras, rows, strict=True)):
        open_ = np.isfinite(centre[..., 0])
        shown = sure.row[:, c] >= 0
        open_[sure.row[shown, c], sure.instant[shown]] = False
        seen, instant = np.nonzero(open_)
        plane = camera_models.undistort(camera, centre[seen, instant])
        known = np.isfinite(plane).all(axis=1)
        seen, instant, plane = seen[known], instant[known], plane[known]
        toward = np.column_stack([plane, np.ones(len(plane))]) @ camera.cam_from_world[:, :3]
        row = np.full((len(seen), len(cameras)), -1)
        row[:, c] = seen
        parts.append(
            Candidates(
                instant=instant,
                xyz=np.tile(camera.centre_in_world, (len(seen), 1)),
                direction=toward / np.linalg.norm(toward, axis=1, keepdims=True),
                row=row,
                sigma_m=sigma_px[seen] / epipolar.focal_px(camera),
                view_cost=np.where(row >= 0, -RAY_GAIN, 0.0),
            )
        )
    return concatenate(parts)


def _seeds(pairs: PairDistances, n_cameras: int) -> tuple[NDArray, NDArray]:
    """Return instants (S,) and rows (S, C) of all pairs of views that agree."""
    instants, rows = [np.zeros(0, int)], [np.zeros((0, n_cameras), int)]
    for (c, d), distance in pairs.items():
        a, b, at = np.nonzero(distance <= GATE)
        row = np.full((len(at), n_cameras), -1)
        row[:, c], row[:, d] = a, b
        instants.append(at)
        rows.append(row)
    return np.concatenate(instants), np.concatenate(rows)


class _Views:
    """Body centres of C cameras at N instants."""

    def __init__(self, cameras, centres, sigma_px, height_px) -> None:
        self.cameras, self.centres = cameras, centres
        self.sigma_px, self.height_px = sigma_px, height_px
        self.plane = [
            camera_models.undistort(k, xy) for k, xy in zip(cameras, centres, strict=True)
        ]
        self.matrix = np.stack([camera.cam_from_world for camera in cameras])

    def place(self, instant: NDArray, row: NDArray) -> NDArray:
        """Return the triangulated centres (M, 3) of rows (M, C)."""
        xy = np.stack([p[row[:, c], instant] for c, p in enumerate(self.plane)])
        weight = np.where(row.T >= 0, 1.0, 0.0)
        if not len(instant):
            return np.zeros((0, 3))
        return triangulation.triangulate(xy, weight, self.matrix)

    def joined(self, instant: NDArray, row: NDArray) -> NDArray:
        """Return rows (M, C) with those of other views that show a body at the seed's place."""
        xyz, row = self.place(instant, row), row.copy()
        for c, camera in enumerate(self.cameras):
            off = np.linalg.norm(
                self.centres[c][:, instant] - camera_models.project(camera, xyz), axis=-1
            )
            off = np.nan_to_num(off / self.sigma_px[c][:, None], nan=np.inf)
            best = np.argmin(off, axis=0)
            near = off[best, np.arange(len(best))] <= GATE
            row[:, c] = np.where(row[:, c] >= 0, row[:, c], np.where(near, best, -1))
        return row

    def compare(self, instant: NDArray, row: NDArray, xyz: NDArray) -> tuple[NDArray, NDArray]:
        """Return errors (M, C) in standard deviations and body heights (M, C) in metres.

        Without a row the error is inf.
        """
        error, size_m = np.full(row.shape, np.inf), np.full(row.shape, np.nan)
        for c, camera in enumerate(self.cameras):
            off = self.centres[c][row[:, c], instant] - camera_models.project(camera, xyz)
            off = np.linalg.norm(off, axis=-1) / self.sigma_px[c][row[:, c]]
            error[:, c] = np.where(row[:, c] >= 0, np.nan_to_num(off, nan=np.inf), np.inf)
            depth_m = xyz @ camera.cam_from_world[2, :3] + camera.cam_from_world[2, 3]
            size_m[:, c] = (
                self.height_px[c][row[:, c], instant] * depth_m / epipolar.focal_px(camera)
            )
        return error, size_m

    def spread(self, row: NDArray, xyz: NDArray) -> NDArray:
        """Return the standard deviation (M,), m, of places seen by rows; inf if unbounded."""
        square = np.zeros((len(row), 3, 3))
        for c, camera in enumerate(self.cameras):
            ray = xyz - camera.centre_in_world
            far_m = np.linalg.norm(ray, axis=1)
            sigma_m = (
                np.maximum(self.sigma_px[c][row[:, c]], 1e-9) * far_m / epipolar.focal_px(camera)
            )
            ray = ray / far_m[:, None]
            across = np.eye(3) - ray[:, :, None] * ray[:, None]
            square += across * np.where(row[:, c] >= 0, sigma_m**-2, 0.0)[:, None, None]
        variance = np.trace(triangulation.inverse_3x3(square), axis1=1, axis2=2)
        return np.sqrt(np.nan_to_num(variance, nan=np.inf))


def pair_distances(
    cameras: Sequence[Camera],
    plane: Sequence[NDArray],
    sigma_px: Sequence[NDArray],
    mirror: Sequence[int] | None = None,
) -> PairDistances:
    """Return the robust distances between all rows of all pairs of views, in standard deviations.

    `plane` holds keypoints (P, N, J, 2) on the undistorted, normalised plane, NaN where missing;
    `sigma_px` the standard deviation (P,) of a joint of each row. With `mirror`, the same joint of
    the other side (J,), the smaller of both distances counts.
    """
    found = {}
    for c in range(len(cameras)):
        for d in range(c + 1, len(cameras)):
            spread_px = (sigma_px[c][:, None] + sigma_px[d]) / 2
            distance = epipolar_distance(cameras[c], cameras[d], plane[c], plane[d])
            if mirror is not None:
                turned = plane[d][:, :, mirror]
                other = epipolar_distance(cameras[c], cameras[d], plane[c], turned)
                distance = np.minimum(distance, other)
            found[c, d] = distance / np.maximum(spread_px, 1e-9)[..., None]
    return found


def epipolar_distance(first: Camera, second: Camera, one: NDArray, other: NDArray) -> NDArray:
    """Return the robust distance (P, Q, N), px, between bodies of two views.

    It is the median over joints of the mean distance to the other view's epipolar lines (Hartley &
    Zisserman 2004, sec. 9.1 and 11.1), inf where fewer than three joints are seen in both. `one`
    (P, N, J, 2) and `other` (Q, N, J, 2) are on the undistorted, normalised plane; NaN if missing.
    """
    rotation, shift = epipolar.relative_pose(first, second)
    essential = cross_matrices(shift) @ rotation
    # Epipolar lines of one view's joints in the other view.
    in_second = one @ essential[:, :2].T + essential[:, 2]
    in_first = other @ essential[:2] + essential[2]
    scale_second = epipolar.focal_px(second) / np.hypot(in_second[..., 0], in_second[..., 1])
    scale_first = epipolar.focal_px(first) / np.hypot(in_first[..., 0], in_first[..., 1])
    product = np.abs(
        in_second[:, None, ..., 0] * other[None, ..., 0]
        + in_second[:, None, ..., 1] * other[None, ..., 1]
        + in_second[:, None, ..., 2]
    )
    distance = product * (scale_second[:, None] + scale_first[None]) / 2
    return _median(distance)


def _median(distance: NDArray) -> NDArray:
    """Return the median over the last axis without NaN; inf if fewer than three are known."""
    ordered = np.sort(distance, axis=-1)
    count = np.isfinite(ordered).sum(axis=-1)
    middle = np.take_along_axis(ordered, np.maximum(count - 1, 0)[..., None] // 2, axis=-1)[..., 0]
    return np.where(count >= 3, middle, np.inf)


def view_distances(pairs: PairDistances, instant: NDArray, row: NDArray, most: float) -> NDArray:
    """Return the mean distance (M, C) of each view of a candidate to its other views.

    `pairs` come from `pair_distances`, `row` (M, C) is -1 for none; distances are cut at `most`.
    The result is zero for a view without a row.
    """
    total, count = np.zeros(row.shape), np.zeros(row.shape)
    for (c, d), distance in pairs.items():
        both = (row[:, c] >= 0) & (row[:, d] >= 0)
        value = np.minimum(distance[row[both, c], row[both, d], instant[both]], most)
        for view in (c, d):
            total[both, view] += value
            count[both, view] += 1
    return total / np.maximum(count, 1)
