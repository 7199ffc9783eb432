"""Pictures against projected truth: corners, rolling shutter, motion blur, repeatability."""

import dataclasses

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from fixtures.cameras import scene as projection
from fixtures.cameras import small_hall
from virtualgym.cameras import row_warp
from virtualgym.hall import quads
from virtualgym.rendering import hall_renderer

TWIST = np.array([0.3, -0.5, 0.2]), np.array([0.8, -0.6, 0.3])
READOUT_S = 0.1


@pytest.fixture(scope="module")
def room():
    return hall_renderer.Renderer(small_hall.scene())


def moved(camera, time_s):
    """Return the camera after it moved with TWIST for a time, by matrices alone."""
    angular, velocity = TWIST
    world_from_cam = (
        camera.cam_from_world[:, :3].T @ Rotation.from_rotvec(angular * time_s).as_matrix()
    )
    centre = camera.centre_in_world + velocity * time_s
    pose = np.column_stack([world_from_cam.T, -world_from_cam.T @ centre])
    return dataclasses.replace(camera, cam_from_world=pose)


def found_corners(picture, camera):
    """Return errors (N, 2) px of those chessboard corners that are large enough in a picture."""
    xyz = small_hall.corners()
    in_cam = xyz @ camera.cam_from_world[:, :3].T + camera.cam_from_world[:, 3]
    xyz = xyz[(in_cam[:, 2] > 0.5) & (np.abs(in_cam[:, :2]).max(axis=1) < in_cam[:, 2])]
    xy = projection.opencv_projection(camera, xyz)
    inside = ((xy > 12) & (xy < np.array(camera.size) - 13)).all(axis=1)
    xy = xy[inside]
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 100, 1e-4)
    start = np.ascontiguousarray(xy[:, None], np.float32)
    refined = cv2.cornerSubPix(grey, start, (6, 6), (-1, -1), stop)
    return (refined[:, 0] - xy)[np.array([square_px(point, camera) > 20 for point in xyz[inside]])]


def square_px(point, camera):
    """Return how thin a square of the chessboard looks; thin ones have no detectable corner."""
    edges = np.eye(3)[~np.isclose(point % small_hall.ROOM_M[1], 0)] * small_hall.SQUARE_M / 2
    ends = [projection.opencv_projection(camera, point + sign * edges) for sign in (1, -1)]
    return np.linalg.svd(ends[0] - ends[1])[1][1]


@pytest.mark.parametrize("target", [(6.5, 7.5, 1.0), (3.0, 8.0, 0.2), (7.5, 2.0, 1.6)])
def test_corners_are_where_the_lens_model_projects_them(room, target):
    camera = small_hall.camera(target=target, size=(1280, 720))
    error = found_corners(room.render(camera), camera)
    assert len(error) > 80
    assert np.sqrt((error**2).mean()) < 0.045
    assert np.percentile(np.abs(error), 99) < 0.1
    assert np.abs(error.mean(axis=0)).max() < 0.01


def test_edges_of_things_are_where_they_are_projected():
    camera = small_hall.camera(target=(6.5, 7.5, 1.5), size=(640, 360))
    dark, bright = (np.full((4, 4, 3), value, np.uint8) for value in (40, 200))
    plate = quads.Quad([4.1, 6.2, 2.3], [1.3, -0.9, 0.1], [0.02, 0.03, -1.1], bright)
    picture = hall_renderer.Renderer(small_hall.scene([plate], texture=dark)).render(camera)
    grey = picture[..., 1].astype(np.float32)
    shares = np.linspace(0.15, 0.85, 60)
    for corner, edge, outward in (
        (plate.origin, plate.u, -plate.v),
        (plate.origin, plate.v, -plate.u),
        (plate.origin + plate.v, plate.u, plate.v),
        (plate.origin + plate.u, plate.v, plate.u),
    ):
        on = projection.opencv_projection(camera, corner + shares[:, None] * edge)
        beyond = projection.opencv_projection(
            camera, corner + shares[:, None] * edge + 0.01 * outward
        )
        along = np.gradient(on, axis=0)
        normal = np.column_stack([-along[:, 1], along[:, 0]])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        normal *= np.sign(np.einsum("ij,ij->i", normal, beyond - on))[:, None]
        steps = np.arange(-5, 5.01, 0.1)
        at = (on[:, None] + steps[:, None] * normal[:, None]).astype(np.float32)
        profile = cv2.remap(grey, at[..., 0], at[..., 1], cv2.INTER_LINEAR)
        low, high = profile[:, -8:].mean(axis=1), profile[:, :8].mean(axis=1)
        # A step's area is its place, however blurred.
        place = ((profile - low[:, None]) / (high - low)[:, None]).sum(axis=1) * 0.1 - 5.05
        assert abs(place.mean()) < 0.03


