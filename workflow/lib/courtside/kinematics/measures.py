"""Path, distance, speed and acceleration of points of the body, each with its uncertainty."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.kinematics import (
    centre_of_mass,
    filtering,
    joint_angles,
    noise_propagation,
    path_length,
)
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
    """How a take is filtered."""

    cutoff_hz: NDArray  # (J,): -3 dB frequency of the whole zero-lag filter for each joint
    order: int = 4  # its effective order
    distance_cutoff_hz: float = 6.0  # for distances, of all points (`path_length.measure`)
    noise: Noise | None = None  # of the keypoints; estimated from each path where None


@dataclass(frozen=True, eq=False)
class Point:
    """A weighted mean of joints of one person over time, filtered."""

    definition: str  # how it is made; points with the same text are comparable
    # position, velocity, acceleration: (T, 3), metres and seconds, world.
    position: NDArray
    velocity: NDArray
    acceleration: NDArray
    covariance: tuple[NDArray, ...]  # of these three, (T, 3, 3), from the keypoints' noise
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
    """One person's raw and filtered joints, and how they are filtered."""

    raw: Keypoints3D
    filtered: NDArray
    person: int
    how: Filter


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
    points: Keypoints3D,
    table: DerivedJoints,
    skeleton: str,
    how: Filter,
    sex_of: Mapping[str, str | None] | None = None,
) -> list[Person]:
    """Measure all persons of a take.

    `points` are raw, short gaps filled (`filtering.fill_gaps`), of the named skeleton. `sex_of`
    maps persons to "m", "f" or None.

    All joints are filtered first; points are means of filtered joints, speeds and accelerations the
    derivatives of their cubic splines. The joints' errors are taken to be independent; what the
    filter removes of the motion is in no uncertainty.
    """
    smooth = filtering.smooth(points, how.cutoff_hz, how.order).xyz
    made = []
    for at, person in enumerate(points.person_id):
        sex = (sex_of or {}).get(str(person))
        weights, words = definitions(table, skeleton, points.joints, sex)
        take = _Take(points, smooth[at], at, how)
        found = {name: _point(take, weights[name], words[name]) for name in weights}
        made.append(Person(str(person), points.time_s, found, _angles(take)))
    return made


def _point(take: _Take, weights: NDArray, words: str) -> Point:
    raw, how, used = take.raw, take.how, np.flatnonzero(weights)
    xyz, covariance, reason = derived_joints.combine(
        raw.xyz[take.person], raw.covariance_2d[take.person], raw.reason[take.person], weights
    )
    noise = _noise(xyz, covariance, take)
    position = np.einsum("j,tjk->tk", weights[used], take.filtered[:, used])
    velocity = noise_propagation.differentiate(position, raw.rate_hz)
    camera = np.trace(raw.covariance_camera[take.person][:, used], axis1=-2, axis2=-1)
    distances = [
        path_length.measure(
            xyz, covariance, raw.rate_hz, noise, how.distance_cutoff_hz, how.order, axes, MODEL_BIAS
        )
        for axes in (path_length.SPACE, path_length.GROUND)
    ]
    return Point(
        words,
        position,
        velocity,
        noise_propagation.differentiate(velocity, raw.rate_hz),
        tuple(_spread(take, weights, noise, derivative) for derivative in (0, 1, 2)),
        np.sqrt(camera @ np.abs(weights[used])),
        noise,
        reason,
        *distances,
    )


def _noise(xyz: NDArray, covariance: NDArray, take: _Take) -> Noise:
    if take.how.noise is not None:
        return take.how.noise
    return noise_propagation.estimate(xyz, covariance, take.raw.rate_hz)


def _spread(take: _Take, weights: NDArray, noise: Noise, derivative: int) -> NDArray:
    """Return the covariance of a filtered mean of joints, or of a derivative."""
    total = np.zeros(())
    known = np.isfinite(take.filtered[:, weights != 0]).all(axis=(1, 2))
    for cutoff_hz in np.unique(np.asarray(take.how.cutoff_hz)[weights != 0]):
        share = np.where(take.how.cutoff_hz == cutoff_hz, weights, 0.0)
        used = np.flatnonzero(share)
        raw = np.einsum(
            "j,tjkl->tkl", share[used] ** 2, take.raw.covariance_2d[take.person][:, used]
        )
        total = total + noise_propagation.filtered_covariance(
            raw, known, noise, take.raw.rate_hz, float(cutoff_hz), take.how.order, derivative
        )
    return total


def _angles(take: _Take) -> dict[str, Angle]:
    joints = [joint for joint in take.raw.joints if joint in limbs.JOINTS]
    at = [take.raw.joints.tolist().index(joint) for joint in joints]
    spreads = []
    for index in at:
        xyz, covariance = (
            getattr(take.raw, key)[take.person][:, index] for key in ("xyz", "covariance_2d")
        )
        noise = _noise(xyz, covariance, take)
        one = (np.arange(len(take.raw.joints)) == index).astype(float)
        spreads.append(_spread(take, one, noise, 0))
    return joint_angles.measure(take.filtered[:, at], np.stack(spreads, axis=1), joints)
