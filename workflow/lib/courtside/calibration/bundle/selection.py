"""Choice and weights of tie points, control points, images and frames of a network."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.bundle import problem, solver
from courtside.calibration.bundle.problem import Network
from courtside.geometry import similarity
from courtside.geometry.similarity import Sim3
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

LEAST_PX = 0.05  # ASSUME: no feature is located better


def transform(network: Network, b_from_a: Sim3) -> Network:
    """Return a network whose frame is moved and scaled by a similarity."""
    rotation = network.cam_from_world[:, :, :3] @ b_from_a.rotation.T
    shift = b_from_a.scale * network.cam_from_world[:, :, 3] - rotation @ b_from_a.translation
    pose = np.concatenate([rotation, shift[:, :, None]], axis=2)
    return replace(network, cam_from_world=pose, xyz=b_from_a.points(network.xyz))


def free_frame(network: Network, fixed: Sequence[int]) -> Sim3:
    """Return the similarity `frame_from_sfm` into a frame for sessions without a court.

    Its origin is the mean of the projection centres. z points against the mean of the pictures' y
    axes: upwards if the cameras are held upright. x points from the first fixed camera (image index
    in `fixed`) to the second, and their distance is the unit. The first and last image stand in for
    fewer than two fixed cameras.
    """
    places = centres(network)
    ends = places[fixed[:2]] if len(fixed) > 1 else places[[0, -1]]
    along = ends[1] - ends[0]
    up = -network.cam_from_world[:, 1, :3].mean(axis=0)
    x = along - (along @ up) / (up @ up) * up
    x, z = x / np.linalg.norm(x), up / np.linalg.norm(up)
    rotation, scale = np.stack([x, np.cross(z, x), z]), 1 / np.linalg.norm(along)
    return Sim3(float(scale), rotation, -scale * rotation @ places.mean(axis=0))


def between(cam_from_a: NDArray, cam_from_b: NDArray) -> Sim3:
    """Fit the similarity `b_from_a` to the poses (V, 3, 4) of the same images in both frames.

    Their rotations give its rotation, then their projection centres scale and translation by least
    squares. The centres may lie on one line; of one image the scale is 1.
    """
    rotation, _ = similarity.kabsch(
        np.einsum("vji,vjk->ik", cam_from_b[:, :, :3], cam_from_a[:, :, :3])
    )
    turned, places = _centres(cam_from_a) @ rotation.T, _centres(cam_from_b)
    middle, other = turned.mean(axis=0), places.mean(axis=0)
    arms = turned - middle
    extent = (arms**2).sum()
    scale = float((arms * (places - other)).sum() / extent) if extent > 0 else 1.0
    return Sim3(scale, rotation, other - scale * middle)


def select(network: Network, points: NDArray, seen: NDArray | None = None) -> Network:
    """Return a network with the points (N,) bool and the observations `seen` (M,) bool, or all.

    All images and lenses stay. Observations of dropped points are dropped in any case.
    """
    seen = points[network.point_idx] & (True if seen is None else seen)
    number = np.cumsum(points) - 1
    per_point = {name: getattr(network, name)[points] for name in problem.PER_POINT}
    per_view = {name: getattr(network, name)[seen] for name in problem.PER_VIEW}
    return replace(network, **per_point, **per_view | {"point_idx": number[per_view["point_idx"]]})


def thin(
    network: Network, *, min_angle_deg: float, max_error_px: float, max_points: int, seed: int
) -> Network:
    """Keep a random choice of the points that tie images well.

    Observations farther than `max_error_px` from their point's projection are dropped, then points
    with fewer than two, or whose rays are all within half of `min_angle_deg` of their mean. A
    random choice does better than the points seen under the widest angles: those are often wrong.
    More points than a few thousand do not help: their errors come from the features and are not
    independent.
    """
    error = np.linalg.norm(problem.residuals(network), axis=1)
    seen = error <= max_error_px  # of a point behind its image the error is NaN
    network = select(network, np.ones(len(network.xyz), dtype=bool), seen)
    points = _widest_angle(network) >= np.radians(min_angle_deg)
    n_seen = np.bincount(network.point_idx, minlength=len(network.xyz))
    good = np.flatnonzero(points & (n_seen >= 2))
    chosen = np.random.default_rng(seed).permutation(good)[:max_points]
    points = np.zeros(len(network.xyz), dtype=bool)
    points[chosen] = True
    return select(network, points)


def _widest_angle(network: Network) -> NDArray:
    """Return twice the widest angle between a point's rays and their mean, (N,) rad."""
    rays = network.xyz[network.point_idx] - centres(network)[network.image_idx]
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    mean = np.zeros((len(network.xyz), 3))
    np.add.at(mean, network.point_idx, rays)
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-12)
    cosine = np.einsum("mi,mi->m", rays, mean[network.point_idx])
    widest = np.zeros(len(network.xyz))
    np.maximum.at(widest, network.point_idx, np.arccos(np.clip(cosine, -1, 1)))
    return 2 * widest


