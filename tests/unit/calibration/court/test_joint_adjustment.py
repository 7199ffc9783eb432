"""Fixed cameras from ties and clicks: exact truth, the whole adjustment, and repeated errors."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.bundle import selection, solver, walk_parts
from courtside.calibration.court import court as court_files
from courtside.calibration.court import joint_adjustment, line_edges, sfm_alignment
from courtside.geometry import similarity
from courtside.study.errors import InputError
from fixtures.cameras import networks_made
from fixtures.cameras.scene import opencv_projection

COURT = court_files.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
FIXED = {"side": 0, "back": 1}
SIZES = dict.fromkeys(FIXED, networks_made.SIZE)
EVERYTHING = {
    "images_per_part": 100,
    "min_angle_deg": 0,
    "max_error_px": 1e3,
    "max_points": 10**6,
    "seed": 0,
}
GAUSSIAN = {"click_sigma_px": 2.0, "click_bias_px": 0.0, "click_loss": np.inf}
SIGMA_PX = 2.0 * 1280 / 3840  # of a click in these pictures


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
    del options["click_bias_px"]
    sizes = dict.fromkeys(fixed, networks_made.SIZE)
    return joint_adjustment.condense(in_sfm, fixed, sizes, clicks, court, **options, **thinning)


def assert_cameras(found, true, tolerance_m=1e-5):
    for camera, known in zip(found, true, strict=True):
        np.testing.assert_allclose(camera.centre_in_world, known.centre_in_world, atol=tolerance_m)
        np.testing.assert_allclose(camera.K, known.K, rtol=1e-5, atol=1e-3)
        np.testing.assert_allclose(camera.cam_from_world, known.cam_from_world, atol=tolerance_m)


def test_exact_ties_and_clicks_give_the_true_cameras_whatever_the_frame():
    truth = made(6, 60)
    clicks = clicks_of(truth)
    ties, (part,) = condense(networks_made.disturbed(truth, scale=0.3), clicks)
    whole = part.network
    found = joint_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    assert_cameras(found.cameras, networks_made.fixed_cameras(truth))
    assert [c.name for c in found.cameras] == ["side", "back"]
    assert found.cameras[0].size == networks_made.SIZE
    np.testing.assert_allclose(whole.xyz, truth.xyz, atol=1e-4)
    np.testing.assert_allclose(whole.cam_from_world, truth.cam_from_world, atol=1e-4)


def test_clicks_of_a_neighbouring_court_strain_the_ties_and_right_ones_do_not():
    truth = made(n_walk=6, n_points=60, noise_px=0.5)
    right = clicks_of(truth, noise_px=0.5)
    neighbour = clicks_of(truth, noise_px=0.5, xyz=np.add(COURT.xyz, (8.1, 0, 0)))
    _, parts = condense(truth, right, tie_sigma_px=0.5)
    assert 0 <= joint_adjustment.strain(parts) < 10
    _, parts = condense(truth, {**right, "back": neighbour["back"]}, tie_sigma_px=0.5)
    assert joint_adjustment.strain(parts) > 100


def test_condensed_ties_agree_with_the_whole_adjustment_of_other_clicks():
    truth = made(4, 40, noise_px=0.5)
    ties, (part,) = condense(truth, clicks_of(truth))
    whole = part.network
    clicks = clicks_of(truth, SIGMA_PX, seed=1)
    clicks["side"][3] = np.nan
    found = joint_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    both = selection.add_control_points(
        whole,
        COURT.xyz,
        COURT.sigma_m,
        {0: clicks["side"], 1: clicks["back"]},
        sigma_px={0: SIGMA_PX, 1: SIGMA_PX},
        loss_scale=np.inf,
    )
    both, _ = solver.adjust(both, tolerance=1e-12)
    off = found.network.difference(selection.images_only(both, [0, 1]))
    sigma = np.sqrt(np.diag(found.covariance))
    assert np.abs(off[sigma > 0] / sigma[sigma > 0]).max() < 0.1


def repeated(truth, n_draws, small):
    """Yield solutions of drawn ties, lens priors, courts and clicks."""
    rng, exact = np.random.default_rng(2), truth.lens_mean
    court = replace(COURT, sigma_m=small * COURT.sigma_m)
    truth = replace(truth, lens_sigma=small * truth.lens_sigma)
    sigma = np.where(np.isfinite(truth.lens_sigma), truth.lens_sigma, 0)
    weights = {**GAUSSIAN, "click_sigma_px": 2.0 * small}
    for _ in range(n_draws):
        drawn = replace(
            truth,
            xy=truth.xy + small * rng.normal(size=truth.xy.shape),
            lens_mean=exact + sigma * rng.normal(size=exact.shape),
        )
        real = court.xyz + court.sigma_m[:, None] * rng.normal(size=court.xyz.shape)
        clicks = clicks_of(truth, small * SIGMA_PX, rng.integers(10**9), real)
        ties, _ = condense(drawn, clicks, court=court, tie_sigma_px=small, **weights)
        yield joint_adjustment.solve(ties, clicks, court, **weights)


def test_covariance_is_that_of_repeated_clicks_ties_and_courts():
    """With a third of the usual errors: covariance is of first order, few ties bend the rest."""
    truth, n_draws = made(4, 25), 80
    places = np.array([[0.0, 0, 0], [3, 6, 2]])
    seen = clicks_of(truth, xyz=places)
    off, square, of_points = [], [], []
    for found in repeated(truth, n_draws, 0.3):
        active = np.diag(found.covariance) > 0
        part = found.covariance[np.ix_(active, active)]
        scale = np.sqrt(np.diag(part))
        error = found.network.difference(selection.images_only(truth, [0, 1]))[active]
        off.append(error / scale)
        square.append(off[-1] @ np.linalg.solve(part / np.outer(scale, scale), off[-1]))
        error_m = sfm_alignment.reconstruct(found.cameras, seen) - places
        spread = found.point_covariance(places)
        of_points.append([e @ np.linalg.solve(c, e) for e, c in zip(error_m, spread, strict=True)])
    assert len(off[0]) == 28  # all but flex
    assert np.mean(square) == pytest.approx(28, abs=4 * np.sqrt(2 * 28 / n_draws))
    ratio = np.sqrt(np.mean(np.square(off), axis=0))
    assert np.median(ratio) == pytest.approx(1, abs=0.1)
    assert np.abs(ratio - 1).max() < 4 / np.sqrt(2 * n_draws)
    np.testing.assert_allclose(np.mean(of_points, axis=0), 3, atol=4 * np.sqrt(6 / n_draws))


def test_clicks_along_flat_edges_weigh_less():
    truth = made(6, 60)
    ties, _ = condense(truth, clicks_of(truth))
    cameras = dict(zip(FIXED, networks_made.fixed_cameras(truth), strict=True))
    places = np.array([[0.0, 0, 0], [3, 6, 2], [6, 13, 1]])
    seen, rng = clicks_of(truth, xyz=places), np.random.default_rng(4)
    root = {
        name: np.linalg.cholesky(
            line_edges.click_covariances(camera, COURT.xyz, line_edges.on_lines(COURT))
        )
        for name, camera in cameras.items()
    }
    errors = []
    for _ in range(30):
        noise = {name: (root[name] @ rng.normal(size=(18, 2, 1)))[..., 0] for name in FIXED}
        clicks = {name: xy + SIGMA_PX * noise[name] for name, xy in clicks_of(truth).items()}
        solved = [
            way(ties, clicks, COURT, **GAUSSIAN)
            for way in (joint_adjustment.solve, joint_adjustment.solve_by_edges)
        ]
        off = [sfm_alignment.reconstruct(each.cameras, seen) - places for each in solved]
        errors.append([np.linalg.norm(each) for each in off])
    alike, weighed = np.median(errors, axis=0)
    assert weighed < 0.85 * alike


def test_what_the_clicks_in_a_picture_have_in_common_is_found():
    """Clicks too high in one picture and too low in the other: no world frame explains that."""
    truth = made(6, 60)
    clicks, shift = clicks_of(truth), {"side": np.array([0, 0.5]), "back": np.array([0, -0.5])}
    shifted = {name: xy + shift[name] for name, xy in clicks.items()}
    ties, _ = condense(truth, clicks, tie_sigma_px=0.02)
    bias = {**GAUSSIAN, "click_sigma_px": 0.3, "click_bias_px": 3.0}
    found = joint_adjustment.solve(ties, shifted, COURT, **bias)
    np.testing.assert_allclose(found.network.flex[:, 3:], [[0, 0.5], [0, -0.5]], atol=0.1)
    held = joint_adjustment.solve(ties, shifted, COURT, **{**bias, "click_bias_px": 0.0})
    assert not held.network.flex.any()
    spread = [np.trace(s.point_covariance(COURT.xyz).sum(axis=0)) for s in (found, held)]
    assert spread[0] > spread[1]
    exact = joint_adjustment.solve(ties, clicks, COURT, **bias)
    assert_cameras(exact.cameras, networks_made.fixed_cameras(truth))


def test_wrong_clicks_and_ties_count_little_under_the_loss():
    truth = made(6, 60, noise_px=0.3)
    clicks = clicks_of(truth, 0.3)
    good = joint_adjustment.solve(condense(truth, clicks)[0], clicks, COURT, **GAUSSIAN)
    wrong = {name: xy.copy() for name, xy in clicks.items()}
    wrong["side"][3] += 60.0
    truth.xy[np.random.default_rng(0).choice(len(truth.xy), 10, replace=False)] += 40.0
    robust = {**GAUSSIAN, "click_loss": 2.0}
    ties, _ = condense(truth, wrong, **robust, tie_loss=2.0)
    found = joint_adjustment.solve(ties, wrong, COURT, **robust)
    plain = joint_adjustment.solve(condense(truth, wrong)[0], wrong, COURT, **GAUSSIAN)
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
    chosen = joint_adjustment.solve(ties, clicks, COURT, **GAUSSIAN, points=use)
    fewer = {name: np.where(use[:, None], xy, np.nan) for name, xy in clicks.items()}
    left = joint_adjustment.solve(ties, fewer, COURT, **GAUSSIAN)
    np.testing.assert_array_equal(chosen.covariance, left.covariance)
    everything = joint_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
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
    found = joint_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    true = networks_made.fixed_cameras(truth, ("side", "back", "far"))
    assert_cameras(found.cameras, true, 1e-4)
    assert np.isfinite(found.covariance).all()


def test_a_camera_that_nothing_places_is_an_error():
    truth = third_fixed(made(6, 60))
    clicks = clicks_of(truth)
    clicks["far"] = np.full_like(clicks["side"], np.nan)
    blind = selection.select(truth, np.ones(60, dtype=bool), truth.image_idx != 2)
    ties, _ = condense(blind, clicks, {**FIXED, "far": 2})
    with pytest.raises(InputError, match=r"camera far: expected .*, found neither"):
        joint_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    exact = networks_made.fixed_cameras(truth, ("side", "back", "far"))[2]
    clicks["far"] = opencv_projection(exact, COURT.xyz)
    found = joint_adjustment.solve(ties, clicks, COURT, **GAUSSIAN)
    assert_cameras(found.cameras[2:], [exact], 1e-3)


def test_an_image_that_no_tie_sees_changes_nothing():
    truth = made(6, 60, noise_px=0.5)
    clicks = clicks_of(truth, SIGMA_PX)
    seen = truth.image_idx != 5
    blind = selection.select(truth, np.ones(60, dtype=bool), seen)
    without = replace(
        blind,
        **{
            name: np.delete(getattr(truth, name), 5, axis=0)
            for name in ("cam_from_world", "flex", "flex_sigma", "lens_of_image", "height_px")
        },
        image_idx=blind.image_idx - (blind.image_idx > 5),
    )
    found, expected = (
        joint_adjustment.solve(condense(n, clicks)[0], clicks, COURT, **GAUSSIAN)
        for n in (blind, without)
    )
    assert_cameras(found.cameras, expected.cameras)
    np.testing.assert_allclose(found.covariance, expected.covariance, rtol=1e-3, atol=1e-12)


def test_thinning_keeps_the_points_asked_for():
    truth = made(4, 60, noise_px=0.5)
    few = {"min_angle_deg": 5, "max_error_px": 10, "max_points": 20, "seed": 1}
    assert len(condense(truth, clicks_of(truth), thinning=EVERYTHING | few)[1][0].network.xyz) == 20


def test_parts_share_images_out_and_find_the_cameras_together():
    truth = made(30, 60, noise_px=0.3)
    clicks, parted = clicks_of(truth, noise_px=0.1), EVERYTHING | {"images_per_part": 10}
    whole, together = condense(truth, clicks)[0], condense(truth, clicks, thinning=parted)
    ties, parts = together
    assert [len(part.images) for part in parts] == [12, 12, 12]
    found, one = (joint_adjustment.solve(t, clicks, COURT, **GAUSSIAN) for t in (ties, whole))
    for mine, its, true in zip(
        found.cameras, one.cameras, networks_made.fixed_cameras(truth), strict=True
    ):
        error = np.linalg.norm(its.centre_in_world - true.centre_in_world)
        assert np.linalg.norm(mine.centre_in_world - its.centre_in_world) < error
    # What one part knows, not the sum over three.
    share = np.trace(ties.knowledge.information) / np.trace(whole.knowledge.information)
    assert 0.3 < share < 1
    place = walk_parts.centres(parts)
    np.testing.assert_allclose(place, selection.centres(truth), atol=0.05)


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


def test_clicks_are_as_good_as_the_picture_is_long():
    assert joint_adjustment.click_sigma(1.5, (3840, 2160)) == 1.5
    assert joint_adjustment.click_sigma(1.5, (1280, 720)) == 0.5
    assert joint_adjustment.click_sigma(1.5, (720, 1280)) == 0.5  # the same camera on its side


FREE = {"tie_sigma_px": 1.0, "tie_loss": np.inf, **EVERYTHING}


def from_side(cameras):
    """Return the second camera's direction and rotation as seen from the first."""
    one, other = cameras
    between = other.cam_from_world[:, :3] @ one.cam_from_world[:, :3].T
    centre = one.cam_from_world[:, :3] @ (other.centre_in_world - one.centre_in_world)
    return centre / np.linalg.norm(centre), between


