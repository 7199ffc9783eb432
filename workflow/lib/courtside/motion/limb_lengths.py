"""Limbs do not change their length: the lengths of a take, and skeletons that keep to them.

An elbow is what networks place worst; shoulder and wrist tell where it can be at all.
"""

from dataclasses import replace
from itertools import pairwise, product

import numpy as np

from courtside.records import limbs

SIDES = ("left", "right")
LEAST = 10  # frames, of both sides together, that a length must rest on
# ASSUME: a take's own median length is wrong by 5 % (one standard deviation): on the development bodies the
# ratio to the true length, offsets taken off, has mean 0.98 and standard deviation 0.04.
LENGTH_SIGMA = 0.05
UNKNOWN_M = 0.03  # standard deviation per axis of a joint for which none is stated
LIMB_ROUNDS = 8


def lengths(xyz, joints):
    """Return the length of each limb segment over a take, both sides taken together.

    Parameters
    ----------
    xyz : (T, J, 3) float
        One person, metres; NaN where missing.
    joints : sequence of str
        Names of the J joints.

    Returns
    -------
    lengths : dict of (str, str) to float
        For each segment, named without its side (`("shoulder", "elbow")`), the median over the frames of both
        sides, metres; none for a segment seen in fewer than `LEAST`.
    """
    place = dict(zip(joints, np.moveaxis(xyz, 1, 0), strict=True))
    found = {}
    for start, stop in (pair for chain in limbs.CHAINS for pair in pairwise(chain)):
        ends = [(f"{side}_{start}", f"{side}_{stop}") for side in SIDES]
        apart = [place[b] - place[a] for a, b in ends if a in place and b in place]
        apart = np.linalg.norm(np.concatenate(apart or [np.zeros((0, 3))]), axis=1)
        known = apart[np.isfinite(apart)]
        if len(known) >= LEAST:
            found[start, stop] = float(np.median(known))
    return found


def keep(points):
    """Move the joints of a record, each as far as its uncertainty allows, to where limbs keep their length.

    Parameters
    ----------
    points : Keypoints3D

    Returns
    -------
    points : Keypoints3D
        `xyz` of shoulders, elbows, wrists, hips, knees and ankles is changed; joints that are missing stay
        missing, and a limb without a length (`lengths`) stays as it is. The covariance is left as it was: the
        lengths come from the same joints, wrong ones from wrong joints, and it stays an upper bound.

    Notes
    -----
    In each frame the most probable place of a chain's three joints, given where they were measured, with what
    covariance (of keypoints and cameras), and the lengths: Gauss-Newton on the squared Mahalanobis distances
    and the squared relative errors of length over `LENGTH_SIGMA`.
    """
    joints, xyz = list(points.joints), points.xyz.copy()
    covariance = points.covariance_2d + np.nan_to_num(points.covariance_camera)
    for person, (side, chain) in product(range(len(xyz)), product(SIDES, limbs.CHAINS)):
        known = lengths(points.xyz[person], joints)
        names = [f"{side}_{joint}" for joint in chain]
        wanted = [known.get(pair) for pair in pairwise(chain)]
        if set(names) <= set(joints) and any(wanted):
            at = [joints.index(name) for name in names]
            xyz[person][:, at] = _chain(xyz[person][:, at], covariance[person][:, at], wanted)
    return replace(points, xyz=xyz)


def _chain(xyz, covariance, wanted):
    """Return places (T, 3, 3) of three joints in a row, measured at `xyz`, at the wanted distances."""
    known = np.isfinite(xyz).all(axis=2)
    stated = np.isfinite(covariance).all(axis=(2, 3))[..., None, None]
    information = np.linalg.inv(np.where(stated, covariance, UNKNOWN_M**2 * np.eye(3)))
    information[~known] = np.eye(3)  # any: nothing ties a missing joint to the others
    measured = np.where(known[..., None], xyz, 0.0).reshape(-1, 9)
    prior = np.zeros((len(xyz), 9, 9))
    for at in range(3):
        prior[:, 3 * at : 3 * at + 3, 3 * at : 3 * at + 3] = information[:, at]
    place = measured
    for _ in range(LIMB_ROUNDS):
        normal, right = prior.copy(), np.einsum("nij,nj->ni", prior, measured - place)
        for at, length in enumerate(wanted):
            if length:
                rows, error = _length_rows(place, at, length, known[:, at] & known[:, at + 1])
                normal += rows[:, :, None] * rows[:, None]
                right += rows * error[:, None]
        place = place + np.linalg.solve(normal, right[..., None])[..., 0]
    return np.where(known[..., None], place.reshape(-1, 3, 3), np.nan)


def _length_rows(place, at, length, both):
    """Return rows (T, 9) and right sides (T,) of one segment's length, in standard deviations."""
    first, second = slice(3 * at, 3 * at + 3), slice(3 * at + 3, 3 * at + 6)
    line = place[:, second] - place[:, first]
    size = np.maximum(np.linalg.norm(line, axis=1), np.finfo(float).tiny)
    sigma = LENGTH_SIGMA * length
    way = np.where(both, 1 / sigma, 0.0)[:, None] * line / size[:, None]
    rows = np.zeros_like(place)
    rows[:, first], rows[:, second] = -way, way
    return rows, np.where(both, (length - size) / sigma, 0.0)
