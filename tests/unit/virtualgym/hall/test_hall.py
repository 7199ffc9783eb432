"""A whole hall: the court's points are where its pictures show them, cameras fit, seeds repeat."""

import dataclasses
from pathlib import Path

import cv2
import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.geometry.camera import Camera
from fixtures.cameras import scene as projection
from virtualgym.cameras import layouts
from virtualgym.hall import hall
from virtualgym.presets import PLAIN, RICH
from virtualgym.rendering.hall_renderer import Renderer

COURTS = Path(__file__).parents[4] / "config" / "courts"
BADMINTON = court_files.read(COURTS / "badminton.yaml")
# Errors of paint that no reading of a picture could miss.
ROUGH = dataclasses.replace(PLAIN, line_sigma_m=0.012, post_tip_sigma_m=0.03, n_gear=0)


@pytest.fixture(scope="module")
def renderer():
    return Renderer(hall.build(ROUGH, BADMINTON, 5))


def close_up(place, target):
    pose = projection.look_at(place, target)
    matrix = np.array([[1500.0, 0, 322], [0, 1500, 235], [0, 0, 1]])
    return Camera("close", (640, 480), matrix, np.array([-0.1, 0.02, 1e-3, -1e-3, 0]), pose)


def edge_m(picture, camera, start, along, outward):
    """Return the mean distance of a white line's edge outward of a place in a picture, m."""
    steps, stretch = np.arange(-0.02, 0.02, 0.0002), np.linspace(0.08, 0.3, 60)
    xyz = start + stretch[:, None, None] * along + steps[:, None] * outward
    xy = projection.opencv_projection(camera, xyz.reshape(-1, 3)).astype(np.float32)
    found = cv2.remap(picture[..., 0], *xy.T.reshape(2, 60, -1), cv2.INTER_LINEAR).mean(axis=0)
    white, wood = found[:20].mean(), found[-20:].mean()
    assert white > wood + 50
    return steps[0] + 0.0002 * ((found - wood) / (white - wood)).sum()


@pytest.mark.parametrize("name", ["p01", "p02", "p03", "p16"])
def test_the_corners_of_the_court_are_where_their_lines_are_seen(renderer, name):
    at = BADMINTON.points.index(name)
    corner, nominal = renderer.scene.court_xyz[at], BADMINTON.xyz[at]
    inward = np.sign([*(BADMINTON.size_m / 2 - nominal[:2]), 0])
    x, y = np.eye(3)[:2] * inward
    camera = close_up(corner - 1.5 * x - 2.0 * y + [0, 0, 4.0], corner + 0.1)
    picture = renderer.render(camera)
    pixel_m = 4.7 / 1500
    for along, outward in ((x, -y), (y, -x)):
        assert abs(edge_m(picture, camera, corner, along, outward)) < 0.1 * pixel_m
    assert np.abs(corner - nominal).max() > 0.002


def test_the_tips_of_the_posts_are_where_they_are_seen(renderer):
    for name in ("p17", "p18"):
        tip = renderer.scene.court_xyz[BADMINTON.points.index(name)]
        camera = close_up(tip + np.array([0.3, -2.0, 2.5]), tip)
        picture = renderer.render(camera).astype(float)
        # The top's face, from its light against the wood around and the tape beside.
        corners = tip + 0.02 * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
        mask = np.zeros(picture.shape[:2], np.uint8)
        outline = np.rint(projection.opencv_projection(camera, corners)).astype(np.int32)
        cv2.fillConvexPoly(mask, outline, 1)
        inner = cv2.erode(mask, np.ones((5, 5), np.uint8)) > 0
        assert inner.sum() > 50
        assert picture[inner].std(axis=0).max() < 3


def test_the_same_seed_builds_the_same_hall():
    halls = [hall.build(PLAIN, BADMINTON, seed, floor_texel_m=0.05) for seed in (1, 1, 2)]
    sequence = np.random.SeedSequence(1)
    sequence.spawn(3)  # what else its owner drew from it does not matter
    halls.append(hall.build(PLAIN, BADMINTON, sequence, floor_texel_m=0.05))
    for other in (halls[1], halls[3]):
        np.testing.assert_array_equal(halls[0].court_xyz, other.court_xyz)
        for one, same in zip(halls[0].quads, other.quads, strict=True):
            np.testing.assert_array_equal(one.texture, same.texture)
            np.testing.assert_array_equal([one.origin, one.u, one.v], [same.origin, same.u, same.v])
    assert np.abs(halls[0].court_xyz - halls[2].court_xyz).max() > 1e-4
    assert (halls[0].quads[0].texture != halls[2].quads[0].texture).mean() > 0.3


@pytest.mark.parametrize("path", sorted(COURTS.glob("*.yaml")), ids=lambda path: path.stem)
@pytest.mark.parametrize("layout", sorted(layouts.LAYOUTS))
def test_every_camera_stands_inside_the_hall_and_before_its_furniture(path, layout):
    court = court_files.read(path)
    low, high = hall.room(court)
    rng = np.random.default_rng(0)
    for camera in layouts.fixed_cameras(layout, court, (1280, 720), RICH, rng):
        place = camera.centre_in_world
        assert (place > low + 1.0).all(), camera.name
        assert (place < high - [2.9, 2.9, 1.0]).all(), camera.name


def test_the_plain_hall_has_less_to_see():
    def detail(preset):
        scene = hall.build(preset, BADMINTON, 3, floor_texel_m=0.02)
        camera = layouts.fixed_cameras(
            "b", BADMINTON, (640, 360), preset, np.random.default_rng(0)
        )[0]
        grey = cv2.cvtColor(Renderer(scene).render(camera), cv2.COLOR_BGR2GRAY).astype(np.float32)
        return np.abs(cv2.Laplacian(grey, cv2.CV_32F)).mean()

    assert detail(PLAIN) < 0.6 * detail(RICH)
