"""Path, distance, speed and acceleration of points of the body, each with its uncertainty."""

from dataclasses import dataclass

import numpy as np

from courtside.kinematics import (
    centre_of_mass,
    filtering,
    joint_angles,
    noise_propagation,
    path_length,
)
from courtside.records.keypoints import derived_joints
from courtside.records.keypoints import skeleton as limbs

CENTRE = (
    "head_centre",
    "neck",
    *limbs.JOINTS,
)  # the 14 joints whose plain mean is the skeleton's centre
# ASSUME: joints err along their way where they move, and less at rest than their covariance says, so that
# noise lengthens paths less than a steady one would: on the eight development takes by 0.72 of it for the
# neck and both centres of the body (24 values, standard deviation 0.43).
MODEL_BIAS = 0.7, 0.4


@dataclass(frozen=True, eq=False)
class Filter:
    """How a take is filtered.

    Attributes
    ----------
    cutoff_hz : (J,) float
        -3 dB frequency of the whole zero-lag filter for each joint.
    order : int
        Its effective order.
    distance_cutoff_hz : float
        For distances, of all points (`path_length.measure`).
    noise : courtside.kinematics.noise_propagation.Noise or None
        Of the keypoints; found from each path where None.
    """

    cutoff_hz: np.ndarray
    order: int = 4
    distance_cutoff_hz: float = 6.0
    noise: noise_propagation.Noise | None = None


@dataclass(frozen=True, eq=False)
class Point:
    """A weighted mean of joints of one person over time, filtered.

    Attributes
    ----------
    definition : str
        How it is made; the same words where it can be compared.
    position, velocity, acceleration : (T, 3) float
        Metres and seconds, world.
    covariance : tuple of three (T, 3, 3) float
        Of these three, from the keypoints' noise.
    camera_sigma_m : (T,) float
        Standard deviation of the position from the calibration, root of the sum over the axes: one error for
        all frames, which changes slowly over the hall and so hardly touches speeds.
    noise : courtside.kinematics.noise_propagation.Noise
    reason : (T,) uint8
        `courtside.records.keypoints.missing_reason`.
    distance, ground_distance : Distance
        In space, and of the path's projection on the floor.
    """

    definition: str
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    covariance: tuple
    camera_sigma_m: np.ndarray
    noise: noise_propagation.Noise
    reason: np.ndarray
    distance: path_length.Distance
    ground_distance: path_length.Distance


@dataclass(frozen=True, eq=False)
class Person:
    """What was measured of one person.

    Attributes
    ----------
    person : str
    time_s : (T,) float
    points : dict of str to Point
        `neck`, `centre` (plain mean of `CENTRE`), `mass` (`courtside.kinematics.centre_of_mass`).
    angles : dict of str to Angle
        `courtside.kinematics.joint_angles.measure`.
    """

    person: str
    time_s: np.ndarray
    points: dict
    angles: dict


@dataclass(frozen=True, eq=False)
class _Take:
    """One person's raw and filtered joints, and how they are filtered."""

    raw: object
    filtered: np.ndarray
    person: int
    how: object


def size(vectors, covariance, axes=path_length.SPACE):
    """Return the lengths of vectors and their standard deviations.

    Parameters
    ----------
    vectors : (T, 3) float
    covariance : (T, 3, 3) float
    axes : slice
        `path_length.SPACE` or `path_length.GROUND`.

    Returns
    -------
    length, sigma : (T,) float, (T,) float
        Sigma is that along the vector. A length below two sigma says little: noise makes it longer, so that
        a point at rest has the speed of its noise.
    """
    vectors, covariance = vectors[:, axes], covariance[:, axes, axes]
    length = np.linalg.norm(vectors, axis=1)
    unit = vectors / np.where(length > 0, length, 1.0)[:, None]
    return length, np.sqrt(np.einsum("ti,tij,tj->t", unit, covariance, unit))


def definitions(table, skeleton, joints, sex):
    """Return weights and definition of the measured points.

    Parameters
    ----------
    table : courtside.records.keypoints.derived_joints.DerivedJoints
    skeleton : str
        Name of the joints' skeleton.
    joints : sequence of str, length J
    sex : {"m", "f"} or None

    Returns
    -------
    weights, words : dict of str to (J,) float, dict of str to str
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


def measure(points, table, skeleton, how, sex_of=None):
    """Measure all persons of a take.

    Parameters
    ----------
    points : Keypoints3D
        Raw, short gaps filled (`filtering.fill_gaps`), not filtered.
    table : courtside.records.keypoints.derived_joints.DerivedJoints
    skeleton : str
        Name of the skeleton of `points`.
    how : Filter
    sex_of : dict of str to {"m", "f", None}, optional
        By person.

    Returns
    -------
    people : list of Person

    Notes
    -----
    All joints are filtered first; points are means of filtered joints, speeds and accelerations the
    derivatives of their cubic splines. Joints' errors are taken to be independent of one another; what the
    filter takes from the motion is in no uncertainty.
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


def _point(take, weights, words):
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


def _noise(xyz, covariance, take):
    if take.how.noise is not None:
        return take.how.noise
    return noise_propagation.estimate(xyz, covariance, take.raw.rate_hz)


def _spread(take, weights, noise, derivative):
    """Return the covariance of a filtered mean of joints, or of a derivative."""
    total = 0.0
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


def _angles(take):
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
