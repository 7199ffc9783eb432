"""Errors of 3D joints against truth, and against views that were left out."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from typing import ClassVar, Protocol

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.reconstruction import resampling
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import derived_joints
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.records.keypoints.keypoints import Keypoints2D, Keypoints3D
from courtside.statistics.normal_errors import ellipsoid, mahalanobis
from courtside.study.errors import InputError

LEVELS = (0.5, 0.9, 0.95)  # of the ellipsoids whose coverage is counted
WANTED_90 = (80, 97)  # ASSUME: percent, the coverage of 90 % ellipsoids that the study asks for
SETS = {  # joints taken together, by the start of their names
    "limbs": ("left_", "right_"),
    "left half": ("left_",),
    "right half": ("right_",),
}
COLUMNS = ["person", "joint", "n", "missing_percent", "median_mm", "p95_mm", "mean_mm", "rms_mm"]
COLUMNS += ["bias_x_mm", "bias_y_mm", "bias_z_mm", "bias_mm", "sd_mm"]
COLUMNS += ["unbiased_median_mm", "unbiased_p95_mm", "sigma_mm"]
COLUMNS += [f"coverage_{100 * level:.0f}_percent" for level in LEVELS]
LARGE_M = 0.1  # errors above it are counted by themselves
COLUMNS += ["n_large", "coverage_90_large_percent"]


class Truth(Protocol):
    """True motion: joints (J,), person_id (P,), time_s (T,) reference clock, xyz (P, T, J, 3) m."""

    __dataclass_fields__: ClassVar[dict]
    joints: NDArray
    person_id: NDArray
    time_s: NDArray
    xyz: NDArray


def at_times(time_s: NDArray, xyz: NDArray, wanted_s: NDArray) -> NDArray:
    """Interpolate true positions (P, T, J, 3) at other times (U,) by a cubic spline, (P, U, J, 3).

    Both times are on the reference clock; NaN outside the span of `time_s`.
    """
    found = scipy.interpolate.CubicSpline(time_s, xyz, axis=1, extrapolate=False)(wanted_s)
    return np.asarray(found)


def true_places(points: Keypoints3D, truth: Truth) -> NDArray:
    """Return the truth (P, T, K, 3) at a record's times, with the record's persons in their order.

    NaN outside the truth's span, and for a person who is not in the truth.
    """
    known, wanted = list(map(str, truth.person_id)), list(map(str, points.person_id))
    there = [at for at, person in enumerate(wanted) if person in known]
    true = np.full((len(wanted), len(points.time_s), *truth.xyz.shape[2:]), np.nan)
    order = [known.index(wanted[at]) for at in there]
    true[there] = at_times(truth.time_s, truth.xyz[order], points.time_s)
    return true


def errors(
    points: Keypoints3D, joints: Sequence[str], true_xyz: NDArray
) -> tuple[list[str], NDArray, NDArray]:
    """Return the differences of a record from the truth, joint by joint.

    The names of the M joints of both; measured minus true (P, T, M, 3) m, NaN where missing; and
    the covariance (P, T, M, 3, 3) m2 that the record states (`Keypoints3D.covariance`).
    `joints` name those of the truth, `true_xyz` (P, T, K, 3) m: at the record's times, persons in
    the record's order.
    """
    names, own, other = _of_both(points, joints)
    error = points.xyz[:, :, own] - true_xyz[:, :, other]
    return names, error, points.covariance[:, :, own]


def _of_both(points: Keypoints3D, joints: Sequence[str]) -> tuple[list[str], list[int], list[int]]:
    """Return the names of joints of both, and their indices in the record and in `joints`."""
    own, other = points.joints.tolist(), list(joints)
    names = [name for name in own if name in other]
    return names, [own.index(name) for name in names], [other.index(name) for name in names]


def table(
    person_id: Sequence[str], names: list[str], error: NDArray, covariance: NDArray
) -> pd.DataFrame:
    """Summarise errors: one row for each person and joint, and for sets of the limb joints.

    From what `errors` returns. missing_percent is over the frames with truth; sd_mm is the root
    mean square about the mean error, sigma_mm the root of the mean trace of the stated covariance.
    unbiased_... are of the distances once the row's mean error is taken off: for a set of joints
    that is a shift of the whole skeleton, about half of it from the calibration.
    """
    groups = {name: [at] for at, name in enumerate(names)}
    groups |= {label: of_set(names, label) for label in SETS}
    persons = {str(name): [at] for at, name in enumerate(person_id)}
    if len(persons) > 1:
        persons["all"] = list(chain.from_iterable(persons.values()))
    rows = [
        {
            "person": person,
            "joint": label,
            **_summary(error[people][:, :, at], covariance[people][:, :, at]),
        }
        for person, people in persons.items()
        for label, at in groups.items()
        if at
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def of_set(names: list[str], label: str) -> list[int]:
    """Return the indices of a set of limb joints (`SETS`) in `names`, those that are there."""
    wanted = (name for name in limbs.JOINTS if name.startswith(SETS[label]))
    return [names.index(name) for name in wanted if name in names]


def _summary(error: NDArray, covariance: NDArray) -> dict:
    error, covariance = error.reshape(-1, 3), covariance.reshape(-1, 3, 3)
    known = np.isfinite(error).all(axis=1)
    row = {"n": int(known.sum()), "missing_percent": 100 * (1 - known.mean())}
    if not known.any():
        return row
    error, covariance = error[known], covariance[known]
    distance_mm = 1000 * np.linalg.norm(error, axis=1)
    row |= {
        "median_mm": np.median(distance_mm),
        "p95_mm": np.percentile(distance_mm, 95),
        "mean_mm": distance_mm.mean(),
        "rms_mm": np.sqrt(np.mean(distance_mm**2)),
    }
    bias_mm = 1000 * error.mean(axis=0)
    row |= {f"bias_{axis}_mm": bias_mm[k] for k, axis in enumerate("xyz")}
    row["bias_mm"] = np.linalg.norm(bias_mm)
    row["sd_mm"] = np.sqrt(max(0.0, row["rms_mm"] ** 2 - row["bias_mm"] ** 2))
    unbiased_mm = np.linalg.norm(1000 * error - bias_mm, axis=1)
    row["unbiased_median_mm"] = np.median(unbiased_mm)
    row["unbiased_p95_mm"] = np.percentile(unbiased_mm, 95)
    stated = np.isfinite(covariance).all(axis=(1, 2))
    if stated.any():
        trace = np.trace(covariance[stated], axis1=1, axis2=2)
        row["sigma_mm"] = 1000 * np.sqrt(trace.mean())
        distance = mahalanobis(error[stated], covariance[stated])
        for level in LEVELS:
            inside = distance <= ellipsoid(level)
            row[f"coverage_{100 * level:.0f}_percent"] = 100 * inside.mean()
        large = np.linalg.norm(error[stated], axis=1) > LARGE_M
        row["n_large"] = int(large.sum())
        if large.any():
            inside = distance[large] <= ellipsoid(0.9)
            row["coverage_90_large_percent"] = 100 * inside.mean()
    return row


def identity_percent(points: Keypoints3D, joints: Sequence[str], true_xyz: NDArray) -> NDArray:
    """Return the share of frames in which each person has the right identity, (P,) percent.

    That is the share of the frames with that person in which no other true person is nearer, by the
    mean distance over the joints; NaN for a person without frames. Parameters as for `errors`.
    """
    _, own, other = _of_both(points, joints)
    found, true = points.xyz[:, None, :, own], true_xyz[None, :, :, other]
    apart = np.linalg.norm(found - true, axis=-1)  # (P measured, P true, T, M)
    seen = np.isfinite(apart)
    mean = np.where(seen, apart, 0).sum(axis=-1) / np.maximum(seen.sum(axis=-1), 1)
    placed = seen.any(axis=-1).all(axis=1)
    right = mean.argmin(axis=1) == np.arange(len(found))[:, None]
    return np.array(
        [100 * r[p].mean() if p.any() else np.nan for r, p in zip(right, placed, strict=True)]
    )


def derive_truth(truth: Truth, table: DerivedJoints, skeleton: str, names: Sequence[str]) -> Truth:
    """Append derived joints to a truth, if the network's skeleton defines them in the same way.

    Joints that `skeleton` defines differently are left out, and then have no true error.
    """
    alike = [name for name in names if table.comparable(skeleton, derived_joints.RIG, name)]
    if not alike:
        return truth
    weights = np.stack([table.weights(derived_joints.RIG, name, truth.joints) for name in alike])
    more = np.einsum("nj,ptjk->ptnk", weights, truth.xyz)
    joints = np.array([*map(str, truth.joints), *alike])
    return replace(truth, joints=joints, xyz=np.concatenate([truth.xyz, more], axis=2))


def distance_to_truth(points: Keypoints3D, truth: Truth) -> NDArray:
    """Return the distance to the truth, (P, T, J) mm; NaN where either is missing.

    The truth is interpolated at the times of `points`, never extrapolated. `InputError` if none of
    the persons is in the truth.
    """
    known, wanted = list(map(str, truth.person_id)), list(map(str, points.person_id))
    if not set(known) & set(wanted):
        raise InputError(
            f"truth: expected one of the persons {wanted}, found {known}; give the persons of the "
            "take the same names"
        )
    real = true_places(points, truth)
    names, apart, _ = errors(points, list(map(str, truth.joints)), real)
    at = [list(points.joints).index(name) for name in names]
    error = np.full(points.xyz.shape[:-1], np.nan)
    error[:, :, at] = 1000 * np.linalg.norm(apart, axis=-1)
    return error


def limb_distances(points: Keypoints3D, truth: Truth) -> NDArray:
    """Return the distances of the 12 limb joints to the truth, (P, T, 12) mm, as those of all."""
    names = points.joints.tolist()
    return distance_to_truth(points, truth)[:, :, [names.index(joint) for joint in limbs.JOINTS]]


def distance_to_unused_view(
    points: Keypoints3D, camera: Camera, view: Keypoints2D, clock: Clock | None = None
) -> NDArray:
    """Return the distances (P, T, J) px between a view's detections and projected points.

    The points must not rest on this view. It holds the persons of the points, in their order
    (`People.assigned`), not tracklets: somebody who walks by is not compared with a person who is
    not detected at that moment.
    """
    xy, _ = resampling.resample(view, points.time_s, clock or Clock())
    names = list(map(str, view.joints))
    at = [names.index(joint) if joint in names else -1 for joint in map(str, points.joints)]
    xy = np.where((np.array(at) >= 0)[:, None], xy[:, :, at], np.nan)
    return np.linalg.norm(xy - camera_models.project(camera, points.xyz), axis=-1)
