"""Path, distance, speed and acceleration of points of the body, each with its uncertainty."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.kinematics import (
    centre_of_mass,
    joint_angles,
    noise_propagation,
    path_length,
    shared_errors,
)
from courtside.kinematics.joint_angles import Angle
from courtside.kinematics.noise_propagation import Noise
from courtside.kinematics.path_length import Distance, Others
from courtside.kinematics.shared_errors import Field
from courtside.records.keypoints import derived_joints, keypoints
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.records.keypoints.keypoints import Keypoints3D

# The 14 joints whose plain mean is the skeleton's centre.
CENTRE = ("head_centre", "neck", *limbs.JOINTS)
# ASSUME: moving joints err along their path, joints at rest err less than their covariance says,
# and limbs of constant length take noise away: noise lengthens paths less than steady noise would.
# With offsets fitted without the body and the cameras of known18, the corrected joints of
# players-dev did by 0.38 of that in space and 0.33 on the floor (neck and both centres of the body
# in eight takes: 24 values each, standard deviations 0.49 and 0.51), in all 34 development takes by
# 0.18 and 0.07 (102 values each, 0.49 and 0.62). Before the correction it was 0.7 in the eight
# takes, 0.32 and 0.24 in the 34. The values are not independent: bodies and movements recur.
MODEL_BIAS = 0.35, 0.5


@dataclass(frozen=True, eq=False)
class Filter:
    """How a take was filtered."""

    cutoff_hz: NDArray  # (J,): -3 dB frequency of the whole zero-lag filter for each joint
    order: int = 4  # its effective order


@dataclass(frozen=True, eq=False)
class Point:
    """A weighted mean of joints of one person over time, filtered."""

    definition: str  # how it is made; points with the same text are comparable
    # position, velocity, acceleration: (T, 3), metres and seconds, world.
    position: NDArray
    velocity: NDArray
    acceleration: NDArray
    # Of these three, (T, 3, 3), from keypoints and network; NaN in filled gaps.
    covariance: tuple[NDArray, ...]
    # Of the same, from the cameras; 0 where nothing is known of them.
    camera_covariance: tuple[NDArray, ...]
    noise: Noise
    reason: NDArray  # (T,): `courtside.records.keypoints.missing_reason`
    # distance, ground_distance: in space, and of the path's projection on the floor.
    distance: Distance
    ground_distance: Distance


@dataclass(frozen=True, eq=False)
class Person:
    """Measures of one person."""

    person: str
    time_s: NDArray
    # `neck`, `centre` (plain mean of `CENTRE`), `mass` (`courtside.kinematics.centre_of_mass`).
    points: dict[str, Point]
    angles: dict[str, Angle]  # `courtside.kinematics.joint_angles.measure`


@dataclass(frozen=True, eq=False)
class _Take:
    """One person's joints before and after the filter, and the filter."""

    skeletons: Keypoints3D
    raw: Keypoints3D
    person: int
    how: Filter
    field: Field | None
    recorded: bool


def size(
    vectors: NDArray, covariance: NDArray, axes: slice = path_length.SPACE
) -> tuple[NDArray, NDArray]:
    """Return the lengths (T,) of vectors (T, 3) of covariance (T, 3, 3), and their sigmas (T,).

    Sigma is that along the vector. `axes` is `path_length.SPACE` or `path_length.GROUND`. A length
    below two sigma says little: noise makes it longer, and a point at rest has the speed of its
    noise.
    """
    vectors, covariance = vectors[:, axes], covariance[:, axes, axes]
    length = np.linalg.norm(vectors, axis=1)
    unit = vectors / np.where(length > 0, length, 1.0)[:, None]
    return length, np.sqrt(np.einsum("ti,tij,tj->t", unit, covariance, unit))


