"""The tiny study through every rule: all files are there, readable, and plausible."""

import importlib.util
import json
import re

import ezc3d
import numpy as np
import pandas as pd
from scipy.stats import chi2, norm

from courtside.calibration.records import covariance as camera_covariance
from courtside.exports import tidy, trc
from courtside.geometry import camera as cameras
from courtside.records.keypoints import keypoints
from courtside.records.truth import session_truth
from courtside.video import images
from smoke.snakemake_runs import ROOT, planned

TAKE = "walk-4cams-tiny/takes/balancing"
METHOD = "file/all-robust/blazepose-full"


# Conditions need a session for each setting, clocks a longer take, offsets and networks several
# bodies.
LARGER_STUDY = {
    "draw_capture",
    "draw_worlds",
    "evaluate_clocks",
    "draw_clock_errors",
    "evaluate_joint_errors",
    "evaluate_joint_offsets",
    "evaluate_skin_depths",
}
LARGER_STUDY |= {"compare_networks", "draw_agreement", "refine_cameras"}
LARGER_STUDY |= {"find_court", "check_court"}  # need painted lines and no clicks, or a file
# Devices beside fixed cameras need a take of both; keypoints of other programs, own networks and
# boards are in test_other_sessions.py.
LARGER_STUDY |= {"select_person", "import_pose2d", "import_pose3d", "check_network"}
LARGER_STUDY |= {"calibrate_boards", "calibrate_wand", "calibrate_from_people"}


def test_every_rule_of_the_study_ran(tiny_study):
    rules = (ROOT / "workflow" / "rules").glob("*.smk")
    names = {name for file in rules for name in re.findall(r"^rule (\w+):", file.read_text(), re.M)}
    logged = {path.parent.name for path in tiny_study.glob("*/logs/*/*.log")}
    assert names - LARGER_STUDY <= logged
    assert len(names) >= 12


def test_a_second_run_has_nothing_to_do(tiny_study):
    assert planned(anew=True) == {}


def test_the_skeleton_is_a_person_in_metres(tiny_study):
    points = keypoints.read_3d(tiny_study / TAKE / "pose3d" / f"{METHOD}.npz")
    assert points.xyz.shape == (1, 24, 33, 3)
    assert np.isfinite(points.xyz).all(axis=-1).mean() > 0.95
    names = points.joints.tolist()
    nose, ankle = (
        np.nanmedian(points.xyz[0, :, names.index(n), 2]) for n in ("nose", "left_ankle")
    )
    assert 1.1 < nose - ankle < 1.7
    np.testing.assert_allclose(np.diff(points.time_s), 1 / 60, atol=1e-4)


def test_raw_and_filtered_results_are_both_exported(tiny_study):
    for stage in ("pose3d", "pose3d_filtered"):
        stem = tiny_study / TAKE / stage / f"{METHOD}.p1"
        joints, rate_hz, _, xyz = trc.read(f"{stem}.trc")
        rows = pd.read_csv(f"{stem}.csv")
        c3d = ezc3d.c3d(f"{stem}.c3d")
        assert rate_hz == 60
        assert list(rows.columns) == list(tidy.COLUMNS)
        assert c3d["parameters"]["POINT"]["LABELS"]["value"] == joints
        np.testing.assert_allclose(
            rows[["x_m", "y_m", "z_m"]].to_numpy().reshape(xyz.shape), xyz, atol=2e-5
        )
        np.testing.assert_allclose(
            c3d["data"]["points"][:3].transpose(2, 1, 0) / 1000, xyz, atol=2e-5
        )


def test_cameras_fit_the_videos(tiny_study):
    found = cameras.read_toml(tiny_study / "walk-4cams-tiny/calibration/file/cameras.toml")
    assert [camera.name for camera in found] == ["cam01", "cam02", "cam03", "cam04"]
    assert [tuple(camera.size) for camera in found] == [(1080, 1920)] * 2 + [(1088, 1920)] * 2


def errors(tiny_study, name):
    rows = pd.read_csv(tiny_study / "plain-tiny" / "evaluation" / f"{name}.csv")
    return rows[rows["outcome"].isna() & rows["in_sample"]]


