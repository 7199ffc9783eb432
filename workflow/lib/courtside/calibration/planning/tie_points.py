"""Simulate the ties between images of a planned session, by features of a hall's walls.

A feature is found as long as it is seen from nearly the same side. Each point of the walls and the
floor therefore has a *life*: a range of directions, along the path of the camera, in which it is
found.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.bundle import conversion, problem
from courtside.calibration.bundle.problem import Network
from courtside.calibration.planning import cameras
from courtside.geometry.camera import Camera, in_picture, project

CHUNK = 4000  # points tried at once, which bounds the memory
LONG_PX = 1280  # longer side of the pictures in which textures were measured
# Lives begin up to this many longest mean lives before the path: 0.25 % of earlier ones would last.
BEFORE = 6.0
# ASSUME: of a point to an image: nearer ones are out of focus and soon out of the picture.
NEAREST_M = 1.0


@dataclass(frozen=True)
class Texture:
    """How much there is to see in a hall."""

    # Features in a picture of `LONG_PX` that are found again from exactly the same place; in
    # proportion to the longer side.
    n_alive: float
    lives_deg: tuple[float, ...]  # mean lives, exponentially distributed, of two kinds of features
    shares: tuple[float, ...]  # of the kinds among the features of one picture
    noise_px: float  # standard deviation of a tie per axis, whatever the picture's size
    floor: float  # share of the features that are on the floor


# ASSUME: chosen by trial so that the ties per image, and the images per tie, come near those of the
# virtual sessions: plain-a with 10, 20, 40 bridging images 157, 311, 383 ties per image, seen in
# 4.0, 4.7, 6.8 images; rich-a 527, 808, 1064 in 5.0, 6.3, 9.5. Noise is the robust spread of their
# residuals with 20 to 40 images; it changes by a quarter from pictures of 640 px to 1920 px.
TEXTURES = {
    "plain": Texture(480, (1.2, 12.0), (0.6, 0.4), 0.30, 0.05),
    "rich": Texture(1150, (2.0, 16.0), (0.55, 0.45), 0.17, 0.15),
}


def network(
    fixed: Sequence[Camera],
    walked: Sequence[Camera],
    hall_m: ArrayLike,
    texture: Texture,
    lens_prior: tuple[NDArray, NDArray],
    rng: np.random.Generator,
) -> Network:
    """Return the network that error-free structure from motion would find, in the court's frame.

    Fixed cameras come first, each with a lens of its own, then the bridging images in order, all by
    one camera; points seen once or never are not in it. `hall_m` (2, 3) are two opposite corners of
    the hall. `lens_prior` is mean and sigma of the lenses, (C + 1, 8) each.
    """
    images = [*fixed, *walked]
    order = path_order(fixed, walked, np.asarray(hall_m).mean(axis=0))
    found, tried, wanted = [], 0, float(CHUNK)
    while tried < wanted:
        xyz = points_on_surfaces(hall_m, CHUNK, texture.floor, rng)
        seen, n_alive = _seen(images, order, xyz, texture, rng)
        if not tried and n_alive:
            full = max(max(camera.size) for camera in images) / LONG_PX
            wanted = CHUNK * texture.n_alive * full / n_alive
        tried += CHUNK
        use = seen.sum(axis=1) >= 2
        use &= np.arange(CHUNK) < CHUNK - max(0, tried - wanted)  # of the last chunk only a part
        found.append((xyz[use], seen[use]))
    xyz, seen = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return _network_of(images, len(fixed), xyz, seen, lens_prior)


def path_order(fixed: Sequence[Camera], walked: Sequence[Camera], middle_m: NDArray) -> NDArray:
    """Return the indices of all images, fixed ones first, in the order of the walk.

    Without a walk it is that around the hall's middle (3,) m, from behind the widest gap.
    """
    places = np.array([camera.centre_in_world for camera in [*fixed, *walked]])
    if not walked:
        x, y, _ = (places - middle_m).T
        azimuth = np.arctan2(y, x)
        order = np.argsort(azimuth)
        gap = np.diff(azimuth[order], append=azimuth[order[0]] + 2 * np.pi)
        return np.roll(order, -int(gap.argmax()) - 1)
    return cameras.path_order(places, np.arange(len(places)) < len(fixed))


def points_on_surfaces(
    hall_m: ArrayLike, n_points: int, floor: float, rng: np.random.Generator
) -> NDArray:
    """Return points spread evenly over a hall's walls and, a share `floor`, its floor, (N, 3) m."""
    low, high = np.min(hall_m, axis=0), np.max(hall_m, axis=0)
    xyz = rng.uniform(low, high, (n_points, 3))
    wide, deep = (high - low)[:2]
    on_floor = rng.random(n_points) < floor
    across = rng.random(n_points) < deep / (wide + deep)  # a wall of constant x
    far = rng.random(n_points) < 0.5
    at = np.where(across, 0, 1)
    wall = np.where(far, high[at], low[at])
    xyz[np.arange(n_points), at] = np.where(on_floor, xyz[np.arange(n_points), at], wall)
    xyz[on_floor, 2] = low[2]
    return xyz