def definitions(
    table: DerivedJoints, skeleton: str, joints: Sequence[str] | NDArray, sex: str | None
) -> tuple[dict[str, NDArray], dict[str, str]]:
    """Return weights (J,) and definition of each measured point of a named skeleton.

    `sex` is "m", "f" or None (`centre_of_mass.shares`).
    """
    of = {name: table.definition(skeleton, name) for name in ("neck", "head_centre", "head_mass")}
    people = {"m": "men", "f": "women", None: "mean of men and women"}[sex]
    centre = [table.weights(skeleton, name, joints) for name in CENTRE]
    weights = {
        "neck": table.weights(skeleton, "neck", joints),
        "centre": np.mean(centre, axis=0),
        "mass": centre_of_mass.weights(table, skeleton, joints, sex),
    }
    words = {
        "neck": of["neck"],
        "centre": f"mean of 12 limb joints, neck ({of['neck']}), head ({of['head_centre']})",
        "mass": f"de Leva 1996, {people}, head ({of['head_mass']})",
    }
    return weights, words


def measure(
    skeletons: Keypoints3D,
    raw: Keypoints3D,
    table: DerivedJoints,
    skeleton: str,
    how: Filter,
    sex_of: Mapping[str, str | None] | None = None,
    field: Field | None = None,
    *,
    recorded: bool = False,
) -> list[Person]:
    """Measure all persons of a take on its filtered skeletons.

    `skeletons`, of the named `skeleton`, are the exported ones, corrected or not. Their last step
    is the filter `how` (`skeleton_filter.smooth`). They were made from `raw`
    (`skeleton_filter.prepare`), whose noise determines that of the measures. `sex_of` gives "m",
    "f" or None for persons, `field` the errors of the cameras, where known. People are `recorded`,
    or virtual.

    Nothing is filtered again. Points are means of the skeletons' joints, speeds and accelerations
    the derivatives of their cubic splines, distances the integrals of the speeds. Three errors are
    stated. The noise of keypoints is that of the raw joints after the filter, independent between
    joints. The network's errors are correlated between neighbouring joints and last for some
    frames. The cameras' errors are one field in space for the whole take (`shared_errors`) and do
    not affect the speed of a point at rest. Motion that the filter removes is not part of any
    stated uncertainty.
    """
    made = []
    for at, person in enumerate(skeletons.person_id):
        sex = (sex_of or {}).get(str(person))
        weights, words = definitions(table, skeleton, skeletons.joints, sex)
        take = _Take(skeletons, raw, at, how, field, recorded)
        found = {name: _point(take, weights[name], words[name]) for name in weights}
        turns = angles(skeletons, at, field, recorded=recorded)
        made.append(Person(str(person), skeletons.time_s, found, turns))
    return made


def _point(take: _Take, weights: NDArray, words: str) -> Point:
    position, _, reason = _combined(take, take.skeletons, weights)
    noise, rate_hz, order = _noise(take, weights), take.raw.rate_hz, take.how.order
    parts, network = _parts(take, weights), _network_parts(take, weights)
    velocity = noise_propagation.differentiate(position, rate_hz)
    cameras = _camera_fields(take, position)
    spreads = [_position_covariance(take, weights)]
    known = np.isfinite(position).all(axis=1)
    for at in (1, 2):
        own, slow = (
            noise_propagation.summed_covariance(of, known, by, rate_hz, order, at)
            for of, by in ((parts, noise), (network, shared_errors.NETWORK))
        )
        spreads.append(own + np.nan_to_num(slow))
    others = Others(network, shared_errors.NETWORK, cameras[1])
    distances = [
        path_length.measure(position, parts, rate_hz, noise, order, axes, MODEL_BIAS, others)
        for axes in (path_length.SPACE, path_length.GROUND)
    ]
    return Point(
        words,
        position,
        velocity,
        noise_propagation.differentiate(velocity, rate_hz),
        tuple(spreads),
        tuple(field @ field.swapaxes(1, 2) for field in cameras),
        noise,
        reason,
        *distances,
    )


