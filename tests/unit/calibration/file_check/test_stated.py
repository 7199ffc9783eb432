"""Cameras that no calibration may state; right ones of any arrangement pass."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.file_check import stated
from courtside.geometry.camera import undistort
from courtside.study.errors import InputError
from fixtures.cameras import scene

RING = scene.ring(4)


def posed(camera, pose):
    return replace(camera, cam_from_world=np.asarray(pose))


def test_right_cameras_pass():
    for count in range(5):
        stated.check("hall.toml", scene.ring(4)[:count])


def test_two_cameras_of_one_pose_are_named():
    first, second, *others = RING
    same = [first, posed(second, first.cam_from_world), *others]
    message = r"^hall.toml: cameras c0 and c1: expected a pose of its own for each, found one and"
    with pytest.raises(InputError, match=message):
        stated.check("hall.toml", same)


def test_cameras_in_one_place_that_look_elsewhere_pass():
    """As the parts of a picture all around."""
    turned = np.diag([-1.0, 1.0, -1.0]) @ RING[0].cam_from_world
    stated.check("hall.toml", [RING[0], posed(RING[1], turned), *RING[2:]])


@pytest.mark.parametrize("point", [(0.49, 0.51), (0.0, 0.0), (-1.2, 0.8)])
def test_a_principal_point_that_is_not_in_px_from_the_corner_is_named(point):
    matrix = RING[2].K.copy()
    matrix[:2, 2] = point
    cameras = [*RING[:2], replace(RING[2], K=matrix), RING[3]]
    message = r"^hall.toml: camera c2: expected the principal point in px .* the 1920x1080 px pict"
    with pytest.raises(InputError, match=message):
        stated.check("hall.toml", cameras)


def test_a_principal_point_at_one_side_passes():
    """As of a part of a picture."""
    matrix = RING[2].K.copy()
    matrix[:2, 2] = 0.5, 900
    stated.check("hall.toml", [*RING[:2], replace(RING[2], K=matrix)])


@pytest.mark.parametrize(
    ("point", "dist", "message"),
    [
        ((1920, 1080), 0.0, "the principal point in the 1920x1080 px picture, found"),
        ((959.5, -40), 0.0, r"the principal point in the 1920x1080 px picture, found \(959.5, -40"),
        ((959.5, 539.5), -4.0, "distortions that give every pixel a direction, found .-4.0"),
    ],
)
def test_a_matrix_or_a_lens_of_another_picture_is_named(point, dist, message):
    matrix = RING[2].K.copy()
    matrix[:2, 2] = point
    wrong = replace(RING[2], K=matrix, dist=np.array([dist, 0, 0, 0, 0]))
    with pytest.raises(InputError, match=f"^hall.toml: camera c2: expected {message}"):
        stated.check("hall.toml", [*RING[:2], wrong, RING[3]])


@pytest.mark.parametrize("factor", [1 / 400, 64])
def test_focal_lengths_that_are_not_in_px_are_named(factor):
    """As in mm, or in 1/64 px."""
    matrix = RING[2].K * np.array([[factor, 1, 1], [1, factor, 1], [1, 1, 1]])
    message = "^hall.toml: camera c2: expected focal lengths in px, such as 1920 for the 1920x1080"
    with pytest.raises(InputError, match=message):
        stated.check("hall.toml", [*RING[:2], replace(RING[2], K=matrix), RING[3]])


def test_a_lens_that_folds_in_the_corners_alone_passes():
    """As one whose board never came there: it shows 2/3 of the radius at which it folds."""
    corner = np.linalg.norm(RING[2].K[:2, 2]) / RING[2].K[0, 0]
    dist = [-1 / (3 * (1.4 * corner) ** 2), 0, 0, 0, 0]
    folds = replace(RING[2], dist=np.array(dist))
    assert np.isnan(undistort(folds, [0, 0])).all()
    stated.check("hall.toml", [*RING[:2], folds, RING[3]])
