"""Fixed cameras from ties and clicks: exact truth, the whole adjustment, and repeated errors."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import networks_made
from courtside.geometry import alignment, bundle, control_points, court_adjustment, courts
from courtside.study.errors import InputError
from scene import opencv_projection

COURT = courts.read(Path(__file__).parents[3] / "config" / "courts" / "badminton.yaml")
FIXED = {"side": 0, "back": 1}
SIZES = dict.fromkeys(FIXED, networks_made.SIZE)
EVERYTHING = {"min_angle_deg": 0, "max_error_px": 1e3, "max_points": 10**6, "seed": 0}
GAUSSIAN = {"click_sigma_px": 2.0, "click_loss": np.inf}  # 0.67 px in a picture 1280 px wide
SIGMA_PX = 2.0 * 1280 / 3840


def made(n_walk=4, n_points=30, **options):
    return networks_made.exact_lens_prior(networks_made.make(n_walk, n_points, **options))


def clicks_of(network, noise_px=0.0, seed=0, xyz=COURT.xyz, names=tuple(FIXED)):
    rng = np.random.default_rng(seed)
    cameras = networks_made.fixed_cameras(network, names)
    exact = {c.name: opencv_projection(c, xyz) for c in cameras}
    return {name: xy + noise_px * rng.normal(size=xy.shape) for name, xy in exact.items()}


def condense(
    network, clicks, fixed=FIXED, thinning=EVERYTHING, tie_sigma_px=1.0, court=COURT, **changes
):
    in_sfm = networks_made.in_random_frame(network)
    options = {"tie_sigma_px": tie_sigma_px, "tie_loss": np.inf, **GAUSSIAN, **changes}
    sizes = dict.fromkeys(fixed, networks_made.SIZE)
    return court_adjustment.condense(in_sfm, fixed, sizes, clicks, court, **options, **thinning)


def assert_cameras(found, true, tolerance_m=1e-5):
    for camera, known in zip(found, true, strict=True):
        np.testing.assert_allclose(camera.centre_in_world, known.centre_in_world, atol=tolerance_m)
        np.testing.assert_allclose(camera.K, known.K, rtol=1e-5, atol=1e-3)
        np.testing.assert_allclose(camera.cam_from_world, known.cam_from_world, atol=tolerance_m)


def test_exact_ties_and_clicks_give_the_true_cameras_whatever_the_frame():
    truth = made(6, 60)
    clicks = clicks_of(truth)
    ties, whole = condense(networks_made.disturbed(truth, scale=0.3), clicks)
    found = court_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    assert_cameras(found.cameras, networks_made.fixed_cameras(truth))
    assert [c.name for c in found.cameras] == ["side", "back"]
    assert found.cameras[0].size == networks_made.SIZE
    np.testing.assert_allclose(whole.xyz, truth.xyz, atol=1e-4)
    np.testing.assert_allclose(whole.cam_from_world, truth.cam_from_world, atol=1e-4)


def test_condensed_ties_agree_with_the_whole_adjustment_of_other_clicks():
    truth = made(4, 40, noise_px=0.5)
    ties, whole = condense(truth, clicks_of(truth))
    clicks = clicks_of(truth, SIGMA_PX, seed=1)
    clicks["side"][3] = np.nan
    found = court_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    both = control_points.add(
        whole,
        COURT.xyz,
        COURT.sigma_m,
        {0: clicks["side"], 1: clicks["back"]},
        sigma_px={0: SIGMA_PX, 1: SIGMA_PX},
        loss_scale=np.inf,
    )
    both, _ = bundle.adjust(both, tolerance=1e-12)
    off = found.network.difference(control_points.alone(both, [0, 1]))
    sigma = np.sqrt(np.diag(found.covariance))
    assert np.abs(off[sigma > 0] / sigma[sigma > 0]).max() < 0.1


def repeated(truth, n_draws, small):
    """Yield solutions of drawn ties, lens priors, courts and clicks."""
    rng, exact = np.random.default_rng(2), truth.lens_mean
    court = replace(COURT, sigma_m=small * COURT.sigma_m)
    truth = replace(truth, lens_sigma=small * truth.lens_sigma)
    sigma = np.where(np.isfinite(truth.lens_sigma), truth.lens_sigma, 0)
    weights = {"click_sigma_px": 2.0 * small, "click_loss": np.inf}
    for _ in range(n_draws):
        drawn = replace(
            truth,
            xy=truth.xy + small * rng.normal(size=truth.xy.shape),
            lens_mean=exact + sigma * rng.normal(size=exact.shape),
        )
        real = court.xyz + court.sigma_m[:, None] * rng.normal(size=court.xyz.shape)
        clicks = clicks_of(truth, small * SIGMA_PX, rng.integers(10**9), real)
        ties, _ = condense(drawn, clicks, court=court, tie_sigma_px=small, **weights)
        yield court_adjustment.solve(ties, clicks, court, **weights)


def test_covariance_is_that_of_repeated_clicks_ties_and_courts():
    """With errors of a third of the usual: covariance is of first order, and few ties bend the rest."""
    truth, n_draws = made(4, 25), 80
    places = np.array([[0.0, 0, 0], [3, 6, 2]])
    seen = clicks_of(truth, xyz=places)
    off, square, of_points = [], [], []
    for found in repeated(truth, n_draws, 0.3):
        active = np.diag(found.covariance) > 0
        part = found.covariance[np.ix_(active, active)]
        scale = np.sqrt(np.diag(part))
        error = found.network.difference(control_points.alone(truth, [0, 1]))[active]
        off.append(error / scale)
        square.append(off[-1] @ np.linalg.solve(part / np.outer(scale, scale), off[-1]))
        error_m = alignment.reconstruct(found.cameras, seen) - places
        spread = found.point_covariance(places)
        of_points.append([e @ np.linalg.solve(c, e) for e, c in zip(error_m, spread, strict=True)])
    assert len(off[0]) == 28  # all but flex
    assert np.mean(square) == pytest.approx(28, abs=4 * np.sqrt(2 * 28 / n_draws))
    ratio = np.sqrt(np.mean(np.square(off), axis=0))
    assert np.median(ratio) == pytest.approx(1, abs=0.1)
    assert np.abs(ratio - 1).max() < 4 / np.sqrt(2 * n_draws)
    np.testing.assert_allclose(np.mean(of_points, axis=0), 3, atol=4 * np.sqrt(6 / n_draws))


def test_wrong_clicks_and_ties_count_little_under_the_loss():
    truth = made(6, 60, noise_px=0.3)
    clicks = clicks_of(truth, 0.3)
    good = court_adjustment.solve(condense(truth, clicks)[0], clicks, COURT, **GAUSSIAN)
    wrong = {name: xy.copy() for name, xy in clicks.items()}
    wrong["side"][3] += 60.0
    truth.xy[np.random.default_rng(0).choice(len(truth.xy), 10, replace=False)] += 40.0
    robust = {"click_sigma_px": 2.0, "click_loss": 2.0}
    ties, _ = condense(truth, wrong, **robust, tie_loss=2.0)
    found = court_adjustment.solve(ties, wrong, COURT, **robust)
    plain = court_adjustment.solve(condense(truth, wrong)[0], wrong, COURT, **GAUSSIAN)
    true = [c.centre_in_world for c in networks_made.fixed_cameras(truth)]

    def error_m(solution):
        return np.linalg.norm(
            [c.centre_in_world - t for c, t in zip(solution.cameras, true, strict=True)]
        )

    assert error_m(found) < 2 * error_m(good) + 0.01
    assert error_m(plain) > 3 * error_m(found)


def test_a_choice_of_points_is_the_same_as_leaving_the_others_unclicked():
    truth = made(4, 30, noise_px=0.5)
    ties, _ = condense(truth, clicks_of(truth))
    clicks = clicks_of(truth, SIGMA_PX, seed=1)
    use = np.zeros(len(COURT.points), dtype=bool)
    use[COURT.indices("eight")] = True
    chosen = court_adjustment.solve(ties, clicks, COURT, **GAUSSIAN, points=use)
    fewer = {name: np.where(use[:, None], xy, np.nan) for name, xy in clicks.items()}
    left = court_adjustment.solve(ties, fewer, COURT, **GAUSSIAN)
    np.testing.assert_array_equal(chosen.covariance, left.covariance)
    everything = court_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    assert np.trace(chosen.point_covariance(COURT.xyz).sum(axis=0)) > np.trace(
        everything.point_covariance(COURT.xyz).sum(axis=0)
    )


def third_fixed(network):
    """Return the network whose third image is a fixed camera too, with a lens of its own."""
    lens_of_image = network.lens_of_image.copy()
    lens_of_image[2] = len(network.lens)
    return replace(
        network,
        lens_of_image=lens_of_image,
        **{
            name: np.concatenate([getattr(network, name), getattr(network, name)[2:]])
            for name in ("lens", "lens_mean", "lens_sigma")
        },
    )


def test_a_camera_without_clicks_is_placed_by_its_ties():
    truth = third_fixed(made(6, 60))
    clicks = clicks_of(truth)
    clicks["far"] = np.full_like(clicks["side"], np.nan)
    fixed = {**FIXED, "far": 2}
    ties, _ = condense(networks_made.disturbed(truth, scale=0.3), clicks, fixed)
    found = court_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    true = networks_made.fixed_cameras(truth, ("side", "back", "far"))
    assert_cameras(found.cameras, true, 1e-4)
    assert np.isfinite(found.covariance).all()


def test_a_camera_that_nothing_places_is_an_error():
    truth = third_fixed(made(6, 60))
    clicks = clicks_of(truth)
    clicks["far"] = np.full_like(clicks["side"], np.nan)
    blind = control_points.select(truth, np.ones(60, dtype=bool), truth.image_idx != 2)
    ties, _ = condense(blind, clicks, {**FIXED, "far": 2})
    with pytest.raises(InputError, match=r"camera far: expected .*, found neither"):
        court_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    exact = networks_made.fixed_cameras(truth, ("side", "back", "far"))[2]
    clicks["far"] = opencv_projection(exact, COURT.xyz)
    found = court_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    assert_cameras(found.cameras[2:], [exact], 1e-3)


def test_an_image_that_no_tie_sees_changes_nothing():
    truth = made(6, 60, noise_px=0.5)
    clicks = clicks_of(truth, SIGMA_PX)
    seen = truth.image_idx != 5
    blind = control_points.select(truth, np.ones(60, dtype=bool), seen)
    without = replace(
        blind,
        **{
            name: np.delete(getattr(truth, name), 5, axis=0)
            for name in ("cam_from_world", "flex", "flex_sigma", "lens_of_image", "height_px")
        },
        image_idx=blind.image_idx - (blind.image_idx > 5),
    )
    found, expected = (
        court_adjustment.solve(condense(n, clicks)[0], clicks, COURT, **GAUSSIAN)
        for n in (blind, without)
    )
    assert_cameras(found.cameras, expected.cameras)
    np.testing.assert_allclose(found.covariance, expected.covariance, rtol=1e-3, atol=1e-12)


def test_thinning_keeps_the_points_asked_for():
    truth = made(4, 60, noise_px=0.5)
    few = {"min_angle_deg": 5, "max_error_px": 10, "max_points": 20, "seed": 1}
    assert len(condense(truth, clicks_of(truth), thinning=few)[1].xyz) == 20


def test_clicks_of_one_camera_give_no_frame():
    truth = made()
    clicks = clicks_of(truth)
    clicks["back"][:] = np.nan
    with pytest.raises(InputError, match="expected three or more that are not on one line"):
        condense(truth, clicks)


def test_a_court_point_behind_the_camera_that_saw_it_is_an_error():
    truth = made()
    clicks = clicks_of(truth)
    clicks["side"][7] = np.nan  # the alignment cannot notice
    xyz = COURT.xyz.copy()
    xyz[7] = [3, -40, 0]
    with pytest.raises(InputError, match="found some behind after alignment"):
        condense(truth, clicks, court=replace(COURT, xyz=xyz))


def test_clicks_are_as_good_as_the_picture_is_wide():
    assert court_adjustment.click_sigma(1.5, (3840, 2160)) == 1.5
    assert court_adjustment.click_sigma(1.5, (1280, 720)) == 0.5
