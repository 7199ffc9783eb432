"""Lengths of known paths, the bias that noise gives them, and how sure the corrected length is."""

import tracemalloc

import numpy as np
import pytest

from courtside.kinematics import filtering, noise_propagation, path_length
from courtside.kinematics.noise_propagation import Noise
from courtside.kinematics.path_length import Others
from fixtures.people import footwork

SECONDS = 24
MODEL_BIAS = 1.0, 0.15
RATE_HZ = 50.0
T = np.arange(501) / RATE_HZ
CIRCLE = 2 * np.stack([np.cos(T), np.sin(T)], axis=1)  # 2 m/s
SPEED = np.full(len(T), 2.0)


def covariance(n_frames, sigma_m):
    return np.broadcast_to(np.eye(3) * sigma_m**2, (n_frames, 3, 3))


def measure(xyz, stated, rate_hz, noise, cutoff_hz, order, axes=path_length.SPACE):
    """Measure a raw path after one filter, without other errors than its noise."""
    path = filtering.zero_lag(xyz, rate_hz, cutoff_hz, order)
    parts, none = {cutoff_hz: stated}, Others({}, noise, np.zeros((len(path), 3, 0)))
    return path_length.measure(path, parts, rate_hz, noise, order, axes, MODEL_BIAS, none)


def arc(xyz):
    return np.linalg.norm(np.diff(xyz, axis=0), axis=1).sum()


def test_the_mean_length_of_random_vectors():
    rng = np.random.default_rng(0)
    mean = np.array([[0.0, 0, 0], [0.1, 0, 0], [1.0, 2.0, -1.0], [5.0, 0, 0], [0.3, 0.3, 0]])
    roots = rng.normal(0, 0.4, (5, 3, 3))
    roots[4, 2] = 0  # flat
    spread = roots @ roots.transpose(0, 2, 1)
    draws = mean[:, None] + np.einsum("nij,nkj->nki", roots, rng.normal(size=(5, 400_000, 3)))
    simulated = np.linalg.norm(draws, axis=-1).mean(axis=1)
    np.testing.assert_allclose(path_length.mean_norm(mean, spread), simulated, rtol=3e-3)


def test_the_mean_length_of_many_vectors_needs_little_memory():
    """The nodes of all vectors at once are 48 times as large as these."""
    mean, spread = np.ones((20_000, 3)), np.broadcast_to(np.eye(3), (20_000, 3, 3)).copy()
    tracemalloc.start()
    path_length.mean_norm(mean, spread)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10 * spread.nbytes


def test_the_mean_length_in_closed_form():
    for dimensions, factor in ((2, np.sqrt(np.pi / 2)), (3, np.sqrt(8 / np.pi))):
        found = path_length.mean_norm(np.zeros((1, dimensions)), 0.04 * np.eye(dimensions)[None])
        assert found[0] == pytest.approx(0.2 * factor, rel=1e-6)
    straight = path_length.mean_norm(np.array([[3.0, 4.0, 0]]), np.zeros((1, 3, 3)))
    assert straight[0] == pytest.approx(5.0, rel=1e-6)


def test_a_circle_without_noise():
    t = np.arange(0, 20, 1 / 60)
    xyz = np.stack([2 * np.cos(t), 2 * np.sin(t), 1 + 0 * t], axis=1)
    for axes in (path_length.SPACE, path_length.GROUND):
        found = measure(xyz, covariance(len(t), 1e-6), 60.0, Noise(0.0), 6.0, 4, axes)
        assert found.measured_m == pytest.approx(2 * t[-1], rel=1e-3)
        assert found.corrected_m == pytest.approx(2 * t[-1], rel=1e-3)
        assert found.seconds == pytest.approx(t[-1])


