import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as cameras
from courtside.geometry import depth_registration
from courtside.geometry.camera import Camera
from fixtures.recordings import aligned_depth

REST = np.eye(3, 4)
DEPTH = Camera("d", (160, 120), [[100, 0, 79.2], [0, 101, 59.6], [0, 0, 1]], np.zeros(5), REST)
COLOUR = Camera(
    "c", (240, 180), [[180, 0, 120.4], [0, 181, 88.9], [0, 0, 1]], [0.08, -0.05, 0.001, 0, 0], REST
)
TURNED = Rotation.from_euler("xyz", [1.0, -2.0, 0.5], degrees=True).as_matrix()
APART = np.column_stack([TURNED, [0.05, -0.01, 0.004]])
# The plane n . x = offset, in the depth camera's axes.
NORMAL, OFFSET = np.array([0.3, -0.2, 1.0]), 2.4


def directions(camera):
    rays = depth_registration.rays(camera)
    return np.concatenate([rays, np.ones((*rays.shape[:2], 1))], axis=-1)


def plane_depth():
    return OFFSET / (directions(DEPTH) @ NORMAL)


def plane_in_colour():
    """Return how far each colour pixel sees the plane, along the colour camera's axis."""
    normal = APART[:, :3] @ NORMAL
    return (OFFSET + normal @ APART[:, 3]) / (directions(COLOUR) @ normal)


def test_rays_look_where_points_are_seen():
    xyz = 3 * directions(COLOUR)
    columns, rows = np.meshgrid(np.arange(240), np.arange(180))
    assert np.allclose(cameras.project(COLOUR, xyz), np.stack([columns, rows], axis=-1), atol=1e-8)


def test_every_depth_pixel_lies_on_the_plane():
    depth_m = plane_depth()
    xy, z = depth_registration.points_in_colour(
        depth_m, depth_registration.rays(DEPTH), COLOUR, APART
    )
    in_colour = (directions(DEPTH) * depth_m[..., None]) @ APART[:, :3].T + APART[:, 3]
    assert np.allclose(z, in_colour[..., 2])
    assert np.allclose(xy, cameras.project(COLOUR, in_colour))


def test_pixels_without_depth_have_no_place():
    depth_m = plane_depth()
    depth_m[3, 4], depth_m[5, 6] = 0, np.nan
    xy, z = depth_registration.points_in_colour(
        depth_m, depth_registration.rays(DEPTH), COLOUR, APART
    )
    for place in ((3, 4), (5, 6)):
        assert np.isnan(z[place])
        assert np.isnan(xy[place]).all()


def test_a_plane_is_seen_by_every_colour_pixel_inside():
    aligned = aligned_depth.align(plane_depth(), DEPTH, COLOUR, APART)
    seen = aligned[20:-20, 20:-20]
    assert np.isfinite(seen).mean() > 0.99
    # A depth pixel is half a pixel wide either way: the plane's slope over that is the error
    # allowed.
    slope = np.abs(np.gradient(plane_in_colour())).max()
    off = np.abs(aligned - plane_in_colour())[20:-20, 20:-20]
    assert np.nanmax(off) < 2.5 * slope


def test_the_nearest_of_overlapping_depth_pixels_is_seen():
    """A square before a wall: the wall behind it must not show through."""
    depth_m = np.full((120, 160), 4.0)
    depth_m[40:80, 60:100] = 1.0
    aligned = aligned_depth.align(
        depth_m, DEPTH, COLOUR, np.column_stack([np.eye(3), [0.05, 0, 0]])
    )
    corners = np.array([[60, 40], [99, 79]]) - DEPTH.K[:2, 2]
    xyz = np.column_stack([corners / np.diag(DEPTH.K)[:2], [1.0, 1.0]]) + np.array([0.05, 0, 0])
    (x0, y0), (x1, y1) = np.rint(cameras.project(COLOUR, xyz)).astype(int)
    inside = aligned[y0 + 1 : y1, x0 + 1 : x1]
    assert np.allclose(inside, 1.0)
    assert np.nanmin(aligned[: y0 - 2]) == 4.0
    # Left of the square the wall is hidden from the depth camera: no depth there.
    shadow_px = 180 * 0.05 * (1 - 1 / 4)
    hidden = np.isnan(aligned[(y0 + y1) // 2]).sum()
    assert hidden == pytest.approx(shadow_px, abs=4)


def test_where_the_cameras_stand_in_the_world_does_not_matter():
    placed = np.column_stack([TURNED, [1.0, 2.0, 3.0]])
    there = Camera("c", COLOUR.size, COLOUR.K, COLOUR.dist, placed)
    depth_m = plane_depth()
    ours = aligned_depth.align(depth_m, DEPTH, COLOUR, APART)
    assert np.array_equal(ours, aligned_depth.align(depth_m, DEPTH, there, APART), equal_nan=True)
