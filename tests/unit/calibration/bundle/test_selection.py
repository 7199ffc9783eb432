"""Ties thinned, moved, weighted, marginalised: against recomputation and full adjustment."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.calibration.bundle import problem as networks
from courtside.calibration.bundle import selection, solver
from courtside.geometry import similarity
from fixtures.cameras import networks_made
from fixtures.cameras.scene import opencv_projection

KNOWN = np.array(
    [[0, 0, 0], [6.1, 0, 0], [0, 13.4, 0], [6.1, 13.4, 0], [0, 6.7, 1.55], [6.1, 6.7, 1.55]]
)
KNOWN_SIGMA = np.full(len(KNOWN), 0.005)
LARGEST = 1e9  # no limit


def centres(network):
    pose = network.cam_from_world
    return np.stack([-p[:, :3].T @ p[:, 3] for p in pose])


def test_a_moved_network_sees_the_same():
    made = networks_made.make(noise_px=1.0, flex=True)
    turn = Rotation.from_rotvec([0.3, -1, 2]).as_matrix()
    b_from_a = similarity.Sim3(2.5, turn, np.array([1.0, -4, 7]))
    moved = selection.transform(made, b_from_a)
    np.testing.assert_allclose(networks.residuals(moved), networks.residuals(made), atol=1e-8)
    np.testing.assert_allclose(centres(moved), 2.5 * centres(made) @ turn.T + [1, -4, 7], atol=1e-9)
    np.testing.assert_allclose(moved.xyz, 2.5 * made.xyz @ turn.T + [1, -4, 7], atol=1e-9)


def test_selected_points_keep_their_observations():
    made = networks_made.make(3, 10, noise_px=1.0)
    points = np.arange(10) % 3 != 1
    seen = np.random.default_rng(0).random(len(made.xy)) < 0.6
    found = selection.select(made, points, seen)
    np.testing.assert_array_equal(found.xyz, made.xyz[[0, 2, 3, 5, 6, 8, 9]])
    kept = {
        (made.image_idx[at], *made.xyz[made.point_idx[at]], *made.xy[at])
        for at in range(len(made.xy))
        if seen[at] and made.point_idx[at] % 3 != 1
    }
    of_found = {
        (found.image_idx[at], *found.xyz[found.point_idx[at]], *found.xy[at])
        for at in range(len(found.xy))
    }
    assert of_found == kept
    assert len(selection.select(made, points).xy) == 7 * 5


def thinned(made, min_angle_deg=0.0, max_error_px=LARGEST, max_points=1000, seed=0):
    limits = {
        "min_angle_deg": min_angle_deg,
        "max_error_px": max_error_px,
        "max_points": max_points,
    }
    return selection.thin(made, **limits, seed=seed)


def test_points_under_small_angles_go():
    made = networks_made.make(6, 60)
    pair = made.image_idx >= 6  # two images of the walk: twice the half angle is the angle itself
    made = selection.select(made, np.ones(60, dtype=bool), pair)
    first, second = (made.xyz - centre for centre in centres(made)[6:])
    cosine = (first * second).sum(axis=1)
    cosine /= np.linalg.norm(first, axis=1) * np.linalg.norm(second, axis=1)
    angle = np.degrees(np.arccos(cosine))
    limit = np.sort(angle)[29:31].mean()
    found = thinned(made, min_angle_deg=limit)
    np.testing.assert_array_equal(found.xyz, made.xyz[angle > limit])


def test_far_observations_go_and_points_seen_once_with_them():
    made = networks_made.make(3, 10)
    made.xy[(made.point_idx == 4) & (made.image_idx != 2)] += 9.0  # one view of it is left
    wrong = np.flatnonzero(made.point_idx == 7)[1]
    made.xy[wrong] -= 6.0
    found = thinned(made, max_error_px=5.0)
    np.testing.assert_array_equal(found.xyz, np.delete(made.xyz, 4, axis=0))
    assert len(found.xy) == 9 * 5 - 1
    assert np.linalg.norm(networks.residuals(found), axis=1).max() < 1e-6


def test_a_dropped_observation_lends_a_point_no_angle():
    made = networks_made.make(6, 10)
    near = np.isin(made.image_idx, [1, 7])  # neighbours, and image 0 on the other side
    made = selection.select(made, np.ones(10, dtype=bool), near | (made.image_idx == 0))
    made.xy[(made.image_idx == 0) & (made.point_idx == 3)] += 30.0
    found = thinned(made, min_angle_deg=30, max_error_px=5)
    np.testing.assert_array_equal(found.xyz, np.delete(made.xyz, 3, axis=0))


def test_points_behind_their_image_go():
    made = networks_made.make(3, 10)
    made.xyz[2] = (
        centres(made)[0] * 3 - 2 * made.xyz[2]
    )  # beyond the first camera, seen from the point
    found = thinned(made, max_error_px=1.0)
    np.testing.assert_array_equal(found.xyz, np.delete(made.xyz, 2, axis=0))


def test_a_choice_is_random_and_repeatable():
    made = networks_made.make(3, 40)
    chosen = [thinned(made, max_points=12, seed=seed).xyz for seed in (0, 0, 1)]
    assert [len(c) for c in chosen] == [12, 12, 12]
    np.testing.assert_array_equal(chosen[0], chosen[1])
    assert not np.array_equal(chosen[0], chosen[2])
    assert all((made.xyz == place).all(axis=1).any() for place in chosen[2])


def clicks_of(network, images=(0, 1), noise_px=0.0, seed=0):
    rng = np.random.default_rng(seed)
    exact = [opencv_projection(camera, KNOWN) for camera in networks_made.fixed_cameras(network)]
    return {v: exact[v] + noise_px * rng.normal(size=exact[v].shape) for v in images}


def with_clicks(network, clicks, sigma_px=0.7):
    sigma = dict.fromkeys(clicks, sigma_px)
    return selection.add_control_points(
        network, KNOWN, KNOWN_SIGMA, clicks, sigma_px=sigma, loss_scale=np.inf
    )


def test_control_points_come_behind_the_ties():
    made = networks_made.make(3, 10)
    clicks = clicks_of(made)
    clicks[0][[1, 4]], clicks[1][4] = np.nan, np.nan
    found = selection.add_control_points(
        made, KNOWN, 0.01 * np.arange(6), clicks, sigma_px={0: 0.5, 1: 2.0}, loss_scale=3.0
    )
    np.testing.assert_array_equal(found.xyz[10:], np.delete(KNOWN, 4, axis=0))
    np.testing.assert_array_equal(found.xyz_mean[10:], found.xyz[10:])
    np.testing.assert_allclose(found.xyz_sigma[10:], [0, 0.01, 0.02, 0.03, 0.05])
    np.testing.assert_array_equal(found.image_idx[50:], [0] * 4 + [1] * 5)
    np.testing.assert_array_equal(found.sigma_px[50:], [[0.5] * 2] * 4 + [[2.0] * 2] * 5)
    np.testing.assert_array_equal(found.loss_scale[50:], 3.0)
    assert np.abs(networks.residuals(found)[50:]).max() < 1e-8
    np.testing.assert_array_equal(found.xy[:50], made.xy)


def test_a_camera_without_clicks_adds_nothing():
    made = networks_made.make(3, 10)
    nothing = dict.fromkeys((0, 1), np.full((len(KNOWN), 2), np.nan))
    found = with_clicks(made, nothing)
    assert len(found.xyz) == 10 and len(found.xy) == 50
    assert len(with_clicks(made, {**nothing, **clicks_of(made, [1])}).xy) == 56


def test_weights_are_set():
    found = selection.weigh(networks_made.make(3, 10), sigma_px=1.4, loss_scale=2)
    assert set(found.sigma_px.ravel()) == {1.4} and set(found.loss_scale) == {2.0}


@pytest.mark.parametrize(
    ("noise_px", "flex", "limit"), [(0.0, False, 0.03), (0.5, False, 0.1), (0.5, True, 0.1)]
)
def test_condensed_ties_and_clicks_give_the_whole_adjustment(noise_px, flex, limit):
    """Ties condensed with exact clicks, used with clicks that move the cameras by up to 1.4 sigmas.

    The limit, in sigmas, is what a parabola can miss: less than a tenth of that move.
    """
    made = networks_made.exact_lens_prior(networks_made.make(4, 40, noise_px=noise_px, flex=flex))
    if flex:
        sigma = np.zeros((6, 5))
        sigma[2:] = [0.005, 0.005, 0.005, 5, 5]
        made = replace(made, flex_sigma=sigma)
    n_ties, n_seen = len(made.xyz), len(made.xy)
    solved, _ = solver.adjust(with_clicks(made, clicks_of(made)), tolerance=1e-12)
    tied = selection.select(
        solved, np.arange(len(solved.xyz)) < n_ties, np.arange(len(solved.xy)) < n_seen
    )
    knowledge = selection.marginalise(tied, [0, 1])
    clicks = clicks_of(made, noise_px=0.7, seed=4)
    whole, whole_normal = solver.adjust(with_clicks(tied, clicks), tolerance=1e-12)
    small = with_clicks(knowledge.reference, clicks)
    small, normal = solver.adjust(small, quadratic=knowledge, tolerance=1e-12)
    covariance = normal.covariance()
    both = selection.images_only(whole, [0, 1])
    off = small.difference(both)[normal.active] / np.sqrt(np.diag(covariance)[normal.active])
    assert np.abs(off).max() < limit
    columns = np.r_[0:22, 66 : 66 + 16]  # images 0 and 1 of six, lenses 0 and 1
    expected = whole_normal.covariance()[np.ix_(columns, columns)]
    scale = np.sqrt(np.diag(expected))
    scale[scale == 0] = 1.0
    units = np.outer(scale, scale)
    np.testing.assert_allclose(covariance / units, expected / units, atol=0.1)


def test_condensed_ties_and_the_same_clicks_give_the_same_to_rounding():
    made = networks_made.exact_lens_prior(networks_made.make(4, 40, noise_px=0.5))
    clicks = clicks_of(made, noise_px=0.7)
    whole, normal = solver.adjust(with_clicks(made, clicks), tolerance=1e-14)
    tied = selection.select(whole, np.arange(len(whole.xyz)) < 40)
    knowledge = selection.marginalise(tied, [0, 1])
    small = with_clicks(knowledge.reference, clicks)
    small, small_normal = solver.adjust(small, quadratic=knowledge, tolerance=1e-14)
    sigma = np.sqrt(np.diag(small_normal.covariance())[small_normal.active])
    off = small.difference(selection.images_only(whole, [0, 1]))[small_normal.active] / sigma
    assert np.abs(off).max() < 1e-5
    columns = np.r_[0:22, 66 : 66 + 16]
    expected = np.sqrt(np.diag(normal.covariance())[columns][small_normal.active])
    np.testing.assert_allclose(sigma, expected, rtol=1e-5)


def test_ties_that_are_not_at_rest_pull_the_fixed_cameras():
    """The images of the walk stand off by some pixels; eliminated, they go where they belong."""
    truth = networks_made.exact_lens_prior(networks_made.make(4, 40))
    step = np.zeros(truth.n_columns)
    images = step[22:66].reshape(4, 11)
    images[:, :6] = np.random.default_rng(0).normal(size=(4, 6)) * ([2e-3] * 3 + [0.02] * 3)
    moved = truth.moved(step, np.zeros_like(truth.xyz))
    assert np.abs(networks.residuals(moved)).mean() > 1
    knowledge = selection.marginalise(moved, [0, 1])
    clicks = clicks_of(truth)
    found, normal = solver.adjust(
        with_clicks(knowledge.reference, clicks), quadratic=knowledge, tolerance=1e-12
    )
    sigma = np.sqrt(np.diag(normal.covariance())[normal.active])
    off = found.difference(selection.images_only(truth, [0, 1]))[normal.active] / sigma
    assert np.abs(off).max() < 0.1


def test_ties_leave_frame_and_scale_open():
    made = networks_made.exact_lens_prior(networks_made.make(4, 40))
    knowledge = selection.marginalise(made, [0, 1])
    values = np.linalg.eigvalsh(scaled(knowledge.information))
    assert (np.abs(values) < 1e-8).sum() == 7 + 10  # and the ten numbers of flex, which are fixed
    np.testing.assert_allclose(knowledge.gradient, 0, atol=1e-6)


def scaled(information):
    scale = 1 / np.sqrt(np.maximum(np.diag(information), 1e-30))
    scale[np.diag(information) == 0] = 0
    return information * np.outer(scale, scale)


def test_the_free_frame_is_that_of_the_first_two_fixed_cameras():
    made = networks_made.in_random_frame(networks_made.make(6, 20))
    found = selection.transform(made, selection.free_frame(made, [0, 1]))
    places = centres(found)
    np.testing.assert_allclose(places.mean(axis=0), 0, atol=1e-9)
    along = places[1] - places[0]
    assert np.linalg.norm(along) == pytest.approx(1)
    assert along[1] == pytest.approx(0, abs=1e-9) and along[0] > 0
    up = -found.cam_from_world[:, 1, :3].mean(axis=0)
    np.testing.assert_allclose(up / np.linalg.norm(up), [0, 0, 1], atol=1e-9)
    np.testing.assert_allclose(networks.residuals(found), networks.residuals(made), atol=1e-7)


def test_the_free_frame_is_the_same_wherever_the_model_was():
    made = networks_made.make(6, 20)
    found = [
        selection.transform(n, selection.free_frame(n, [0, 1])).xyz
        for n in (made, networks_made.in_random_frame(made), networks_made.in_random_frame(made, 9))
    ]
    np.testing.assert_allclose(found[1], found[0], atol=1e-9)
    np.testing.assert_allclose(found[2], found[0], atol=1e-9)


@pytest.mark.parametrize("fixed", [[], [0]])
def test_the_walk_gives_the_unit_where_there_are_not_two_fixed_cameras(fixed):
    made = networks_made.in_random_frame(networks_made.make(6, 20))
    places = centres(selection.transform(made, selection.free_frame(made, fixed)))
    assert np.linalg.norm(places[-1] - places[0]) == pytest.approx(1)


@pytest.mark.parametrize("on_one_line", [False, True])
def test_poses_tell_one_frame_from_another_also_on_one_line(on_one_line):
    made = networks_made.make(6, 20)
    if on_one_line:
        places = np.arange(8)[:, None] * [2.0, 1.0, 0.1] + [5.0, 0, 1]
        made.cam_from_world[:, :, 3] = -np.einsum(
            "vij,vj->vi", made.cam_from_world[:, :, :3], places
        )
    other = networks_made.in_random_frame(made)
    found = selection.between(made.cam_from_world, other.cam_from_world)
    moved = selection.transform(made, found)
    np.testing.assert_allclose(moved.cam_from_world, other.cam_from_world, atol=1e-9)
    np.testing.assert_allclose(moved.xyz, other.xyz, atol=1e-9)


def test_the_pose_of_one_image_tells_its_frame_but_not_the_scale():
    made = selection.images_only(networks_made.make(6, 20), [0])
    other = networks_made.in_random_frame(made).cam_from_world
    found = selection.between(made.cam_from_world, other)
    assert found.scale == 1.0
    moved = selection.transform(made, found)
    np.testing.assert_allclose(moved.cam_from_world, other, atol=1e-9)


def test_the_spread_of_residuals_is_that_of_the_noise():
    made = networks_made.make(8, 200, noise_px=0.4)
    assert selection.residual_spread(made) == pytest.approx(0.4, rel=0.05)
    made.xy[::10] += 50.0
    assert selection.residual_spread(made) == pytest.approx(0.4, rel=0.2)
    assert selection.residual_spread(networks_made.make()) == selection.LEAST_PX


def test_rounding_makes_no_negative_information():
    """Of a network that leaves a direction nearly open; what is known stays as it is."""
    rng = np.random.default_rng(0)
    unit = 10.0 ** rng.uniform(-2, 3, 6)
    axes, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    true = axes[:, 1:] * rng.uniform(0.1, 1, 5) @ axes[:, 1:].T
    noisy = unit[:, None] * (true - 1e-5 * np.outer(axes[:, 0], axes[:, 0])) * unit
    gradient = unit * (true @ rng.normal(size=6) + 1e-5 * axes[:, 0])
    found, slope = selection._without_noise(noisy, gradient, unit)
    scaled = found / np.outer(unit, unit)
    assert np.linalg.eigvalsh(scaled).min() > -1e-14
    np.testing.assert_allclose(scaled, true, atol=1e-12)
    assert abs(axes[:, 0] @ (slope / unit)) < 1e-12
    np.testing.assert_allclose(axes[:, 1:].T @ ((slope - gradient) / unit), 0, atol=1e-12)


def test_columns_that_are_fixed_have_no_information():
    information, unit = np.diag([4.0, 0.0]), np.array([2.0, 0.0])
    found, slope = selection._without_noise(information, np.array([1.0, 0.0]), unit)
    np.testing.assert_allclose(found, information)
    np.testing.assert_allclose(slope, [1, 0])