def test_rows_of_a_rolling_shutter_are_exposed_one_after_the_other(room):
    camera = small_hall.camera()
    height = camera.size[1]
    rolling = room.render(camera, twist=TWIST, readout_s=READOUT_S).astype(float)
    for row in (6, 100, 180, 260, 353):
        time_s = ((row + 0.5) / height - 0.5) * READOUT_S
        still = room.render(moved(camera, time_s)).astype(float)
        backwards = room.render(moved(camera, -time_s)).astype(float)
        # The lens's blur mixes neighbouring rows, which are exposed at other times.
        assert np.abs(rolling[row] - still[row]).mean() < 0.6
        if abs(row - height / 2) > 50:
            assert np.abs(rolling[row] - backwards[row]).mean() > 5


def test_motion_without_readout_or_exposure_changes_nothing(room):
    camera = small_hall.camera()
    np.testing.assert_array_equal(room.render(camera, twist=TWIST), room.render(camera))


def test_motion_blur_is_the_mean_over_the_exposure(room):
    camera = small_hall.camera(dist=(0, 0, 0, 0, 0))
    turn = (np.array([0.0, 1.0, 0.0]), np.zeros(3))
    exposure_s = 0.012
    blurred = room.render(camera, twist=turn, exposure_s=exposure_s).astype(float)
    poses = []
    for time_s in (np.arange(12) + 0.5) / 12 * exposure_s - exposure_s / 2:
        rotation = (
            Rotation.from_rotvec(turn[0] * time_s).as_matrix().T @ camera.cam_from_world[:, :3]
        )
        pose = np.column_stack([rotation, -rotation @ camera.centre_in_world])
        poses.append(room.render(dataclasses.replace(camera, cam_from_world=pose)).astype(float))
    part = np.s_[120:240, 220:420]  # turning moves the picture's corners otherwise than its middle
    sharp = room.render(camera).astype(float)
    assert np.abs(blurred - np.mean(poses, axis=0))[part].mean() < 1.0
    assert np.abs(sharp - np.mean(poses, axis=0))[part].mean() > 4.0


def test_the_same_seed_gives_the_same_picture(room):
    camera = small_hall.camera()
    first, same, other = (
        room.render(camera, noise=4.0, rng=np.random.default_rng(seed)) for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first, same)
    assert np.abs(first.astype(float) - other).mean() > 2
    clean = room.render(camera).astype(float)
    middle = (clean > 30) & (clean < 225)
    assert np.std((first - clean)[middle]) == pytest.approx(4.0, rel=0.05)


def test_cameras_of_one_name_with_other_lenses_do_not_share_rays(room):
    first = small_hall.camera(dist=(0, 0, 0, 0, 0))
    second = small_hall.camera()
    room.render(first)
    fresh = hall_renderer.Renderer(room.scene)
    np.testing.assert_array_equal(room.render(second), fresh.render(second))


WARP_PX = np.array([[3.0, -2.0], [1.5, 2.5]])


@pytest.mark.parametrize("warp_px", [None, WARP_PX])
def test_corners_are_where_a_long_lens_and_a_stabiliser_show_them(room, warp_px):
    """Nine coefficients against OpenCV's twelve, whose k4 to k6 are 0; bent rows by their rule."""
    prism = (0.01, 0.03, -0.02, 0.04)
    camera = small_hall.camera(
        target=(6.5, 7.5, 1.0), size=(1280, 720), dist=(*small_hall.DIST, *prism)
    )
    grey = cv2.cvtColor(room.render(camera, row_warp_px=warp_px), cv2.COLOR_BGR2GRAY)
    xyz = small_hall.corners()
    in_cam = xyz @ camera.cam_from_world[:, :3].T + camera.cam_from_world[:, 3]
    xyz = xyz[(in_cam[:, 2] > 0.5) & (np.abs(in_cam[:, :2]).max(axis=1) < in_cam[:, 2])]
    turn, move = cv2.Rodrigues(camera.cam_from_world[:, :3])[0], camera.cam_from_world[:, 3]
    twelve = np.array([*small_hall.DIST, 0.0, 0.0, 0.0, *prism])
    lens_px = cv2.projectPoints(xyz, turn, move, camera.K, twelve)[0][:, 0]
    xy = lens_px
    for _ in range(20 if warp_px is not None else 0):
        xy = lens_px - row_warp.shifts(warp_px, xy[:, 1], 720).T
    wide = np.array([square_px(point, dataclasses.replace(camera, dist=small_hall.DIST)) > 20
                     for point in xyz])  # fmt: skip
    xy = xy[wide & ((xy > 12) & (xy < np.array(camera.size) - 13)).all(axis=1)]
    stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_COUNT, 100, 1e-4)
    start = np.ascontiguousarray(xy[:, None], np.float32)
    error = cv2.cornerSubPix(grey, start, (6, 6), (-1, -1), stop)[:, 0] - xy
    assert len(error) > 80
    assert np.sqrt((error**2).mean()) < 0.05
    assert np.abs(error.mean(axis=0)).max() < 0.015


def test_light_of_rows_scales_the_picture(room):
    camera = small_hall.camera(size=(320, 180))
    rows = np.linspace(0.5, 1.0, 180)
    usual, lit = (room.render(camera, light=light).astype(float) for light in (None, rows))
    np.testing.assert_allclose(lit[10:-10], usual[10:-10] * rows[10:-10, None, None], atol=1.5)
