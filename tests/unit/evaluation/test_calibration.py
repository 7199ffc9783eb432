"""Trials of the study: choices of clicks, and errors that are known because they were put there."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from scipy.spatial.transform import Rotation

from courtside.calibration.bundle import selection
from courtside.calibration.court import court, joint_adjustment, resection
from courtside.calibration.records import tie_points
from courtside.calibration.records.support import Support
from courtside.evaluation import calibration
from courtside.geometry import similarity
from fixtures.cameras import networks_made, scene
from fixtures.cameras.scene import look_at, opencv_projection

COURT = court.read(Path(__file__).parents[3] / "config" / "courts" / "badminton.yaml")
SETTINGS = {"click_sigma_px": 0.9, "click_bias_px": 0.5, "click_loss": 4.0}
SETS = ["all", "eight", "three"]


def truth():
    return networks_made.fixed_cameras(networks_made.make(6, 60))


def clicks_of(cameras, xyz=COURT.xyz):
    return {camera.name: opencv_projection(camera, xyz) for camera in cameras}


def record(cameras=None, **changes):
    made = networks_made.exact_lens_prior(networks_made.make(6, 60))
    knowledge = selection.marginalise(made, [0, 1])
    known = joint_adjustment.Ties(("side", "back"), (networks_made.SIZE,) * 2, knowledge)
    moved = similarity.Sim3(0.3, np.eye(3)[[1, 2, 0]], np.array([1.0, 2, 3]))
    in_sfm = [moved.camera(camera) for camera in cameras or truth()]
    nothing = np.zeros((0, 3))
    whole = Support(1.0, "", 1.0, ("", ""), 1.0)
    made = tie_points.Record(
        "", "", in_sfm, [60, 60], known, np.zeros(0, str), nothing, nothing, 0.1, (1, 1), whole
    )
    return replace(made, **changes)


def by_choice(rows):
    return {(row["method"], row["n_clicks"], row["in_sample"]): row for row in rows}


def test_choices_are_whole_sets_and_sets_without_the_scored_points():
    found = [(n, whole, use.sum()) for n, whole, use in calibration.choices(COURT, SETS)]
    assert found == [(18, True, 18), (18, False, 16), (8, True, 8), (8, False, 6), (3, True, 3)]
    for _, whole, use in calibration.choices(COURT, SETS):
        assert use[COURT.indices(["p02", "p03"])].all() == whole
        assert use[COURT.indices(["p01"])].all()


def test_exact_ties_and_clicks_have_no_error():
    real = truth()
    found = by_choice(
        calibration.of_ties(record(), real, COURT, clicks_of(real), sets=SETS, **SETTINGS)
    )
    assert len(found) == 5 + 5 + 1
    for key, row in found.items():
        assert row["outcome"] == "", key
        for name in ("xy_cm", "volume_rms_cm", "camera_position_cm", "focal_percent"):
            assert row[name] == pytest.approx(0, abs=2e-3), (key, name)
        assert set(row) <= set(calibration.COLUMNS)
        assert ("coverage90" in row) == (key[0] == "sfm")


def test_failures_and_missing_clicks_become_outcomes():
    real = truth()
    clicks = clicks_of(real)
    clicks["side"][COURT.indices(["p02"])] = np.nan
    made = record(fault="court points: no", ties=None)
    found = by_choice(calibration.of_ties(made, real, COURT, clicks, sets=SETS, **SETTINGS))
    for (method, n_clicks, _), row in found.items():
        failed = method in ("sfm", "paper") or n_clicks == 3
        assert bool(row["outcome"]) == failed
        assert ("volume_rms_cm" in row) == (not failed)
    assert found["sfm", 18, True]["outcome"] == "court points: no"
    assert "no place for p02" in found["paper", 3, True]["outcome"]


def test_a_camera_that_nothing_ties_fails_its_trial_alone():
    real = truth()
    clicks, made = clicks_of(real), record()
    clicks["side"][:] = np.nan
    own = made.ties.knowledge
    information = own.information.copy()
    of_side = information.shape[0] // len(real)
    information[:of_side] = information[:, :of_side] = 0
    ties = replace(made.ties, knowledge=replace(own, information=information))
    found = by_choice(
        calibration.of_ties(replace(made, ties=ties), real, COURT, clicks, sets=SETS, **SETTINGS)
    )
    assert "camera side: expected matches" in found["sfm", 18, True]["outcome"]
    assert len(found) == 5 + 5 + 1


def test_known_cameras_have_no_error_and_fail_where_points_are_too_few():
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    places = {"corner": (-11, -8, 5.0), "back": (3.05, -14.3, 2.1)}
    real = [
        replace(
            truth()[0], name=name, K=matrix, dist=np.zeros(5), cam_from_world=look_at(at, (3, 6, 1))
        )
        for name, at in places.items()
    ]
    lenses = {camera.name: camera for camera in real}
    found = by_choice(
        calibration.of_known(real, COURT, clicks_of(real), lenses, sets=SETS, click_sigma_px=0.9)
    )
    assert len(found) == 5 * 3
    fewest = {"dlt": 6, "known": 8, "known-board": 4}
    for (method, n_clicks, whole), row in found.items():
        enough = (n_clicks if whole else n_clicks - 2) >= fewest[method]
        assert (row["outcome"] == "") == enough, (method, n_clicks, whole)
        if enough:
            assert row["volume_rms_cm"] == pytest.approx(0, abs=0.02), (method, n_clicks)
    without = calibration.of_known(
        real, COURT, clicks_of(real), {}, sets=["all"], click_sigma_px=0.9
    )
    assert {row["method"] for row in without} == {"dlt", "known"}


def test_cameras_shifted_together_shift_every_point_as_much():
    real = truth()
    shift = similarity.Sim3(1.0, np.eye(3), np.array([0.02, 0.01, -0.02]))  # 3 cm
    found = [shift.camera(camera) for camera in real]

    def covariance(xyz):
        return np.tile(np.eye(3) * 1e-4, (len(xyz), 1, 1))

    errors = calibration.score(found, real, COURT, clicks_of(real), covariance)
    for name in ("xo_cm", "yo_cm", "xy_cm", "volume_rms_cm", "volume_p95_cm", "camera_position_cm"):
        assert errors[name] == pytest.approx(3, abs=1e-4)
    assert errors["camera_rotation_deg"] == pytest.approx(0, abs=1e-5)
    assert errors["predicted_volume_cm"] == pytest.approx(np.sqrt(3))
    # 3 cm are 9 in squared sigmas: beyond 7.81, the 95 % limit of chi-square with 3 degrees
    # of freedom.
    assert errors["coverage95"] == 0


def test_a_skewed_projection_matrix_is_scored_unchanged():
    """An exact matrix, scored in a world shifted by 2 cm; it is not a camera, so it has no pose."""
    real = truth()
    real = [replace(camera, dist=np.zeros(5)) for camera in real]
    beside = np.eye(4)
    beside[0, 3] = -0.02
    found = {
        camera.name: resection.Linear(camera.K @ camera.cam_from_world @ beside, None, 0.0, 1.0, "")
        for camera in real
    }
    errors = calibration.score_linear(found, real, COURT, clicks_of(real))
    for name in ("xo_cm", "yo_cm", "volume_rms_cm"):
        assert errors[name] == pytest.approx(2, abs=1e-6)
    assert "camera_position_cm" not in errors


RING = scene.ring(3, dist=(-0.05, 0.01, 1e-3, 0, 0))


def test_published_errors_are_those_of_the_ends_of_x_and_y():
    xyz = COURT.xyz + 0.0
    xyz[1] += [0.03, 0, 0.04]
    xyz[2] += [0, -0.02, 0]
    xyz[7] += 1.0  # no part of it
    found = calibration.court_points(COURT, xyz)
    assert found == pytest.approx({"xo_cm": 5.0, "yo_cm": 2.0, "xy_cm": 3.5})


def test_errors_of_cameras_are_means_over_cameras():
    changed = []
    for camera, shift_m, turn_deg, focal in zip(
        RING, [0.01, 0.02, 0.06], [0.5, 0, 1.0], [1.01, 0.98, 1.0], strict=True
    ):
        turn = Rotation.from_euler("y", turn_deg, degrees=True).as_matrix()
        rotation = turn @ camera.cam_from_world[:, :3]
        centre = camera.centre_in_world + np.array([0, shift_m, 0])
        pose = np.column_stack([rotation, -rotation @ centre])
        K = camera.K * [[focal, 1, 1], [1, focal, 1], [1, 1, 1]]
        changed.append(replace(camera, cam_from_world=pose, K=K))
    found = calibration.poses(changed, RING)
    expected = {"camera_position_cm": 3.0, "camera_rotation_deg": 0.5, "focal_percent": 1.0}
    assert found == pytest.approx(expected, rel=1e-6)


def test_numbers_over_the_volume():
    error = np.zeros((101, 3))
    error[:, 2] = np.arange(101) / 100
    found = calibration.over_volume(error)
    assert found["volume_p95_cm"] == pytest.approx(95)
    assert found["volume_rms_cm"] == pytest.approx(np.sqrt((np.arange(101) ** 2).mean()))


def test_coverage_of_gaussian_errors_is_their_level():
    rng = np.random.default_rng(0)
    root = rng.normal(size=(20000, 3, 3)) * 0.01
    covariance = root @ root.transpose(0, 2, 1)
    error = np.einsum("nij,nj->ni", root, rng.normal(size=(20000, 3)))
    found = calibration.coverage(error, covariance)
    for level in (50, 90, 95):  # four standard deviations of a share of 20000
        share = level / 100
        assert found[f"coverage{level}"] == pytest.approx(
            share, abs=4 * np.sqrt(share * (1 - share) / 20000)
        )
    expected = 100 * np.sqrt((error**2).sum(axis=1).mean())
    assert found["predicted_volume_cm"] == pytest.approx(expected, rel=0.03)


def test_errors_twice_as_large_as_stated_are_seen():
    error = 0.02 * np.random.default_rng(1).normal(size=(5000, 3))
    found = calibration.coverage(error, np.tile(1e-4 * np.eye(3), (5000, 1, 1)))
    share = stats.chi2.cdf(stats.chi2.ppf(0.95, 3) / 4, 3)
    assert found["coverage95"] == pytest.approx(share, abs=4 * np.sqrt(share * (1 - share) / 5000))
    assert share < 0.5
