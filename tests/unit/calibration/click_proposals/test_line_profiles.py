"""Profiles across drawn lines: where they are taken, and that expectation and picture agree."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from courtside.calibration.click_proposals import line_profiles
from courtside.calibration.court import line_edges
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures

BLUR_PX = 0.6


@pytest.fixture(scope="module")
def court():
    return court_pictures.badminton()


@pytest.fixture(scope="module")
def camera():
    return court_pictures.pair()[0]


@pytest.fixture(scope="module")
def grey(camera, court):
    return court_pictures.draw(camera, court).mean(axis=2).astype(np.float32)


def look(grey, camera, court, line, reach_px=4.0):
    ends, half = line_edges.middle_line(court, line)
    place = (ends + ends[0]) / 2  # its first half
    paint = line_edges.paint(camera, court)
    return line_profiles.sample_stretch(
        grey, camera, place, ends[0], half, paint, reach_px, BLUR_PX
    )


@pytest.mark.parametrize("line", range(12))
def test_what_is_expected_is_what_is_seen(grey, camera, court, line):
    stretch = look(grey, camera, court, line)
    half = (stretch.paint.shape[1] - 1) // 2
    middle = (stretch.seen.shape[1] - 1) // 2
    seen = stretch.seen[:, middle - half : middle + half + 1]
    floor, paint = 129.3, 231.3  # mean levels of the colours drawn
    off = (seen - floor) / (paint - floor) - stretch.paint
    assert (
        np.abs(off).mean() < 0.05
    )  # blur along a line is not expected, and tells where lines cross
    assert np.corrcoef(seen.ravel(), stretch.paint.ravel())[0, 1] > 0.9


def test_normals_point_to_the_higher_coordinate_and_along_is_px(grey, camera, court):
    stretch = look(grey, camera, court, 0)
    at = np.column_stack([np.full(5, 0.02), np.linspace(0.5, 6, 5), np.zeros(5)])
    tangent, normal = line_profiles.tangent_and_normal(
        camera, at, np.array([0, 13.4, 0]), np.array([0.02, 0, 0])
    )
    towards = cameras.project(camera, at + np.array([0.02, 0, 0])) - cameras.project(camera, at)
    assert (np.sum(towards * normal, axis=1) > 0).all()
    np.testing.assert_allclose(np.sum(tangent * normal, axis=1), 0, atol=1e-12)
    origin = cameras.project(camera, [0.02, 0, 0])
    np.testing.assert_allclose(
        stretch.along_px, np.linalg.norm(stretch.xy - origin, axis=1), rtol=5e-3
    )
    width = np.linalg.norm(
        cameras.project(camera, [0.04, 3, 0]) - cameras.project(camera, [0.0, 3, 0])
    )
    assert stretch.width_px == pytest.approx(width, rel=0.4)


def test_a_line_outside_the_picture_gives_nothing(grey, court):
    away = court_pictures.looking("away", (3, -9, 3), (3, -20, 3))
    assert look(grey, away, court, 0) is None


def test_the_blur_is_of_the_given_size(camera, court):
    """The expected edge rises from 16 % to 84 % over two standard deviations."""
    big = court_pictures.looking("near", (3.05, 4.9, 3.0), (3.05, 8.7, 0), f=1800.0)
    empty = np.zeros(big.size[::-1], np.float32)
    ends = np.array([[2.5, 8.70, 0], [3.6, 8.70, 0]])
    paint = line_edges.paint(big, court)
    half = np.array([0, 0.02, 0])
    stretch = line_profiles.sample_stretch(
        empty, big, ends, ends.mean(axis=0), half, paint, 2.0, 1.5
    )
    rise = stretch.paint[10]
    t = (np.arange(len(rise)) - (len(rise) - 1) / 2) * line_profiles.STEP_PX
    assert stretch.width_px > 8
    low, high = np.interp([0.159, 0.841], rise[t < 0], t[t < 0])
    assert (high - low) / 2 == pytest.approx(1.5, rel=0.05)
    assert cv2.minMaxLoc(stretch.paint)[1] == pytest.approx(1, abs=2e-3)


def test_a_line_whose_end_the_lens_model_does_not_reach_is_not_measured(grey, camera, court):
    ends, half = line_edges.middle_line(court, 0)
    strong = replace(camera, dist=np.array([-0.9, 0, 0, 0, 0]))
    corner = cameras.project(strong, ends[0] - [6.0, 3.0, 0])
    assert np.isnan(corner).all() and np.isfinite(cameras.project(strong, ends[1])).all()
    paint = line_edges.paint(strong, court)
    given = ends, ends[0] - [6.0, 3.0, 0], half, paint, 4.0, BLUR_PX
    assert line_profiles.sample_stretch(grey, strong, *given) is None