def test_the_walked_camera_calibrates_the_fixed_ones(tiny_study):
    rows = errors(tiny_study, "global-n12-o0")
    rows = rows[rows["click_strength"] == 1]
    ours = rows[(rows["method"] == "sfm") & (rows["n_clicks"] == 18)]
    assert len(ours) == 30
    # At 480 px a person clicks flat lines several decimetres off: 5.0 cm were measured.
    assert ours["volume_rms_cm"].quantile(0.95) <= 6.5
    assert ours["n_fixed_registered"].eq(2).all()
    assert ours["coverage90"].mean() > 0.8
    aligned = rows[(rows["method"] == "sim3") & (rows["n_clicks"] == 18)]
    assert aligned["volume_rms_cm"].median() > 3 * ours["volume_rms_cm"].median()


def test_the_linear_calibration_of_layout_a_looks_well_and_is_not(tiny_study):
    rows = errors(tiny_study, "known")
    rows = rows[(rows["method"] == "dlt") & (rows["click_strength"] == 1)]
    linear = rows[(rows["n_clicks"] == 8) & rows["in_sample"]]
    assert linear["xy_cm"].median() < 10  # at its own points
    assert linear["volume_rms_cm"].median() > 30 * linear["xy_cm"].median()
    quality = json.loads((tiny_study / "plain-tiny/calibration/dlt8/quality.json").read_text())
    assert "in line with the camera" in quality["degenerate"]["side"]


def test_calibrated_cameras_are_the_true_ones_within_their_stated_covariance(tiny_study):
    session = tiny_study / "plain-tiny/calibration/sfm-n12"
    found = cameras.read_toml(session / "cameras.toml")
    real = session_truth.read(tiny_study / "virtual/plain-tiny/truth.npz")
    covariance = camera_covariance.read(session / "covariance.npz")
    assert covariance.cameras == [camera.name for camera in real.cameras]
    assert np.linalg.eigvalsh(covariance.covariance).min() > 0
    for ours, true in zip(found, real.cameras, strict=True):
        assert ours.name == true.name
        stated = covariance.of([ours.name]).covariance
        # Of right covariances, 1 in 10,000 fails: errors depend on the draw of clicks and, in
        # structure from motion, on the processor. Small pictures, hence the wide second bounds.
        shift = ours.cam_from_world[:, :3] @ (ours.centre_in_world - true.centre_in_world)
        assert shift @ np.linalg.solve(stated[3:6, 3:6], shift) < chi2.ppf(0.9999, 3)
        assert np.sqrt(np.trace(stated[3:6, 3:6])) < 0.5
        focal_px, sigma_px = true.K[1, 1], np.sqrt(stated[6, 6])
        assert abs(ours.K[1, 1] - focal_px) < norm.ppf(0.99995) * sigma_px
        assert sigma_px < 0.025 * focal_px


def test_the_calibration_study_draws_its_figures(tiny_study):
    session = tiny_study / "plain-tiny" / "figures"
    stems = [
        session / name
        for name in ("badminton_fig06.global", "badminton_fig08", "coverage", "growth")
    ]
    stems += [session / "error_map.sfm-n12", tiny_study / "figures" / "court_points.badminton"]
    for stem in stems:
        assert stem.with_name(f"{stem.name}.png").read_bytes().startswith(b"\x89PNG")
        assert len(pd.read_csv(stem.with_name(f"{stem.name}.csv"))) >= 1
    assert len(pd.read_csv(tiny_study / "figures" / "calibration.csv")) > 10


def test_the_picture_of_the_readme_is_drawn(tiny_study, tmp_path, monkeypatch):
    spec = importlib.util.spec_from_file_location("draw_result", ROOT / "docs" / "draw_result.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    known = {"SESSION": "players-tiny", "CALIBRATION": "known18", "NETWORK": "blazepose-full"}
    for name, value in {**known, "LARGE": "back", "CLOSE": ("oblique", "mirror")}.items():
        monkeypatch.setattr(script, name, value)
    script.main(tiny_study, tmp_path / "result.png")
    assert images.read(tmp_path / "result.png").std() > 10


def test_every_figure_has_its_numbers(tiny_study):
    for name in ("overlay", "skeletons", "reprojection", "visibility"):
        stem = tiny_study / TAKE / "figures" / f"{name}.{METHOD.replace('/', '.')}"
        assert (stem.parent / f"{stem.name}.png").read_bytes().startswith(b"\x89PNG")
        assert (stem.parent / f"{stem.name}.pdf").read_bytes().startswith(b"%PDF")
        assert len(pd.read_csv(stem.parent / f"{stem.name}.csv")) > 10
