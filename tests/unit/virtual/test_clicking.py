"""Simulated clicks: their statistics against what was asked for."""

import numpy as np
import pytest

import scene
from courtside.virtual import clicking

POINTS = scene.points(500)
CAMERAS = scene.ring(3, dist=(-0.1, 0.02, 1e-3, 1e-3, 0))


def click(seed=0, cameras=CAMERAS, points=POINTS, sigma=0.7, bias=0.5):
    return clicking.simulate(
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
