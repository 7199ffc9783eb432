"""Predicted errors: those of simulated sessions, and near those that the virtual study measured."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.bundle import selection, solver
from courtside.calibration.court import joint_adjustment, line_edges, quality, sfm_alignment
from courtside.calibration.planning import cameras, prediction, tie_points
from courtside.calibration.planning.prediction import Prediction
from courtside.calibration.records import covariance
from courtside.evaluation.calibration import over_volume
from courtside.geometry.camera import in_picture, project
from fixtures.cameras import hall_plan, scene

PRIOR = (hall_plan.LENS_MEAN, hall_plan.LENS_SIGMA)
# Median of volume_rms_cm over draws and offsets in results/plain-a/evaluation/global-n*.csv: all 18
# points, method sfm. The variance of these clicks is half of the stated one (`quality.json`).
MEASURED_CM = {10: 1.26, 20: 1.17, 40: 1.28}
SHOWN = {"click_sigma_px": 1.75 / np.sqrt(2), "click_bias_px": 1.25 / np.sqrt(2)}


@functools.cache
def predict(count, **options):
    weights = hall_plan.WEIGHTS | options
    return prediction.predict(
        hall_plan.fixed(),
        hall_plan.walked(count),
        hall_plan.COURT,
        hall_plan.HALL_M,
        hall_plan.PLAIN,
        PRIOR,
        seed=0,
        thinning=hall_plan.THINNING,
        **weights,
    )


@pytest.mark.parametrize("count", MEASURED_CM)
def test_near_what_the_virtual_study_measured(count):
    found = predict(count, **SHOWN)
    assert found.error_cm[1] == pytest.approx(MEASURED_CM[count], rel=0.25)
    assert found.error_cm[0] < found.error_cm[1] < found.error_cm[2]


def test_predicted_errors_are_those_of_simulated_sessions():
    """Clicks, court and ties of 100 sessions are drawn, and the cameras solved from them."""
    found = predict(10, click_loss=1e6)
    fixed, court = hall_plan.fixed(), hall_plan.COURT
    rng = np.random.default_rng([0, 10])
    ties = tie_points.network(
        fixed, hall_plan.walked(10), hall_plan.HALL_M, hall_plan.PLAIN, PRIOR, rng
    )
    ties = selection.thin(ties, **hall_plan.THINNING)
    ties = selection.weigh(ties, sigma_px=0.6, loss_scale=np.inf)
    known = selection.marginalise(ties, [0, 1])
    extent, axes = np.linalg.eigh(known.information)
    root = axes * np.sqrt(np.maximum(extent, 0))
    rng, grid, rms_cm = np.random.default_rng(1), quality.volume(court), []
    axis = {c.name: np.sqrt(line_edges.click_variances(c, court)) for c in fixed}
    names, sizes = ("side", "back"), (hall_plan.SIZE,) * 2
    for _ in range(100):
        gradient = root @ rng.standard_normal(len(root))  # what noise in the ties does
        drawn = solver.Quadratic(known.reference, known.information, gradient)
        real = court.xyz + court.sigma_m[:, None] * rng.standard_normal((18, 3))
        seen = prediction.clicks(fixed, replace(court, xyz=real))
        seen = {
            name: xy
            + (0.5 * rng.standard_normal(2) + 0.7 * axis[name] * rng.standard_normal((18, 2))) / 3
            for name, xy in seen.items()
        }
        weights = {key: hall_plan.WEIGHTS[key] for key in ("click_sigma_px", "click_bias_px")}
        solved = joint_adjustment.solve_by_edges(
            joint_adjustment.Ties(names, sizes, drawn), seen, court, click_loss=1e6, **weights
        )
        truly = {camera.name: project(camera, grid) for camera in fixed}
        error_m = sfm_alignment.reconstruct(solved.cameras, truly) - grid
        rms_cm.append(over_volume(error_m)["volume_rms_cm"])
    assert np.quantile(rms_cm, [0.05, 0.5, 0.95]) == pytest.approx(found.error_cm, rel=0.25)


def test_sharper_clicks_and_more_images_help():
    least = predict(20)
    assert predict(20, click_sigma_px=2.0, click_bias_px=1.5).error_cm[1] > 1.3 * least.error_cm[1]
    assert predict(5).error_cm[1] > 1.05 * least.error_cm[1]
    assert least.neighbour_deg < predict(5).neighbour_deg
    assert 1000 < least.n_ties <= 2000


def test_without_a_walk_the_court_points_hold_the_cameras():
    alone = predict(0)
    assert alone.n_ties < 20
    assert np.isnan(alone.neighbour_deg)
    assert predict(20).error_cm[1] < alone.error_cm[1] < 3


def test_cameras_on_their_side_are_as_good():
    turned = [scene.quarter_turned(camera) for camera in hall_plan.fixed()]
    weights = hall_plan.WEIGHTS | {"thinning": hall_plan.THINNING, "seed": 0}
    hall = hall_plan.COURT, hall_plan.HALL_M, hall_plan.PLAIN, PRIOR
    found = prediction.predict(turned, hall_plan.walked(10), *hall, **weights)
    assert found.error_cm == pytest.approx(predict(10).error_cm, rel=0.05)


def test_a_camera_that_sees_no_point_is_named():
    away = [
        hall_plan.fixed()[0],
        replace(hall_plan.fixed()[1], name="lost", cam_from_world=np.eye(3, 4)),
    ]
    found = predicted(away)
    assert "lost" in found.fault
    assert np.isnan(found.error_cm).all()
    assert found.solution is None


def test_a_camera_that_two_court_points_hardly_place_is_named():
    """Its picture holds two points of the court, and nothing that another camera sees."""
    side, back = hall_plan.fixed()
    aim = hall_plan.COURT.xyz[hall_plan.COURT.indices(["p17", "p18"])].mean(axis=0)
    narrow = cameras.camera("narrow", (18, 6.7, 3), aim, hall_plan.SIZE, focal_px=9000)
    shown = prediction.clicks([narrow], hall_plan.COURT)["narrow"]
    assert np.isfinite(shown[:, 0]).sum() == 2
    found = predicted([side, back, narrow])
    assert "camera narrow: expected it to be placed" in found.fault
    assert "found 2 court points" in found.fault and np.isnan(found.error_cm).all()


def test_a_camera_adds_no_error_at_places_outside_its_picture():
    """It shows one end of the court; in the rest the two others are as good as alone."""
    side, back = hall_plan.fixed()
    near = cameras.camera("near", (3, 9, 3), (3, 0, 0), hall_plan.SIZE, focal_px=900)
    found = predicted([side, back, near])
    names = [camera.name for camera in found.solution.cameras]
    known = covariance.of_network(names, found.solution.covariance)
    grid = quality.volume(hall_plan.COURT)
    seen = np.stack([in_picture(c, project(c, grid)) for c in (side, back, near)])
    assert seen[:2].all() and 0.1 < seen[2].mean() < 0.9
    expected_cm, share = quality.expected_cm([side, back, near], known, grid)
    assert share == 1
    low, median, high = found.error_cm
    assert low < expected_cm < high
    assert np.sqrt(2 / 3) < median / expected_cm < 1.05  # of few independent errors, below the rms


def predicted(fixed):
    return prediction.predict(
        fixed,
        [],
        hall_plan.COURT,
        hall_plan.HALL_M,
        hall_plan.PLAIN,
        PRIOR,
        seed=0,
        thinning=hall_plan.THINNING,
        **hall_plan.WEIGHTS,
    )


def guess(n_images, error_cm, neighbour_deg=3.0, least_ties=100, fault=""):
    errors = (error_cm / 2, error_cm, 2 * error_cm)
    return Prediction(n_images, neighbour_deg, 500, least_ties, errors, fault=fault)


@pytest.mark.parametrize(
    ("predictions", "target_cm", "expected", "why"),
    [
        ([guess(20, 0.8), guess(40, 0.75), guess(75, 0.74)], None, 20, "0.81 cm"),
        ([guess(20, 0.9), guess(40, 0.75), guess(75, 0.74)], None, 40, "within 6 degrees"),
        ([guess(20, 0.9), guess(40, 0.75)], 1.0, 20, "1.00 cm"),
        ([guess(0, 0.5, np.nan), guess(40, 0.75)], 0.6, None, "the least is 0.75 cm"),
        ([guess(20, 0.7, 9.0), guess(40, 0.7)], None, 40, "ties"),
        ([guess(20, 0.7, 9.0)], None, None, "more images"),
        ([guess(20, 0.7, least_ties=19)], None, None, "walk closer"),
        ([guess(20, 0.7, fault="x")], None, None, "walk closer"),
    ],
)
def test_how_many_images_are_needed(predictions, target_cm, expected, why):
    found, reason = prediction.needed(predictions, min_points=20, target_cm=target_cm)
    assert (found and found.n_images) == expected
    assert why in reason
