"""Errors of a simulated take's paths, speeds and joint angles against the truth."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.evaluation import joints
from courtside.evaluation.joints import Truth
from courtside.kinematics import joint_angles, measures, shared_errors
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import derived_joints
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics import normal_errors

FINE = 10  # ASSUME: true points per frame, for the length of the true path; chords err little
CLOSE_S = 1e-4  # times in tables are rounded to half of this or less
COLUMNS = [
    "person", "point", "n", "seconds", "distance_m", "true_distance_m", "distance_error_percent",
    "distance_sigma_percent", "position_median_mm", "position_p95_mm", "speed_rmse_m_s",
    "ground_speed_rmse_m_s", "speed_bias_m_s", "speed_within_90_percent",
]  # fmt: skip
ANGLE_COLUMNS = [
    "person", "angle", "n", "missing_percent", "bias_deg", "rmse_deg", "p95_deg", "sigma_deg",
    "within_90_percent",
]  # fmt: skip


def table(
    frames: pd.DataFrame,
    summary: pd.DataFrame,
    truth: Truth,
    derived: DerivedJoints,
    sex_of: dict[str, str | None],
) -> pd.DataFrame:
    """Compare measured paths and speeds with the true ones, over the frames that were measured.

    Distances are in space, measured and true from a person's first known frame to the last, gaps
    included; errors of the position are of the filtered path. `frames` and `summary` are of
    `courtside.exports.measures`, `sex_of` is "m", "f" or None by person.

    Distances stay empty if the truth does not cover the measured frames, errors of distances also
    if a gap is too long for a distance.
    """
    rows, measured = [], summary.set_index(["person", "measure"])
    for part, point, path in _paths(frames, truth, derived, sex_of):
        row = {"person": part["person"].iloc[0], "point": point, **_errors(part, point, path)}
        rows.append(row | _distances(part, point, path, measured.loc[row["person"]]))
    return pd.DataFrame(rows).reindex(columns=COLUMNS)


def _paths(
    frames: pd.DataFrame, truth: Truth, derived: DerivedJoints, sex_of: dict[str, str | None]
) -> Iterator[tuple[pd.DataFrame, str, "scipy.interpolate.CubicSpline"]]:
    """Yield each person's frames with each point and its true path."""
    for person, part in frames.groupby("person", sort=False):
        of = truth.person_id.tolist().index(person)
        weights, _ = measures.definitions(
            derived, derived_joints.RIG, truth.joints, sex_of.get(str(person))
        )
        for point, shares in weights.items():
            xyz = np.einsum("j,tjk->tk", shares, truth.xyz[of])
            yield part, point, scipy.interpolate.CubicSpline(truth.time_s, xyz)


def speeds(
    frames: pd.DataFrame, truth: Truth, derived: DerivedJoints, sex_of: dict[str, str | None]
) -> tuple[NDArray, NDArray]:
    """Return errors of the speeds of every point and frame within the truth, and their sigmas.

    Both (N,) m/s, NaN where missing; parameters as for `table`.
    """
    found = [
        _speed_errors(_inside(part, path), point, path)
        for part, point, path in _paths(frames, truth, derived, sex_of)
    ]
    error, sigma = (np.concatenate(values) for values in zip(*found, strict=True))
    return error, sigma


def distances(errors: pd.DataFrame) -> tuple[NDArray, NDArray]:
    """Return the errors of distances, and their sigmas, (N,) percent, of a table of `table`."""
    columns = ("distance_error_percent", "distance_sigma_percent")
    error, sigma = (errors[name].to_numpy(dtype=float) for name in columns)
    return error, sigma


def _inside(part: pd.DataFrame, path: "scipy.interpolate.CubicSpline") -> pd.DataFrame:
    return part[part["time_s"].between(path.x[0] - CLOSE_S, path.x[-1] + CLOSE_S)]


def _speed_errors(
    part: pd.DataFrame, point: str, path: "scipy.interpolate.CubicSpline"
) -> tuple[NDArray, NDArray]:
    true = np.linalg.norm(path(part["time_s"].to_numpy(), 1), axis=1)
    speed, sigma = (part[f"{point}_{name}"].to_numpy() for name in ("speed_m_s", "speed_sd_m_s"))
    return speed - true, sigma


def _distances(
    part: pd.DataFrame, point: str, path: "scipy.interpolate.CubicSpline", measured: pd.DataFrame
) -> dict:
    time_s = part["time_s"].to_numpy()[part[f"{point}_speed_m_s"].notna()]
    if len(time_s) < 2 or time_s[0] < path.x[0] - CLOSE_S or time_s[-1] > path.x[-1] + CLOSE_S:
        return {}
    fine_s = np.linspace(time_s[0], time_s[-1], FINE * len(part))
    true_m = np.linalg.norm(np.diff(path(fine_s), axis=0), axis=1).sum()
    found = measured.loc[f"{point}_distance"]
    sigma_m = float(np.hypot(found["sigma"], np.nan_to_num(found["sigma_camera"])))
    return {
        "distance_m": found["value"],
        "true_distance_m": true_m,
        "distance_error_percent": 100 * (found["value"] / true_m - 1),
        "distance_sigma_percent": 100 * sigma_m / true_m,
    }


