"""Register depth images to the picture of the colour camera beside the depth camera.

Depth images hold the distance along the camera's axis, metres; 0 or NaN where nothing was measured.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from courtside.geometry.camera import Camera, project, undistort


def rays(camera: Camera) -> NDArray:
    """Return viewing directions (H, W, 2) of pixels on the plane z = 1; NaN where there is none."""
    columns, rows = np.meshgrid(np.arange(camera.size[0]), np.arange(camera.size[1]))
    return undistort(camera, np.stack([columns, rows], axis=-1))


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
    axes = zip(rotation, shift, strict=True)
    xyz = np.stack([r[0] * x + r[1] * y + r[2] * depth_m + t for r, t in axes], axis=-1)
    colour = replace(colour, cam_from_world=np.eye(3, 4))
    return project(colour, xyz), np.where(xyz[..., 2] > 0, xyz[..., 2], np.nan)
