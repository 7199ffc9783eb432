"""Joints computed from others by one table: neck, head centre, mid-hip and the like."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.configuration import schemas
from courtside.study.errors import InputError, StrPath

SUM_TOLERANCE = 1e-9  # far above the rounding of a sum of decimal fractions
RIG = "rig"  # name in the table of the skeleton of virtual sessions' truth


@dataclass(frozen=True)
class DerivedJoints:
    """The table of derived joints."""

    # For each definition the weights of the joints that it is made of; they sum to 1
    definitions: dict[str, dict[str, float]]
    # For each derived joint and skeleton the name of its definition
    joints: dict[str, dict[str, str]]

    def definition(self, skeleton: str, name: str) -> str:
        """Return the name of the definition of a joint in a skeleton; `InputError` if none."""
        known = self.joints.get(name, {})
        if skeleton not in known:
            raise InputError(
                f"derived joint {name!r}: expected a definition for skeleton {skeleton!r}, found "
                f"those for {sorted(known)}; add it to config/derived_joints.yaml"
            )
        return known[skeleton]

    def comparable(self, skeleton_a: str, skeleton_b: str, name: str) -> bool:
        """Return whether both skeletons define a joint alike; otherwise mark the comparison."""
        return self.definition(skeleton_a, name) == self.definition(skeleton_b, name)

    def weights(self, skeleton: str, name: str, joints: Iterable[str]) -> NDArray:
        """Return the weights of `joints` that make a derived joint or a plain one, (J,) float.

        `name` is a derived joint, or one of `joints` itself if the table has none of that name. An
        `InputError` as for `definition`, or if a part is not among `joints`.
        """
        joints = list(joints)
        if name not in self.joints and name in joints:
            return np.array([float(joint == name) for joint in joints])
        parts = self.definitions[self.definition(skeleton, name)]
        missing = [part for part in parts if part not in joints]
        if missing:
            raise InputError(
                f"derived joint {name!r}: expected the joints {sorted(parts)} in skeleton "
                f"{skeleton!r}, missing: {missing}; correct config/derived_joints.yaml"
            )
        return np.array([parts.get(joint, 0.0) for joint in joints])


def read(path: StrPath) -> DerivedJoints:
    """Read a table of derived joints: YAML with `definitions` and `joints`.

    An `InputError` for what its schema refuses, weights not of sum 1, or an unknown definition.
    """
    content = schemas.read(path, "derived_joints")
    definitions = {
        name: {joint: float(weight) for joint, weight in one["weights"].items()}
        for name, one in content["definitions"].items()
    }
    table = DerivedJoints(definitions, content["joints"])
    for name, weights in table.definitions.items():
        total = sum(weights.values())
        if abs(total - 1.0) > SUM_TOLERANCE:
            raise InputError(
                f"{path}: definitions.{name}: expected weights that sum to 1, found {total:g}; "
                "correct them"
            )
    for name, by_skeleton in table.joints.items():
        for skeleton, used in by_skeleton.items():
            if used not in table.definitions:
                raise InputError(
                    f"{path}: joints.{name}.{skeleton}: expected one of "
                    f"{sorted(table.definitions)}, found {used!r}; correct the name"
                )
    return table


def combine(
    xyz: NDArray, covariance: NDArray, reason: NDArray, weights: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    """Return a weighted sum of joints, with its covariance and reason.

    Joints have `xyz` (..., J, 3) m, `covariance` (..., J, 3, 3) m2, `reason` (..., J), codes of
    `missing_reason`, and `weights` (J,); their errors are taken as independent. The result, without
    the axis J, is NaN where a joint with a weight is missing. Its reason is the first of these
    joints' reasons that is not OK, a missing joint's before that of an interpolated one.
    """
    used = np.flatnonzero(weights)
    kept = np.asarray(weights)[used]
    total = np.einsum("j,...jk->...k", kept, xyz[..., used, :])
    spread = np.einsum("j,...jkl->...kl", kept**2, covariance[..., used, :, :])
    codes = reason[..., used]
    missing = (codes != missing_reason.OK) & (codes != missing_reason.INTERPOLATED)
    first = np.argmax(np.where(missing, 2, codes != missing_reason.OK), axis=-1)
    return total, spread, np.take_along_axis(codes, first[..., None], axis=-1)[..., 0]


def of(
    points: Keypoints3D, table: DerivedJoints, skeleton: str, name: str
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Return one derived joint of all persons and frames; `points` are of `skeleton`.

    xyz, covariance_2d, covariance_camera and reason: (P, T, 3), (P, T, 3, 3), (P, T, 3, 3), (P, T);
    see `combine`. The calibration's error is nearly the same for neighbouring joints and does not
    average out: its covariance is the weighted mean of the parts', which is never too small for
    weights that are not negative.
    """
    weights = table.weights(skeleton, name, points.joints)
    xyz, covariance, reason = combine(points.xyz, points.covariance_2d, points.reason, weights)
    used = np.flatnonzero(weights)
    camera = np.einsum("j,ptjkl->ptkl", np.abs(weights[used]), points.covariance_camera[:, :, used])
    return xyz, covariance, camera, reason


def append(
    points: Keypoints3D, table: DerivedJoints, skeleton: str, names: Iterable[str]
) -> Keypoints3D:
    """Return a record with derived joints behind its own; names that it already has are left.

    A derived joint has the fewest views of its parts, is accepted in a camera where all parts are,
    swapped where one is, and has the mean of their reprojection errors. It is an outlier as
    probably as the most probable of its parts.
    """
    for name in names:
        if name not in points.joints:
            points = _append_one(points, table, skeleton, name)
    return points


def _append_one(points: Keypoints3D, table: DerivedJoints, skeleton: str, name: str) -> Keypoints3D:
    every = table.weights(skeleton, name, points.joints)
    used = np.flatnonzero(every)
    weights = np.abs(every[used])
    xyz, covariance, camera, reason = of(points, table, skeleton, name)
    made = {
        "xyz": xyz,
        "covariance_2d": covariance,
        "covariance_camera": camera,
        # Errors of a network are one side's and one joint's: as for cameras, a mean that is not too
        # small.
        "covariance_network": np.einsum(
            "j,ptjkl->ptkl", weights, points.covariance_network[:, :, used]
        ),
        "offset": np.einsum("j,ptjk->ptk", every[used], points.offset[:, :, used]),
        "outlier": points.outlier[:, :, used].max(axis=2),
        "reason": reason,
        "n_views": points.n_views[:, :, used].min(axis=2),
        "accepted": points.accepted[:, :, used].all(axis=2),
        "swapped": points.swapped[:, :, used].any(axis=2),
        "reproj_error_px": points.reproj_error_px[:, :, used].mean(axis=2),
    }
    longer: dict[str, Any] = {
        key: np.concatenate([getattr(points, key), value[:, :, None]], axis=2)
        for key, value in made.items()
    }
    return replace(points, joints=np.append(points.joints, name), **longer)
