"""Wrong clicks are found, named, and told from line centres, where the truth is exact."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.bundle import selection, solver, variance_components
from courtside.calibration.court import click_checks, court, joint_adjustment, sfm_alignment
from courtside.geometry import camera as camera_models
from courtside.geometry import similarity
from fixtures.cameras import networks_made
from fixtures.cameras.scene import look_at, opencv_projection

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
SIGMA_PX = 0.23
SFM_FROM_WORLD = similarity.Sim3(0.4, np.eye(3)[[1, 2, 0]], np.array([1.0, 2, 3]))


def fixed_cameras():
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    places = {"side": (-18, 6.7, 1.9), "back": (3.05, -14.3, 2.1), "corner": (-9, -7, 5.0)}
    return [
        camera_models.Camera(name, (1280, 720), matrix, np.zeros(5), look_at(at, (3.05, 6.7, 1)))
        for name, at in places.items()
    ]


FIXED = fixed_cameras()
IN_SFM = [SFM_FROM_WORLD.camera(camera) for camera in FIXED]


def clicks(seed=0, xyz=COURT.xyz, sigma_px=SIGMA_PX):
    rng = np.random.default_rng(seed)
    return {
        camera.name: opencv_projection(camera, xyz) + sigma_px * rng.normal(size=(len(xyz), 2))
        for camera in FIXED
    }


def checked(given):
    table = click_checks.leave_one_out(IN_SFM, given, COURT)
    return click_checks.check(COURT, IN_SFM, given, sigma_px=SIGMA_PX, table=table)


def test_exact_clicks_leave_nothing_out():
    table = click_checks.leave_one_out(IN_SFM, clicks(sigma_px=0.0), COURT)
    assert table.cameras == ("side", "back", "corner") and table.points == COURT.points
    np.testing.assert_allclose(table.error_cm, 0, atol=1e-4)
    np.testing.assert_allclose(table.error_px, 0, atol=1e-4)


def test_a_click_is_judged_by_the_others_alone():
    given = clicks(sigma_px=0.0)
    given["corner"][:] = np.nan
    moved = COURT.xyz.copy()
    moved[6] += (
        0.1,
        0.05,
        0.0,
    )  # clicked beside the point in both cameras: nothing but the court tells
    for camera in FIXED[:2]:
        given[camera.name] = opencv_projection(camera, moved)
    table = click_checks.leave_one_out(IN_SFM, given, COURT)
    np.testing.assert_allclose(table.residual_m[6], [0.1, 0.05, 0], atol=1e-5)
    assert table.error_cm[6] == pytest.approx(100 * np.hypot(0.1, 0.05), abs=1e-3)
    assert np.isnan(table.error_px[2]).all()
    true = opencv_projection(FIXED[0], COURT.xyz)
    np.testing.assert_allclose(table.projected_px[0], true, atol=1e-3)


def test_good_clicks_are_not_accused():
    for seed in range(10):
        assert checked(clicks(seed)) == []


@pytest.mark.parametrize("camera", ["side", "back", "corner"])
def test_a_wrong_click_is_named_with_its_camera(camera):
    given = clicks(1)
    given[camera][5] += (25, 18)
    table = click_checks.leave_one_out(IN_SFM, given, COURT)
    worst = click_checks.find_wrong_clicks(table, sigma_px=SIGMA_PX)[0]
    assert (worst.camera, worst.point) == (camera, "p06")
    assert worst.error_px == pytest.approx(np.hypot(25, 18), rel=0.15)
    assert worst.looks_like is None and np.isfinite(worst.error_cm)


def test_a_wrong_click_in_one_of_two_cameras_is_named():
    given = clicks(2)
    given["corner"][:] = np.nan
    given["back"][1] += (30, 0)
    lines = checked(given)
    assert lines[0].startswith("camera back: point p02: expected")
    assert (
        "px away" in lines[0] and "click it again or delete it" in lines[0] and "\n" not in lines[0]
    )


@pytest.mark.parametrize("times_larger", [1, 3])
def test_a_click_is_judged_by_the_sigma_of_its_own_picture(times_larger):
    """The pictures of another camera may be three times as large, with clicks as much worse."""
    given = clicks(4)
    given["side"][5] += (2.4, 1.8)  # 13 sigmas; 4 of the larger pictures
    given["back"] = times_larger * (given["back"] + 0.5) - 0.5
    cameras = [IN_SFM[0], camera_models.scaled(IN_SFM[1], times_larger), IN_SFM[2]]
    sigma_px = joint_adjustment.click_sigmas(3 * SIGMA_PX, cameras)
    np.testing.assert_allclose(sigma_px, SIGMA_PX * np.array([1, times_larger, 1]))
    table = click_checks.leave_one_out(cameras, given, COURT)
    (wrong,) = click_checks.find_wrong_clicks(table, sigma_px=sigma_px)
    assert (wrong.camera, wrong.point) == ("side", "p06")


def test_exchanged_names_are_recognised():
    given = clicks(3)
    given["corner"][[3, 5]] = given["corner"][[5, 3]]
    table = click_checks.leave_one_out(IN_SFM, given, COURT)
    named = {
        (w.camera, w.point): w.looks_like
        for w in click_checks.find_wrong_clicks(table, sigma_px=SIGMA_PX)
    }
    assert named["corner", "p04"] == "p06" and named["corner", "p06"] == "p04"


def test_line_centres_are_recognised_and_edges_are_not():
    centres = COURT.xyz + court.to_line_centres(COURT)
    shifts = []
    for seed in range(8):
        lines = checked(clicks(seed, centres))
        assert len(lines) == 1 and "line centres seem to be clicked" in lines[0]
        xyz = sfm_alignment.reconstruct(IN_SFM, clicks(seed, centres))
        shifts.append(click_checks.inward_shift_of_points(COURT, xyz))
    shift, sigma = np.array(shifts).T
    assert abs(shift.mean() - 1) < 3 * sigma.mean() and sigma.max() < 0.25


def test_the_pattern_is_silent_without_the_points_to_tell():
    few = np.full_like(COURT.xyz, np.nan)
    few[:4] = COURT.xyz[:4]
    assert click_checks.inward_shift_of_points(COURT, few) == (0.0, np.inf)
    exact = click_checks.inward_shift_of_points(COURT, COURT.xyz + court.to_line_centres(COURT))
    assert exact[0] == pytest.approx(1, abs=0.02)


# ---- line centres in place of edges, from ties and clicks together

SIZES = (networks_made.SIZE, networks_made.SIZE)
WEIGHTS = {"click_sigma_px": 0.9, "click_bias_px": 0.01, "click_loss": np.inf}
CLICK_SIGMA_PX = 0.9 * 1280 / 3840


def ties_of(noise_px=0.5):
    made = networks_made.exact_lens_prior(networks_made.make(6, 60, noise_px=noise_px))
    return joint_adjustment.Ties(("side", "back"), SIZES, selection.marginalise(made, [0, 1]))


def clicks_of(xyz, noise_px=0.0, seed=0):
    rng = np.random.default_rng(seed)
    fixed = networks_made.fixed_cameras(networks_made.make(6, 60))
    exact = {camera.name: opencv_projection(camera, xyz) for camera in fixed}
    return {name: xy + noise_px * rng.normal(size=xy.shape) for name, xy in exact.items()}


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_exact_clicks_give_the_shift_itself(share):
    xyz = COURT.xyz + share * court.to_line_centres(COURT)
    found, sigma = click_checks.inward_shift(ties_of(0.0), clicks_of(xyz), COURT, **WEIGHTS)
    assert found == pytest.approx(share, abs=0.02)
    assert 0.02 < sigma < 0.25


def test_the_sigma_is_that_of_repeated_clicks():
    ties, sigmas, off = ties_of(0.0), [], []
    for seed in range(40):
        rng = np.random.default_rng(100 + seed)
        real = COURT.xyz + court.to_line_centres(COURT)
        real = real + COURT.sigma_m[:, None] * rng.normal(size=real.shape)
        clicks = clicks_of(real, CLICK_SIGMA_PX, seed)
        found, sigma = click_checks.inward_shift(ties, clicks, COURT, **WEIGHTS)
        off.append((found - 1) / sigma)
        sigmas.append(sigma)
    # Of 40 draws the mean scatters by 1 / sqrt(40), the standard deviation by 1 / sqrt(80).
    assert abs(np.mean(off)) < 3 / np.sqrt(40)
    assert np.std(off) == pytest.approx(1, abs=3 / np.sqrt(80))
    assert np.ptp(sigmas) < 0.2 * np.mean(sigmas)


def test_the_weights_of_ties_and_painted_lines_count():
    """Ties of a factor are ties of less information; lines are more knowledge of the cameras."""
    xyz = COURT.xyz + 0.4 * court.to_line_centres(COURT)
    ties, clicks = ties_of(0.0), clicks_of(xyz, CLICK_SIGMA_PX, 3)

    def shift(knowledge, **weights):
        own = replace(ties, knowledge=knowledge)
        return click_checks.inward_shift(own, clicks, COURT, **WEIGHTS, **weights)

    known = ties.knowledge
    factors = replace(variance_components.none(2), ties=9.0)
    loose, lines = solver.scaled(known, 1 / 9), solver.scaled(known, 3.0)
    np.testing.assert_allclose(shift(known, factors=factors), shift(loose), rtol=1e-6)
    both = solver.total([known, lines])
    np.testing.assert_allclose(shift(known, lines=lines), shift(both), rtol=1e-6)
    assert shift(known)[1] < 0.8 * shift(loose)[1]


def test_points_without_a_line_say_nothing():
    tips = np.where(COURT.xyz[:, 2:] > 0, COURT.xyz, np.nan)
    clicks = clicks_of(np.nan_to_num(tips))
    clicks = {n: np.where(np.isfinite(tips[:, :2]), xy, np.nan) for n, xy in clicks.items()}
    assert click_checks.inward_shift(ties_of(), clicks, COURT, **WEIGHTS) == (0.0, np.inf)
