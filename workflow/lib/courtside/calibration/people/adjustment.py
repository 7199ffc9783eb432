"""Cameras refined by people: joints as free points, adjusted together with all cameras.

Every joint in every frame is a point of its own, eliminated from the normal equations: the cost is
linear in frames. People do not tell where the world begins, how it is turned and how large it is:
what is known of the cameras before, or court points, hold that.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle import conversion, problem, selection, solver
from courtside.calibration.bundle.problem import POSE, Network
from courtside.calibration.court import joint_adjustment, line_edges
from courtside.calibration.court.court import ClickedPoints, Court
from courtside.calibration.people import prior
from courtside.calibration.people.views import Limits, Seen, placed
from courtside.geometry.camera import Camera, distort, undistort
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

# Limits in units of the last: cameras that are a little wrong must not lose the views that say so.
WIDENED = (4.0, 2.0, 1.0, 1.0)
LOSS = 2.0  # scale of the Cauchy loss, in standard deviations of a joint, times these
SCATTERS = (0.3, 3.0)  # ASSUME: clicks scatter so much less or more than stated
LEAST_SHARE = 1e-3  # of the person's height: no network places a joint better
MAX_ITERATIONS, TOLERANCE = 10, 1e-4  # of a round: limits change the cost far more


@dataclass(frozen=True, eq=False)
class Clicks:
    """Clicked points at known places."""

    xyz: NDArray  # (P, 3): m
    sigma_m: NDArray  # (P,)
    xy: NDArray  # (C, P, 2): px, NaN where not clicked
    sigma_px: NDArray  # (C, P, 2), or (C, 1, 1): scatter of a click per axis
    bias_px: NDArray  # (C,): what all clicks in one picture have in common, likewise
    loss_scale: float  # of the Cauchy loss, in sigmas

    @property
    def clicked(self) -> NDArray:
        """Which points were clicked, (C, P) bool."""
        return np.isfinite(self.xy).all(axis=2)

    def alone_px(self, scatter: float = 1.0) -> NDArray:
        """Return sigmas (C, P, 2) of clicks as if independent, px, their scatter times `scatter`.

        Their sum in each picture is then as uncertain as scatter and bias make it.
        """
        own_px = np.broadcast_to(scatter * self.sigma_px, self.xy.shape)
        shared = self.clicked.sum(axis=1) * self.bias_px**2
        return np.sqrt(own_px**2 + shared[:, None, None])

    def of(self, points: NDArray) -> "Clicks":
        """Return the clicks of some points, (P,) bool; those of the others are NaN."""
        return replace(self, xy=np.where(points[:, None], self.xy, np.nan))


def court_clicks(
    court: Court,
    marked: ClickedPoints,
    cameras: Sequence[Camera],
    *,
    click_sigma_px: float,
    click_bias_px: float,
    click_loss: float,
) -> Clicks:
    """Return a court's clicks, weighted as by `court.joint_adjustment.solve_by_edges`."""
    scatter, bias = (
        np.array([joint_adjustment.click_sigma(px, camera.size) for camera in cameras])
        for px in (click_sigma_px, click_bias_px)
    )
    edges = np.stack([line_edges.click_variances(camera, court) for camera in cameras])
    sigma_px = scatter[:, None, None] * np.sqrt(edges)
    xy = np.stack([marked[camera.name] for camera in cameras])
    return Clicks(court.xyz, court.sigma_m, xy, sigma_px, bias, click_loss)


@dataclass(frozen=True, eq=False)
class Refined:
    """Cameras adjusted with people."""

    cameras: list[Camera]
    covariance: NDArray  # (K, K): of the columns of the cameras' network, flex included
    sigma_share: NDArray  # (J,): of a joint with score 1, per axis, in heights of the person
    alike: float  # how many views of a joint by one camera count as one: they err alike


def refine(
    cameras: Sequence[Camera],
    seen: Seen,
    known: solver.Quadratic,
    limits: Limits,
    clicks: Clicks | None = None,
) -> Refined:
    """Adjust cameras with what they see of people, and with clicks where there are any.

    Graduated as in `triangulate_robust`: views within wide limits are chosen and weighted, cameras
    and joints adjusted with a Cauchy loss as wide, then the limits narrow. A joint's scatter is
    measured from its residuals; views of one joint by one camera err alike, and what their sums
    show (`_alike`) widens all of them.
    """
    names, sizes = [c.name for c in cameras], [c.size for c in cameras]
    found = [_without_k3(camera) for camera in cameras]
    seen = seen.thinned()
    seen = replace(seen, xy=_seen_without_k3(cameras, seen.xy))
    if clicks is not None:
        clicks = replace(clicks, xy=_seen_without_k3(cameras, clicks.xy))
    alike = scatter = 1.0
    for widened in WIDENED:
        network, sigma_share, cells = _network(found, seen, limits, widened)
        network = replace(network, lens_sigma=prior.lens_sigma(known))
        alike = _alike(network, cells) if widened == 1.0 else 1.0
        network = replace(
            network,
            sigma_px=network.sigma_px * np.sqrt(alike),
            loss_scale=np.full(len(network.xy), LOSS * widened / np.sqrt(alike)),
        )
        n_views = len(network.xy)
        if clicks is not None:
            network = _with_clicks(network, clicks, scatter)
        network, normal = solver.adjust(
            network, quadratic=known, max_iterations=MAX_ITERATIONS, tolerance=TOLERANCE
        )
        found = conversion.cameras_of(network, names, sizes)
        if clicks is not None and widened == 1.0:
            scatter = _scatter(network, n_views, clicks)
    found = [
        replace(one, dist=np.append(one.dist[:4], base.dist[4]))
        for one, base in zip(found, cameras, strict=True)
    ]
    return Refined(found, normal.covariance(), sigma_share, alike)


