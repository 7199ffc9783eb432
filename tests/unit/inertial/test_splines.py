"""Splines, their prior and the bordered system, against dense algebra and known covariances."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from courtside.inertial import splines

P, Q, N = 3, 2, 300


@pytest.fixture(scope="module")
def problem():
    rng = np.random.default_rng(0)
    basis = splines.basis_over(0.0, 10.0, 0.5)
    time_s = rng.uniform(0, 10, N)
    inner, outer = rng.normal(size=(N, 5, P)), rng.normal(size=(N, 5, Q))
    return basis, time_s, inner, outer, rng.normal(size=(N, 5))


def design(basis, time_s):
    first, values = basis.at(time_s)
    found = np.zeros((len(time_s), basis.n))
    for row, (start, four) in enumerate(zip(first, values, strict=True)):
        found[row, start : start + 4] = four
    return found


def dense(band):
    n = len(band)
    found = np.zeros((n, n))
    for step in range(4):
        at = np.arange(n - step)
        found[at, at + step] = found[at + step, at] = band[: n - step, step]
    return found


def solved(basis, time_s, inner, outer, wanted):
    first, values = basis.at(time_s)
    per_frame = inner.swapaxes(1, 2) @ inner
    sides = np.concatenate([outer, wanted[..., None]], axis=2)
    vector = inner.swapaxes(1, 2) @ sides
    blocks, right = np.zeros((basis.n, 4, P, P)), np.zeros((basis.n, P, Q + 1))
    splines.gather(blocks, right, first, values, per_frame, vector)
    band = splines.precision(basis, 2.0)
    blocks[:, :, range(P), range(P)] += band[..., None]
    flat = outer.reshape(-1, Q)
    found = splines.solve(
        blocks, right[..., -1], right[..., :-1], flat.T @ flat, flat.T @ wanted.reshape(-1)
    )
    matrix = np.einsum("tk,trp->trkp", design(basis, time_s), inner).reshape(-1, basis.n * P)
    matrix = np.column_stack([matrix, flat])
    normal = matrix.T @ matrix
    normal[: basis.n * P, : basis.n * P] += np.kron(dense(band), np.eye(P))
    return found, normal, matrix.T @ wanted.reshape(-1)


def test_splines_reproduce_a_cubic():
    basis = splines.basis_over(1.0, 4.0, 0.4)
    time_s = np.linspace(1, 4, 200)
    cubic = 0.3 * time_s**3 - time_s**2 + 2
    found = np.linalg.lstsq(design(basis, time_s), cubic, rcond=None)[0]
    assert basis.evaluate(found, time_s) == pytest.approx(cubic, abs=1e-9)
    assert basis.spacing_s <= 0.4


def test_times_outside_are_taken_as_the_ends():
    basis = splines.basis_over(0.0, 2.0, 0.5)
    spline = basis.evaluate(np.arange(basis.n, dtype=float), np.array([-1.0, 0.0, 2.0, 3.0]))
    assert spline[0] == spline[1] and spline[2] == spline[3]


def test_the_prior_is_the_process():
    basis = splines.basis_over(0.0, 20.0, 0.1)
    time_s = np.array([5.0, 6.0, 8.0, 12.0])
    rows = design(basis, time_s)
    covariance = rows @ np.linalg.inv(dense(splines.precision(basis, 2.0))) @ rows.T
    wanted = np.exp(-np.abs(time_s[:, None] - time_s) / 2.0)
    assert covariance == pytest.approx(wanted, abs=0.02)


def test_the_bordered_system_is_the_dense_one(problem):
    found, normal, right = solved(*problem)
    wanted = np.linalg.solve(normal, right)
    assert found.inner.reshape(-1) == pytest.approx(wanted[:-Q], abs=1e-10)
    assert found.border == pytest.approx(wanted[-Q:], abs=1e-12)
    assert found.border_covariance == pytest.approx(np.linalg.inv(normal)[-Q:, -Q:], rel=1e-8)


def test_samples_have_the_covariance(problem):
    found, normal, _ = solved(*problem)
    samples = found.samples(20000, np.random.default_rng(1)).reshape(20000, -1)
    wanted = np.diag(np.linalg.inv(normal[:-Q, :-Q]))
    assert samples.var(axis=0) == pytest.approx(wanted, rel=0.06)


def test_a_band_times_coefficients_is_the_dense_product():
    basis = splines.basis_over(0.0, 3.0, 0.5)
    band = splines.precision(basis, 1.0)
    coefficients = np.random.default_rng(2).normal(size=(basis.n, P))
    found = splines.times(np.repeat(band[..., None], P, axis=2), coefficients)
    assert found == pytest.approx(dense(band) @ coefficients, abs=1e-12)


def test_values_are_those_of_a_spline_through_them():
    basis = splines.basis_over(0.0, 5.0, 0.5)
    coefficients = np.sin(np.arange(basis.n))
    time_s = np.linspace(0, 5, 101)
    values = basis.evaluate(coefficients, time_s)
    knots = np.arange(0, 5.01, 0.5)
    other = make_interp_spline(time_s[::10], values[::10], k=3, t=None)
    assert len(knots) == basis.n_intervals + 1
    assert other(time_s[2:-2]) == pytest.approx(values[2:-2], abs=0.05)


def test_frames_are_added_to_the_coefficients_that_they_reach_alone(problem):
    """A part of a long take costs as much as a part of a short one."""
    basis, time_s, inner, outer, _ = problem
    time_s = np.sort(time_s)
    first, values = basis.at(time_s)
    per_frame, vector = inner.swapaxes(1, 2) @ inner, inner.swapaxes(1, 2) @ outer
    whole, parts = [
        (np.zeros((basis.n, 4, P, P)), np.zeros((basis.n, P, Q))) for _ in ("whole", "parts")
    ]
    splines.gather(*whole, first, values, per_frame, vector)
    for part in np.array_split(np.arange(N), 7):
        splines.gather(*parts, first[part], values[part], per_frame[part], vector[part])
    for one, other in zip(whole, parts, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-12)
    unknown = [np.full_like(one, np.nan) for one in whole]
    few = slice(100, 120)
    reached = np.zeros(basis.n, dtype=bool)
    reached[first[few].min() : first[few].max() + 4] = True
    for one in unknown:
        one[reached] = 0.0
    splines.gather(*unknown, first[few], values[few], per_frame[few], vector[few])
    assert all(np.isfinite(one[reached]).all() for one in unknown)
    assert all(np.isnan(one[~reached]).all() for one in unknown) and 0 < reached.sum() < basis.n
