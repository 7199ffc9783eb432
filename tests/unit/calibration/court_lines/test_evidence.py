"""Scores of cameras at and beside the right place, in drawn pictures."""

import numpy as np
import pytest

from courtside.calibration.court_lines import evidence, ridges, views
from fixtures.cameras import court_pictures


def test_the_right_camera_explains_most(court, seen):
    view = court_pictures.view_of(court_pictures.pair()[1])
    shift = np.array([[0, 0, 0], [0.3, 0, 0], [0, 1.0, 0], [0, 0, 0.4], [0, 300.0, 0]])
    many = view[np.zeros(5, dtype=int)]
    many = views.Views(many.rotation, many.centre + shift, many.f_px, many.division, many.principal)
    found = evidence.score(seen, many, views.samples(court, 0.3), 3.0)
    assert (found.weight * found.close)[0].sum() > 0.6 * found.weight[0].sum()
    assert (found.score[0] > 2 * found.score[1:]).all()
    assert found.score[4] == -1  # the court is out of the picture, behind the camera
    assert found.weight.shape == found.close.shape == (5, len(views.samples(court, 0.3).line))


def test_distances_are_by_direction():
    on = np.zeros((40, 60), dtype=bool)
    on[20, 10:50] = True
    found = evidence.fields(ridges.Ridges(on, np.zeros(on.shape)))
    assert found.distance[0, 25, 30] == pytest.approx(5, abs=0.2)
    assert found.distance[6, 25, 30] == evidence.FARTHEST_PX
    assert found.chance(8.0)[6] == 0 < found.chance(8.0)[0]


def test_chance_alone_scores_little(court):
    rng = np.random.default_rng(0)
    on = rng.random((540, 960)) < 0.02
    seen = evidence.fields(ridges.Ridges(on, rng.uniform(0, np.pi, on.shape)))
    view = court_pictures.view_of(court_pictures.pair()[1])
    assert evidence.score(seen, view, views.samples(court, 0.3), 3.0).score[0] < 10