def _errors(part: pd.DataFrame, point: str, path: "scipy.interpolate.CubicSpline") -> dict:
    part = _inside(part, path)
    time_s = part["time_s"].to_numpy()
    place = part[[f"{point}_{axis}_m" for axis in "xyz"]].to_numpy()
    apart_mm = 1000 * np.linalg.norm(place - path(time_s), axis=1)
    known = np.isfinite(apart_mm)
    row = {"n": int(known.sum()), "seconds": float(np.ptp(time_s)) if len(time_s) else 0.0}
    if not known.any():
        return row
    speed, sigma = _speed_errors(part, point, path)
    ground = part[f"{point}_ground_speed_m_s"].to_numpy()
    ground = ground - np.linalg.norm(path(time_s, 1)[:, :2], axis=1)
    return {
        **row,
        "position_median_mm": np.nanmedian(apart_mm),
        "position_p95_mm": np.nanpercentile(apart_mm, 95),
        "speed_rmse_m_s": np.sqrt(np.nanmean(speed**2)),
        "ground_speed_rmse_m_s": np.sqrt(np.nanmean(ground**2)),
        "speed_bias_m_s": np.nanmean(speed),
        "speed_within_90_percent": _within_90_percent(speed, sigma),
    }


def _within_90_percent(error: NDArray, sigma: NDArray) -> float:
    """Return how many errors (N,) of a stated sigma lie in their 90 % interval, percent."""
    stated = np.isfinite(error) & np.isfinite(sigma)
    inside = np.abs(error[stated]) <= normal_errors.WITHIN_90 * sigma[stated]
    return 100 * inside.mean() if stated.any() else np.nan


def angles(points: Keypoints3D, truth: Truth) -> pd.DataFrame:
    """Compare the joint angles of skeletons with those of the true joints, by person and angle.

    Angles and their standard deviations are as `courtside.kinematics.measures` states them for
    these skeletons. An angle of a limb has one row for both sides together (`knee_flexion`) and one
    for each. bias_deg is measured minus true, p95_deg of its size, sigma_deg the root mean square
    of the stated standard deviations. A true angle that folds at 0 or 180 degrees (a straight limb)
    makes the bias one-sided.
    """
    rows = []
    for at, person in enumerate(map(str, points.person_id)):
        errors = _angle_errors(points, truth, at)
        for angle, sides in _by_angle(errors).items():
            parts = zip(*(errors[side] for side in sides), strict=True)
            row = _of_angle(*(np.concatenate(part) for part in parts))
            rows.append({"person": person, "angle": angle, **row})
    return pd.DataFrame(rows).reindex(columns=ANGLE_COLUMNS)


def angles_of(points: Keypoints3D, truth: Truth, person: str, clock: Clock) -> pd.DataFrame:
    """Compare the joint angles of one person of a source with another clock (`angles`).

    Without a common time (`no_common_time`), each angle has a row with n = 0 and no errors.
    """
    at = replace(points, time_s=clock.to_reference(points.time_s))
    within = at.between(truth.time_s[0], truth.time_s[-1])
    found = angles(within if len(within.time_s) else at.frames(np.arange(1)), truth)
    return found[found["person"] == person]


def no_common_time(name: str, points: Keypoints3D, truth: Truth, clock: Clock) -> str:
    """Return a line if a source has no frame at a time with truth, else an empty string."""
    at, (first, last) = clock.to_reference(points.time_s), truth.time_s[[0, -1]]
    if ((at >= first) & (at <= last)).any():
        return ""
    span = f"{at.min():.2f} to {at.max():.2f} s" if len(at) else "none"
    return (
        f"source {name}: expected frames from {first:.2f} to {last:.2f} s, the times with truth, "
        f"found {span} by its clock; no angle is compared: check the clock in `sync`"
    )


def all_angles(points: Keypoints3D, truth: Truth) -> tuple[NDArray, NDArray]:
    """Return the errors of all angles of all persons, and their sigmas: (N,) degrees."""
    found = [
        one
        for at in range(len(points.person_id))
        for one in _angle_errors(points, truth, at).values()
    ]
    error, sigma, _ = (np.concatenate(values) for values in zip(*found, strict=True))
    return error, sigma


def _angle_errors(
    points: Keypoints3D, truth: Truth, person: int
) -> dict[str, tuple[NDArray, NDArray, NDArray]]:
    """Return by angle of one person: errors and sigmas (T,) degrees; where there is truth (T,)."""
    true_xyz = joints.true_places(points, truth)[person]
    names = [name for name in truth.joints.tolist() if name in limbs.JOINTS]
    true_xyz = true_xyz[:, [truth.joints.tolist().index(name) for name in names]]
    known = shared_errors.independent(np.zeros((*true_xyz.shape[:2], 3, 3)))
    true = joint_angles.measure(true_xyz, known, names)
    return {
        angle: (one.degrees - true[angle].degrees, one.sigma_deg, np.isfinite(true[angle].degrees))
        for angle, one in measures.angles(points, person).items()
    }


def _by_angle(found: Mapping[str, object]) -> dict[str, list[str]]:
    """Return the measured angles that make up each angle: both sides of a limb, and one."""
    both: dict[str, list[str]] = {}
    for name in found:
        stem = limbs.without_side(name)
        both.setdefault(stem, []).append(name)
    return both | {name: [name] for name in found}


def _of_angle(error: NDArray, sigma: NDArray, there: NDArray) -> dict:
    """Return errors and coverage (n,); frames without truth are left out, not missing."""
    error, sigma = error[there], sigma[there]
    known = np.isfinite(error)
    row = {"n": int(known.sum()), "missing_percent": 100 * (1 - known.mean()) if len(known) else 0}
    if not known.any():
        return row
    error, sigma = error[known], sigma[known]
    stated = np.isfinite(sigma)
    return {
        **row,
        "bias_deg": error.mean(),
        "rmse_deg": np.sqrt(np.mean(error**2)),
        "p95_deg": np.percentile(np.abs(error), 95),
        "sigma_deg": np.sqrt(np.mean(sigma[stated] ** 2)) if stated.any() else np.nan,
        "within_90_percent": _within_90_percent(error, sigma),
    }
