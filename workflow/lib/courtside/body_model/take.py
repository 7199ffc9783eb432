"""A take's skeletons fitted by the model: joints with constant bones."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.body_model import angles, fit, held, pose, segments, shape, start
from courtside.body_model.fit import Spread
from courtside.body_model.pose import Pose
from courtside.body_model.shape import Shape
from courtside.kinematics import filtering, shared_errors
from courtside.records.footwork import Contacts
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeletal_motion import SkeletalMotion
from courtside.study.execution import log

UNKNOWN_M = 0.03  # ASSUME: standard deviation per axis that a joint without a network's has
# And that points of the hand have: fingers bend, and the model's hand does not. Chosen on
# `players-dev`: joints gain, and the hand's direction does not lose. With 0.1 for each, its three
# points, which err alike, pull the wrist too strongly.
HAND_M = 0.17
# Standard deviation per axis, m, of a limb joint's mean error over a take, with joint offsets
# subtracted: on five takes of `players-dev`. The network errs alike in all frames of a pose, and
# neighbours err with the joint, so the fit does not reduce it as its own covariance says.
SHIFT_M = {
    "shoulder": 0.008, "elbow": 0.009, "wrist": 0.006, "hip": 0.006, "knee": 0.005, "ankle": 0.004,
}  # fmt: skip
# Fits, with their steps, between which the lengths of segments are fitted, and the points of feet,
# hands and head placed.
ROUNDS = (3, 3, 6)
LEAST = 6  # limb joints of a frame that is fitted


@dataclass(frozen=True, eq=False)
class Fitted:
    """One person's fit over the frames that it covers."""

    frames: slice
    shape: Shape
    pose: Pose
    spread: Spread


def errors(points: Keypoints3D, person: int, *, recorded: bool = False) -> tuple[NDArray, NDArray]:
    """Return the covariance (T, J, 3, 3) m2 by which one person's joints count, and their noise.

    Filled gaps have no stated noise: they count with twice the joint's usual one. Joints that the
    network's errors are unknown of get `UNKNOWN_M`, or `HAND_M`. What is constant of the errors of
    `recorded` people counts as noise, in full (`shared_errors.constant`).
    """
    network, own = points.covariance_network[person], points.covariance_2d[person]
    parts = [joint.partition("_")[2] for joint in points.joints.tolist()]
    sigma = np.where(np.isin(parts, segments.POINTS["hand"]), HAND_M, UNKNOWN_M)
    variance = np.where(np.isfinite(network), network, (sigma**2)[:, None, None] * np.eye(3))
    around = np.ma.median(np.ma.masked_invalid(np.trace(own, axis1=2, axis2=3)), axis=0) / 3
    unknown = 4 * np.ma.filled(around, UNKNOWN_M**2)[:, None, None] * np.eye(3)
    noise = np.where(np.isfinite(own), own, unknown)
    total = noise + variance
    if recorded:
        steady = shared_errors.constant(shared_errors.variances(network), points.joints.tolist())
        noise = noise + steady[..., None, None] * np.eye(3)
    return total, noise


def person(
    points: Keypoints3D,
    at: int,
    cutoff_hz: Mapping[str, float],
    height_m: float | None = None,
    contacts: Contacts | None = None,
    *,
    recorded: bool = False,
) -> Fitted | None:
    """Fit one person's frames from the first to the last that is seen; None if none is.

    `contacts`, of the same persons and frames, hold heels and toes where they stand. Only the last
    round uses them: earlier rounds would take longer and end in the same poses. People are
    `recorded`, or virtual.
    """
    names, frames = points.joints.tolist(), _frames(points, at)
    if _unseen(points, at, frames):
        return None
    covariance, noise = (one[frames] for one in errors(points, at, recorded=recorded))
    xyz = points.xyz[at][frames]
    place = {joint: xyz[:, k] for k, joint in enumerate(names)}
    sigma = np.sqrt(np.trace(covariance, axis1=2, axis2=3) / 3)
    spread = {joint: sigma[:, k] for k, joint in enumerate(names)}
    model = segments.model()
    body = shape.of_lengths(model, shape.lengths(place, spread, height_m), names)
    body = shape.with_feet(body, place)
    free = shape.is_free(body)
    filled = {joint: _filled(place[joint]) for joint in skeleton.JOINTS}
    found = start.pose(model, filled)
    known = np.isfinite(xyz[:, body.index]).all(axis=2)
    information = np.where(known[..., None, None], np.linalg.inv(covariance[:, body.index]), 0.0)
    data = fit.Data(np.nan_to_num(xyz[:, body.index]), information, noise[:, body.index])
    weight = np.trace(information, axis1=2, axis2=3)
    hz = fit.cutoffs(model, cutoff_hz)
    stand = None
    if contacts is not None:
        own, floor_m = contacts.held[at, frames], contacts.floor_m[at]
        stand = held.of_contacts(body.joints, own, floor_m, points.rate_hz)
    for number, steps in enumerate(ROUNDS, start=1):
        origin, turned = pose.forward(model, found, body.offsets)
        body = shape.with_points(body, free, origin, turned, data.xyz, weight)
        on = stand if number == len(ROUNDS) else None
        found = fit.fit(model, body, data, found, hz, points.rate_hz, steps, on)
        if number < len(ROUNDS):
            body = fit.lengthened(model, body, data, found, points.rate_hz)
    return Fitted(frames, body, found, fit.spread(model, body, data, found))


