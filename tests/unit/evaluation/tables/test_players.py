"""The table of simulated players: what is summarised, what is compared, what stays empty."""

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation.tables import players
from courtside.records.keypoints import skeleton

MODEL = {"calibration": "sfm-n40", "model": "net"}


def errors(fusion="all-robust", stage="pose3d", median=20.0, p95=50.0, persons=("m3",), **changes):
    """Return an evaluation of one take: coverage at 90 % rises from 70 to 92 % in steps of 2 %."""
    rows = []
    for person in [*persons, *(["all"] if len(persons) > 1 else [])]:
        about = {"session": "s", "take": "t", "stage": stage, "fusion": fusion, **MODEL}
        about |= {"person": person, "n": 100, "missing_percent": 1.0, "sigma_mm": 9.0}
        about |= {"identity_percent": 100.0 if person == "m3" else 97.0, "p95_mm": p95, **changes}
        if person == "all":
            about["identity_percent"] = np.nan
        whole = {"joint": "limbs", "median_mm": median, "coverage_90_percent": 85.0}
        rows.append({**about, **whole, "coverage_50_percent": 45.0, "coverage_95_percent": 93.0})
        for at, joint in enumerate((*skeleton.JOINTS, "nose")):
            level = 70.0 + 2 * at if joint != "nose" else 5.0
            own = {"joint": joint, "median_mm": median + at, "coverage_90_percent": level}
            rows.append({**about, **own, "coverage_50_percent": 1.0, "coverage_95_percent": 1.0})
    return pd.DataFrame(rows)


def gain(fusion, than, median, p95, stage="pose3d"):
    row = {"session": "s", "take": "t", "stage": stage, "fusion": fusion, "than": than, **MODEL}
    row |= {"median_mm": median, "median_from_mm": median - 1, "median_to_mm": median + 1}
    return {**row, "p95_mm": p95, "p95_from_mm": p95 - 2, "p95_to_mm": p95 + 2}


def table(errors_, kinematics=(), clocks=(), gains=()):
    parts = [pd.DataFrame(list(part)) for part in (kinematics, clocks, gains)]
    return players.table(pd.concat(errors_), *parts)


def test_coverage_is_the_range_over_the_limb_joints_only():
    row = table([errors()]).iloc[0]
    assert (row["coverage_90_least_percent"], row["coverage_90_most_percent"]) == (70, 92)
    assert row["coverage_90_percent"] == 85 and row["worst_joint_median_mm"] == 31
    assert (row["joints_within"], row["joints_stated"]) == (7, 12)  # 80, 82, ..., 92


def test_persons_are_pooled_and_the_most_mistaken_identity_counts():
    found = table([errors(persons=("m3", "f3"))])
    assert len(found) == 1
    assert found["identity_percent"].iloc[0] == 97


def test_stages_are_ordered_raw_first_within_a_fusion():
    stages = ["pose3d_corrected", "pose3d", "pose3d_filtered"]
    found = table([errors(stage=stage) for stage in stages])
    assert found["stage"].tolist() == ["raw", "filtered", "corrected"]


def test_ours_is_compared_with_other_rules_on_the_same_cameras():
    rules = {"three-robust": (20, 50), "three-dlt": (26, 40), "halfbody": (30, 80)}
    found = table([errors(name, median=m, p95=p) for name, (m, p) in rules.items()])
    found = found.set_index("fusion")
    ours = found.loc["three-robust"]
    assert (ours["vs_dlt_median_mm"], ours["vs_dlt_p95_mm"]) == (-6, 10)
    assert (ours["vs_halfbody_median_mm"], ours["vs_halfbody_p95_mm"]) == (-10, -30)
    assert ours["beats_others"] == "no"  # not in the 95 % quantile of the linear one
    assert (found.loc[["three-dlt", "halfbody"], "beats_others"] == "").all()
    assert np.isnan(found.loc["halfbody", "vs_dlt_median_mm"])


