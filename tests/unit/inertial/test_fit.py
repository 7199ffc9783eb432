"""The fit brings a wandering body back, by corrections of the size that is needed."""

from functools import cache

import numpy as np
import pytest

from courtside.inertial import fit, vision
from fixtures.people import moved_bodies

TRUE = moved_bodies.moving(4, seconds=12.0)


@cache
def fitted(drift_m):
    """Return the fit of a body whose root wanders by so much."""
    body = moved_bodies.moving(4, seconds=12.0)
    rng = np.random.default_rng(0)
    body.translation[:, 0] += drift_m * moved_bodies.smooth(rng, len(body.time_s), (3,), 2.0)
    seen = vision.observe(body, moved_bodies.seen(TRUE, 1, sd_m=(0.01,) * 3), 0.01)
    state = fit.Fit(body, seen, moved_bodies.UP, 0.0)
    state.run()
    return state


def test_sizes_of_corrections_follow_what_is_needed():
    still, wandering = fitted(0.0), fitted(0.5)
    assert wandering.size["shift"] > 4 * still.size["shift"]
    assert still.size["shift"] < 0.3 * still.stated["shift"]
    assert wandering.size["thigh"] == pytest.approx(still.size["thigh"], rel=0.5)


def test_a_wandering_root_is_brought_back():
    fit = fitted(0.5)
    residual = np.linalg.norm(fit.vision - fit.last, axis=2)
    assert np.nanmedian(residual) < 0.03
    assert np.nanmedian(np.linalg.norm(fit.vision - fit.first, axis=2)) > 0.2


def test_the_fit_settles():
    changes = fitted(0.5).rms_change_m
    assert changes[-1] < fit.TOLERANCE_M
    assert changes[-1] < 0.05 * changes[0]


def test_the_fit_is_repeatable():
    first = fitted(0.0)
    fitted.cache_clear()
    assert np.array_equal(fitted(0.0).coefficients, first.coefficients)


def test_the_way_a_body_faces_ignores_its_lean():
    turns = np.linspace(0, 3 * np.pi, 50)
    lean = np.array([[1, 0, 0], [0, np.cos(0.3), -np.sin(0.3)], [0, np.sin(0.3), np.cos(0.3)]])
    found = fit.facings(moved_bodies.about_up(turns) @ lean, moved_bodies.UP)
    assert found[:, 1] == pytest.approx(turns, abs=1e-9)
    assert np.abs(found[:, [0, 2]]).max() == 0
