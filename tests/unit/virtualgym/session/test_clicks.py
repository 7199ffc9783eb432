"""Simulated clicks: their statistics against what was asked for."""

import numpy as np
import pytest

from fixtures.cameras import scene
from virtualgym import presets
from virtualgym.session import clicks

POINTS = scene.points(500)
CAMERAS = scene.ring(3, dist=(-0.1, 0.02, 1e-3, 1e-3, 0))


def click(seed=0, cameras=CAMERAS, points=POINTS, sigma=0.7, bias=0.5):
    return clicks.simulate(
        cameras,
        points,
        sigma_px_at_3840=sigma,
        bias_px_at_3840=bias,
        rng=np.random.default_rng(seed),
    )


def test_without_errors_clicks_are_the_projections():
    for camera in CAMERAS:
        found = click(sigma=0, bias=0)[camera.name]
        np.testing.assert_allclose(found, scene.opencv_projection(camera, POINTS), atol=1e-8)


def test_scatter_scales_with_the_width_and_the_bias_is_common_to_all_cameras():
    biases = []
    for seed in range(60):
        found = click(seed)
        errors = [found[c.name] - scene.opencv_projection(c, POINTS) for c in CAMERAS]
        # The cameras are 1920 px wide: half of the numbers at 3840 px.
        assert np.std(np.array(errors) - np.mean(errors, (0, 1))) == pytest.approx(0.35, rel=0.05)
        means = np.mean(errors, axis=1)
        assert np.abs(means - means.mean(0)).max() < 0.08
        biases.append(means.mean(0))
    assert np.std(biases) == pytest.approx(0.25, rel=0.25)


def test_points_outside_the_picture_are_not_clicked():
    away = np.array([[0, 0, 1.0], [0, 0, 9.0], [50, 0, 1.0]])
    found = click(points=away)
    assert np.isfinite(found["c0"][0]).all() and np.isnan(found["c0"][1]).all()
    for camera in CAMERAS:
        xy = found[camera.name]
        inside = np.isfinite(xy).all(axis=1)
        assert (xy[inside] >= -0.5).all() and (xy[inside] <= np.array([1919.5, 1079.5])).all()
        assert (np.isnan(xy).any(axis=1) == np.isnan(xy).all(axis=1)).all()


def test_a_click_does_not_depend_on_what_else_is_seen():
    moved = POINTS.copy()
    moved[0] = [0, 0, 9.0]  # now out of view
    np.testing.assert_array_equal(click()["c1"][1:], click(points=moved)["c1"][1:])


def draws(n_draws=4, seed=1, session="plain-a", preset="plain", cameras=CAMERAS):
    options = {"n_draws": n_draws, "seed": seed, "session": session, "preset": preset}
    return list(clicks.draws(cameras, POINTS, **options))


def test_draws_are_the_same_whatever_their_number_and_the_cameras_after():
    few, many = draws(2), draws(6, cameras=CAMERAS[:2])
    for one, other in zip(few, many[:2], strict=True):
        np.testing.assert_array_equal(one["c0"], other["c0"])
        np.testing.assert_array_equal(one["c1"], other["c1"])
    assert len(many) == 6


def test_draws_sessions_and_seeds_differ():
    known = [d["c0"] for d in draws(3)] + [
        draws(1, session="plain-b")[0]["c0"],
        draws(1, 2)[0]["c0"],
    ]
    assert all(
        np.abs(one - other).max() > 0.01
        for at, one in enumerate(known)
        for other in known[at + 1 :]
    )


def test_draws_scatter_as_their_preset_says():
    """Scatter within a draw and a bias common to it, at half of the width that both are stated for."""
    made = presets.PRESETS["plain"]
    exact = {c.name: scene.opencv_projection(c, POINTS) for c in CAMERAS}
    errors = np.array([[d[name] - xy for name, xy in exact.items()] for d in draws(80)])
    within = errors - errors.mean(axis=(1, 2), keepdims=True)
    assert np.std(within) == pytest.approx(made.click_sigma_px_at_3840 / 2, rel=0.02)
    bias = errors.mean(axis=(1, 2))
    # 160 numbers: their standard deviation scatters by 1 / sqrt(320)
    assert np.std(bias) == pytest.approx(made.click_bias_px_at_3840 / 2, rel=0.2)
    assert abs(np.mean(bias)) < 4 * made.click_bias_px_at_3840 / 2 / np.sqrt(160)
