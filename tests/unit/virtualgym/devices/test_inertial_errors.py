"""Errors of a virtual inertial suit: random wander, iron nearby, order of the strengths."""

from dataclasses import asdict

import numpy as np
import pytest

from virtualgym.devices import inertial_errors
from virtualgym.devices.inertial_errors import STRENGTHS, Errors


def test_wandering_has_its_spread_and_memory():
    rng = np.random.default_rng(0)
    values = inertial_errors.wandering(rng, 20000, (4, 3), 0.02, 1.0)
    assert values.shape == (20000, 4, 3)
    assert values.std() == pytest.approx(1.0, abs=0.06) and abs(values.mean()) < 0.06
    later = values[50:] * values[:-50]  # one memory later
    assert later.mean() == pytest.approx(np.exp(-1), abs=0.08)


def test_wander_from_zero_reaches_its_spread():
    rng = np.random.default_rng(1)
    values = inertial_errors.wandering(rng, 300, (2000,), 0.1, 5.0, from_zero=True)
    assert (values[0] == 0).all()
    expected = np.sqrt(1 - np.exp(-2 * 0.1 * np.arange(300) / 5.0))
    np.testing.assert_allclose(values.std(axis=1)[[5, 50, 299]], expected[[5, 50, 299]], rtol=0.06)


def test_iron_turns_some_headings_for_seconds():
    time_s = np.arange(0, 600, 0.02)
    errors = Errors(disturbed_deg=20.0, disturbed_every_s=6.0)
    heading = inertial_errors.disturbance(np.random.default_rng(2), time_s, 6, errors)
    far = np.abs(heading) > np.radians(5)
    assert 0.02 < far.mean() < 0.3 and far.any(axis=0).all()
    assert (np.abs(heading).max(axis=1) < np.radians(1)).mean() > 0.2, "in between all is well"
    rate = np.abs(np.diff(heading, axis=0)) / 0.02
    assert np.degrees(rate.max()) < 2 * 1.5 * 4 * 20 / 0.3, "it takes its time"


def test_without_iron_headings_are_undisturbed():
    time_s = np.arange(0, 10, 0.02)
    assert not inertial_errors.disturbance(np.random.default_rng(0), time_s, 6, Errors()).any()


def test_each_strength_is_worse_than_the_one_before_in_everything():
    memories = {name for name in asdict(Errors()) if name.endswith("_s") and name != "latency_s"}
    memories -= {"smooth_s", "drift_m_s"}
    order = [STRENGTHS[name] for name in ("none", "mild", "usual", "strong")]
    of_fourth = {"disturbed_deg", "leak", "slip"}
    for name in set(asdict(Errors())) - memories - of_fourth:
        values = [getattr(each, name) for each in order]
        assert values == sorted(set(values)), name
    for name in of_fourth:
        assert [getattr(each, name) for each in order] == [0, 0, 0, 0]
        assert getattr(STRENGTHS["disturbed"], name) > 0