def centres(network: Network) -> NDArray:
    """Return the projection centres of all images, (V, 3)."""
    return _centres(network.cam_from_world)


def _centres(pose: NDArray) -> NDArray:
    return -np.einsum("vji,vj->vi", pose[:, :, :3], pose[:, :, 3])


def residual_spread(network: Network) -> float:
    """Return the robust standard deviation of all residuals per axis, px; at least `LEAST_PX`."""
    residual = problem.residuals(network)
    return max(MEDIAN_TO_SIGMA * float(np.nanmedian(np.abs(residual))), LEAST_PX)


def weigh(network: Network, *, sigma_px: float, loss_scale: float) -> Network:
    """Return a network in which all observations have one sigma, px per axis, and one loss.

    `loss_scale` is the scale of the Cauchy loss, in sigmas; inf: no loss.
    """
    return replace(
        network,
        sigma_px=np.full(len(network.xy), float(sigma_px)),
        loss_scale=np.full(len(network.xy), float(loss_scale)),
    )


def add_control_points(
    network: Network,
    xyz: NDArray,
    xyz_sigma: NDArray,
    clicks: Mapping[int, NDArray],
    *,
    sigma_px: Mapping[int, ArrayLike],
    loss_scale: float,
) -> Network:
    """Return a network with control points appended to its own points.

    Their coordinates `xyz` (P, 3) m, in the network's frame, are known with `xyz_sigma` (P,). The
    clicks (P, 2) px, NaN where not clicked, and their sigma are by index of the image; points
    without a click are left out. A sigma is a number, or one for each axis, (2,), of all points or
    of each, (P, 2); `loss_scale` is in sigmas.
    """
    clicked = [
        (v, p) for v, xy in clicks.items() for p in np.flatnonzero(np.isfinite(xy).all(axis=1))
    ]
    image_idx, point = np.array(clicked, dtype=int).reshape(-1, 2).T
    used, point_idx = np.unique(point, return_inverse=True)
    by_point = {v: np.broadcast_to(each, (len(xyz), 2)) for v, each in sigma_px.items()}
    sigma = np.array([by_point[v][p] for v, p in clicked]).reshape(-1, 2)
    xyz, xyz_sigma = np.asarray(xyz)[used], np.asarray(xyz_sigma)[used]
    places = np.array([clicks[v][p] for v, p in clicked]).reshape(-1, 2)
    return replace(
        network,
        xyz=np.concatenate([network.xyz, xyz]),
        xyz_mean=np.concatenate([network.xyz_mean, xyz]),
        xyz_sigma=np.concatenate([network.xyz_sigma, xyz_sigma]),
        image_idx=np.concatenate([network.image_idx, image_idx]),
        point_idx=np.concatenate([network.point_idx, point_idx + len(network.xyz)]),
        xy=np.concatenate([network.xy, places]),
        sigma_px=np.concatenate([network.sigma_px, sigma]),
        loss_scale=np.concatenate([network.loss_scale, np.full(len(places), float(loss_scale))]),
    )