def test_two_and_four_cameras_are_not_compared_with_the_half_body_rule():
    found = table([errors(name) for name in ("all-robust", "two-robust", "halfbody")])
    assert found["vs_halfbody_median_mm"].isna().all() and (found["beats_others"] == "").all()


def test_a_paired_comparison_decides_where_there_is_one():
    parts = [errors("all-robust", median=20), errors("all-dlt", median=22, p95=60)]
    assert table(parts).set_index("fusion").loc["all-robust", "beats_others"] == "yes"
    gains = [gain("all-robust", "all-dlt", 0.5, -3)]
    row = table(parts, gains=gains).set_index("fusion").loc["all-robust"]
    assert row["beats_others"] == "no" and row["vs_dlt_paired_median_mm"] == 0.5
    assert (row["vs_dlt_paired_p95_from_mm"], row["vs_dlt_paired_p95_to_mm"]) == (-5, -1)
    assert row["vs_dlt_median_mm"] == -2


def kinematics(person, distance, rmse, point="neck"):
    row = {"session": "s", "take": "t", "fusion": "all-robust", **MODEL, "person": person}
    row |= {
        "stage": "pose3d_corrected",
        "point": point,
        "seconds": 24.0,
        "distance_error_percent": distance,
    }
    return {**row, "speed_rmse_m_s": rmse, "position_median_mm": 10.0}


def clock(camera, error_ms, within, status="found"):
    row = {"session": "s", "take": "t", **MODEL, "camera": camera, "status": status}
    return {**row, "worst_error_ms": error_ms, "within_90_percent": within}


def test_kinematics_stand_with_their_stage_and_clocks_with_the_raw_one_by_their_worst_value():
    parts = [errors(stage=stage) for stage in ("pose3d", "pose3d_corrected")]
    measured = [kinematics("m3", -0.8, 0.05), kinematics("f3", 0.5, 0.07)]
    clocks = [clock("back", -3, True), clock("front", 2, "True"), clock("mirror", 9, "False")]
    clocks.append(clock("far", 800, False, "ambiguous"))
    found = table(parts, measured, clocks).set_index("stage")
    raw, last = found.loc["raw"], found.loc["corrected"]
    assert (last["neck_distance_error_percent"], last["neck_speed_rmse_m_s"]) == (-0.8, 0.07)
    assert last["kinematics_seconds"] == 24 and np.isnan(last["centre_speed_rmse_m_s"])
    assert raw[["n_clocks", "n_clocks_found", "n_clocks_within"]].tolist() == [4, 3, 2]
    assert raw["clock_error_ms"] == 9
    assert pd.isna(last["n_clocks"]) and np.isnan(raw["neck_speed_rmse_m_s"])
    unknown = [*measured, kinematics("f4", np.nan, 0.06)]
    last = table(parts, unknown).set_index("stage").loc["corrected"]
    assert np.isnan(last["neck_distance_error_percent"])
    assert last["neck_speed_rmse_m_s"] == 0.07
    unknown = [*measured, kinematics("f4", np.nan, np.nan)]
    last = table(parts, unknown).set_index("stage").loc["corrected"]
    assert np.isnan(last["neck_speed_rmse_m_s"])


def test_clocks_that_were_not_found_are_counted():
    found = table([errors()], clocks=[clock("back", 800, False, "unknown")]).iloc[0]
    assert (found["n_clocks"], found["n_clocks_found"], found["n_clocks_within"]) == (1, 0, 0)
    assert np.isnan(found["clock_error_ms"])


def test_names_that_look_like_numbers_are_read_as_text(tmp_path):
    errors().assign(take="007").to_csv(tmp_path / "a.csv", index=False)
    assert set(players.read([tmp_path / "a.csv"])["take"]) == {"007"}
    assert players.read([]).empty


def test_a_table_without_errors_is_refused():
    with pytest.raises(KeyError, match="session"):
        players.table(pd.DataFrame(), pd.DataFrame(), pd.DataFrame(), pd.DataFrame())
