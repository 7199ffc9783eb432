"""Joints that are computed from others, by one table: neck, head centre, mid-hip and the like."""

from dataclasses import dataclass, replace

import numpy as np

from courtside.records.keypoints import missing_reason
from courtside.study.configuration import yaml_files
from courtside.study.errors import InputError, reading

SUM_TOLERANCE = 1e-9
SEE = "see config/derived_joints.yaml"
RIG = "rig"  # the skeleton of the truth of virtual sessions, as the table names it


@dataclass(frozen=True)
class Definition:
    """How a derived joint is made.

    Attributes
    ----------
    means : str
        In words.
    weights : dict of str to float
        Of the source's joints; they sum to 1.
    """

    means: str
    weights: dict


@dataclass(frozen=True)
class DerivedJoints:
    """The table of derived joints.

    Attributes
    ----------
    definitions : dict of str to Definition
    joints : dict of str to dict of str to str
        For each derived joint and skeleton the name of its definition.
    """

    definitions: dict
    joints: dict

    def definition(self, skeleton, name):
        """Return the name of the definition of a joint in a skeleton.

        Raises
        ------
        InputError
            If the table has no such joint, or the joint none for this skeleton.
        """
        known = self.joints.get(name, {})
        if skeleton not in known:
            raise InputError(
                f"derived joint {name!r}: expected a definition for skeleton {skeleton!r}, found those for "
                f"{sorted(known)}; add it to config/derived_joints.yaml"
            )
        return known[skeleton]

    def comparable(self, skeleton_a, skeleton_b, name):
        """Say whether a joint has one definition in both skeletons; otherwise a comparison needs a mark."""
        return self.definition(skeleton_a, name) == self.definition(skeleton_b, name)

    def weights(self, skeleton, name, joints):
        """Return the weights of `joints` that make a derived joint or a plain one, (J,) float.

        Parameters
        ----------
        skeleton : str
        name : str
            A derived joint, or one of `joints` itself where the table has none of that name.
        joints : sequence of str, length J

        Raises
        ------
        InputError
            As for `definition`, or if a part is not among `joints`.
        """
        joints = list(joints)
        if name not in self.joints and name in joints:
            return np.array([float(joint == name) for joint in joints])
        parts = self.definitions[self.definition(skeleton, name)].weights
        missing = [part for part in parts if part not in joints]
        if missing:
            raise InputError(
                f"derived joint {name!r}: expected the joints {sorted(parts)} in skeleton {skeleton!r}, "
                f"missing: {missing}; correct config/derived_joints.yaml"
            )
        return np.array([parts.get(joint, 0.0) for joint in joints])


def read(path):
    """Read a table of derived joints.

    Parameters
    ----------
    path : str or Path
        YAML with `definitions` and `joints`.

    Returns
    -------
    table : DerivedJoints

    Raises
    ------
    InputError
        If a key is missing, weights do not sum to 1, or a joint names a definition that is not there.
    """
    content = yaml_files.read(path)
    what = (
        "`definitions` with `means` and `weights`, and `joints` with a definition for each skeleton"
    )
    with reading(path, what, SEE):
        definitions = {
            name: Definition(
                str(value["means"]), {joint: float(w) for joint, w in value["weights"].items()}
            )
            for name, value in content["definitions"].items()
        }
        joints = {name: dict(value) for name, value in content["joints"].items()}
        _check(path, definitions, joints)
    return DerivedJoints(definitions, joints)


def _check(path, definitions, joints):
    for name, definition in definitions.items():
        total = sum(definition.weights.values())
        if not abs(total - 1.0) < SUM_TOLERANCE:
            raise InputError(
                f"{path}: definitions.{name}: expected weights that sum to 1, found {total:g}; correct them"
            )
    for name, by_skeleton in joints.items():
        for skeleton, used in by_skeleton.items():
            if used not in definitions:
                raise InputError(
                    f"{path}: joints.{name}.{skeleton}: expected one of {sorted(definitions)}, "
                    f"found {used!r}; correct the name"
                )


def combine(xyz, covariance, reason, weights):
    """Return a weighted sum of joints, with its covariance and reason.

    Parameters
    ----------
    xyz : (..., J, 3) float
        Metres.
    covariance : (..., J, 3, 3) float
        Square metres; the errors of the joints are taken to be independent of one another.
    reason : (..., J) uint8
        `courtside.records.keypoints.missing_reason`.
    weights : (J,) float

    Returns
    -------
    xyz, covariance, reason : (..., 3) float, (..., 3, 3) float, (...,) uint8
        NaN where a joint with a weight is missing. The reason is the first of these joints' reasons that is
        not OK, a missing joint's before that of an interpolated one.
    """
    used = np.flatnonzero(weights)
    kept = np.asarray(weights)[used]
    total = np.einsum("j,...jk->...k", kept, xyz[..., used, :])
    spread = np.einsum("j,...jkl->...kl", kept**2, covariance[..., used, :, :])
    codes = reason[..., used]
    missing = (codes != missing_reason.OK) & (codes != missing_reason.INTERPOLATED)
    first = np.argmax(np.where(missing, 2, codes != missing_reason.OK), axis=-1)
    return total, spread, np.take_along_axis(codes, first[..., None], axis=-1)[..., 0]


def of(points, table, skeleton, name):
    """Return one derived joint of all persons and frames.

    Parameters
    ----------
    points : Keypoints3D
    table : DerivedJoints
    skeleton : str
        Name of the skeleton of `points`.
    name : str

    Returns
    -------
    xyz, covariance_2d, covariance_camera, reason
        Arrays (P, T, 3), (P, T, 3, 3), (P, T, 3, 3), (P, T); see `combine`. The calibration's error is
        nearly the same for neighbouring joints, so that it does not average out: its covariance is the
        mean of the parts' weighted by size, which is never too small for weights that are not negative.
    """
    weights = table.weights(skeleton, name, points.joints)
    xyz, covariance, reason = combine(points.xyz, points.covariance_2d, points.reason, weights)
    used = np.flatnonzero(weights)
    camera = np.einsum("j,ptjkl->ptkl", np.abs(weights[used]), points.covariance_camera[:, :, used])
    return xyz, covariance, camera, reason


def append(points, table, skeleton, names):
    """Return a record with derived joints behind its own.

    Parameters
    ----------
    points : Keypoints3D
    table : DerivedJoints
    skeleton : str
    names : sequence of str
        Names that the record already has are left as they are.

    Returns
    -------
    longer : Keypoints3D
        A derived joint rests on the fewest views of its parts, on a camera where all parts do, and has the
        mean of their reprojection errors.
    """
    for name in names:
        if name not in points.joints:
            points = _append_one(points, table, skeleton, name)
    return points


def _append_one(points, table, skeleton, name):
    used = np.flatnonzero(table.weights(skeleton, name, points.joints))
    xyz, covariance, camera, reason = of(points, table, skeleton, name)
    made = {
        "xyz": xyz,
        "covariance_2d": covariance,
        "covariance_camera": camera,
        "reason": reason,
        "n_views": points.n_views[:, :, used].min(axis=2),
        "accepted": points.accepted[:, :, used].all(axis=2),
        "reproj_error_px": points.reproj_error_px[:, :, used].mean(axis=2),
    }
    longer = {
        key: np.concatenate([getattr(points, key), value[:, :, None]], axis=2)
        for key, value in made.items()
    }
    return replace(points, joints=np.append(points.joints, name), **longer)
