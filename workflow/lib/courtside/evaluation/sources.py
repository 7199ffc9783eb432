"""Errors of a take's sources (devices, cameras) against the truth, and the parts of the errors."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from math import factorial

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.geometry import rotations, similarity
from courtside.geometry.interpolation import between
from courtside.geometry.similarity import Sim3
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.body_motion import BodyMotion

PARTS = ("origin", "scale", "rotation", "time")
LONGEST_S = 0.1  # ASSUME: longer gaps are not interpolated; a fast wrist turns within them
MOST_SHIFT_S = 0.3  # ASSUME: largest error of a clock that is searched
SEARCHED = 400  # ASSUME: about so many frames are enough to find the shift in time
FEWEST_JOINTS = 4  # of a frame aligned by itself: three points would fit with too little left over
ROOT = ("left_hip", "right_hip")


def shared(source: BodyMotion, reference: BodyMotion) -> list[str]:
    """Return the names of the limb joints of both sources, in the first one's order.

    Others, such as eyes, are left out: not every source has them, and means over joints must be
    comparable.
    """
    known = set(map(str, reference.joints)) & set(skeleton.JOINTS)
    return [str(name) for name in source.joints if str(name) in known]


def matched(
    source: BodyMotion, reference: BodyMotion, *, form: str = "fixed", shift_s: float = 0.0
) -> tuple[NDArray, NDArray]:
    """Return both motions (T, M, 3) at the source's times plus `shift_s`, in mm, NaN where missing.

    The source is in its own units first, so that its scale is that of its T-pose. `form` is `fixed`
    or `following`.
    """
    names = shared(source, reference)
    own, other = (
        getattr(motion, form)[:, [list(motion.joints).index(name) for name in names]]
        for motion in (source, reference)
    )
    true = between(reference.time_s, other, source.time_s + shift_s, LONGEST_S)
    to_mm = 1000 * reference.unit_m
    return own * to_mm, true * to_mm


def errors(source: BodyMotion, reference: BodyMotion) -> tuple[list[str], dict[str, NDArray]]:
    """Return the names of the M common joints, and a source's errors (T, M, 3) mm by alignment.

    body_frame: in the frame of the T-pose, without further alignment. trunk_frame: in the frame
    that moves with the trunk. root_relative: body_frame, minus the error of the middle of the hips
    in each frame. procrustes_take: after one similarity for the whole take; procrustes_frame: after
    one per frame.
    """
    names = shared(source, reference)
    measured, true = matched(source, reference)
    moving, truth = matched(source, reference, form="following")
    root = (measured - true)[:, [names.index(name) for name in ROOT]].mean(axis=1, keepdims=True)
    return names, {
        "body_frame": measured - true,
        "trunk_frame": moving - truth,
        "root_relative": measured - true - root,
        "procrustes_take": _procrustes(measured[None], true[None])[0],
        "procrustes_frame": _procrustes(measured, true),
    }


def _procrustes(measured: NDArray, true: NDArray) -> NDArray:
    """Return errors (B, ..., 3) after a similarity for each of B sets; NaN if undetermined."""
    rest = np.full(measured.shape, np.nan)
    for at, (one, other) in enumerate(zip(measured, true, strict=True)):
        known = np.isfinite(one).all(axis=-1) & np.isfinite(other).all(axis=-1)
        a, b = one[known], other[known]
        if len(a) < FEWEST_JOINTS or similarity.is_collinear(a) or similarity.is_collinear(b):
            continue
        rest[at] = similarity.umeyama(a, b).points(one) - other
    return rest


def table(names: list[str], errors_mm: dict[str, NDArray], true_known: NDArray) -> pd.DataFrame:
    """Summarise errors (T, M, 3) mm: one row for each alignment and joint, and for all joints.

    The square of rmse_mm is the sum of those of bias_mm and sd_mm. Missing values are counted where
    the reference has a value, `true_known` (T, M).
    """
    groups = {name: [at] for at, name in enumerate(names)} | {"all": list(range(len(names)))}
    rows = [
        {"alignment": alignment, "joint": joint, **_row(error[:, at], true_known[:, at])}
        for alignment, error in errors_mm.items()
        for joint, at in groups.items()
    ]
    return pd.DataFrame(rows)


def _row(error: NDArray, true_known: NDArray) -> dict:
    known = np.isfinite(error).all(axis=-1) & true_known
    row = {"n": int(known.sum()), "missing_percent": np.nan}
    if true_known.any():
        row["missing_percent"] = 100 * (1 - known.sum() / true_known.sum())
    if not known.any():
        return row
    error = error[known]
    bias, distance = error.mean(axis=0), np.linalg.norm(error, axis=-1)
    return row | {
        **{f"bias_{axis}_mm": bias[k] for k, axis in enumerate("xyz")},
        "bias_mm": np.linalg.norm(bias),
        "sd_mm": np.sqrt(np.mean(np.sum((error - bias) ** 2, axis=-1))),
        "rmse_mm": np.sqrt(np.mean(distance**2)),
        "median_mm": np.median(distance),
        "p95_mm": np.percentile(distance, 95),
    }


def split(source: BodyMotion, reference: BodyMotion, *, form: str = "fixed") -> pd.DataFrame:
    """Split the mean squared error of a source into parts that add up.

    part: origin, scale, rotation, time, remainder, all; mean_square_mm2: they add up to that of
    all; percent of all; and the value in the fit of everything at once, where there is one:
    origin's shift in mm, scale's factor, rotation's angle in degrees, time's shift in seconds
    (added to the source's times). `form` is `fixed` or `following`.

    There are four corrections: one shift in space, one scale, one rotation, one shift in time for
    the whole take. For every subset the mean squared error is found that remains when all of the
    subset are fitted together. A part's share is its mean reduction over all orders of the
    corrections (Lindeman, Merenda & Gold 1980; Shapley 1953): no order is preferred, no share is
    negative, and with the remainder they add up to the whole. Rotation and scale are about the
    origin, or about the middle of all points where the origin may shift. All subsets use the same
    frames: those that the reference covers at every shift tried.
    """
    fits = {}
    inside = _covered(source, reference, form)
    shift_s = _best_shift(source, reference, form, inside, PARTS)
    for size in range(len(PARTS) + 1):
        for subset in combinations(PARTS, size):
            if "time" in subset and size < len(PARTS):
                at_s = _best_shift(source, reference, form, inside, subset)
            else:
                at_s = shift_s if "time" in subset else 0.0
            fits[frozenset(subset)] = _fit(source, reference, form, inside, at_s, subset)
    total, (remainder, values) = fits[frozenset()][0], fits[frozenset(PARTS)]
    remaining = {subset: fit[0] for subset, fit in fits.items()}
    shares = {part: _share(part, remaining) for part in PARTS} | {
        "remainder": remainder,
        "all": total,
    }
    rows = pd.DataFrame(shares.items(), columns=["part", "mean_square_mm2"])
    rows["percent"] = 100 * rows["mean_square_mm2"] / (total or np.nan)
    return rows.assign(value=rows["part"].map(values | {"time": shift_s}))


def _share(part: str, remaining: dict[frozenset[str], float]) -> float:
    """Return the mean reduction by a part over all orders of the corrections."""
    others = [other for other in PARTS if other != part]
    share = 0.0
    for size in range(len(others) + 1):
        weight = factorial(size) * factorial(len(others) - size) / factorial(len(PARTS))
        for subset in combinations(others, size):
            without, fitted = remaining[frozenset(subset)], remaining[frozenset((*subset, part))]
            share += weight * (without - fitted)
    return share


def _covered(source: BodyMotion, reference: BodyMotion, form: str) -> NDArray:
    """Return the values (T, M) that both know at every shift in time that is tried."""
    known = np.ones((len(source.time_s), len(shared(source, reference))), bool)
    for shift_s in np.arange(-MOST_SHIFT_S, MOST_SHIFT_S + 0.01, LONGEST_S / 2):
        measured, true = matched(source, reference, form=form, shift_s=shift_s)
        known &= np.isfinite(measured + true).all(axis=-1)
    return known


def _best_shift(
    source: BodyMotion, reference: BodyMotion, form: str, inside: NDArray, subset: Sequence[str]
) -> float:
    """Return the shift in time with the least error when the other corrections are fitted too."""
    # Some of the frames are enough to find it.
    every = slice(None, None, max(1, len(source.time_s) // SEARCHED))
    thin = {key: getattr(source, key)[every] for key in ("time_s", "fixed", "following")}
    some, inside = replace(source, **thin), inside[every]

    def remaining(shift_s):
        return _fit(some, reference, form, inside, shift_s, subset)[0]

    coarse = np.linspace(-MOST_SHIFT_S, MOST_SHIFT_S, 25)
    at_s = coarse[int(np.argmin([remaining(shift_s) for shift_s in coarse]))]
    step_s = coarse[1] - coarse[0]
    limits = max(at_s - step_s, -MOST_SHIFT_S), min(at_s + step_s, MOST_SHIFT_S)
    found = scipy.optimize.minimize_scalar(
        remaining, bounds=limits, method="bounded", options={"xatol": 1e-5}
    )
    # No shift at all must not be worse than the one found.
    return float(found.x) if found.fun < remaining(0.0) else 0.0


def _fit(
    source: BodyMotion,
    reference: BodyMotion,
    form: str,
    inside: NDArray,
    shift_s: float,
    subset: Sequence[str],
) -> tuple[float, dict[str, float]]:
    """Return (remaining mean squared error, values) of some corrections at one shift in time."""
    measured, true = matched(source, reference, form=form, shift_s=shift_s)
    good = inside & np.isfinite(true).all(axis=-1)
    a, b = measured[good], true[good]
    if not len(a):
        return np.nan, {}
    zero = np.zeros(3)
    middle_a, middle_b = (a.mean(axis=0), b.mean(axis=0)) if "origin" in subset else (zero, zero)
    a, b = a - middle_a, b - middle_b
    rotation = similarity.kabsch(b.T @ a)[0] if "rotation" in subset else np.eye(3)
    turned = a @ rotation.T
    scale = float((turned * b).sum() / (a * a).sum()) if "scale" in subset else 1.0
    rest = float(np.mean(np.sum((scale * turned - b) ** 2, axis=-1)))
    angle = np.degrees(rotations.angles(rotation))
    shift = float(np.linalg.norm(middle_b - scale * rotation @ middle_a))
    return rest, {"origin": shift, "scale": scale, "rotation": float(angle)}


def body_frame_errors(
    body_from_device: Sim3, device_from_world: NDArray, body_from_world: Sim3
) -> dict[str, float]:
    """Return the errors of a body frame by the same definition as the true one.

    angle_deg: of the rotation between the axes. unit_percent: by how much the unit is too long.
    origin_mm: distance of the origins, without meaning for a source without a place in the world.
    `device_from_world` (3, 4) is the true pose of the source's own axes, metres.
    """
    rotation = body_from_device.rotation @ device_from_world[:, :3] @ body_from_world.rotation.T
    world_from_device = Sim3(1.0, device_from_world[:, :3], device_from_world[:, 3]).inverse()
    origin = world_from_device.points(body_from_device.inverse().translation)
    true = body_from_world.inverse().translation
    return {
        "angle_deg": float(np.degrees(rotations.angles(rotation))),
        "unit_percent": float(100 * (body_from_world.scale / body_from_device.scale - 1)),
        "origin_mm": float(1000 * np.linalg.norm(origin - true)),
    }