def _seen(images, order, xyz, texture, rng) -> tuple[NDArray, float]:
    """Return which image sees which point, (N, V) bool, and how many a largest picture sees."""
    angle_deg = _along(np.array([images[at].centre_in_world for at in order]), xyz)
    alive = np.zeros(angle_deg.shape, dtype=bool)
    alive[:, order] = _alive(angle_deg, texture, rng)
    for at, camera in enumerate(images):
        alive[alive[:, at], at] = _in_view(camera, xyz[alive[:, at]])
    long_px = np.array([max(camera.size) for camera in images])
    n_alive = alive[:, long_px == long_px.max()].sum(axis=0).mean()
    fine = rng.random(alive.shape) < long_px / long_px.max()
    return alive & fine, n_alive


def _along(centres: NDArray, xyz: NDArray) -> NDArray:
    """Return how far the direction from points to each image has turned along the path, degrees."""
    ray = centres - xyz[:, None]
    ray = ray / np.linalg.norm(ray, axis=2, keepdims=True)
    between = np.linalg.norm(np.diff(ray, axis=1), axis=2) / 2
    turn_deg = np.degrees(2 * np.arcsin(np.clip(between, 0, 1)))
    return np.concatenate([np.zeros((len(xyz), 1)), np.cumsum(turn_deg, axis=1)], axis=1)


def _alive(angle_deg: NDArray, texture: Texture, rng: np.random.Generator) -> NDArray:
    """Return in which images each point is in its life, (N, V) bool."""
    lives_deg, shares = np.array(texture.lives_deg), np.array(texture.shares)
    births = shares / lives_deg  # long lives fill more pictures than their number
    kind = rng.choice(len(births), size=len(angle_deg), p=births / births.sum())
    life_deg = rng.exponential(lives_deg[kind])
    before_deg = BEFORE * lives_deg.max()
    start_deg = rng.uniform(-before_deg, angle_deg[:, -1])
    since = angle_deg - start_deg[:, None]
    return (since >= 0) & (since <= life_deg[:, None])


def _in_view(camera: Camera, xyz: NDArray) -> NDArray:
    away_m = np.linalg.norm(xyz - camera.centre_in_world, axis=1)
    return in_picture(camera, project(camera, xyz)) & (away_m > NEAREST_M)


def _network_of(images, n_fixed, xyz, seen, lens_prior) -> Network:
    point_idx, image_idx = np.nonzero(seen)
    alone = conversion.network_of(images)
    lens = alone.lens[: n_fixed + 1]
    mean, sigma = (values[: len(lens)] for values in lens_prior)
    of_image = np.minimum(np.arange(len(images)), n_fixed)
    alone = replace(alone, lens=lens, lens_of_image=of_image, lens_mean=mean, lens_sigma=sigma)
    nowhere = np.zeros((len(image_idx), 2))
    blank = problem.with_points(alone, xyz, image_idx, point_idx, nowhere)
    return replace(blank, xy=problem.residuals(blank))