def _position_covariance(take: _Take, weights: NDArray) -> NDArray:
    """Return the covariance (T, 3, 3) of a mean of joints, without the cameras' part."""
    used = np.flatnonzero(weights)
    errors = shared_errors.of_person(take.skeletons, take.person, recorded=take.recorded)
    axes = np.eye(3)
    n_frames = len(take.skeletons.time_s)

    def variance(direction: NDArray) -> NDArray:
        slopes = [np.broadcast_to(weights[at] * direction, (n_frames, 3)) for at in used]
        return errors.variance(used.tolist(), slopes)

    along = [variance(axis) for axis in axes]
    found = np.empty((n_frames, 3, 3))
    for i, j in np.ndindex(3, 3):
        both = variance(axes[i] + axes[j]) if i != j else 4 * along[i]
        found[:, i, j] = (both - along[i] - along[j]) / 2
    return found


def _camera_fields(take: _Take, position: NDArray) -> list[NDArray]:
    """Return how the cameras' errors move a path (T, 3) and its derivatives: three (T, 3, R)."""
    if take.field is None:
        return [np.zeros((*position.shape, 0))] * 3
    found = shared_errors.over(take.field, position)
    lines = [found.reshape(len(found), -1)]
    lines += [noise_propagation.differentiate(lines[0], take.raw.rate_hz)]
    lines += [noise_propagation.differentiate(lines[1], take.raw.rate_hz)]
    return [each.reshape(found.shape) for each in lines]


def _network_parts(take: _Take, weights: NDArray) -> dict[float, NDArray]:
    """Return what the network's errors add to a mean of joints, as `_parts`, all scales at 1."""
    cutoffs_hz, used = np.asarray(take.how.cutoff_hz), weights != 0
    sigma = weights * np.sqrt(shared_errors.variances(take.raw.covariance_network[take.person]))
    alike = shared_errors.alike(take.raw.joints.tolist())
    each = sigma * (sigma @ alike)  # what errors have in common counts half for each
    return {
        float(cutoff_hz): each[:, used & (cutoffs_hz == cutoff_hz)].sum(axis=1)[:, None, None]
        * np.eye(3)
        for cutoff_hz in np.unique(cutoffs_hz[used])
    }


def _combined(
    take: _Take, points: Keypoints3D, weights: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    xyz, covariance = points.xyz[take.person], points.covariance_2d[take.person]
    return derived_joints.combine(xyz, covariance, points.reason[take.person], weights)


def _noise(take: _Take, weights: NDArray) -> Noise:
    xyz, covariance, _ = _combined(take, take.raw, weights)
    return noise_propagation.estimate(xyz, covariance, take.raw.rate_hz)


def _parts(take: _Take, weights: NDArray) -> dict[float, NDArray]:
    """Return the raw covariance (T, 3, 3) of the joints of a mean that share a cut-off, by it."""
    cutoffs_hz = np.asarray(take.how.cutoff_hz)
    raw, parts = take.raw.covariance_2d[take.person], {}
    for cutoff_hz in np.unique(cutoffs_hz[weights != 0]):
        used = np.flatnonzero((cutoffs_hz == cutoff_hz) & (weights != 0))
        parts[float(cutoff_hz)] = np.einsum("j,tjkl->tkl", weights[used] ** 2, raw[:, used])
    return parts


def angles(
    skeletons: Keypoints3D, person: int, field: Field | None = None, *, recorded: bool = False
) -> dict[str, Angle]:
    """Return the joint angles of one person, by the person's index, as `measure` states them."""
    joints, parts = skeletons.joints.tolist(), []
    for at in keypoints.blocks(len(skeletons.time_s)):
        part = skeletons.frames(at)
        errors = shared_errors.of_person(part, person, field, recorded=recorded)
        parts.append(joint_angles.measure(part.xyz[person], errors, joints))
    return {name: joint_angles.joined([part[name] for part in parts]) for name in parts[0]}
