"""Distances in an empty hall, against planes and boxes whose place is known."""

from dataclasses import fields, replace

import numpy as np
import pytest

from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import small_hall
from virtualgym.hall import painted_lines, quads
from virtualgym.rendering import background
from virtualgym.rendering.hall_renderer import Renderer

CAMERA = small_hall.camera(size=(320, 180))
LOW, HIGH = np.array([3.0, 3.5, 0.0]), np.array([3.6, 4.4, 0.9])
NET = painted_lines.Net(
    np.array([[2.0, 6.0, 0.0], [6.0, 6.0, 0.0]]), np.array([[2.0, 6.0, 1.5], [6.0, 6.0, 1.5]]), 0.0
)


@pytest.fixture(scope="module")
def renderer():
    grey = np.full((4, 4, 3), 120, np.uint8)
    crate = quads.box(LOW, np.diag(HIGH - LOW), grey)
    return Renderer(small_hall.scene(crate, net=NET))


@pytest.fixture(scope="module")
def empty(renderer):
    return background.look(renderer, CAMERA)


def rays(camera):
    """Return the eye (3,) and the direction (H, W, 3) of every pixel, of depth 1."""
    width, height = camera.size
    xy = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1)
    seen = cameras.undistort(camera, xy)
    rotation = camera.cam_from_world[:, :3]
    return camera.centre_in_world, np.concatenate(
        [seen, np.ones((height, width, 1))], -1
    ) @ rotation


def test_the_picture_is_that_of_the_empty_hall(renderer, empty):
    assert (empty.picture == renderer.render(CAMERA)).all()
    assert empty.filmed is not None and empty.filmed.size == CAMERA.size


def test_solid_things_are_as_far_as_they_are(empty):
    eye, way = rays(CAMERA)
    with np.errstate(divide="ignore"):
        near, far = ((side - eye) / way for side in (LOW, HIGH))
    enter = np.minimum(near, far).max(axis=-1)
    leave = np.maximum(near, far).min(axis=-1)
    crate = enter < leave - 0.05  # not just its edges
    assert crate.sum() > 500
    np.testing.assert_allclose(empty.solid_m[crate], enter[crate], rtol=1e-3)
    wall = ~empty.floor & ~(enter < leave + 0.1)
    room = np.maximum(*((side - eye) / way for side in small_hall.ROOM_M)).min(axis=-1)
    np.testing.assert_allclose(empty.solid_m[wall], room[wall], rtol=1e-3)


def test_the_floor_is_where_rays_meet_it_first_and_hides_nobody(empty):
    eye, way = rays(CAMERA)
    assert empty.floor.mean() > 0.2
    assert np.isinf(empty.solid_m[empty.floor]).all()
    place = eye + way * (-eye[2] / way[..., 2])[..., None]
    inside = ((place > 0.05) & (place < small_hall.ROOM_M[1] - 0.05))[..., :2].all(axis=-1)
    assert inside[empty.floor].mean() > 0.99


def test_the_net_is_where_rays_cross_its_mesh(empty):
    eye, way = rays(CAMERA)
    away = (6.0 - eye[1]) / way[..., 1]
    place = eye + way * away[..., None]
    high, low = 1.5 - painted_lines.TAPE_M, 1.5 - painted_lines.NET_DEPTH_M
    across = (place[..., 0] > 2.05) & (place[..., 0] < 5.95)
    meshed = across & (place[..., 2] > low + 0.02) & (place[..., 2] < high - 0.02)
    assert meshed.sum() > 1000
    np.testing.assert_allclose(empty.net_m[meshed], away[meshed], rtol=1e-3)
    beside = (place[..., 2] < low - 0.02) | (place[..., 2] > high + 0.02)
    assert np.isinf(empty.net_m[beside]).all()


def test_a_margin_shows_more_of_the_same(renderer, empty):
    wide = background.look(renderer, CAMERA, margin_px=12)
    assert wide.picture.shape == (204, 344, 3)
    assert (wide.filmed.K == CAMERA.K).all() and wide.filmed.size == CAMERA.size
    inner = slice(12, -12), slice(12, -12)
    assert (wide.floor[inner] != empty.floor).mean() < 1e-3
    middle = slice(60, 120), slice(110, 210)  # the vignette is of the whole picture
    difference = wide.picture[inner][middle].astype(int) - empty.picture[middle]
    assert np.abs(difference).mean() < 4


def test_what_is_kept_comes_back_for_the_cameras_asked(empty, tmp_path):
    path, other = tmp_path / "backdrops.npz", replace(CAMERA, name="other")
    dark = replace(empty, camera=other, picture=empty.picture // 2)
    background.write(path, [empty, dark])
    for found, expected in zip(background.read(path, [other, CAMERA]), [dark, empty], strict=True):
        for field in fields(expected):
            one, two = getattr(found, field.name), getattr(expected, field.name)
            np.testing.assert_array_equal(one, two)
            assert getattr(one, "dtype", None) == getattr(two, "dtype", None)


@pytest.mark.parametrize("change", [{"name": "third"}, {"size": (640, 360)}])
def test_a_kept_hall_of_other_cameras_is_refused(empty, tmp_path, change):
    background.write(tmp_path / "backdrops.npz", [empty])
    with pytest.raises(
        InputError, match=r"backdrops.npz: expected camera \w+ with .* make it again"
    ):
        background.read(tmp_path / "backdrops.npz", [replace(CAMERA, **change)])