def images_only(network: Network, images: ArrayLike) -> Network:
    """Return a network of some images, each with a lens of its own, without any point or prior."""
    images = np.asarray(images, dtype=int)
    lens = network.lens[network.lens_of_image[images]]
    return problem.without_points(network.cam_from_world[images], lens, network.height_px[images])


def marginalise(network: Network, images: Sequence[int] | NDArray) -> solver.Quadratic:
    """Marginalise a network without control points to some images and their lenses.

    Each of these images has a lens of its own. The result is about `images_only(network, images)`;
    the ties leave its frame and scale open.
    """
    normal = solver.normal_equations(network)
    n_images, n_lens = len(network.cam_from_world), len(problem.LENS)
    lenses = network.lens_of_image[np.asarray(images)]
    blocks = [problem.IMAGE * v + np.arange(problem.IMAGE) for v in images]
    blocks += [problem.IMAGE * n_images + n_lens * k + np.arange(n_lens) for k in lenses]
    columns = np.concatenate(blocks)
    place = np.full(network.n_columns, -1)
    place[columns] = np.arange(len(columns))
    place = place[normal.active]
    mine, rest = place >= 0, place < 0
    mixed = normal.information[np.ix_(rest, mine)]
    whole = normal.information[np.ix_(rest, rest)]
    scale = 1 / np.sqrt(np.maximum(np.diag(whole), 1e-300))
    right = np.column_stack([mixed, normal.gradient[rest]]) * scale[:, None]
    solved = scale[:, None] * np.linalg.lstsq(whole * np.outer(scale, scale), right)[0]
    information = np.zeros((len(columns), len(columns)))
    gradient = np.zeros(len(columns))
    at = place[mine]
    of_mine = normal.information[np.ix_(mine, mine)]
    information[np.ix_(at, at)] = of_mine - mixed.T @ solved[:, :-1]
    gradient[at] = normal.gradient[mine] - mixed.T @ solved[:, -1]
    unit = np.zeros(len(columns))
    unit[at] = np.sqrt(np.diag(of_mine))
    return solver.Quadratic(
        images_only(network, images), *_without_noise(information, gradient, unit)
    )


def _without_noise(
    information: NDArray, gradient: NDArray, unit: NDArray
) -> tuple[NDArray, NDArray]:
    """Return information and gradient without the directions of negative information.

    They differ from none by rounding, which a nearly open network magnifies. `unit` (K,) is the
    root of each column's information before others were marginalised; 0 of fixed columns.
    """
    scale = np.divide(1.0, unit, out=np.zeros_like(unit), where=unit > 0)
    extent, axes = np.linalg.eigh((information + information.T) / 2 * np.outer(scale, scale))
    lost = axes[:, extent < 0]
    known = np.eye(len(unit)) - lost @ lost.T
    root = unit[:, None] * axes * np.sqrt(np.maximum(extent, 0))
    return root @ root.T, unit * (known @ (scale * gradient))


def with_lens_priors(
    network: Network,
    sizes: Sequence[tuple[int, int]],
    spread: Mapping[str, float],
    centre_share: float,
) -> Network:
    """Return a network with priors of usual lenses: square pixels, centred, without distortion.

    Standard deviations are `spread` by name of `problem.LENS`, and of the principal point
    `centre_share` of the picture's longer side; `sizes` are those of the pictures by lens, px.
    """
    mean, sigma = network.lens.copy(), np.full(network.lens.shape, np.inf)
    mean[:, problem.LENS.index("aspect")] = 1.0
    mean[:, 2:4] = [[(length - 1) / 2 for length in size] for size in sizes]
    sigma[:, 2:4] = [[centre_share * max(size)] for size in sizes]
    mean[:, 4:] = 0.0
    for key, value in spread.items():
        sigma[:, problem.LENS.index(key)] = value
    return replace(network, lens_mean=mean, lens_sigma=sigma)
