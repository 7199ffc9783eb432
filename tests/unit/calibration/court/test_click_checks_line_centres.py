"""Line centres clicked instead of edges, told from ties and clicks together, where the truth is exact."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.bundle import selection
from courtside.calibration.court import click_checks, court, joint_adjustment
from fixtures.cameras import networks_made
from fixtures.cameras.scene import opencv_projection

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
SIZES = (networks_made.SIZE, networks_made.SIZE)
WEIGHTS = {"click_sigma_px": 0.9, "click_bias_px": 0.01, "click_loss": np.inf}
SIGMA_PX = 0.9 * 1280 / 3840


def ties_of(noise_px=0.5):
    made = networks_made.exact_lens_prior(networks_made.make(6, 60, noise_px=noise_px))
    return joint_adjustment.Ties(("side", "back"), SIZES, selection.what_ties_say(made, [0, 1]))


def clicks_of(xyz, noise_px=0.0, seed=0):
    rng = np.random.default_rng(seed)
    fixed = networks_made.fixed_cameras(networks_made.make(6, 60))
    exact = {camera.name: opencv_projection(camera, xyz) for camera in fixed}
    return {name: xy + noise_px * rng.normal(size=xy.shape) for name, xy in exact.items()}


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_exact_clicks_give_the_shift_itself(share):
    xyz = COURT.xyz + share * court.to_line_centres(COURT)
    found, sigma = click_checks.shift(ties_of(0.0), clicks_of(xyz), COURT, **WEIGHTS)
    assert found == pytest.approx(share, abs=0.02)
    assert 0.02 < sigma < 0.25


def test_the_sigma_is_that_of_repeated_clicks():
    ties, sigmas, off = ties_of(0.0), [], []
    for seed in range(40):
        rng = np.random.default_rng(100 + seed)
        real = COURT.xyz + court.to_line_centres(COURT)
        real = real + COURT.sigma_m[:, None] * rng.normal(size=real.shape)
        clicks = clicks_of(real, SIGMA_PX, seed)
        found, sigma = click_checks.shift(ties, clicks, COURT, **WEIGHTS)
        off.append((found - 1) / sigma)
        sigmas.append(sigma)
    # Of 40 draws the mean scatters by 1 / sqrt(40), the standard deviation by 1 / sqrt(80).
    assert abs(np.mean(off)) < 3 / np.sqrt(40)
    assert np.std(off) == pytest.approx(1, abs=3 / np.sqrt(80))
    assert np.ptp(sigmas) < 0.2 * np.mean(sigmas)


def test_points_without_a_line_say_nothing():
    tips = np.where(COURT.xyz[:, 2:] > 0, COURT.xyz, np.nan)
    clicks = clicks_of(np.nan_to_num(tips))
    clicks = {n: np.where(np.isfinite(tips[:, :2]), xy, np.nan) for n, xy in clicks.items()}
    assert click_checks.shift(ties_of(), clicks, COURT, **WEIGHTS) == (0.0, np.inf)