def _frames(points: Keypoints3D, at: int) -> slice:
    """Return a person's frames from the first to the last with `LEAST` limb joints; may be none."""
    limbs = np.isin(points.joints, skeleton.JOINTS)
    known = np.isfinite(points.xyz[at][:, limbs]).all(axis=2)
    seen = np.flatnonzero(known.sum(axis=1) >= LEAST)
    return slice(int(seen[0]), int(seen[-1]) + 1) if len(seen) > 1 else slice(0)


def _unseen(points: Keypoints3D, at: int, frames: slice) -> list[str]:
    """Return the limb joints that one person shows in none of these frames."""
    seen = np.isfinite(points.xyz[at][frames]).all(axis=2).any(axis=0)
    return sorted(set(skeleton.JOINTS) - set(points.joints[seen].tolist()))


def people(
    points: Keypoints3D,
    cutoff_hz: Mapping[str, float],
    height_m_of: Mapping[str, float | None],
    contacts: Contacts | None = None,
    *,
    recorded: bool = False,
) -> dict[int, Fitted]:
    """Fit the model to all persons of a record (`person`); return the fits by the person's index.

    A person who cannot be fitted is left out, with a warning in the log.
    """
    fits = {}
    for at, name in enumerate(points.person_id.tolist()):
        height_m = height_m_of.get(name)
        found = person(points, at, cutoff_hz, height_m, contacts, recorded=recorded)
        if found is not None:
            fits[at] = found
            continue
        frames = _frames(points, at)
        few = f"{LEAST} limb joints are seen together in fewer than two frames"
        lost = f"never seen while {LEAST} limb joints are: {', '.join(_unseen(points, at, frames))}"
        why = lost if frames.stop else few
        log.logger.warning("%s: the skeletal model cannot be fitted: %s", name, why)
    log.logger.info("persons fitted: %d of %d", len(fits), len(points.person_id))
    return fits


def _filled(line: NDArray) -> NDArray:
    """Return a path (T, 3) with gaps filled along straight lines."""
    known, at = np.isfinite(line).all(axis=1), np.arange(len(line))
    return np.stack([np.interp(at, at[known], line[known, axis]) for axis in range(3)], axis=1)


def joints(points: Keypoints3D, fits: Mapping[int, Fitted]) -> Keypoints3D:
    """Return the record with the joints of the fits, where the record has these joints.

    Joints that are on no segment of the model, as of the face and the fingers, are left out.
    The fit's error is split as `errors` does: the noise, and the rest as the network's.
    To the rest of limb joints whose network's errors are known, `SHIFT_M` is added.
    """
    model, kept = segments.model(), np.zeros(points.xyz.shape[:3], dtype=bool)
    xyz, noise, rest = (
        np.full(one.shape, np.nan)
        for one in (points.xyz, points.covariance_2d, points.covariance_network)
    )
    for at, one in fits.items():
        shift = _shifts(points, at)[one.shape.index][:, None, None] * np.eye(3)
        for part in fit.chunks(len(one.pose.root)):
            placed, by = fit.derivatives(model, one.shape, one.pose.frames(part), with_lengths=True)
            total, own = one.spread.frames(part).points(by)
            rows = np.ix_(one.frames.start + np.arange(part.start, part.stop), one.shape.index)
            known = np.isfinite(points.xyz[at][rows]).all(axis=2)
            kept[at][rows] = known
            xyz[at][rows] = np.where(known[..., None], placed, np.nan)
            noise[at][rows] = np.where(known[..., None, None], own, np.nan)
            rest[at][rows] = np.where(known[..., None, None], total - own + shift, np.nan)
    found = points.without(np.isfinite(points.xyz[..., 0]) & ~kept)
    found = replace(found, xyz=xyz, covariance_2d=noise, covariance_network=rest)
    on = [segments.segment_of(joint) is not None for joint in points.joints.tolist()]
    return found if all(on) else found.some_joints(np.flatnonzero(on).tolist())