def test_ties_without_a_court_give_the_true_cameras_up_to_frame_and_scale():
    truth = made(6, 60)
    start = networks_made.in_random_frame(networks_made.disturbed(truth, scale=0.3))
    ties, (part,) = joint_adjustment.condense_free(start, FIXED, SIZES, **FREE)
    whole = part.network
    found = joint_adjustment.free(ties)
    assert [c.name for c in found.cameras] == ["side", "back"]
    exact = networks_made.fixed_cameras(truth)
    for ours, expected in zip(from_side(found.cameras), from_side(exact), strict=True):
        np.testing.assert_allclose(ours, expected, atol=1e-5)
    for camera, known in zip(found.cameras, exact, strict=True):
        np.testing.assert_allclose(camera.K, known.K, rtol=1e-5, atol=1e-2)
    apart = found.cameras[1].centre_in_world - found.cameras[0].centre_in_world
    assert np.linalg.norm(apart) == pytest.approx(1, abs=0.01)  # the unit is that before adjustment
    lengths = [np.linalg.norm(n.xyz[5] - n.xyz[9]) for n in (whole, truth)]
    true_apart = np.linalg.norm(exact[1].centre_in_world - exact[0].centre_in_world)
    assert lengths[0] / np.linalg.norm(apart) == pytest.approx(lengths[1] / true_apart, rel=1e-4)


