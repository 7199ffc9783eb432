"""Bundle adjustment against pycolmap's, scipy's least squares, and its own statistics."""

from dataclasses import replace

import numpy as np
import pycolmap
import pytest
from scipy import optimize

from courtside.calibration.bundle import problem as networks
from courtside.calibration.bundle import solver
from fixtures.cameras import networks_made

FREE_LENS = (np.inf, 0.0, 0.0, 0.0, np.inf, 0.0, 0.0, 0.0)


def with_known_points(network, n_known, sigma=1e-4):
    mean, spread = network.xyz_mean.copy(), network.xyz_sigma.copy()
    mean[:n_known], spread[:n_known] = network.xyz[:n_known], sigma
    return replace(network, xyz_mean=mean, xyz_sigma=spread)


def test_exact_observations_give_the_exact_network():
    truth = with_known_points(networks_made.make(), 6, 1e-3)
    truth = replace(truth, lens_sigma=np.tile(FREE_LENS, (3, 1)), lens_mean=truth.lens)
    start = networks_made.disturbed(truth, scale=0.5)
    start.lens[:, [1, 2, 3, 5, 6, 7]] = truth.lens[:, [1, 2, 3, 5, 6, 7]]
    found, normal = solver.adjust(start, tolerance=1e-14)
    assert normal.cost < 1e-12
    np.testing.assert_allclose(found.cam_from_world, truth.cam_from_world, atol=1e-7)
    np.testing.assert_allclose(found.lens, truth.lens, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(found.xyz, truth.xyz, atol=1e-6)


@pytest.mark.parametrize("loss_scale", [np.inf, 1.5])
def test_it_finds_what_scipy_finds(loss_scale):
    truth = with_known_points(networks_made.make(3, 12, noise_px=0.5), 5, 0.01)
    truth = replace(truth, loss_scale=np.full(len(truth.xy), loss_scale))
    truth.xy[7] += 6.0
    start = networks_made.disturbed(truth, scale=0.3)
    _, normal = solver.adjust(start, max_iterations=100, tolerance=1e-13)
    n_columns, n_points = start.n_columns, len(start.xyz)
    free = np.concatenate([normal.active, np.ones(3 * n_points, dtype=bool)])

    def unpack(part):
        whole = np.zeros(n_columns + 3 * n_points)
        whole[free] = part
        return start.moved(whole[:n_columns], whole[n_columns:].reshape(-1, 3))

    def terms(part):
        now = unpack(part)
        seen = networks.residuals(now) / now.sigma_px
        square = (seen**2).sum(axis=1, keepdims=True)
        if np.isfinite(loss_scale):  # so long that half the sum of squares is Cauchy's loss
            seen = seen * np.sqrt(loss_scale**2 * np.log1p(square / loss_scale**2) / square)
        lens = (now.lens - now.lens_mean)[:, 1:] / now.lens_sigma[:, 1:]
        known = np.isfinite(now.xyz_sigma)
        points = (now.xyz - now.xyz_mean)[known] / now.xyz_sigma[known, None]
        return np.concatenate([seen.ravel(), lens.ravel(), points.ravel()])

    best = optimize.least_squares(
        terms, np.zeros(free.sum()), x_scale="jac", ftol=1e-10, max_nfev=60
    )
    assert best.success
    assert normal.cost <= best.cost * (1 + 1e-6)
    assert solver.cost(unpack(best.x)) == pytest.approx(best.cost, rel=1e-6)


def colmap_of(network):
    """Return the network as a pycolmap reconstruction, first pixel's corner at (0, 0)."""
    made = pycolmap.Reconstruction()
    width, height = networks_made.SIZE
    for k, (f, aspect, cx, cy, *dist) in enumerate(network.lens):
        params = [f * aspect, f, cx + 0.5, cy + 0.5, *dist]
        camera = pycolmap.Camera(
            model="OPENCV", width=width, height=height, params=params, camera_id=k + 1
        )
        made.add_camera_with_trivial_rig(camera)
    for v, pose in enumerate(network.cam_from_world):
        seen = network.xy[network.image_idx == v] + 0.5
        image = pycolmap.Image(
            name=f"{v}", keypoints=seen, camera_id=int(network.lens_of_image[v]) + 1, image_id=v + 1
        )
        made.add_image_with_trivial_frame(image, pycolmap.Rigid3d(pose))
    for n, xyz in enumerate(network.xyz):
        track = pycolmap.Track()
        for v in np.unique(network.image_idx):
            own = network.point_idx[network.image_idx == v]
            track.add_element(int(v) + 1, int(np.flatnonzero(own == n)[0]))
        made.add_point3D(xyz, track)
    return made


def test_it_finds_what_pycolmap_finds():
    truth = networks_made.make(5, 80, noise_px=0.5)
    lens_sigma = np.tile((np.inf, np.inf, 0.0, 0.0, np.inf, np.inf, np.inf, np.inf), (3, 1))
    start = networks_made.disturbed(replace(truth, lens_sigma=lens_sigma), scale=0.3)
    start.lens[:, 2:4] = truth.lens[:, 2:4]
    found, normal = solver.adjust(start, max_iterations=100, tolerance=1e-13)
    theirs = colmap_of(start)
    options = pycolmap.BundleAdjustmentOptions()
    options.ceres.loss_function_type = pycolmap.LossFunctionType.TRIVIAL
    options.ceres.solver_options.max_num_iterations = 300
    options.ceres.solver_options.function_tolerance = 1e-14
    pycolmap.bundle_adjustment(theirs, options)
    square = sum(
        (
            (
                image.points2D[k].xy
                - image.project_point(theirs.points3D[image.points2D[k].point3D_id].xyz)
            )
            ** 2
        ).sum()
        for image in theirs.images.values()
        for k in range(len(image.points2D))
    )
    assert normal.cost == pytest.approx(square / 2, rel=1e-6)
    lens = np.array([theirs.cameras[k + 1].params for k in range(3)])
    np.testing.assert_allclose(found.lens[:, 0], lens[:, 1], rtol=1e-4)


def test_the_covariance_is_that_of_repeated_noise():
    truth = with_known_points(networks_made.make(4, 25), 8, 0.005)
    truth = replace(truth, sigma_px=np.full(len(truth.xy), 0.5))
    rng = np.random.default_rng(5)
    steps, exact = [], truth.xy.copy()
    for _ in range(150):
        noisy = replace(truth, xy=exact + 0.5 * rng.standard_normal(exact.shape))
        drawn = truth.xyz_mean + 0.005 * rng.standard_normal(truth.xyz.shape)
        noisy = replace(noisy, xyz_mean=drawn, lens_mean=truth.lens + draw_lens(rng))
        found, normal = solver.adjust(noisy, tolerance=1e-9)
        steps.append(found.difference(truth)[normal.active])
    predicted = np.sqrt(np.diag(np.linalg.inv(normal.information)))
    ratio = np.std(steps, axis=0) / predicted
    assert np.median(ratio) == pytest.approx(1, abs=0.08)
    assert ratio.min() > 0.75
    assert ratio.max() < 1.3


def draw_lens(rng):
    sigma = np.array(networks_made.LENS_SIGMA)
    return rng.standard_normal((3, len(sigma))) * np.where(np.isfinite(sigma), sigma, 0)


def test_more_knowledge_pulls_towards_itself():
    truth = with_known_points(networks_made.make(), 6)
    size = truth.n_columns
    stiff = solver.Quadratic(truth, 1e12 * np.eye(size), np.zeros(size))
    noisy = replace(truth, xy=truth.xy + np.random.default_rng(0).normal(size=truth.xy.shape))
    found, _ = solver.adjust(noisy, quadratic=stiff)
    assert np.abs(found.difference(truth)).max() < 1e-6


def test_the_mean_of_quadratics_is_the_mean_of_their_values():
    truth, rng = networks_made.make(2, 10), np.random.default_rng(3)
    several = []
    for seed in range(3):
        root = rng.normal(size=(truth.n_columns, truth.n_columns))
        about = networks_made.disturbed(truth, seed, scale=1e-4)
        several.append(solver.Quadratic(about, root @ root.T, rng.normal(size=truth.n_columns)))
    together = solver.mean(several)

    def value(quadratic, network):
        return solver.cost(network, quadratic) - solver.cost(network)

    at, other = (networks_made.disturbed(truth, seed, scale=1e-3) for seed in (8, 9))
    expected = np.mean([value(each, at) - value(each, other) for each in several])
    assert value(together, at) - value(together, other) == pytest.approx(expected, rel=1e-3)


def test_small_and_large_networks_follow_the_same_equations(monkeypatch):
    network = networks_made.disturbed(
        with_known_points(networks_made.make(3, 20), 6), 5, scale=1e-3
    )
    dense = solver.normal_equations(network)
    monkeypatch.setattr(solver, "DENSE_ELEMENTS", 0)
    large = solver.normal_equations(network)
    np.testing.assert_allclose(dense.information, large.information, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(dense.gradient, large.gradient, rtol=1e-9, atol=1e-6)
    step = np.random.default_rng(6).normal(size=len(dense.gradient))
    np.testing.assert_allclose(dense.back(step), large.back(step), rtol=1e-9, atol=1e-9)


def test_a_point_behind_an_image_says_nothing_there():
    truth = with_known_points(networks_made.make(3, 12, noise_px=0.5), 6)
    centre = -truth.cam_from_world[0, :, :3].T @ truth.cam_from_world[0, :, 3]
    truth.xyz[8] = 3 * centre - 2 * truth.xyz[8]  # beyond the first image, seen from the point
    normal = solver.normal_equations(truth)
    assert np.isinf(normal.cost) and np.isfinite(normal.information).all()
    behind = np.isnan(networks.residuals(truth)).any(axis=1)
    assert 0 < behind.sum() < len(behind)
    views = ("image_idx", "point_idx", "xy", "sigma_px", "loss_scale")
    others = replace(truth, **{name: getattr(truth, name)[~behind] for name in views})
    expected = solver.normal_equations(others)
    np.testing.assert_allclose(normal.information, expected.information)
    np.testing.assert_allclose(normal.gradient, expected.gradient)


def test_what_nothing_is_known_of_stays_where_it_is():
    """An image without observations, and its lens, of which only the focal length has no prior."""
    truth = with_known_points(networks_made.make(3, 20, noise_px=0.5), 6)
    seen = truth.image_idx != 1
    views = ("image_idx", "point_idx", "xy", "sigma_px", "loss_scale")
    blind = replace(truth, **{name: getattr(truth, name)[seen] for name in views})
    found, normal = solver.adjust(blind)
    np.testing.assert_array_equal(found.cam_from_world[1], truth.cam_from_world[1])
    assert found.lens[1, 0] == truth.lens[1, 0]
    np.testing.assert_allclose(found.lens[1, 1:], truth.lens_mean[1, 1:], atol=1e-6)
    assert not normal.active[11:22].any() and not normal.active[55 + 8]
    assert np.isfinite(np.linalg.inv(normal.information)).all()