def _without_k3(camera: Camera) -> Camera:
    """Return a camera as networks have it: their lenses end at p2."""
    return replace(camera, dist=np.append(camera.dist[:4], 0.0))


def _seen_without_k3(cameras: Sequence[Camera], xy: NDArray) -> NDArray:
    """Return where px (C, ..., 2) would be without each lens's k3, which stays as it is."""
    each = []
    for camera, px in zip(cameras, xy, strict=True):
        if camera.dist[4]:
            straight = undistort(camera, px)
            focal = np.diag(camera.K)[:2]
            px = distort(_without_k3(camera).dist, straight) * focal + camera.K[:2, 2]
        each.append(px)
    return np.stack(each)


def _network(
    cameras: Sequence[Camera], seen: Seen, limits: Limits, widened: float
) -> tuple[Network, NDArray, NDArray]:
    """Return joints seen by two cameras or more, sigma by joint (J,), and each view's cell (M,).

    A cell is one joint in one camera, of all persons and takes.
    """
    points = placed(cameras, seen, limits.times(widened))
    xy, score, height_px = seen.flat()
    n_joints = seen.score.shape[2]
    image_idx, at = np.nonzero(points.accepted)
    used, point_idx = np.unique(at, return_inverse=True)
    network = problem.with_points(
        conversion.network_of(cameras), points.xyz[used], image_idx, point_idx, xy[image_idx, at]
    )
    unit_px = height_px[image_idx, at] / np.sqrt(score[image_idx, at])
    sigma_share = _sigma_share(points, score, height_px, n_joints)
    joint = at % n_joints
    cells = joint * len(cameras) + image_idx
    return replace(network, sigma_px=unit_px * sigma_share[joint]), sigma_share, cells


def _sigma_share(points, score, height_px, n_joints) -> NDArray:
    """Return the scatter (J,) of each joint: three degrees of freedom less per point."""
    inside = points.accepted
    squares = np.where(inside, np.nan_to_num(score * (points.error_px / height_px) ** 2), 0.0)
    freedom = np.maximum(2 * inside.sum(axis=0) - 3, 0)
    by_joint = (part.reshape(-1, n_joints).sum(axis=0) for part in (squares.sum(axis=0), freedom))
    total, count = by_joint
    pooled = total.sum() / max(count.sum(), 1)
    variance = np.where(count > 0, total / np.maximum(count, 1), pooled)
    return np.maximum(np.sqrt(variance), LEAST_SHARE)


def _alike(network: Network, cells: NDArray) -> float:
    """Return how many times the variance of sums over cells is that of independent residuals.

    At least 1. A camera that sees a knee 1 cm too low sees it so for a whole stride, and nearly so
    of other persons: its views are not independent, and a covariance that takes them so is too
    small. With a cell for each track, 90 % ellipsoids of development sessions with 8 to 16 tracks
    held 0 to 3 % of the joints; with cells of all tracks they hold 96 to 100 %.
    """
    scaled = problem.residuals(network) / network.sigma_px
    weight = 1 / (1 + (scaled**2).sum(axis=1) / LOSS**2)
    scaled *= weight[:, None]
    _, cell = np.unique(cells, return_inverse=True)
    sums = np.stack([np.bincount(cell, axis) for axis in scaled.T])
    return max(float((sums**2).sum() / (scaled**2).sum()), 1.0)


def _scatter(network: Network, n_views: int, clicks: Clicks) -> float:
    """Return the scatter of the clicks, which follow the views, in their stated sigmas.

    From the median of their residuals; a camera's place and direction take six of them.
    """
    stated_px = np.broadcast_to(clicks.sigma_px, clicks.xy.shape)[clicks.clicked]
    scaled = problem.residuals(network)[n_views:] / stated_px
    left = 1 - len(POSE) * len(network.cam_from_world) / max(scaled.size, 1)
    if left <= 0.25:
        return 1.0
    found = MEDIAN_TO_SIGMA * float(np.median(np.abs(scaled))) / np.sqrt(left)
    return float(np.clip(found, *SCATTERS))


def _with_clicks(network: Network, clicks: Clicks, scatter: float) -> Network:
    """Return a network with clicks whose sums are as uncertain as scatter and bias make them."""
    sigma_px = clicks.alone_px(scatter)
    return selection.add_control_points(
        network,
        clicks.xyz,
        clicks.sigma_m,
        dict(enumerate(clicks.xy)),
        sigma_px=dict(enumerate(sigma_px)),
        loss_scale=clicks.loss_scale * float((scatter * clicks.sigma_px / sigma_px).mean()),
    )