def test_the_covariance_without_a_court_is_that_of_repeated_ties():
    """Of what frame and scale leave alone: the angles between the cameras and their focal lengths.

    With errors of a third of the usual, as above.
    """
    truth, small, n_draws = made(6, 40), 0.3, 40
    rng, sigma = np.random.default_rng(5), small * np.nan_to_num(truth.lens_sigma, posinf=0)
    truth = replace(truth, lens_sigma=small * truth.lens_sigma)
    options = {**FREE, "tie_sigma_px": small}
    off = []
    for _ in range(n_draws):
        drawn = replace(
            truth,
            xy=truth.xy + small * rng.normal(size=truth.xy.shape),
            lens_mean=truth.lens_mean + sigma * rng.normal(size=truth.lens_mean.shape),
        )
        found = joint_adjustment.free(
            joint_adjustment.condense_free(drawn, FIXED, SIZES, **options)[0]
        )
        exact = networks_made.fixed_cameras(truth)
        one, other = found.cameras
        between = from_side(found.cameras)[1] @ from_side(exact)[1].T
        turn = np.array([between[2, 1], between[0, 2], between[1, 0]])
        # A turn a of the first camera and b of the second: exp(b) R exp(-a), to first order b - R
        # a.
        by_column = np.zeros((3, 38))
        by_column[:, 11:14], by_column[:, :3] = np.eye(3), -from_side(exact)[1]
        focal = np.zeros((2, 38))
        focal[0, 22], focal[1, 30] = 1, 1
        rows = np.concatenate([by_column, focal])
        spread = rows @ found.covariance @ rows.T
        error = np.concatenate(
            [turn, [one.K[1, 1] - exact[0].K[1, 1], other.K[1, 1] - exact[1].K[1, 1]]]
        )
        off.append(error / np.sqrt(np.diag(spread)))
    square = np.mean(np.square(off), axis=0)
    assert np.abs(np.sqrt(square) - 1).max() < 4 / np.sqrt(2 * n_draws)
    assert np.mean(square) == pytest.approx(1, abs=4 * np.sqrt(2 / n_draws / 5))


