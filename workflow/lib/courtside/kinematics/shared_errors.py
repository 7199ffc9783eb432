"""Errors that joints share with one another and from frame to frame.

The noise of keypoints is independent between joints. Three other errors are not: the network's
errors, which are correlated between neighbouring joints of a limb and last for some frames; the
network's known offset, if it was not subtracted; and the errors of the cameras, one smooth field
for all joints and frames of a take.

.. [Kanko2021] Kanko et al. (2021), Concurrent assessment of gait kinematics using marker-based and
   markerless motion capture, Journal of Biomechanics 127, 110665.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from courtside.kinematics.noise_propagation import Noise
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D

# Of the network's errors on the bodies of `players-dev`, each left out of the fit of its errors
# (docs/measured/movement.md). These bodies share seeds: the one left out performs the movement of
# those fitted on, so that errors in other movements may be larger. Share of the stated variance
# that counts in a measure: the stated one is wide for the sake of a few large errors, and a tenth
# of it is what 90 % intervals of speeds and angles need. Correlation of neighbouring joints of an
# arm or a leg: 0.2 to 0.6. Time in which an error falls to 1/e of itself: 0.15 to 0.25 s, by lags
# up to 0.3 s.
NETWORK_SHARE = 0.1
NEIGHBOURS = 0.4
NETWORK = Noise(0.2, scale=NETWORK_SHARE)
# Standard deviation per axis of a recorded person's joints: the root mean square distance between
# the joint centres of a markerless and a marker-based system [Kanko2021]_, 30 people who walk: 36
# mm at the hip, less than 25 mm elsewhere. ASSUME: it is the same in other movements.
RECORDED_M = {joint: (0.036 if joint == "hip" else 0.025) / np.sqrt(3) for joint in skeleton.LIMBS}
# Places (N, 3) m -> how far (N, 3, R) m each of R independent causes, of standard deviation 1,
# moves points there: the errors of cameras.
Field = Callable[[NDArray], NDArray]


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of J joints of one person over T frames."""

    covariance: NDArray  # (T, J, 3, 3) m2, each joint's own; NaN where unknown
    network: NDArray  # (T, J) m2: the network's variance per axis
    alike: NDArray  # (J, J): correlation of the network's errors
    # By joint (T, 3, R) m: of R causes that all joints share, of standard deviation 1. Joints other
    # than those of limbs, most of them, have one NaN in memory.
    shared: Sequence[NDArray]

    def variance(self, joints: Sequence[int], slopes: Sequence[NDArray]) -> NDArray:
        """Return the variance (T,) of a value by its slopes (T, 3) per metre of some joints."""
        pairs = list(zip(joints, slopes, strict=True))
        own = sum(np.einsum("ti,tij,tj->t", s, self.covariance[:, at], s) for at, s in pairs)
        cause = sum(np.einsum("ti,tir->tr", s, self.shared[at]) for at, s in pairs)
        total = own + np.sum(np.square(cause), axis=-1)
        sigma = np.sqrt(self.network)
        for (one, first), (other, second) in product(pairs, pairs):
            along = np.sum(first * second, axis=-1) * self.alike[one, other]
            total = total + along * sigma[:, one] * sigma[:, other]
        return np.asarray(total)


def independent(covariance: NDArray) -> Errors:
    """Return errors that are independent between joints; `covariance` is (T, J, 3, 3) m2."""
    n_frames, n_joints = covariance.shape[:2]
    nothing = np.zeros((n_frames, n_joints))
    return Errors(covariance, nothing, np.eye(n_joints), [np.zeros((n_frames, 3, 0))] * n_joints)


def with_frame(field: Field, frame: NDArray) -> Field:
    """Return a field of errors with those of the world frame, `CameraCovariance.frame`, as well."""
    extent, axes = np.linalg.eigh(frame)
    causes = axes * np.sqrt(np.maximum(extent, 0.0))

    def at(xyz: NDArray) -> NDArray:
        lifted = np.broadcast_to([0.0, 0.0, 1.0], xyz.shape)
        motions = np.stack([np.cross([1, 0, 0], xyz), np.cross([0, 1, 0], xyz), lifted], axis=-1)
        return np.concatenate([field(xyz), motions @ causes], axis=-1)

    return at if frame.any() else field


def of_person(
    points: Keypoints3D, person: int, field: Field | None = None, *, recorded: bool = False
) -> Errors:
    """Return the stated errors of one person of a record, by the person's index.

    Those of cameras are of limb joints alone, NaN elsewhere. Of the network's variance a share
    counts, and in full what is constant (`constant`) where people are `recorded`, not virtual.
    """
    network, known = variances(points.covariance_network[person]), points.joints.tolist()
    steady = constant(network, known) if recorded else 0.0
    network = steady + NETWORK_SHARE * (network - steady)
    shared = list(np.nan_to_num(points.offset[person]).swapaxes(0, 1)[..., None])
    if field is not None:
        for at, joint in enumerate(known):
            shared[at] = _with_cameras(shared[at], joint, points.xyz[person, :, at], field)
    found = independent(points.covariance_2d[person])
    return replace(found, network=network, alike=alike(known), shared=shared)


def _with_cameras(shared: NDArray, joint: str, xyz: NDArray, field: Field) -> NDArray:
    """Return causes (T, 3, R) of one joint, at places (T, 3), with those of the cameras."""
    if joint not in skeleton.JOINTS:
        return np.broadcast_to(np.nan, (len(xyz), 3, 1))
    return np.concatenate([shared, over(field, xyz)], axis=-1)


def variances(covariance: NDArray) -> NDArray:
    """Return the mean variance per axis of covariances (..., 3, 3), 0 where unknown."""
    return np.nan_to_num(np.trace(covariance, axis1=-2, axis2=-1) / 3)


def constant(network: NDArray, joints: Sequence[str]) -> NDArray:
    """Return what of recorded people's variances (..., J) m2 is the square of `RECORDED_M`.

    It has no share of large errors: it is the same in every frame.
    """
    most = [RECORDED_M.get(skeleton.without_side(joint), 0.0) ** 2 for joint in joints]
    return np.minimum(network, most)


def alike(joints: Sequence[str]) -> NDArray:
    """Return the correlation (J, J) of the network's errors of named joints."""
    found, places = np.eye(len(joints)), {joint: at for at, joint in enumerate(joints)}
    for side, chain in product(("left", "right"), skeleton.CHAINS):
        for first, second in pairwise(f"{side}_{joint}" for joint in chain):
            if first in places and second in places:
                found[places[first], places[second]] = NEIGHBOURS
                found[places[second], places[first]] = NEIGHBOURS
    return found


def over(field: Field, xyz: NDArray) -> NDArray:
    """Return a field (..., 3, R) at places (..., 3) m; NaN where a place is missing."""
    flat = xyz.reshape(-1, 3)
    known = np.isfinite(flat).all(axis=1)
    values = field(flat[known])
    found = np.full((len(flat), *values.shape[1:]), np.nan)
    found[known] = values
    return found.reshape(*xyz.shape, -1)