@pytest.mark.parametrize("rate_hz", [30.0, 60.0])
@pytest.mark.parametrize("sigma_m", [0.015, 0.025])
@pytest.mark.parametrize("memory_s", [0.0, 0.05, 0.15, "mixed"])
def test_a_player_goes_the_true_distance_within_one_percent(rate_hz, sigma_m, memory_s):
    truth = arc(footwork.neck(1000, SECONDS, seed=11)[1])
    _, path = footwork.neck(rate_hz, SECONDS, seed=11)
    rng = np.random.default_rng(2)
    if memory_s == "mixed":
        parts = [
            footwork.noise(len(path), rate_hz, sigma_m / np.sqrt(2), m, rng) for m in (0, 0.25)
        ]
        noisy = path + sum(parts)
    else:
        noisy = path + footwork.noise(len(path), rate_hz, sigma_m, memory_s, rng)
    stated = covariance(len(path), sigma_m)
    noise = noise_propagation.estimate(noisy, stated, rate_hz)
    found = measure(noisy, stated, rate_hz, noise, 6.0, 4)
    assert found.corrected_m == pytest.approx(truth, rel=0.01)
    # The filtered path without noise is what the bias is counted from.
    clean = measure(path, stated, rate_hz, noise, 6.0, 4).measured_m
    assert found.measured_m - clean < found.bias_most_m + 3 * found.sigma_m
    assert found.bias_m <= found.bias_most_m + 1e-9
    assert abs(found.corrected_m - clean) < 3 * found.sigma_m


def test_the_sigma_is_the_scatter_of_the_length():
    rate_hz, sigma_m, noise = 30.0, 0.02, Noise(0.1)
    _, path = footwork.neck(rate_hz, SECONDS, seed=3)
    stated = covariance(len(path), sigma_m)
    found = [
        measure(
            path + footwork.noise(len(path), rate_hz, sigma_m, 0.1, np.random.default_rng(seed)),
            stated, rate_hz, noise, 6.0, 4,
        )
        for seed in range(60)
    ]  # fmt: skip
    own = [np.sqrt(f.sigma_m**2 - (f.bias_sigma_m) ** 2) for f in found]
    scatter = np.std([f.measured_m for f in found], ddof=1)
    assert np.mean(own) == pytest.approx(scatter, rel=0.3)


def test_gaps_do_not_join_the_noise_on_both_sides_of_them():
    rate_hz, sigma_m, noise = 30.0, 0.02, Noise(0.0)
    path = np.outer(np.arange(900) / rate_hz, [1.5, 0.0, 0.0])
    path[np.arange(900) % 36 < 12] = np.nan  # 25 gaps
    found = [
        measure(
            path + np.random.default_rng(seed).normal(0, sigma_m, path.shape),
            covariance(len(path), sigma_m), rate_hz, noise, 6.0, 4,
        )
        for seed in range(60)
    ]  # fmt: skip
    own = [np.sqrt(f.sigma_m**2 - f.bias_sigma_m**2 - f.gaps_sigma_m**2) for f in found]
    assert np.mean(own) == pytest.approx(np.std([f.measured_m for f in found], ddof=1), rel=0.25)


def test_a_person_at_rest_goes_nearly_nowhere():
    sigma_m = 0.02
    noisy = np.random.default_rng(0).normal(0, sigma_m, (900, 3))
    found = measure(noisy, covariance(900, sigma_m), 30.0, Noise(0.0), 6.0, 4)
    assert found.measured_m > 8
    assert abs(found.corrected_m) < 0.25 * found.measured_m
    assert abs(found.corrected_m) < 3 * found.sigma_m


def test_a_gap_on_a_straight_line_changes_neither_distance_nor_time():
    t = np.arange(301) / 30
    xyz = np.stack([2 * t, 0 * t, 0 * t], axis=1)
    xyz[100:150] = np.nan
    found = measure(xyz, covariance(301, 1e-4), 30.0, Noise(0.0), 6.0, 4)
    assert found.seconds == pytest.approx(10)
    assert found.measured_m == pytest.approx(2 * (99 / 30 + 150 / 30), rel=1e-3)
    assert found.gaps_m == pytest.approx(2 * 51 / 30, rel=1e-3)
    assert found.corrected_m == pytest.approx(20, rel=1e-3)