def test_without_a_court_all_parts_of_a_walk_give_the_cameras():
    """Where only the images of the first of two parts are noisy, the other halves its error."""
    truth = made(20, 60)
    exact = from_side(networks_made.fixed_cameras(truth))[1]
    of_first = np.isin(truth.image_idx, walk_parts.split(truth, [0, 1], 10)[0].images[2:])
    rng, errors = np.random.default_rng(6), []
    for _ in range(5):
        noise = 0.5 * rng.normal(size=truth.xy.shape) * of_first[:, None]
        options = FREE | {"tie_sigma_px": 0.5, "images_per_part": 10}
        drawn = replace(truth, xy=truth.xy + noise)
        ties, parts = joint_adjustment.condense_free(drawn, FIXED, SIZES, **options)
        assert len(parts) == 2
        alone = networks_made.fixed_cameras(parts[0].network)
        turns = [from_side(c)[1] @ exact.T for c in (joint_adjustment.free(ties).cameras, alone)]
        errors.append(np.linalg.norm(np.array(turns) - np.eye(3), axis=(1, 2)))
    both, first = np.sqrt(np.mean(np.square(errors), axis=0))
    assert 0.3 < both / first < 0.7


def test_without_a_court_all_parts_of_a_walk_are_in_one_frame():
    """The images of each part are others: others are the mean of their places and their up."""
    truth = made(80, 60, noise_px=0.3)
    options = FREE | {"images_per_part": 40}
    start = networks_made.in_random_frame(truth)
    parts = joint_adjustment.condense_free(start, FIXED, SIZES, **options)[1]
    assert len(parts) == 2
    true = selection.centres(truth)
    apart = np.linalg.norm(true[1] - true[0])
    fixed = np.array([selection.centres(part.network)[part.fixed] for part in parts])
    np.testing.assert_allclose(fixed[1], fixed[0], atol=0.002)
    found = walk_parts.centres(parts)
    off = np.linalg.norm(similarity.umeyama(found, true).points(found) - true, axis=1)
    assert off.mean() < 0.001 * apart


def test_files_under_each_others_names_are_a_fault():
    truth = made()
    clicks = clicks_of(truth)
    clicks["side"], clicks["back"] = clicks["back"], clicks["side"]
    with pytest.raises(InputError, match=r"cameras side and back: .* may be exchanged"):
        condense(truth, clicks)
