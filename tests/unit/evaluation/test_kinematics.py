"""Errors of kinematics: measures made from the truth itself, and with known errors."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation import kinematics
from courtside.records import tables
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import derived_joints
from fixtures.people import walker, waves

TABLE = derived_joints.read(Path(__file__).parents[3] / "config" / "derived_joints.yaml")
LIMBS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
JOINTS = [f"{side}_{name}" for side in ("left", "right") for name in LIMBS]
JOINTS += ["left_eye", "right_eye", "rig_head"]
RADIUS_M, TURN_S = 2.0, 4.0


def truth(seconds=8.0, rate_hz=60):
    """Return a person who is carried round a circle, all joints in one place."""
    time_s = np.arange(round(seconds * rate_hz) + 1) / rate_hz
    phase = 2 * np.pi * time_s / TURN_S
    place = RADIUS_M * np.stack([np.cos(phase), np.sin(phase), 0 * phase], axis=1)
    xyz = np.repeat(place[None, :, None], len(JOINTS), axis=2)
    return SimpleNamespace(
        joints=np.array(JOINTS), person_id=np.array(["p1"]), time_s=time_s, xyz=xyz
    )


def measured(real, shift_m=0.0, faster=0.0, sigma=0.1, step=2, camera_m=np.nan):
    """Return frames and summary of a perfect measurement, moved and sped up."""
    time_s, place = real.time_s[::step], real.xyz[0, ::step, 0]
    speed = 2 * np.pi * RADIUS_M / TURN_S + faster
    columns = {"time_s": time_s, "person": "p1"}
    for point in ("neck", "centre", "mass"):
        columns |= {
            f"{point}_{axis}_m": place[:, k] + shift_m * (k == 2) for k, axis in enumerate("xyz")
        }
        columns |= {f"{point}_speed_m_s": speed, f"{point}_ground_speed_m_s": speed}
        columns[f"{point}_speed_sd_m_s"] = sigma
    length_m = 1.02 * 2 * np.pi * RADIUS_M * (time_s[-1] - time_s[0]) / TURN_S
    summary = pd.DataFrame(
        [
            ("p1", f"{point}_distance", length_m, 0.1, camera_m)
            for point in ("neck", "centre", "mass")
        ],
        columns=["person", "measure", "value", "sigma", "sigma_camera"],
    )
    return pd.DataFrame(columns), summary


def errors(real, frames, summary):
    rows = kinematics.table(frames, summary, real, TABLE, {"p1": "m"})
    return rows.set_index("point").loc["neck"]


def test_a_perfect_path_has_no_error_and_a_2_percent_error_is_found():
    real = truth()
    found = errors(real, *measured(real))
    assert found["position_p95_mm"] < 1e-6 and found["speed_rmse_m_s"] < 1e-3
    assert found["true_distance_m"] == pytest.approx(2 * 2 * np.pi * RADIUS_M, rel=1e-5)
    assert found["distance_error_percent"] == pytest.approx(2, abs=1e-3)
    assert found["distance_sigma_percent"] == pytest.approx(10 / (8 * np.pi), rel=1e-3)
    assert (found["n"], found["speed_within_90_percent"]) == (241, 100)
    found = errors(real, *measured(real, camera_m=0.1))
    assert found["distance_sigma_percent"] == pytest.approx(np.sqrt(2) * 10 / (8 * np.pi), rel=1e-3)


def test_known_errors_of_position_and_speed_are_separated():
    real = truth()
    found = errors(real, *measured(real, shift_m=0.02, faster=0.3, sigma=0.1))
    assert found["position_median_mm"] == pytest.approx(20)
    assert found["speed_bias_m_s"] == pytest.approx(0.3, abs=1e-3)
    assert found["ground_speed_rmse_m_s"] == pytest.approx(0.3, abs=1e-3)
    assert found["speed_within_90_percent"] == 0


def test_errors_of_speeds_and_distances_come_with_their_sigmas():
    real = truth()
    frames, summary = measured(real, faster=0.3, sigma=0.2)
    error, sigma = kinematics.speeds(frames, real, TABLE, {"p1": "m"})
    np.testing.assert_allclose(error, 0.3, atol=1e-3)
    assert len(error) == 3 * 241 and (sigma == 0.2).all()
    error, sigma = kinematics.distances(kinematics.table(frames, summary, real, TABLE, {"p1": "m"}))
    np.testing.assert_allclose(error, 2, atol=1e-3)
    np.testing.assert_allclose(sigma, 10 / (8 * np.pi), rtol=1e-3)


def test_errors_of_all_angles_are_those_of_the_table():
    real = posed(60.0)
    measured = skeletons(real)
    measured.xyz[0, :, :6] = posed(50.0).xyz[0, :, :6]
    error, sigma = kinematics.all_angles(measured, real)
    rows = kinematics.angles(measured, real).set_index("angle")
    assert len(error) == len(sigma) == 10 * 121
    one_side = rows.loc[
        [name for name in rows.index if name.startswith(("left_", "right_", "trunk"))]
    ]
    assert np.sqrt(np.mean(error**2)) == pytest.approx(np.sqrt(np.mean(one_side["rmse_deg"] ** 2)))


@pytest.mark.parametrize("last", [59, 719])  # their times are rounded up: 1.96667 and 23.9667 s
def test_times_rounded_beyond_the_truth_count_as_its_end(tmp_path, last):
    real = truth(seconds=last / 30, rate_hz=30)
    frames, summary = measured(real, step=1)
    tables.write(tmp_path / "frames.csv", frames)
    kept = pd.read_csv(tmp_path / "frames.csv")
    assert kept["time_s"].iloc[-1] > real.time_s[-1]
    found = errors(real, kept, summary)
    assert found["distance_error_percent"] == pytest.approx(2, abs=0.02)
    assert found["n"] == last + 1


def test_distances_span_gaps_and_need_truth_from_the_first_to_the_last_frame():
    real = truth()
    frames, summary = measured(real)
    late = frames.assign(time_s=frames["time_s"] + 0.5)
    assert np.isnan(errors(real, late, summary)["distance_error_percent"])
    gap = frames.copy()
    gap.loc[100:110, ["neck_x_m", "neck_speed_m_s"]] = np.nan
    found = errors(real, gap, summary)
    assert found["distance_error_percent"] == pytest.approx(2, abs=1e-3) and found["n"] == 230
    ends = frames.copy()
    ends.loc[:9, ["neck_x_m", "neck_speed_m_s"]] = np.nan
    assert errors(real, ends, summary)["true_distance_m"] < 2 * 2 * np.pi * RADIUS_M


def posed(elbow_deg, seconds=4.0, rate_hz=30):
    """Return the truth of a person who bends both elbows by an angle over time, else stands."""
    time_s = np.arange(round(seconds * rate_hz) + 1) / rate_hz
    bend = np.radians(np.broadcast_to(elbow_deg, len(time_s)))
    standing = {"shoulder": (0.2, 0, 1.4), "elbow": (0.2, 0, 1.1), "hip": (0.1, 0, 0.9)}
    standing |= {"knee": (0.1, 0.1, 0.5), "ankle": (0.1, 0, 0.1)}
    xyz = np.zeros((1, len(time_s), len(LIMBS) * 2, 3))
    for side, sign in enumerate((-1, 1)):
        for at, name in enumerate(LIMBS):
            place = standing.get(name, standing["elbow"]) * np.array([sign, 1, 1])
            xyz[0, :, side * len(LIMBS) + at] = place
        forearm = 0.25 * np.stack([0 * bend, np.sin(bend), -np.cos(bend)], axis=1)
        xyz[0, :, side * len(LIMBS) + LIMBS.index("wrist")] += forearm
    return SimpleNamespace(
        joints=np.array(JOINTS[:12]), person_id=np.array(["p1"]), time_s=time_s, xyz=xyz
    )


def skeletons(real, sigma_m=0.01):
    """Return a perfect measurement of a truth, with a stated standard deviation per axis."""
    shape = real.xyz.shape[:-1]
    nothing = np.zeros((*shape, 3, 3))
    return replace(
        waves.record(real.xyz[0]),
        joints=real.joints,
        person_id=real.person_id,
        time_s=real.time_s,
        covariance_2d=nothing + sigma_m**2 * np.eye(3),
        covariance_camera=nothing,
        covariance_network=nothing,
        offset=np.zeros_like(real.xyz),
    )


def test_perfect_joint_angles_have_no_error_and_lie_in_their_intervals():
    real = posed(60 + 30 * np.sin(np.linspace(0, 6, 121)))
    rows = kinematics.angles(skeletons(real), real).set_index("angle")
    assert rows.loc["elbow_flexion", "n"] == 2 * 121 and rows.loc["left_elbow_flexion", "n"] == 121
    assert rows["rmse_deg"].max() < 1e-4 and rows["within_90_percent"].min() == 100


def test_a_bent_elbow_measured_too_straight_has_this_bias_and_misses_its_interval():
    real = posed(60.0)
    measured = skeletons(real, sigma_m=0.002)
    measured.xyz[0, :, :6] = posed(50.0).xyz[0, :, :6]
    rows = kinematics.angles(measured, real).set_index("angle")
    assert rows.loc["left_elbow_flexion", "bias_deg"] == pytest.approx(-10, abs=1e-6)
    assert rows.loc["elbow_flexion", "bias_deg"] == pytest.approx(-5, abs=1e-6)
    assert rows.loc["elbow_flexion", "rmse_deg"] == pytest.approx(10 / np.sqrt(2), abs=1e-6)
    assert rows.loc["elbow_flexion", "within_90_percent"] == 50
    assert rows.loc["knee_flexion", "within_90_percent"] == 100


def test_coverage_of_angles_follows_the_noise_that_was_stated():
    real = posed(60.0, seconds=60)
    measured = skeletons(real, sigma_m=0.01)
    noise = np.random.default_rng(1).normal(0, 0.01, measured.xyz.shape)
    measured = replace(measured, xyz=measured.xyz + noise)
    rows = kinematics.angles(measured, real).set_index("angle")
    assert rows.loc["elbow_flexion", "within_90_percent"] == pytest.approx(90, abs=1.5)
    assert rows.loc["elbow_flexion", "sigma_deg"] == pytest.approx(
        rows.loc["elbow_flexion", "rmse_deg"], rel=0.05
    )


def test_angles_without_truth_are_left_out_and_missing_ones_are_counted():
    real = posed(60.0)
    measured = skeletons(real)
    measured.xyz[0, :30, JOINTS.index("left_wrist")] = np.nan
    measured = replace(measured, time_s=measured.time_s + 1.0)
    row = kinematics.angles(measured, real).set_index("angle").loc["left_elbow_flexion"]
    assert (row["n"], row["missing_percent"]) == (61, pytest.approx(100 * 30 / 91))


def test_a_source_without_a_common_time_has_rows_without_errors_and_one_line():
    real, measured, late = posed(60.0), walker.points(n_frames=50), Clock(offset_s=-1000.0)
    rows = kinematics.angles_of(measured, real, "p1", late).set_index("angle")
    assert rows.loc["elbow_flexion", "n"] == 0 and np.isnan(rows.loc["elbow_flexion", "rmse_deg"])
    line = kinematics.no_common_time("suit", measured, real, late)
    assert line.startswith("source suit: expected frames from 0.00 to 4.00 s") and "1000.00" in line
    usual = kinematics.angles_of(measured, real, "p1", Clock()).set_index("angle")
    assert usual.loc["elbow_flexion", "n"] > 0 and set(usual.index) == set(rows.index)
    assert kinematics.no_common_time("suit", measured, real, Clock()) == ""
