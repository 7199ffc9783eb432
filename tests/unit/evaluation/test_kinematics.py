"""Errors of kinematics: measures made from the truth itself, and with known errors."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation import kinematics
from courtside.records.keypoints import derived_joints

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


def measured(real, shift_m=0.0, faster=0.0, sigma=0.1, step=2):
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
        [("p1", f"{point}_distance", length_m, 0.1) for point in ("neck", "centre", "mass")],
        columns=["person", "measure", "value", "sigma"],
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


def test_known_errors_of_position_and_speed_are_separated():
    real = truth()
    found = errors(real, *measured(real, shift_m=0.02, faster=0.3, sigma=0.1))
    assert found["position_median_mm"] == pytest.approx(20)
    assert found["speed_bias_m_s"] == pytest.approx(0.3, abs=1e-3)
    assert found["ground_speed_rmse_m_s"] == pytest.approx(0.3, abs=1e-3)
    assert found["speed_within_90_percent"] == 0


def test_frames_beyond_the_truth_or_missing_give_no_distance():
    real = truth()
    frames, summary = measured(real)
    late = frames.assign(time_s=frames["time_s"] + 0.5)
    assert np.isnan(errors(real, late, summary)["distance_error_percent"])
    gap = frames.copy()
    gap.loc[100:110, "neck_x_m"] = np.nan
    found = errors(real, gap, summary)
    assert np.isnan(found["distance_m"]) and found["n"] == 230
    ends = frames.copy()
    ends.loc[:9, "neck_x_m"] = np.nan
    assert errors(real, ends, summary)["true_distance_m"] < 2 * 2 * np.pi * RADIUS_M
