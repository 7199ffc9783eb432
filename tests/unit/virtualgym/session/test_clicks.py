"""Clicks of court points: their statistics, and what they depend on."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from fixtures.cameras import scene
from virtualgym import presets
from virtualgym.session import click_model, clicks

POINTS = scene.points(500)
CAMERAS = scene.ring(3, dist=(-0.1, 0.02, 1e-3, 1e-3, 0))


def click(seed=0, cameras=CAMERAS, points=POINTS, sigma=0.7, bias=0.5):
    return clicks.click_points(
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


def test_scatter_scales_with_the_longer_side_and_the_bias_is_common_to_all_cameras():
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


COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
PLACES = {"side": (-12, 6.7, 2.5), "back": (3.05, -12, 2.5), "near": (3.05, -6, 6)}
FIXED = [
    replace(CAMERAS[0], name=name, dist=np.zeros(5), cam_from_world=scene.look_at(at, (3, 6.7, 0)))
    for name, at in PLACES.items()
]


def draws(n_draws=4, seed=1, session="plain-a", preset="plain", cameras=FIXED, strength=1.0):
    options = {"n_draws": n_draws, "seed": seed, "session": session, "preset": preset}
    return list(clicks.clicks_of_persons(cameras, COURT, COURT.xyz, **options, strength=strength))


def errors_of(drawn, camera):
    exact = scene.opencv_projection(camera, COURT.xyz)
    return np.array([draw[camera.name] - exact for draw in drawn])


def test_draws_are_the_same_whatever_their_number_and_the_cameras_after():
    few, many = draws(2), draws(6, cameras=FIXED[:2])
    for one, other in zip(few, many[:2], strict=True):
        np.testing.assert_array_equal(one["side"], other["side"])
        np.testing.assert_array_equal(one["back"], other["back"])
    assert len(many) == 6


def test_draws_sessions_and_seeds_differ():
    known = [d["back"] for d in draws(3)] + [
        draws(1, session="plain-b")[0]["back"],
        draws(1, 2)[0]["back"],
    ]
    assert all(
        np.nanmax(np.abs(one - other)) > 0.01
        for at, one in enumerate(known)
        for other in known[at + 1 :]
    )


def test_a_strength_multiplies_every_error():
    one, three = draws(3), draws(3, strength=3.0)
    for camera in FIXED:
        expected = 3 * errors_of(one, camera)
        found = errors_of(three, camera)
        both = np.isfinite(expected) & np.isfinite(found)
        assert both.sum() > 50
        np.testing.assert_allclose(found[both], expected[both], atol=1e-7)


def test_strengths_have_labels_and_a_third_of_the_persons():
    options = {"n_draws": 6, "seed": 1, "preset": "plain", "session": "plain-a"}
    found = clicks.clicks_of_strengths([1, 2], FIXED, COURT, COURT.xyz, **options)
    labels = [(drawn["click_strength"], drawn["draw"]) for drawn, _ in found]
    assert labels == [(1, draw) for draw in range(6)] + [(2, 0), (2, 1)]


def test_clicks_scatter_as_the_model_says_and_persons_differ():
    """Of many persons: the model's covariance times their mean square factor, plus the bias."""
    camera = FIXED[1]
    found = errors_of(draws(1500), camera)
    model = click_model.covariance(camera, COURT.xyz, COURT, presets.PRESETS["plain"])
    square_factor = np.exp(2 * click_model.HAND_SPREAD**2)
    for point in (3, 11, 16):
        known = found[:, point][np.isfinite(found[:, point]).all(axis=1)]
        expected = square_factor * model[point] + click_model.bias_px(camera) ** 2 * np.eye(2)
        assert len(known) > 1400
        np.testing.assert_allclose(np.diag(np.cov(known.T)), np.diag(expected), rtol=0.15)