def test_a_gap_longer_than_the_known_path_leaves_the_distance_unknown():
    t = np.arange(301) / 30
    xyz = np.stack([2 * t, 0 * t, 0 * t], axis=1)
    xyz[60:240] = np.nan
    found = measure(xyz, covariance(301, 1e-4), 30.0, Noise(0.0), 6.0, 4)
    assert np.isnan([found.corrected_m, found.sigma_m, found.gaps_m]).all()
    assert np.isfinite(found.bias_m)  # by which the report tells the cause
    assert found.measured_m == pytest.approx(2 * (59 / 30 + 60 / 30), rel=1e-3)


@pytest.mark.parametrize("gap_s", [0.2, 0.4, 0.8])
def test_ninety_percent_of_distances_with_gaps_hold_the_truth(gap_s):
    """A player's footwork with up to six gaps anywhere, forty times; some leave too little."""
    rate_hz, sigma_m, noise, off = 30.0, 0.015, Noise(0.05), []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        time_s, path = footwork.neck(rate_hz, 12, seed=seed)
        noisy = path + footwork.noise(len(path), rate_hz, sigma_m, 0.05, rng)
        for start in rng.integers(10, len(path) - 40, rng.integers(1, 7)):
            noisy[start : start + round(gap_s * rate_hz)] = np.nan
        found = measure(noisy, covariance(len(path), sigma_m), rate_hz, noise, 6.0, 4)
        assert found.seconds == pytest.approx(time_s[-1] - time_s[0])
        off.append((found.corrected_m - arc(path)) / found.sigma_m)
    known = np.isfinite(off)
    assert known.mean() > 0.9
    assert (np.abs(off)[known] < 1.645).mean() >= 0.88


def test_without_a_covariance_the_length_is_given_and_its_bias_unknown():
    _, path = footwork.neck(30, 5)
    unknown = np.full((len(path), 3, 3), np.nan)
    found = measure(path, unknown, 30.0, Noise(0.0), 6.0, 4)
    smooth = filtering.zero_lag(path, 30.0, 6.0, 4)
    assert found.measured_m == pytest.approx(arc(smooth), rel=0.005)
    assert np.isnan([found.bias_m, found.corrected_m, found.sigma_m]).all()
    none = measure(np.full((50, 3), np.nan), unknown[:50], 30.0, Noise(0.0), 6.0, 4)
    assert (none.measured_m, none.seconds) == (0.0, 0.0)
    assert np.isnan(none.corrected_m)


def bridge_circle(gaps, place=CIRCLE, speed=SPEED):
    """Return the path in gaps (start, stop)."""
    starts, stops = zip(*gaps, strict=True)
    runs = list(zip([0, *stops], [*starts, len(place)], strict=True))
    return path_length.bridged(place, speed, runs, RATE_HZ)


def test_gaps_of_a_circle_are_as_long_as_the_arc():
    found = bridge_circle([(100, 150), (300, 320)])
    assert found.length_m == pytest.approx(2 * (51 + 21) / RATE_HZ, rel=1e-3)
    assert found.sigma_m < 0.002


def test_a_path_without_gaps_has_none():
    found = path_length.bridged(CIRCLE, SPEED, [(0, len(T))], RATE_HZ)
    assert (found.length_m, found.sigma_m) == (0.0, 0.0)


def test_the_less_is_known_of_a_path_the_less_certain_is_its_gap():
    wavy = CIRCLE + 0.1 * np.sin(9 * T)[:, None]
    speed = np.linalg.norm(np.gradient(wavy, 1 / RATE_HZ, axis=0), axis=1)
    long, short = (bridge_circle([(60, 90)], wavy[:n], speed[:n]) for n in (501, 160))
    assert short.sigma_m > 1.3 * long.sigma_m > 0
    assert np.isnan(bridge_circle([(100, 400)]).length_m)
