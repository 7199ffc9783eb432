"""Path, distance, speed and acceleration of points of the body, each with its uncertainty."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.kinematics import centre_of_mass, joint_angles, noise_propagation, path_length
from courtside.kinematics.joint_angles import Angle
from courtside.kinematics.noise_propagation import Noise
from courtside.kinematics.path_length import Distance
from courtside.records.keypoints import derived_joints
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.records.keypoints.keypoints import Keypoints3D

# The 14 joints whose plain mean is the skeleton's centre.
CENTRE = ("head_centre", "neck", *limbs.JOINTS)
# ASSUME: moving joints err along their path, and joints at rest err less than their covariance
# says: noise lengthens paths less than steady noise would. On the eight development takes it did by
# 0.72 of that for the neck and both centres of the body (24 values, standard deviation 0.43).
MODEL_BIAS = 0.7, 0.4


@dataclass(frozen=True, eq=False)
class Filter:
    """How a take was filtered."""

    cutoff_hz: NDArray  # (J,): -3 dB frequency of the whole zero-lag filter for each joint
    order: int = 4  # its effective order
    noise: Noise | None = None  # of the keypoints; estimated from each path where None


@dataclass(frozen=True, eq=False)
class Point:
    """A weighted mean of joints of one person over time, filtered."""

    definition: str  # how it is made; points with the same text are comparable
    # position, velocity, acceleration: (T, 3), metres and seconds, world.
    position: NDArray
    velocity: NDArray
    acceleration: NDArray
    # Of these three, (T, 3, 3): of the position as stated for the skeleton, NaN in filled gaps; of
    # the others from the keypoints' noise.
    covariance: tuple[NDArray, ...]
    # (T,): sigma of the position from the calibration, root of the sum over the axes: one error for
    # all frames, which changes slowly over the hall and hardly affects speeds.
    camera_sigma_m: NDArray
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
    """One person's joints, filtered and before, and how they were filtered."""

    skeletons: Keypoints3D
    raw: Keypoints3D
    person: int
    how: Filter

    def of(self, points: Keypoints3D, key: str) -> NDArray:
        """Return a value of this person's joints (T, J, ...)."""
        return getattr(points, key)[self.person]


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
) -> list[Person]:
    """Measure all persons of a take on its filtered skeletons.

    `skeletons`, of the named `skeleton`, are those that are exported, corrected or not: filtered
    last, as `how` says (`skeleton_filter.smooth`). `raw` is what they were made from
    (`skeleton_filter.prepare`): its noise is that of the measures. `sex_of` gives "m", "f" or None
    for persons.

    Nothing is filtered again. Points are means of the skeletons' joints, speeds and accelerations
    the derivatives of their cubic splines, distances the integrals of the speeds. Uncertainties of
    positions and angles are those stated for the skeletons; those of derivatives come from the raw
    noise that passes the filter. The joints' errors are taken to be independent. In no uncertainty
    of a derivative: what the filter removes of the motion, and how the error of a corrected joint
    changes with the posture.
    """
    made = []
    for at, person in enumerate(skeletons.person_id):
        sex = (sex_of or {}).get(str(person))
        weights, words = definitions(table, skeleton, skeletons.joints, sex)
        take = _Take(skeletons, raw, at, how)
        found = {name: _point(take, weights[name], words[name]) for name in weights}
        made.append(Person(str(person), skeletons.time_s, found, angles(skeletons, at)))
    return made


def _point(take: _Take, weights: NDArray, words: str) -> Point:
    position, covariance, reason = _combined(take, take.skeletons, weights)
    noise, rate_hz, used = _noise(take, weights), take.raw.rate_hz, np.flatnonzero(weights)
    parts = _parts(take, weights)
    known = np.isfinite(position).all(axis=1)
    velocity = noise_propagation.differentiate(position, rate_hz)
    camera = np.trace(take.of(take.skeletons, "covariance_camera")[:, used], axis1=-2, axis2=-1)
    spreads = [
        noise_propagation.summed_covariance(parts, known, noise, rate_hz, take.how.order, at)
        for at in (1, 2)
    ]
    distances = [
        path_length.measure(position, parts, rate_hz, noise, take.how.order, axes, MODEL_BIAS)
        for axes in (path_length.SPACE, path_length.GROUND)
    ]
    return Point(
        words,
        position,
        velocity,
        noise_propagation.differentiate(velocity, rate_hz),
        (covariance, *spreads),
        np.sqrt(camera @ np.abs(weights[used])),
        noise,
        reason,
        *distances,
    )


def _combined(
    take: _Take, points: Keypoints3D, weights: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    xyz, covariance, reason = (take.of(points, key) for key in ("xyz", "covariance_2d", "reason"))
    return derived_joints.combine(xyz, covariance, reason, weights)


def _noise(take: _Take, weights: NDArray) -> Noise:
    if take.how.noise is not None:
        return take.how.noise
    xyz, covariance, _ = _combined(take, take.raw, weights)
    return noise_propagation.estimate(xyz, covariance, take.raw.rate_hz)


def _parts(take: _Take, weights: NDArray) -> dict[float, NDArray]:
    """Return the raw covariance (T, 3, 3) of the joints of a mean that share a cut-off, by it."""
    cutoffs_hz = np.asarray(take.how.cutoff_hz)
    raw, parts = take.of(take.raw, "covariance_2d"), {}
    for cutoff_hz in np.unique(cutoffs_hz[weights != 0]):
        used = np.flatnonzero((cutoffs_hz == cutoff_hz) & (weights != 0))
        parts[float(cutoff_hz)] = np.einsum("j,tjkl->tkl", weights[used] ** 2, raw[:, used])
    return parts


def angles(skeletons: Keypoints3D, person: int) -> dict[str, Angle]:
    """Return the joint angles of one person, by the person's index, as `measure` states them."""
    joints = [joint for joint in skeletons.joints if joint in limbs.JOINTS]
    at = [skeletons.joints.tolist().index(joint) for joint in joints]
    xyz, covariance = (getattr(skeletons, key)[person][:, at] for key in ("xyz", "covariance_2d"))
    return joint_angles.measure(xyz, covariance, joints)
