"""Adjusted clocks: sinusoids of known offset, noise of known effect, priors, Student's factor."""

from itertools import combinations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from courtside.synchronisation import clock_adjustment

TIME_S = np.arange(900) / 30
OMEGA = 2 * np.pi * np.array([0.31, 0.47, 0.83])


def squares(noise, offsets, drifts):
    """Return the terms of three sinusoids seen by cameras: half squared differences of pairs."""

    def signal(camera, own):
        time_s = (own - offsets[camera] + 15 * drifts[camera]) / (1 + drifts[camera])
        angle = OMEGA * time_s[:, None]
        return np.sin(angle) + noise[camera], OMEGA * np.cos(angle), -(OMEGA**2) * np.sin(angle)

    def terms(own):
        result = {}
        for a, b in combinations(range(len(own)), 2):
            (va, sa, ba), (vb, sb, bb) = signal(a, own[a]), signal(b, own[b])
            miss, slope, bend = vb - va, (sa + sb) / 2, (bb - ba) / 4
            steep = (slope**2).sum(axis=1)
            result[a, b] = ((miss * slope).sum(axis=1), steep + (miss * bend).sum(axis=1), steep)
        return result

    return terms


def noise(rng, cameras, sigma):
    return rng.normal(0, sigma, (cameras, len(TIME_S), len(OMEGA)))


def test_exact_signals_give_exact_clocks():
    offsets, drifts = np.array([0.0, 0.03, -0.02]), np.array([0.0, 2e-4, -1e-4])
    terms = squares(np.zeros((3, 1, 3)), offsets, drifts)
    found = clock_adjustment.adjust(terms, [0, 0, 0], TIME_S, [0, 2, 2])
    own = np.stack([found.own(camera, TIME_S) for camera in range(3)])
    truth = (TIME_S - 15) * (1 + drifts[:, None]) + 15 + offsets[:, None]
    np.testing.assert_allclose(own, truth, atol=1e-5)


def test_the_stated_deviation_is_that_of_many_trials():
    rng = np.random.default_rng(0)
    errors, stated = [], []
    for _ in range(60):
        terms = squares(noise(rng, 3, 0.2), np.zeros(3), np.zeros(3))
        found = clock_adjustment.adjust(terms, [0, 0, 0], TIME_S, [0, 2, 2])
        errors.append(np.r_[found.offset_s[1:], found.drift[1:]])
        stated.append(np.sqrt(np.diag(found.covariance))[[2, 4, 3, 5]])
    ratio = np.std(errors, axis=0) / np.mean(stated, axis=0)
    # Student's factor for 0.6 of 19 degrees of freedom makes the stated one larger by 9 %.
    np.testing.assert_allclose(ratio, 0.92, atol=0.25)
    assert np.mean(ratio) == pytest.approx(0.92, abs=0.12)


def test_clocks_that_are_not_sought_stay():
    terms = squares(np.zeros((3, 1, 3)), np.array([0.0, 0.01, 0.02]), np.zeros(3))
    found = clock_adjustment.adjust(terms, [0, 0.5, 0], TIME_S, [0, 0, 1])
    assert found.offset_s[1] == 0.5
    assert (found.drift == 0).all()
    assert found.covariance[2, 2] == 0


def test_nothing_seen_is_infinitely_uncertain():
    def terms(own):
        return {(0, 1): (np.zeros(len(TIME_S)),) * 3}

    found = clock_adjustment.adjust(terms, [0, 0.1], TIME_S, [0, 2])
    assert np.isinf(found.covariance[2, 2])
    assert found.offset_s[1] == pytest.approx(0.1)


def test_a_prior_as_sure_as_the_data_halves_a_drift():
    covariance = np.zeros((4, 4))
    covariance[2:, 2:] = [[1e-6, 5e-8], [5e-8, 1e-8]]
    data = clock_adjustment.Adjusted(np.array([0, 0.01]), np.array([0, 2e-4]), covariance, 10.0)
    found = clock_adjustment.with_prior(data, 1e-4)
    assert found.drift[1] == pytest.approx(1e-4)
    # Half of the drift's change, carried over by its covariance with the offset: 5e-8 / 1e-8.
    assert found.offset_s[1] == pytest.approx(0.01 - 5 * 1e-4)
    assert found.covariance[3, 3] == pytest.approx(0.5e-8)
    assert found.drift[0] == 0


def test_students_factor_is_the_tables():
    # t of 95 % with 10 degrees of freedom is 1.812, the normal one 1.645.
    assert clock_adjustment.student(10) == pytest.approx(1.812 / 1.645, abs=1e-3)


@pytest.mark.parametrize(("seconds", "most"), [(0.9, 1.6), (1.5, 1.6), (4.0, 1.3)])
def test_evidence_of_a_short_time_is_as_uncertain_as_many_trials(seconds, most):
    """Noise that lasts 0.1 s, evidence only about the middle: blocks of seconds hold all of it."""
    shown = np.abs(TIME_S - 15) < seconds / 2
    errors, stated = [], []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        lasting, speed = (gaussian_filter1d(rng.normal(size=900), width) for width in (3, 6))
        speed = np.where(shown, speed, 0.0)

        def terms(own, lasting=lasting, speed=speed):
            miss = 0.05 * lasting + speed * (own[1] - own[0])
            return {(0, 1): (miss * speed, speed**2, speed**2)}

        found = clock_adjustment.adjust(terms, [0, 0], TIME_S, [0, 1])
        errors.append(found.offset_s[1])
        stated.append(np.sqrt(found.covariance[2, 2]))
    assert np.sqrt(np.mean(np.divide(errors, stated) ** 2)) < most


def test_hardly_any_evidence_of_one_camera_leaves_the_others_certain():
    terms = squares(noise(np.random.default_rng(0), 3, 0.2), np.zeros(3), np.zeros(3))
    shown = np.abs(TIME_S - 15) < 0.25

    def few(own):
        found = terms(own)
        return {
            pair: parts if pair == (0, 1) else tuple(np.where(shown, part, 0.0) for part in parts)
            for pair, parts in found.items()
        }

    found = clock_adjustment.adjust(few, [0, 0, 0], TIME_S, [0, 2, 1])
    assert np.isinf(found.covariance[4, 4])
    assert 0 < found.covariance[2, 2] < 0.01**2
    assert 0 < found.covariance[3, 3] < np.inf
