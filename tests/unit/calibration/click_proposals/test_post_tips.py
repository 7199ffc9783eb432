"""Posts in drawn pictures: axes and ends against projection; a post behind the other is none."""

from functools import cache

import numpy as np
import pytest

from courtside.calibration.click_proposals import post_tips
from courtside.calibration.click_proposals.view import View
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures

SIZE = (1280, 720)


@pytest.fixture(scope="module")
def court():
    return court_pictures.badminton()


@cache
def drawn(at):
    """Return one of two cameras and its picture of the court."""
    camera = court_pictures.pair(SIZE, 1150.0)[at]
    return camera, court_pictures.draw(camera, court_pictures.badminton(), noise=3)


def view(camera, court, picture):
    return View(picture.mean(axis=2).astype(np.float32), camera, court, 0.75, 1)


@pytest.mark.parametrize("at", [0, 1])
@pytest.mark.parametrize("post", [0, 1])
def test_ends_and_axes_are_found(court, at, post):
    camera, picture = drawn(at)
    made = view(camera, court, picture)
    tip = cameras.project(made.camera, court.xyz[court.points.index(("p17", "p18")[post])])
    foot = cameras.project(made.camera, court.xyz[court.points.index(("p10", "p11")[post])])
    xy, covariance, share, reason = post_tips.tip(made, post)
    assert not reason and share > 0.6
    np.testing.assert_allclose(xy, tip, atol=0.6)
    assert np.sqrt(np.linalg.eigvalsh(covariance)[-1]) < 0.6
    ray = post_tips.axis(made, post)
    across = np.array([-ray.direction[1], ray.direction[0]])
    assert abs((foot - ray.start) @ across) < 0.3
    assert abs((tip - ray.start) @ across) < 0.8


def test_the_post_behind_is_none(court):
    side = court_pictures.looking("side", (-9, 6.7, 1.6), (3, 6.7, 0.8), size=SIZE, f=1150.0)
    made = view(side, court, court_pictures.draw(side, court, noise=3))
    for post in (0, 1):
        assert post_tips.tip(made, post)[3] == "one post is behind the other"
    assert post_tips.axis(made, 0) is not None
    assert post_tips.axis(made, 1) is None


def test_without_posts_there_are_none(court):
    camera = court_pictures.pair(SIZE, 1150.0)[0]
    picture = np.random.default_rng(1).normal(120, 4, (*SIZE[::-1], 3)).astype(np.uint8)
    made = view(camera, court, picture)
    assert post_tips.axis(made, 0) is None
    xy, _, share, reason = post_tips.tip(made, 0)
    assert np.isnan(xy).all() and share == 0 and "not seen" in reason