def _shifts(points: Keypoints3D, person: int) -> NDArray:
    """Return the variance (J,) m2 per axis that `SHIFT_M` adds; 0 without errors of a network."""
    parts = [joint.partition("_")[2] for joint in points.joints.tolist()]
    erring = np.nan_to_num(points.covariance_network[person]).any(axis=(0, 2, 3))
    return np.where(erring, np.square([SHIFT_M.get(part, 0.0) for part in parts]), 0.0)


def _away(points: Keypoints3D, at: int, frames: slice, max_gap_s: float) -> NDArray:
    """Return the fitted frames (T,) in runs longer than `max_gap_s` without a limb joint; log."""
    limbs = np.isin(points.joints, skeleton.JOINTS)
    unseen = ~np.isfinite(points.xyz[at][:, limbs]).all(axis=2).any(axis=1)
    unseen[: frames.start], unseen[frames.stop :] = False, False
    away = np.zeros_like(unseen)
    for begin, end in filtering.runs(unseen):
        if (end - begin) / points.rate_hz > max_gap_s:
            away[begin:end] = True
            log.logger.info(
                "%s: no limb joint is seen from %.2f to %.2f s: no motion there",
                *(points.person_id[at], points.time_s[begin], points.time_s[end - 1]),
            )
    return away


def _any_shape(points: Keypoints3D, fits: Mapping[int, Fitted]) -> Shape:
    """Return the shape of one of the fits: all have the same joints; without a fit, of no size."""
    if fits:
        return next(iter(fits.values())).shape
    unknown = dict.fromkeys(shape.OF_HEIGHT, (np.nan, np.nan))
    return shape.of_lengths(segments.model(), unknown, points.joints.tolist())


def motion(
    points: Keypoints3D, fits: Mapping[int, Fitted], max_gap_s: float = np.inf
) -> SkeletalMotion:
    """Return the motion of the fits; persons without one have no joints.

    Frames of a person of whom no limb joint is seen for longer than `max_gap_s` count as not
    fitted, and the log says so: the fit glides through them.
    """
    model, n_people, n_frames = segments.model(), len(points.person_id), len(points.time_s)
    on = _any_shape(points, fits)
    n_segments, n_points = len(model.names), len(on.joints)
    offsets, sigma = np.zeros((n_people, n_segments, 3)), np.full((n_people, n_segments), np.nan)
    places = np.zeros((n_people, n_points, 3))
    root = np.full((n_people, n_frames, 3), np.nan)
    turns = np.full((n_people, n_frames, n_segments, 3, 3), np.nan)
    names = angles.names()
    degrees, spread = np.full((2, n_people, n_frames, len(names)), np.nan)
    for at, one in fits.items():
        offsets[at], sigma[at], places[at] = one.shape.offsets, one.shape.sigma_m, one.shape.places
        root[at, one.frames] = one.pose.root
        turns[at, one.frames] = np.moveaxis(one.pose.local, 0, 1)
        measured = angles.of_fit(model, one.pose, one.spread)
        for k, name in enumerate(names):
            degrees[at, one.frames, k], spread[at, one.frames, k] = measured[name]
        away = _away(points, at, one.frames, max_gap_s)
        for values in (root, turns, degrees, spread):
            values[at, away] = np.nan
    return SkeletalMotion(
        model=points.model,
        person_id=points.person_id,
        time_s=points.time_s,
        segments=np.array(model.names),
        parents=model.parents,
        offsets=offsets,
        offset_sigma_m=sigma,
        joints=np.array(on.joints),
        segment_of=on.segment_of,
        places=places,
        root=root,
        parent_from_segment=turns,
        angles=np.array(names),
        angle_deg=degrees,
        angle_sigma_deg=spread,
    )
