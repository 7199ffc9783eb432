"""Bring the pictures of a depth camera and of the colour camera beside it together."""

import numpy as np

from courtside.geometry import camera as cameras
from courtside.geometry import rotations

NEAREST_M, FARTHEST_M = 0.1, 20.0  # beyond what depth cameras for bodies measure
SLACK_PX = 0.25
STEP_PX = 0.5  # between two places that are tried along a colour pixel's ray, in the depth picture
MOST_STEPS = 4096


def rays(camera):
    """Return the directions that a camera's pixels look along.

    Parameters
    ----------
    camera : Camera

    Returns
    -------
    directions : (H, W, 2) float
        On the z = 1 plane; NaN where the lens shows none.
    """
    columns, rows = np.meshgrid(np.arange(camera.size[0]), np.arange(camera.size[1]))
    return cameras.undistort(camera, np.stack([columns, rows], axis=-1))


def points_in_colour(depth_m, depth_rays, colour, colour_from_depth):
    """Place every depth pixel in the colour picture.

    Parameters
    ----------
    depth_m : (h, w) float
        Along the depth camera's axis, metres; 0 or NaN where there is none.
    depth_rays : (h, w, 2) float
        From `rays` of the depth camera.
    colour : Camera
        Of the colour picture; its place in the world does not matter.
    colour_from_depth : (3, 4) float

    Returns
    -------
    xy : (h, w, 2) float
        Px of the colour picture, not limited to it; NaN where there is no depth.
    z : (h, w) float
        Along the colour camera's axis, metres; NaN likewise.
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


def align(depth_m, depth_camera, colour, colour_from_depth, *, depth_rays=None):
    """Return the depth that each colour pixel sees.

    Parameters
    ----------
    depth_m : (h, w) float
        Along the depth camera's axis, metres; 0 or NaN where there is none.
    depth_camera, colour : Camera
    colour_from_depth : (3, 4) float
    depth_rays : (h, w, 2) float, optional
        From `rays` of the depth camera, where many pictures are aligned.

    Returns
    -------
    z : (H, W) float
        Along the colour camera's axis, metres; NaN where no depth pixel falls.

    Notes
    -----
    A depth pixel covers every colour pixel whose centre lies within its projected square or a quarter of a
    pixel beside it, which closes gaps on slanting surfaces, and at the least the one nearest to its own
    centre. Of several the nearest is seen.
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
    depth_m, depth_camera, colour, colour_from_depth, xy, *, range_m=(NEAREST_M, FARTHEST_M)
):
    """Return how far colour pixels see, by following their rays through the depth picture.

    Parameters
    ----------
    depth_m : (h, w) float
        Along the depth camera's axis, metres; 0 or NaN where there is none.
    depth_camera, colour : Camera
    colour_from_depth : (3, 4) float
    xy : (N, 2) float
        Px of the colour picture; NaN where missing.
    range_m : (float, float)
        Where the rays begin and end, along the colour camera's axis.

    Returns
    -------
    z : (N,) float
        Along the colour camera's axis, metres: of the first depth pixel on the way that lies on the ray;
        NaN where there is none, as for a ray that passes behind what the depth camera sees.

    Notes
    -----
    The way is divided evenly in 1 / z, so that the picture is crossed in steps of half a pixel. A depth
    pixel lies on the ray if it is not farther from it than the next place tried: the cameras stand close
    together, and depth that differs by less shows no parallax.
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


def _in_depth(depth_camera, depth_from_colour, directions, z):
    """Return where points at depths (S,) along directions (N, 3) lie in the depth picture, (N, S, 2)."""
    xyz = directions[:, np.newaxis] * z[:, np.newaxis]
    in_depth = xyz @ depth_from_colour[:, :3].T + depth_from_colour[:, 3]
    return cameras.project(_at_origin(depth_camera), in_depth)


def _at_origin(camera):
    """Return the camera with the world as its own axes."""
    if np.array_equal(camera.cam_from_world, np.eye(3, 4)):
        return camera
    return cameras.Camera(camera.name, camera.size, camera.K, camera.dist, np.eye(3, 4))
