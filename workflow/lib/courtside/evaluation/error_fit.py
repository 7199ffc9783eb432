"""What joint offsets and errors are fitted on: development players, by the true cameras.

An error of the cameras moves all joints of a session: fitted by clicked cameras, it would be taken
for the network's, and be carried into every other hall. Errors are fitted with fewer cameras, too,
and on filtered joints: they are those that a filter does not remove.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.evaluation import joints
from courtside.evaluation.joints import Truth
from courtside.geometry.camera import Camera
from courtside.kinematics import cutoffs, skeleton_filter
from courtside.reconstruction import error_signs, fusion, joint_correction, joint_errors
from courtside.reconstruction.joint_correction import Clip
from courtside.records.cameras import footage
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton
from courtside.records.truth import session_truth, take_truth
from courtside.records.truth.take_truth import TakeTruth
from courtside.study.execution import log

# ASSUME: weight of a joint by the number of cameras of its set: all sets of four cameras of one
# size together count about as much as the one of four.
WEIGHT = {2: 0.25, 3: 0.4}
# Neighbouring frames have nearly the same error. With all of them, takes of many frames per second
# would count more than others.
MOST_HZ = 10.0


def footage_with_truth(
    takes: Iterable[Mapping[str, Any]],
) -> Iterator[tuple[list[Footage], Mapping[str, str | None], TakeTruth]]:
    """Yield, for each take, its footage with the true cameras, its persons' sexes, and its truth.

    Each of the `takes` names its files: `cameras` (the calibration that people were found with),
    `session_truth`, `pose2d`, `people`, `sync` and `truth`; and `sex_of` its persons.
    """
    for take in takes:
        true = {one.name: one for one in session_truth.read(take["session_truth"]).cameras}
        seen = footage.read(take["cameras"], take["pose2d"], take["people"], take["sync"])
        own = [replace(one, camera=true[one.camera.name]) for one in seen]
        yield own, take["sex_of"], take_truth.read(take["truth"])


def sets_of_cameras(seen: Sequence[Footage]) -> Iterator[tuple[Footage, ...]]:
    """Yield all sets of two or more cameras of a take, small ones first."""
    for count in range(2, len(seen) + 1):
        yield from combinations(seen, count)


def thin(points: Keypoints3D) -> slice:
    """Return which frames of a take are used for a fit: at most `MOST_HZ` in a second."""
    return slice(None, None, max(1, round(points.rate_hz / MOST_HZ)))


def clips(
    raw: Keypoints3D, seen: Sequence[Footage], sex_of: Mapping[str, str | None], truth: Truth
) -> list[Clip]:
    """Return what `joint_correction.estimate` needs of a take, for each of its persons."""
    points, cameras = raw.frames(thin(raw)), [one.camera for one in seen]
    each = zip(points.xyz, joints.true_places(points, truth), points.accepted, strict=True)
    return [
        Clip(xyz, true, sex, cameras, accepted)
        for (xyz, true, accepted), sex in zip(each, sex_of.values(), strict=True)
    ]


def triangulated(
    seen: Sequence[Footage], skeleton: Skeleton, people: Sequence[str], options: Mapping[str, Any]
) -> Keypoints3D:
    """Return the raw skeletons of a take; `options` are those of the triangulation."""
    cameras, views = [one.camera for one in seen], [one.view for one in seen]
    clocks = [one.clock for one in seen]
    return fusion.triangulate_take(cameras, views, skeleton, people, clocks=clocks, **options)


def joints_of_sets(
    seen: Sequence[Footage],
    skeleton: Skeleton,
    sex_of: Mapping[str, str | None],
    table: pd.DataFrame | None,
    truth: Truth,
    options: Mapping[str, Any],
    filtering: Mapping[str, Any],
) -> list[tuple[NDArray, NDArray, NDArray, NDArray]]:
    """Return `joints_of` each set of cameras of a take.

    The log says once what is true of all sets, such as a cut-off too high for the frame rate.
    """
    given = skeleton, sex_of, table, truth, options, filtering
    with log.told_once():
        return [joints_of(used, *given) for used in sets_of_cameras(seen)]


def joints_of(
    seen: Sequence[Footage],
    skeleton: Skeleton,
    sex_of: Mapping[str, str | None],
    table: pd.DataFrame | None,
    truth: Truth,
    options: Mapping[str, Any],
    filtering: Mapping[str, Any],
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return what `joint_errors.fit` needs of one take and set of cameras.

    Columns (N, K), errors of filtered joints less the network's offset (N, 3) m, covariance
    (N, 3, 3) m2 of their noise and weights (N,) of the limbs' joints that are placed and true.
    `table` holds the offsets; None, where a network has none, leaves them in the errors. `options`
    are those of the triangulation, `filtering` those of `filter_motion`.
    """
    raw = triangulated(seen, skeleton, list(sex_of), options)
    views, clocks = [one.view for one in seen], [one.clock for one in seen]
    xy, score = error_signs.keypoints_used(views, clocks, raw, skeleton)
    cameras = [one.camera for one in seen]
    signs = error_signs.of_points(cameras, raw, xy, score, skeleton)
    placed = _filtered(raw, skeleton, filtering, table, sex_of, cameras)
    names, error, _ = joints.errors(placed, truth.joints.tolist(), joints.true_places(raw, truth))
    error = error[:, :, [names.index(joint) for joint in limbs.JOINTS]]
    at = [raw.joints.tolist().index(joint) for joint in limbs.JOINTS]
    covariance = placed.covariance_2d[:, :, at]
    columns = joint_errors.design(signs, raw.joints.tolist())
    used = np.zeros(error.shape[:-1], dtype=bool)
    used[:, thin(raw)] = True
    used &= np.isfinite(raw.xyz[:, :, at]).all(axis=-1)  # filled gaps have no signs
    known = used & np.isfinite(error).all(axis=-1) & np.isfinite(covariance).all(axis=(-2, -1))
    weight = np.full(int(known.sum()), WEIGHT.get(len(seen), 1.0))
    return columns[known], error[known], covariance[known], weight


def _filtered(
    raw: Keypoints3D,
    skeleton: Skeleton,
    step: Mapping[str, Any],
    table: pd.DataFrame | None,
    sex_of: Mapping[str, str | None],
    cameras: Sequence[Camera],
) -> Keypoints3D:
    """Return the skeletons of a take, less the offsets of a table, filtered as the study does."""
    points = skeleton_filter.prepare(raw, step["max_gap_s"])
    whose = f"development take of {', '.join(sex_of)}"
    chosen = cutoffs.by_group(points, skeleton, step["cutoff_hz"], step["order"], path=whose)
    cutoff_hz = skeleton.by_group({group: choice.cutoff_hz for group, choice in chosen.items()})
    if table is not None:
        offset = joint_correction.offsets(points, table, sex_of, cameras)
        points = replace(points, xyz=points.xyz - offset)
    return skeleton_filter.smooth(points, cutoff_hz, step["order"])
