"""Lengths of a racket: exact from exact clicks, and as wrong as mathematics says from others."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.bundle import selection
from courtside.calibration.court import court, joint_adjustment, sfm_alignment
from courtside.calibration.records import tie_points
from courtside.calibration.records.support import Support
from courtside.evaluation import racket as racket_trials
from courtside.geometry import similarity, triangulation
from fixtures.cameras import networks_made, scene
from fixtures.cameras.scene import look_at, opencv_projection

COURT = court.read(Path(__file__).parents[3] / "config" / "courts" / "badminton.yaml")
SETTINGS = {"click_sigma_px": 0.9, "click_bias_px": 0.5, "click_loss": 4.0}
LENGTH_M = 0.674
BELOW = np.arange(21) < 10


def truth():
    """Return two cameras without distortion: what a linear calibration can be exact for."""
    network = networks_made.fixed_cameras(networks_made.make(6, 60))
    return [replace(camera, dist=np.zeros(5)) for camera in network]


def record(cameras, **changes):
    """Return exact ties of these cameras, seen in another frame."""
    made = networks_made.exact_lens_prior(networks_made.make(6, 60))
    knowledge = selection.marginalise(made, [0, 1])
    known = joint_adjustment.Ties(("side", "back"), (networks_made.SIZE,) * 2, knowledge)
    moved = similarity.Sim3(0.3, np.eye(3)[[1, 2, 0]], np.array([1.0, 2, 3]))
    in_sfm = [moved.camera(camera) for camera in cameras]
    nothing = np.zeros((0, 3))
    whole = Support(1.0, "", 1.0, ("", ""), 1.0)
    made = tie_points.Record(
        "", "", in_sfm, [60, 60], known, np.zeros(0, str), nothing, nothing, 0.1, (1, 1), whole
    )
    return replace(made, **changes)


def racket(n_frames=21, seed=0):
    rng = np.random.default_rng(seed)
    middle = rng.uniform([1, 1, 0.8], [5, 5, 2.5], (n_frames, 3))
    along = rng.normal(size=(n_frames, 3))
    along *= LENGTH_M / 2 / np.linalg.norm(along, axis=1, keepdims=True)
    return np.stack([middle + along, middle - along], axis=1)


def seen_by(cameras, xyz):
    return {camera.name: opencv_projection(camera, xyz.reshape(-1, 3)) for camera in cameras}


def ways_of(cameras, clicks=None, made=None):
    clicks = clicks or seen_by(cameras, COURT.xyz)
    made = made or record(cameras)
    found = racket_trials.calibrate(made, cameras, COURT, clicks, **SETTINGS)
    return {(way.method, way.n_clicks): way for way in found}


def perfect(cameras):
    def place(seen):
        return sfm_alignment.reconstruct(cameras, seen)

    return racket_trials.Way("perfect", 0, "", place, 0.0)


def test_exact_clicks_of_calibrated_cameras_give_the_length():
    real = networks_made.fixed_cameras(networks_made.make(6, 60))
    found = ways_of(real)
    names = [("dlt", 8), ("known", 8), ("paper", 3), ("sfm", 8), ("sfm", 18), ("perfect", 0)]
    assert list(found) == names
    for key in (("paper", 3), ("sfm", 8), ("sfm", 18), ("perfect", 0)):
        length_m = racket_trials.measure(found[key], seen_by(real, racket()))
        np.testing.assert_allclose(length_m, LENGTH_M, atol=2e-5, err_msg=str(key))
        assert found[key].volume_rms_cm == pytest.approx(0, abs=2e-3)


def test_ways_from_known_points_need_no_structure_from_motion():
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    places = {"side": (-11, -8, 5.0), "back": (3.05, -14.3, 2.1)}
    real = [
        replace(camera, K=matrix, cam_from_world=look_at(places[camera.name], (3, 6, 1)))
        for camera in truth()
    ]
    found = ways_of(real)
    for key in (("dlt", 8), ("known", 8)):
        length_m = racket_trials.measure(found[key], seen_by(real, racket()))
        np.testing.assert_allclose(length_m, LENGTH_M, atol=2e-5, err_msg=str(key))
        assert found[key].volume_rms_cm == pytest.approx(0, abs=2e-2)


def test_a_failed_calibration_has_an_outcome_and_no_numbers():
    real = truth()
    clicks = seen_by(real, COURT.xyz)
    clicks["side"][COURT.indices(["p02"])] = np.nan
    found = ways_of(real, clicks, record(real, fault="court points: no", ties=None))
    assert found["sfm", 18].outcome == "court points: no"
    assert "found 7" in found["known", 8].outcome
    assert "p02" in found["paper", 3].outcome
    rows = racket_trials.rows(list(found.values()), seen_by(real, racket()), LENGTH_M, BELOW)
    for row in rows:
        assert bool(row["outcome"]) == ("mean_abs_mm" not in row)
        known = {*racket_trials.COLUMNS, *racket_trials.length_columns(21)}
        assert set(row) <= known
    assert [row["method"] for row in rows if not row["outcome"]] == ["dlt", "perfect"]


def test_all_ways_measure_the_same_clicks():
    """Lengths scale with the world: ways that differ by 1 % differ by 1 % in every frame."""
    real = truth()
    larger = similarity.Sim3(1.01, np.eye(3), np.zeros(3))
    ways = [perfect(real), perfect([larger.camera(camera) for camera in real])]
    noise = np.random.default_rng(1).normal(0, 1, (2, 42, 2))
    seen = {n: xy + e for (n, xy), e in zip(seen_by(real, racket()).items(), noise, strict=True)}
    one, other = racket_trials.rows(ways, seen, LENGTH_M, BELOW)
    for name in racket_trials.length_columns(21):
        assert other[name] / one[name] == pytest.approx(1.01, rel=1e-6)


def test_errors_grow_in_proportion_to_small_click_errors():
    real = truth()
    exact, noise = seen_by(real, racket()), np.random.default_rng(2).normal(size=(2, 42, 2))
    off = []
    for scale in (0.01, 0.02):
        seen = {n: xy + scale * e for (n, xy), e in zip(exact.items(), noise, strict=True)}
        off.append(racket_trials.measure(perfect(real), seen) - LENGTH_M)
    assert np.linalg.norm(off[1] - 2 * off[0]) < 0.01 * np.linalg.norm(off[1])


def test_click_errors_make_a_racket_longer_on_average():
    """E|d + e| = |d| + tr(P C) / (2 |d|) to second order; P: across the racket, C: cov(e)."""
    real, n_frames, sigma_px = truth(), 40000, 6.0
    ends = np.tile(racket(1), (n_frames, 1, 1))
    noise = np.random.default_rng(3).normal(0, sigma_px, (2, 2 * n_frames, 2))
    exact = seen_by(real, ends)
    seen = {n: xy + e for (n, xy), e in zip(exact.items(), noise, strict=True)}
    off = racket_trials.measure(perfect(real), seen) - LENGTH_M
    both = triangulation.triangulate_robust(
        real,
        np.stack([xy[:2] for xy in exact.values()]),
        np.ones((2, 2)),
        max_error_px=sigma_px,  # which the covariance is of; the views agree exactly
    )
    along = (ends[0, 0] - ends[0, 1]) / LENGTH_M
    covariance = both.covariance.sum(axis=0)
    expected = np.trace((np.eye(3) - np.outer(along, along)) @ covariance) / (2 * LENGTH_M)
    error = np.std(off) / np.sqrt(n_frames)
    assert expected > 8 * error
    assert np.mean(off) == pytest.approx(expected, abs=4 * error + 0.1 * expected)
    assert np.std(off) == pytest.approx(np.sqrt(along @ covariance @ along), rel=0.05)


def test_linear_placing_with_weights_is_least_squares_of_pixels():
    """Cameras at unequal distances: the rows of the farther one count more without weights."""
    matrix = np.array([[1500.0, 0, 959.5], [0, 1500, 539.5], [0, 0, 1]])
    real = [
        replace(scene.ring(1)[0], name=name, K=matrix, cam_from_world=look_at(at, (3, 3, 1)))
        for name, at in {"near": (-2, -4, 3.0), "far": (30, -10, 4.0)}.items()
    ]
    ends = racket(200)
    noise = np.random.default_rng(4).normal(0, 2, (2, 400, 2))
    seen = {n: xy + e for (n, xy), e in zip(seen_by(real, ends).items(), noise, strict=True)}
    matrices = {camera.name: camera.K @ camera.cam_from_world for camera in real}
    linear = racket_trials.place_linearly(matrices, seen)
    least = sfm_alignment.reconstruct(real, seen)
    error = np.sqrt(np.mean((least - ends.reshape(-1, 3)) ** 2))
    assert np.sqrt(np.mean((linear - least) ** 2)) < 0.02 * error
    seen["far"][5] = np.nan
    assert np.isnan(racket_trials.place_linearly(matrices, seen)[5]).all()


def test_scores_match_values_computed_by_hand():
    length_m = LENGTH_M + np.array([0.001, -0.003, 0.002, 0.004, np.nan, -0.001])
    found = racket_trials.score(length_m, LENGTH_M, np.arange(6) < 2)
    assert found == {
        "n_frames": 5,
        "mean_abs_mm": pytest.approx(11 / 5),
        "bias_mm": pytest.approx(3 / 5),
        "std_below_mm": pytest.approx(np.sqrt(8)),
        "std_above_mm": pytest.approx(np.std([2, 4, -1], ddof=1)),
    }
    nothing = racket_trials.score(np.full(6, np.nan), LENGTH_M, np.arange(6) < 2)
    assert nothing.pop("n_frames") == 0 and np.isnan(list(nothing.values())).all()
