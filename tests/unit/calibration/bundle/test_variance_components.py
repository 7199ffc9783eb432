"""Variance factors of clicks and ties: known because the errors were drawn."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate

from courtside.calibration.bundle import selection, variance_components
from courtside.calibration.court import court as court_files
from courtside.calibration.court import joint_adjustment, line_edges, sfm_alignment
from courtside.statistics import normal_errors
from fixtures.cameras import networks_made
from fixtures.cameras.scene import opencv_projection

COURT = court_files.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
WEIGHTS = {"click_sigma_px": 3.0, "click_bias_px": 0.0, "click_loss": np.inf}  # 1 px at 1280 px
EXACT = replace(COURT, sigma_m=np.full(18, 1e-4))


@cache
def exact():
    """Return the network without errors, which nobody changes."""
    return networks_made.exact_lens_prior(networks_made.make(6, 60))


def solved(scatter_px, tie_sigma_px=1.0, points=None, seed=0, weights=WEIGHTS):
    """Solve from ties with errors of 1 px, and clicks with a scatter (2 cameras, 2 axes).

    Along edges that cross flat the clicks scatter more.
    """
    rng = np.random.default_rng(seed)
    truth = exact()
    drawn = replace(truth, xy=truth.xy + rng.normal(size=truth.xy.shape))
    weighed = selection.weigh(drawn, sigma_px=tie_sigma_px, loss_scale=np.inf)
    knowledge = selection.marginalise(weighed, [0, 1])
    ties = joint_adjustment.Ties(("side", "back"), (networks_made.SIZE,) * 2, knowledge)
    clicks = {
        camera.name: opencv_projection(camera, COURT.xyz)
        + rng.normal(size=(18, 2)) * sigma * np.sqrt(line_edges.click_variances(camera, COURT))
        for camera, sigma in zip(networks_made.fixed_cameras(truth), scatter_px, strict=True)
    }
    found = joint_adjustment.solve_with_factors(ties, clicks, EXACT, points=points, **weights)
    return found, truth


@pytest.mark.parametrize("times", [1.0, 3.0])
def test_factors_of_clicks_are_found_for_each_camera_and_axis(times):
    scatter = times * np.array([[2.0, 1.0], [1.0, 0.5]])
    found = [solved(scatter, seed=seed)[0].factors for seed in range(12)]
    mean = np.mean([factors.clicks for factors in found], axis=0)
    # Drawn to one another by the prior; 12 draws of some 15 redundant observations scatter by 10 %.
    assert mean[0, 0] > 1.5 * mean[1, 1] and mean[0, 0] == pytest.approx(4 * times**2, rel=0.35)
    assert np.mean(mean) == pytest.approx(np.mean(scatter**2), rel=0.25)
    assert found[0].clicks_redundancy.sum() < 2 * 36
    assert found[0].clicks_redundancy.sum() > 36


def test_the_factor_of_ties_grows_if_clicks_contradict_them():
    scatter = np.full((2, 2), 0.02)
    right, wrong = (
        np.median([solved(scatter, sigma, seed=seed)[0].factors.ties for seed in range(8)])
        for sigma in (1.0, 0.25)
    )
    assert 0.5 < right < 2
    assert wrong > 3 * right


def test_few_clicks_leave_the_prior():
    few = np.isin(COURT.points, COURT.sets["three"])
    found = solved(np.full((2, 2), 3.0), points=few)[0].factors
    every = solved(np.full((2, 2), 3.0))[0].factors
    assert found.clicks_redundancy.sum() < 6 < every.clicks_redundancy.sum()
    none = variance_components.none(2)
    assert (none.clicks == 1).all() and none.ties == none.bias == 1


@pytest.mark.parametrize("redundancy", [1.2, 4.0, 20.0])
def test_few_residuals_widen_the_ellipsoid_as_the_scatter_drawn_from_them_asks(redundancy):
    rng = np.random.default_rng(0)
    factors = replace(
        variance_components.none(2), clicks_redundancy=np.full((2, 2), redundancy / 4)
    )
    freedom = variance_components.CLICKS_PRIOR + redundancy
    # Of scale 1: the variance that is true, given what prior and residuals showed.
    variance = freedom / rng.chisquare(freedom, 20_000)
    error = rng.normal(size=(20_000, 3)) * np.sqrt(variance)[:, None]
    limit = normal_errors.ellipsoid(0.9) * factors.widening
    assert np.mean(np.sum(error**2, axis=1) <= limit) == pytest.approx(0.9, abs=0.006)


def test_much_redundancy_widens_nothing():
    many = replace(variance_components.none(2), clicks_redundancy=np.full((2, 2), 1e4))
    assert many.widening == pytest.approx(1, abs=1e-3)


def test_three_clicks_hold_nine_in_ten_of_the_errors_of_scattered_clicks():
    few = np.isin(COURT.points, COURT.sets["three"])
    inside = []
    for seed in range(16):
        found, truth = solved(np.full((2, 2), 3.0), points=few, seed=seed)
        true = networks_made.fixed_cameras(truth)
        seen = {camera.name: opencv_projection(camera, COURT.xyz) for camera in true}
        error = sfm_alignment.reconstruct(found.cameras, seen) - COURT.xyz
        distance = normal_errors.mahalanobis(error, found.point_covariance(COURT.xyz))
        inside.append(np.mean(distance <= normal_errors.ellipsoid(0.9)))
    assert 0.8 < np.mean(inside) < 0.97, np.mean(inside)


def test_the_covariance_holds_where_clicks_scatter_three_times_as_much():
    square = []
    for seed in range(30):
        found, truth = solved(np.full((2, 2), 3.0), seed=seed)
        true = networks_made.fixed_cameras(truth)
        for v, (camera, known) in enumerate(zip(found.cameras, true, strict=True)):
            by_focal = found.covariance[22 + 8 * v, 22 + 8 * v]
            square.append((camera.K[1, 1] - known.K[1, 1]) ** 2 / by_focal)
    assert 0.5 < np.mean(square) < 1.5


def test_the_loss_takes_its_known_part_of_a_normal_residual():
    for scale in (2.0, 4.0, np.inf):

        def part(s, k=scale):
            return s / (1 + s / k**2) * np.exp(-s / 2) / 2

        expected = integrate.quad(part, 0, np.inf)[0] / 2
        found = variance_components._consistency(np.array([scale]))
        assert found == pytest.approx(expected, rel=0.01)
