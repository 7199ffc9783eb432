"""Many cameras at once, against the camera model and the courts of the study."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.calibration.court_lines import views
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures


def both():
    plain = (0, 0, 0, 0, 0)
    return [
        court_pictures.looking("a", (3.4, -9.0, 3.2), (3.0, 6.0, 0.2), dist=plain),
        court_pictures.looking("b", (-5.5, -4.0, 3.0), (3.3, 6.2, 0.1), dist=plain),
    ]


def test_projection_is_that_of_the_cameras(court):
    given = both()
    many = views.join([court_pictures.view_of(camera) for camera in given])
    floor = court.xyz[court.xyz[:, 2] == 0]
    found = many.project(floor[:, :2])
    for at, camera in enumerate(given):
        np.testing.assert_allclose(found[at], cameras.project(camera, floor), atol=1e-9)
    assert len(many) == 2 and np.isnan(many.project(np.array([[3.0, -30.0]]))).all()


@pytest.mark.parametrize("division", [-0.6, -0.05, 0.05])
def test_lenses_follow_the_division_model(court, division):
    straight = court_pictures.view_of(both()[0])
    bent = replace(straight, division=np.array([division]))
    floor = court.xyz[court.xyz[:, 2] == 0][:, :2]
    exact, seen = (
        (one.project(floor)[0] - one.principal) / one.f_px[0] for one in (straight, bent)
    )
    square = np.sum(seen**2, axis=1, keepdims=True)
    np.testing.assert_allclose(seen / (1 + division * square), exact, atol=1e-12)


@pytest.mark.parametrize(("division", "off_px"), [(-0.05, 1e-3), (-0.4, 0.1)])
def test_a_camera_is_near_the_division_model_where_it_is_asked_to_be(division, off_px):
    view = replace(court_pictures.view_of(both()[0]), division=np.array([division]))
    x, y = np.meshgrid(np.linspace(-5, 12, 60), np.linspace(-6, 30, 60))
    floor = np.column_stack([x.ravel(), y.ravel()])
    xy = view.project(floor)[0]
    near = np.linalg.norm(xy - view.principal, axis=1) < 500
    camera = views.to_camera(view, "a", court_pictures.SIZE, 1.0, 500.0)
    found = cameras.project(camera, np.column_stack([floor, np.zeros(len(floor))]))
    assert near.sum() > 500
    assert np.linalg.norm(found - xy, axis=1)[near].max() < off_px


def test_a_larger_picture_has_a_larger_camera(court):
    (camera, _) = both()
    large = views.to_camera(court_pictures.view_of(camera), "a", (1920, 1080), 2.0, 500.0)
    xy, wide = (cameras.project(one, court.xyz) for one in (camera, large))
    np.testing.assert_allclose(wide, 2 * (xy + 0.5) - 0.5, atol=1e-9)


def test_half_a_turn_shows_a_symmetric_court_alike(court):
    view = court_pictures.view_of(both()[1])
    turned = views.half_turned(view, court)
    shown = views.outline(view, court)
    np.testing.assert_allclose(views.outline(turned, court)[0, ::-1], shown[0], atol=1e-9)
    assert np.linalg.norm(turned.centre - view.centre) > 5


def test_the_courts_of_the_study_are_symmetric_and_a_half_one_is_not(court):
    for path in (court_pictures.ROOT / "config" / "courts").glob("*.yaml"):
        one = court_files.read(path)
        if len(one.lines_m):
            assert views.is_symmetric(one), path
    assert not views.is_symmetric(replace(court, lines_m=court.lines_m[:-1]))


def test_samples_cover_every_line(court):
    along = views.samples(court, 0.5)
    length = np.bincount(along.line, 2 * np.linalg.norm(along.half, axis=1))
    low, high = court.line_corners()
    np.testing.assert_allclose(length, (high - low).max(axis=1))
