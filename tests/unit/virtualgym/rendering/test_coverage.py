"""Coverage, blur and occlusion of moving surfaces, against areas and places by geometry."""

import cv2
import numpy as np
import pytest

from fixtures.cameras import balls, scene, small_hall
from virtualgym.rendering import coverage, rolling_shutter, shading

CAMERA = small_hall.camera(size=(320, 180))
BOX = (0, 0, 320, 180)
FREE = np.full((180, 320), np.inf)


def screens(*athletes, exposure_s=0.0):
    shutter = 0.0, 0.0, exposure_s
    moving = [rolling_shutter.follow(athlete, CAMERA, *shutter) for athlete in athletes]
    return [rolling_shutter.Screen(each, CAMERA, *shutter) for each in moving]


def cover(*athletes, exposure_s=0.0, solid_m=FREE, net_m=FREE):
    return coverage.cover(screens(*athletes, exposure_s=exposure_s), BOX, solid_m, net_m)


def outline(athlete, time_s=0.0):
    """Return area and centroid of a convex body's picture, px."""
    xy = scene.opencv_projection(CAMERA, athlete.mesh(time_s).vertices.astype(float))
    moments = cv2.moments(cv2.convexHull(xy.astype(np.float32)))
    return moments["m00"], np.array([moments["m10"], moments["m01"]]) / moments["m00"]


def centroid(weight):
    rows, columns = np.indices(weight.shape)
    return np.array([(columns * weight).sum(), (rows * weight).sum()]) / weight.sum()


@pytest.mark.parametrize(
    "athlete",
    [
        balls.Ball((4.0, 4.5, 1.0)),
        balls.Ball((5.5, 4.1, 1.9)),
        balls.Plate((3.4, 4, 0.2), (4, 5, 1.9)),
    ],
)
def test_cover_has_the_area_and_the_place_of_the_projected_body(athlete):
    layer = cover(athlete)
    area, middle = outline(athlete)
    assert layer[..., 3].sum() == pytest.approx(area, rel=0.01)
    np.testing.assert_allclose(centroid(layer[..., 3]), middle, atol=0.05)
    edges = (layer[..., 3] > 0) & (layer[..., 3] < 1)
    assert 0.5 < edges.sum() / np.sqrt(area) < 6, "edges are smooth, and only edges"


def test_blur_is_as_long_as_the_way_during_the_exposure():
    still = balls.Ball((4.0, 4.5, 1.0))
    way = np.array([8.0, -8.0, 0.0])
    moving = balls.Ball((4.0, 4.5, 1.0), way)
    sharp, blurred = (cover(a, exposure_s=0.05)[..., 3] for a in (still, moving))
    ends = [outline(moving, t)[1] for t in (-0.025, 0.025)]
    length = ends[1][0] - ends[0][0]
    assert length > 8, "several moments"

    def variance(weight):
        columns = np.arange(320) - centroid(weight)[0]
        return (weight.sum(axis=0) * columns**2).sum() / weight.sum()

    found = np.sqrt(12 * (variance(blurred) - variance(sharp)))
    assert found == pytest.approx(length, rel=0.06)
    np.testing.assert_allclose(centroid(blurred), np.mean(ends, axis=0), atol=0.15)
    assert blurred.sum() == pytest.approx(sharp.sum(), rel=0.02)


def test_the_nearer_hides_the_other_whatever_their_order():
    away = np.array([4.0, 4.5, 1.0]) - CAMERA.centre_in_world
    near = balls.Ball(CAMERA.centre_in_world + 0.8 * away, bgr=(0, 0, 255), radius_m=0.2)
    far = balls.Ball(CAMERA.centre_in_world + away, bgr=(0, 255, 0), radius_m=0.4)
    one, two = cover(near, far), cover(far, near)
    np.testing.assert_allclose(one, two, atol=1e-3)
    alone = cover(near)
    hidden = alone[..., 3] == 1
    np.testing.assert_allclose(one[hidden], alone[hidden], atol=1e-3)
    assert (one[..., 1] > 50).sum() > 200, "the far one is seen round it"


def test_the_hall_hides_what_is_behind_it():
    ball = balls.Ball((4.0, 4.5, 1.0))
    depth = (ball.place - CAMERA.centre_in_world) @ CAMERA.cam_from_world[2, :3]
    solid = FREE.copy()
    solid[:, :160] = depth - 1
    solid[:90] = depth + 1
    free, layer = cover(ball), cover(ball, solid_m=solid)
    before = solid < depth
    assert layer[before].max() == 0 < free[before].max()
    assert (layer[~before] == free[~before]).all()


def test_the_net_takes_its_share_of_what_is_behind_it():
    ball = balls.Ball((4.0, 4.5, 1.0))
    depth = (ball.place - CAMERA.centre_in_world) @ CAMERA.cam_from_world[2, :3]
    free = cover(ball)
    behind, before = (cover(ball, net_m=np.full((180, 320), depth + x)) for x in (-1, 1))
    assert (before == free).all()
    share = shading.NET_COVER
    expected = free[..., :3] * (1 - share) + share * shading.NET_BGR * free[..., 3:]
    np.testing.assert_allclose(behind[..., :3], expected, atol=1e-2)
    assert (behind[..., 3] == free[..., 3]).all()


def test_a_part_of_the_picture_shows_the_same():
    ball = balls.Ball((4.0, 4.5, 1.0), (3.0, 2.0, 1.0))
    whole = cover(ball, exposure_s=0.02)
    x0, y0, x1, y1 = box = screens(ball, exposure_s=0.02)[0].box(3)
    part = coverage.cover(
        screens(ball, exposure_s=0.02), box, FREE[y0:y1, x0:x1], FREE[y0:y1, x0:x1]
    )
    np.testing.assert_allclose(part, whole[y0:y1, x0:x1], atol=64)  # a ray in a hundred at an edge
    assert np.abs(part - whole[y0:y1, x0:x1]).mean() < 0.05
    assert whole.sum() == pytest.approx(part.sum(), rel=1e-3)


def test_what_is_seen_from_inside_or_behind_shows_nothing():
    assert cover(balls.Ball(CAMERA.centre_in_world, radius_m=1.0)).max() == 0
    assert cover(balls.Ball((-3.0, -3.0, 1.7))).max() == 0
