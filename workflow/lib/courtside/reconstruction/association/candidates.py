"""Candidates for one person in two cameras: how well two tracklets agree."""

from dataclasses import dataclass

import numpy as np

from courtside.geometry import camera as camera_models
from courtside.geometry import triangulation as small_matrices

GATE = 4.0  # standard deviations: a view further off does not see this person
VIEW_GAIN = 3.0  # log-likelihood that one more view that agrees is worth
SURE = -4.0  # cost of places that three views or more agree on
RAY_GAIN = 1.0  # what a row that no other view confirms is worth
SIZE_SPREAD = 0.2  # of body heights computed from several views, as log ratio
BODY_M = (0.4, 2.8)  # heights of bodies from crouching to arms up
LOOSEST_M = 0.5  # places less certain than this are dropped: views from opposite sides say little about depth
WORST = 4.5  # cost of a view is cut off here, so that one bad view costs no more than it can bring


@dataclass(frozen=True)
class Candidates:
    """M places and rays, ordered by instant.

    Attributes
    ----------
    instant : (M,) int
    xyz : (M, 3) float
        The place, or where the ray begins, metres.
    direction : (M, 3) float
        Unit vector along the ray; zero for a place.
    row : (M, C) int
        Which row of each camera shows it, -1 none.
    sigma_m : (M,) float
        Standard deviation of the place in its least certain directions together; of a ray, across it and
        per metre from its beginning.
    view_cost : (M, C) float
        Negative log-likelihood against nobody being there, by view: the lower the likelier; 0 without one.
    """

    instant: np.ndarray
    xyz: np.ndarray
    direction: np.ndarray
    row: np.ndarray
    sigma_m: np.ndarray
    view_cost: np.ndarray

    def of(self, kept):
        """Return some of the candidates only."""
        return Candidates(**{name: value[kept] for name, value in vars(self).items()})

    @property
    def is_ray(self):
        """Whether each one is a ray, (M,) bool."""
        return self.direction.any(axis=1)


def together(parts):
    """Return the candidates of several lists as one, ordered by instant."""
    every = {
        name: np.concatenate([getattr(part, name) for part in parts]) for name in vars(parts[0])
    }
    return Candidates(**every).of(np.argsort(every["instant"], kind="stable"))


def find(cameras, xy, rows, height_px, mirror=None):
    """Find all places where rows of two or more views meet.

    Parameters
    ----------
    cameras : list of Camera, length C
    xy : list of (P, N, J, 2) float, length C
        Keypoints at N instants, px, distorted; NaN where missing.
    rows : list of ((P, N, 2) float, (P,) float), length C
        Centres and standard deviations of `associate.Rows` at these instants.
    height_px : list of (P, N) float, length C
    mirror : list of int, length J, optional
        The same joint of the other side: a network that takes left for right sees the same person.

    Returns
    -------
    candidates : Candidates

    Notes
    -----
    Seeds are pairs of rows of two views whose median joint-to-epipolar-line distance is within the gate.
    Other views join where they show a body at the projected centre. Cost grows with the square of the
    number of cameras, not with the number of combinations of rows.
    """
    plane = [
        camera_models.undistort(camera, points) for camera, points in zip(cameras, xy, strict=True)
    ]
    pairs = of_pairs(cameras, plane, [sigma for _, sigma in rows], mirror)
    instant, row = _seeds(pairs, len(cameras))
    centres = [centre for centre, _ in rows]
    views = _Views(cameras, centres, [sigma for _, sigma in rows], height_px)
    found = _judge(views, pairs, instant, views.joined(instant, row))
    # Without the views that speak against a place, what is left may be the place of somebody hidden there.
    better = np.where(found.view_cost < 0, found.row, -1)
    less = (better != found.row).any(axis=1) & ((better >= 0).sum(axis=1) >= 2)
    if not less.any():
        return found
    return _judge(
        views,
        pairs,
        np.concatenate([found.instant, found.instant[less]]),
        np.concatenate([found.row, better[less]]),
    )


def _judge(views, pairs, instant, row):
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
    agree = error**2 + bend**2 + of_views(pairs, instant, row, 2 * GATE) ** 2
    cost = np.where(row >= 0, np.minimum(0.5 * agree, WORST) - VIEW_GAIN, 0.0)
    return Candidates(instant, xyz, np.zeros_like(xyz), row, sigma_m, cost).of(kept)


def rays(cameras, rows, places):
    """Return the rows of each camera that no three views explain as rays.

    Parameters
    ----------
    cameras, rows
        As for `find`.
    places : Candidates
        From `find`.

    Returns
    -------
    candidates : Candidates
    """
    parts = []
    sure = places.of(((places.row >= 0).sum(axis=1) >= 3) & (places.view_cost.sum(axis=1) < SURE))
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
                sigma_m=sigma_px[seen] / focal_px(camera),
                view_cost=np.where(row >= 0, -RAY_GAIN, 0.0),
            )
        )
    return together(parts)


