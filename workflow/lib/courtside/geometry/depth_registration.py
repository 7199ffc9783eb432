"""Register depth images to the picture of the colour camera beside the depth camera.

Depth images hold the distance along the camera's axis, metres; 0 or NaN where nothing was measured.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import camera as cameras
from courtside.geometry import rotations
from courtside.geometry.camera import Camera

NEAREST_M, FARTHEST_M = 0.1, 20.0  # beyond what depth cameras for bodies measure
SLACK_PX = 0.25  # ASSUME: closes the gaps on slanted surfaces
STEP_PX = 0.5  # along a colour pixel's ray, in the depth image: no depth pixel is stepped over
MOST_STEPS = 4096  # ASSUME: bounds the memory of a call


def rays(camera: Camera) -> NDArray:
    """Return the viewing directions (H, W, 2) of a camera's pixels on the z = 1 plane.

    NaN where the lens model has none.
    """
    columns, rows = np.meshgrid(np.arange(camera.size[0]), np.arange(camera.size[1]))
    return cameras.undistort(camera, np.stack([columns, rows], axis=-1))


def points_in_colour(
    depth_m: NDArray, depth_rays: NDArray, colour: Camera, colour_from_depth: NDArray
) -> tuple[NDArray, NDArray]:
    """Project every depth pixel (h, w) into the colour picture; its pose does not matter.

    `depth_rays` (h, w, 2) are `rays` of the depth camera, `colour_from_depth` is (3, 4). Return px
    (h, w, 2) of the colour picture, not limited to it, and depths (h, w) along the colour camera's
    axis; NaN where there is no depth.
    """
    depth_m = np.where(depth_m > 0, depth_m, np.nan)
    rotation, shift = colour_from_depth[:, :3], colour_from_depth[:, 3]
    x, y = depth_rays[..., 0] * depth_m, depth_rays[..., 1] * depth_m
    xyz = np.stack(
        [
            rotation[k, 0] * x + rotation[k, 1] * y + rotation[k, 2] * depth_m + shift[k]
            for k in range(3)
        ],
        axis=-1,
    )
    return cameras.project(_at_origin(colour), xyz), np.where(xyz[..., 2] > 0, xyz[..., 2], np.nan)


def align(
    depth_m: NDArray,
    depth_camera: Camera,
    colour: Camera,
    colour_from_depth: NDArray,
    *,
    depth_rays: NDArray | None = None,
) -> NDArray:
    """Return the depth (H, W) of each colour pixel, along the colour camera's axis.

    NaN where no depth pixel falls. `depth_m` is (h, w), `colour_from_depth` (3, 4).
    To align many pictures, compute `depth_rays` once, by `rays` of the depth camera.

    A depth pixel covers every colour pixel whose centre lies within its projected square or
    `SLACK_PX` beside it, which closes gaps on slanted surfaces, and at least the colour pixel
    nearest to its own centre. Where several overlap, the nearest surface counts.
    """
    depth_rays = rays(depth_camera) if depth_rays is None else depth_rays
    xy, z = points_in_colour(depth_m, depth_rays, colour, colour_from_depth)
    corner = depth_rays + 0.5 / np.diag(depth_camera.K)[:2]
    half = np.abs(points_in_colour(depth_m, corner, colour, colour_from_depth)[0] - xy) + SLACK_PX
    width, height = colour.size
    keep = (
        np.isfinite(z)
        & np.isfinite(half).all(axis=-1)
        & (xy > -1).all(axis=-1)
        & (xy < (width, height)).all(axis=-1)
    )
    x, y, z, half = xy[keep, 0], xy[keep, 1], z[keep], half[keep]
    order = np.argsort(-z, kind="stable")  # the last written is the nearest
    x, y, z, half = x[order], y[order], z[order], half[order]
    aligned = np.full((height, width), np.inf)
    reach = int(np.ceil(half.max(initial=0.0)))
    for row in range(-reach, reach + 1):
        for column in range(-reach, reach + 1):
            u, v = np.rint(x).astype(int) + column, np.rint(y).astype(int) + row
            inside = (u >= 0) & (u < width) & (v >= 0) & (v < height)
            covers = (np.abs(u - x) <= half[:, 0]) & (np.abs(v - y) <= half[:, 1])
            covers |= row == column == 0
            chosen = inside & covers
            layer = np.full((height, width), np.inf)
            layer[v[chosen], u[chosen]] = z[chosen]
            np.minimum(aligned, layer, out=aligned)
    return np.where(np.isfinite(aligned), aligned, np.nan)


def sample(
    depth_m: NDArray,
    depth_camera: Camera,
    colour: Camera,
    colour_from_depth: NDArray,
    xy: ArrayLike,
    *,
    range_m: tuple[float, float] = (NEAREST_M, FARTHEST_M),
) -> NDArray:
    """Return the depth (N,) at colour px (N, 2), by following rays through the depth image (h, w).

    It lies along the colour camera's axis, as does `range_m`, where the rays begin and end. It is
    that of the first depth pixel on the ray; NaN where there is none, as for a ray that passes
    behind what the depth camera sees, or where xy is. `colour_from_depth` is (3, 4).

    The ray is divided evenly in 1 / z, which gives steps of half a pixel in the depth image. A
    depth pixel lies on the ray if its distance from it is at most one step: the cameras stand close
    together, and smaller depth differences cause no parallax.
    """
    depth_m = np.where(depth_m > 0, depth_m, np.inf)
    xy = np.asarray(xy, dtype=float).reshape(-1, 2)
    depth_from_colour = rotations.invert(np.asarray(colour_from_depth))
    directions = np.concatenate([cameras.undistort(colour, xy), np.ones((len(xy), 1))], axis=-1)
    ends = _in_depth(depth_camera, depth_from_colour, directions, np.array(range_m))
    span_px = np.nan_to_num(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1)).max(initial=1.0)
    n_steps = int(min(np.ceil(span_px / STEP_PX) + 2, MOST_STEPS))
    z = 1 / np.linspace(1 / range_m[0], 1 / range_m[1], n_steps)
    places = np.rint(_in_depth(depth_camera, depth_from_colour, directions, z))
    width, height = depth_camera.size
    inside = ((places >= 0) & (places < (width, height))).all(axis=-1)
    u, v = (np.where(inside, places[..., k], 0).astype(int) for k in (0, 1))
    measured = np.where(inside, depth_m[v, u], np.inf)
    back = depth_from_colour[2, :3] @ directions.T
    along = back[:, np.newaxis] * z + depth_from_colour[2, 3]
    hit = np.abs(measured - along) <= np.gradient(z)
    found = measured[np.arange(len(xy)), hit.argmax(axis=1)]
    z_found = (found - depth_from_colour[2, 3]) / back
    return np.where(hit.any(axis=1) & np.isfinite(xy).all(axis=-1), z_found, np.nan)


def _in_depth(
    depth_camera: Camera, depth_from_colour: NDArray, directions: NDArray, z: NDArray
) -> NDArray:
    """Return depth-image px (N, S, 2) of points at depths (S,) along directions (N, 3)."""
    xyz = directions[:, np.newaxis] * z[:, np.newaxis]
    in_depth = xyz @ depth_from_colour[:, :3].T + depth_from_colour[:, 3]
    return cameras.project(_at_origin(depth_camera), in_depth)


def _at_origin(camera: Camera) -> Camera:
    """Return the camera at the origin of the world, along its axes."""
    if np.array_equal(camera.cam_from_world, np.eye(3, 4)):
        return camera
    return Camera(camera.name, camera.size, camera.K, camera.dist, np.eye(3, 4))
