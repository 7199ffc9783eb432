"""A camera fitted to the paint of a whole court: drawn pictures with known cameras."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.click_proposals.view import View
from courtside.calibration.court_lines import fitting, ridges
from courtside.calibration.court_lines.painting import Pattern
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures


def off_px(view, camera, court):
    floor = court.xyz[court.xyz[:, 2] == 0]
    return np.linalg.norm(view.project(floor[:, :2])[0] - cameras.project(camera, floor), axis=1)


@pytest.mark.parametrize("camera", court_pictures.pair(), ids=lambda camera: camera.name)
def test_a_rough_camera_moves_onto_the_lines(court, camera):
    image = court_pictures.draw(camera, court, noise=3)
    picture = ridges.contrast(image, "light")
    true = court_pictures.view_of(camera)
    middle = np.array([*court.size_m / 2, 0])
    start = replace(
        true, centre=middle + 1.02 * (true.centre - middle), f_px=1.02 * true.f_px, k1=true.k1 * 0
    )
    start = fitting._moved(start, np.array([0.004, -0.004, 0, 0, 0, 0, 0, 0]))
    assert np.median(off_px(start, camera, court)) > 3
    pictures, pattern = fitting.blurred(picture), Pattern.of(court)
    turned = fitting.shifted(pattern, pictures, start, 0)
    assert np.median(off_px(turned.view, camera, court)) < 3
    found = fitting.fit(pattern, pictures, start)
    assert found.match > turned.match
    assert np.median(off_px(found.view, camera, court)) < 2.0
    seen = View.of(image, camera, court, "light")
    again = fitting.fit_again(pattern, pictures, found.view, seen)
    assert again.match > 0.99 * found.match
    assert np.median(off_px(again.view, camera, court)) < 0.5


def test_a_court_out_of_the_picture_cannot_be_fitted(court):
    camera = court_pictures.pair()[1]
    view = court_pictures.view_of(camera)
    away = replace(view, rotation=view.rotation * np.array([-1, 1, -1])[:, None])
    pictures = fitting.blurred(np.zeros(camera.size[::-1], np.float32))
    assert fitting.fit(Pattern.of(court), pictures, away) is None