def _seeds(pairs, n_cameras):
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

    def __init__(self, cameras, centres, sigma_px, height_px):
        self.cameras, self.centres = cameras, centres
        self.sigma_px, self.height_px = sigma_px, height_px
        self.plane = [
            camera_models.undistort(k, xy) for k, xy in zip(cameras, centres, strict=True)
        ]
        self.matrix = np.stack([camera.cam_from_world for camera in cameras])

    def place(self, instant, row):
        """Return the triangulated centres (M, 3) of rows (M, C)."""
        xy = np.stack([p[row[:, c], instant] for c, p in enumerate(self.plane)])
        weight = np.where(row.T >= 0, 1.0, 0.0)
        if not len(instant):
            return np.zeros((0, 3))
        return small_matrices.triangulate(xy, weight, self.matrix)

    def joined(self, instant, row):
        """Return rows (M, C) with those of other views that show a body where the seed says."""
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

    def compare(self, instant, row, xyz):
        """Return errors (M, C) in standard deviations, inf without a row, and body heights (M, C) in m."""
        error, size_m = np.full(row.shape, np.inf), np.full(row.shape, np.nan)
        for c, camera in enumerate(self.cameras):
            off = self.centres[c][row[:, c], instant] - camera_models.project(camera, xyz)
            off = np.linalg.norm(off, axis=-1) / self.sigma_px[c][row[:, c]]
            error[:, c] = np.where(row[:, c] >= 0, np.nan_to_num(off, nan=np.inf), np.inf)
            depth_m = xyz @ camera.cam_from_world[2, :3] + camera.cam_from_world[2, 3]
            size_m[:, c] = self.height_px[c][row[:, c], instant] * depth_m / focal_px(camera)
        return error, size_m

    def spread(self, row, xyz):
        """Return the standard deviation (M,) of places seen by rows (M, C), m; inf where unbounded."""
        square = np.zeros((len(row), 3, 3))
        for c, camera in enumerate(self.cameras):
            ray = xyz - camera.centre_in_world
            far_m = np.linalg.norm(ray, axis=1)
            sigma_m = np.maximum(self.sigma_px[c][row[:, c]], 1e-9) * far_m / focal_px(camera)
            ray = ray / far_m[:, None]
            across = np.eye(3) - ray[:, :, None] * ray[:, None]
            square += across * np.where(row[:, c] >= 0, sigma_m**-2, 0.0)[:, None, None]
        variance = np.trace(small_matrices.inverse_3x3(square), axis1=1, axis2=2)
        return np.sqrt(np.nan_to_num(variance, nan=np.inf))


def of_pairs(cameras, plane, sigma_px, mirror=None):
    """Return the robust distances between all rows of all pairs of views.

    Parameters
    ----------
    cameras : list of Camera, length C
    plane : list of (P, N, J, 2) float, length C
        Keypoints on the undistorted, normalised plane; NaN where missing.
    sigma_px : list of (P,) float, length C
        Standard deviation of a joint of each row.
    mirror : list of int, length J, optional
        The same joint of the other side: then the closer of both readings counts.

    Returns
    -------
    distance : dict of (int, int) to (P, Q, N) float
        By pair of views, in standard deviations.
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


def epipolar_distance(first, second, one, other):
    """Return the robust distance between bodies of two views.

    Parameters
    ----------
    first, second : Camera
    one, other : (P, N, J, 2), (Q, N, J, 2) float
        Keypoints on the undistorted, normalised plane; NaN where missing.

    Returns
    -------
    distance_px : (P, Q, N) float
        Median over joints of the mean distance to the other view's epipolar lines; inf where fewer than
        three joints are seen in both.

    Notes
    -----
    Hartley & Zisserman 2004, sec. 9.1 and 11.1.
    """
    rotation = second.cam_from_world[:, :3] @ first.cam_from_world[:, :3].T
    x, y, z = second.cam_from_world[:, 3] - rotation @ first.cam_from_world[:, 3]
    essential = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ rotation
    in_second = (
        one @ essential[:, :2].T + essential[:, 2]
    )  # lines of one's joints in the second view
    in_first = other @ essential[:2] + essential[2]
    scale_second = focal_px(second) / np.hypot(in_second[..., 0], in_second[..., 1])
    scale_first = focal_px(first) / np.hypot(in_first[..., 0], in_first[..., 1])
    product = np.abs(
        in_second[:, None, ..., 0] * other[None, ..., 0]
        + in_second[:, None, ..., 1] * other[None, ..., 1]
        + in_second[:, None, ..., 2]
    )
    distance = product * (scale_second[:, None] + scale_first[None]) / 2
    return _median(distance)


def focal_px(camera):
    """Return the mean of both focal lengths, px."""
    return (camera.K[0, 0] + camera.K[1, 1]) / 2


def _median(distance):
    """Return the median over the last axis without NaN, inf where fewer than three are known."""
    ordered = np.sort(distance, axis=-1)
    count = np.isfinite(ordered).sum(axis=-1)
    middle = np.take_along_axis(ordered, np.maximum(count - 1, 0)[..., None] // 2, axis=-1)[..., 0]
    return np.where(count >= 3, middle, np.inf)


def of_views(pairs, instant, row, most):
    """Return how far each view of a candidate is from its other views on the average.

    Parameters
    ----------
    pairs : dict of (int, int) to (P, Q, N) float
        From `of_pairs`.
    instant : (M,) int
    row : (M, C) int
        Row of each camera, -1 for none.
    most : float
        Distances are cut off here.

    Returns
    -------
    distance : (M, C) float
        Zero for a view without a row.
    """
    total, count = np.zeros(row.shape), np.zeros(row.shape)
    for (c, d), distance in pairs.items():
        both = (row[:, c] >= 0) & (row[:, d] >= 0)
        value = np.minimum(distance[row[both, c], row[both, d], instant[both]], most)
        for view in (c, d):
            total[both, view] += value
            count[both, view] += 1
    return total / np.maximum(count, 1)
