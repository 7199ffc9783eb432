"""A subject's shape: lengths of segments and places of points on them, from the best frames."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from courtside.body_model import segments
from courtside.body_model.segments import SIDES, Model
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.skeleton import SEGMENTS

BEST = 0.5  # share of the frames, those of least uncertainty, that a length is the median of
LUMBAR = 0.2  # ASSUME: height of the joint of pelvis and thorax, share of the trunk's length
STERNUM_M = 0.02  # ASSUME: of the clavicle's inner end from the middle plane
# ASSUME: standard deviation of a median length, as a share of it: joints err alike in all frames,
# so more frames do not reduce it (`joint_correction.LENGTH_SIGMA`).
SYSTEMATIC = 0.04
# Share of body height, men and women together (Winter 2009, fig. 4.1; hips, shoulders: ASSUME).
OF_HEIGHT = {
    "thigh": 0.245, "shank": 0.246, "upper_arm": 0.186, "forearm": 0.146,
    "hips": 0.11, "shoulders": 0.2, "trunk": 0.288,
}  # fmt: skip
OF_HEIGHT_SIGMA = 0.06  # ASSUME: standard deviation of such a length, as a share of it
HEIGHT_M, HEIGHT_SIGMA = 1.72, 0.06  # ASSUME: of an adult whose height is not stated; as a share
LEAST = 10  # frames that a median needs


@dataclass(frozen=True, eq=False)
class Shape:
    """One subject's segments and the points of a network on them."""

    offsets: NDArray  # (S, 3) m: origins in the parents
    sigma_m: NDArray  # (S,) of their lengths
    by_length: NDArray  # (K, S, 3): how offsets change with each of `OF_HEIGHT`
    length_sigma_m: NDArray  # (K,) of these lengths
    joints: tuple[str, ...]  # J
    index: NDArray  # (J,) of these joints in the record
    segment_of: NDArray  # (J,) int
    places: NDArray  # (J, 3) m, in the segment's axes


def lengths(
    place: Mapping[str, NDArray], sigma: Mapping[str, NDArray], height_m: float | None = None
) -> dict[str, tuple[float, float]]:
    """Return the lengths of the body with their standard deviations, m.

    `place` holds the limb joints (T, 3) m, NaN where missing, `sigma` their standard deviations
    (T,). Both sides count together. Each is the weighted mean of the median of the best frames and
    of its usual share of the height.
    """
    own_sigma = np.hypot(OF_HEIGHT_SIGMA, 0.0 if height_m else HEIGHT_SIGMA)
    found = {}
    for name in OF_HEIGHT:
        apart, spread = _distances(name, place, sigma)
        prior = OF_HEIGHT[name] * (height_m or HEIGHT_M)
        prior_sigma = prior * own_sigma
        known = np.isfinite(apart)
        if known.sum() < LEAST:
            found[name] = (prior, float(prior_sigma))
            continue
        best = known & (spread <= np.quantile(spread[known], BEST))
        median = float(np.median(apart[best]))
        weights = 1 / np.square([SYSTEMATIC * median, prior_sigma])
        mean = float(weights @ [median, prior] / weights.sum())
        found[name] = (mean, float(weights.sum() ** -0.5))
    return found


def _distances(
    name: str, place: Mapping[str, NDArray], sigma: Mapping[str, NDArray]
) -> tuple[NDArray, NDArray]:
    """Return distances (N,) m, and how uncertain each is, of one length of the body."""
    if name in SEGMENTS:
        start, stop = SEGMENTS[name]
        ends = [(f"{side}_{start}", f"{side}_{stop}") for side in SIDES]
        apart = [np.linalg.norm(place[a] - place[b], axis=1) for a, b in ends]
        return np.concatenate(apart), np.concatenate(
            [np.hypot(sigma[a], sigma[b]) for a, b in ends]
        )
    middle = {
        part: (place[f"left_{part}"] + place[f"right_{part}"]) / 2 for part in ("hip", "shoulder")
    }
    if name == "trunk":
        line, parts = middle["shoulder"] - middle["hip"], ("hip", "shoulder")
    else:
        part = name.removesuffix("s")
        line, parts = place[f"left_{part}"] - place[f"right_{part}"], (part, part)
    squares = [sigma[f"{side}_{part}"] ** 2 for side, part in product(SIDES, parts)]
    return np.linalg.norm(line, axis=1), np.sqrt(sum(squares))


def of_lengths(
    model: Model, known: Mapping[str, tuple[float, float]], joints: Sequence[str]
) -> Shape:
    """Return the shape of these lengths; points other than limb joints lie at their segment."""
    size = {name: length for name, (length, _) in known.items()}
    offsets = _offsets(model, size)
    slopes = [_offsets(model, size | {name: size[name] + 1.0}) - offsets for name in OF_HEIGHT]
    by_length, spread = np.array(slopes), np.array([known[name][1] for name in OF_HEIGHT])
    on = [(at, str(joint), segments.segment_of(str(joint))) for at, joint in enumerate(joints)]
    on = [(at, joint, segment) for at, joint, segment in on if segment]
    return Shape(
        offsets,
        np.linalg.norm(by_length * spread[:, None, None], axis=(0, 2)),
        by_length,
        spread,
        tuple(joint for _, joint, _ in on),
        np.array([at for at, _, _ in on]),
        np.array([model.names.index(segment) for _, _, segment in on]),
        np.zeros((len(on), 3)),
    )


def _offsets(model: Model, size: Mapping[str, float]) -> NDArray:
    """Return the segments' origins in their parents (S, 3) m of a body with these lengths."""
    found: dict[str, tuple[float, float, float]] = {"thorax": (0, LUMBAR * size["trunk"], 0)}
    found["head"] = (0, (1 - LUMBAR) * size["trunk"], 0)
    for side, z in zip(SIDES, (-1.0, 1.0), strict=True):
        found[f"{side}_clavicle"] = (0, (1 - LUMBAR) * size["trunk"], z * STERNUM_M)
        found[f"{side}_humerus"] = (0, 0, z * (size["shoulders"] / 2 - STERNUM_M))
        found[f"{side}_femur"] = (0, 0, z * size["hips"] / 2)
        found[f"{side}_forearm"] = (0, -size["upper_arm"], 0)
        found[f"{side}_hand"] = (0, -size["forearm"], 0)
        found[f"{side}_tibia"] = (0, -size["thigh"], 0)
        found[f"{side}_foot"] = (0, -size["shank"], 0)
    return np.array([found.get(name, (0.0, 0.0, 0.0)) for name in model.names])


def is_free(shape: Shape) -> NDArray:
    """Return which points (J,) are placed by `with_points`.

    All but limb joints and what `with_feet` placed.
    """
    # `mid_hip` reads as a hip: it is not free, but the origin of the pelvis.
    names = np.array([joint.partition("_")[2] for joint in shape.joints])
    placed = np.isin(names, ["heel", *skeleton.TOES]) & shape.places.any(axis=1)
    return ~np.isin(names, list(segments.ORIGINS)) & ~placed


def with_feet(shape: Shape, place: Mapping[str, NDArray]) -> Shape:
    """Return the shape with heel and toe in the foot's middle plane, its sole along X.

    From the medians of the sides of the triangle of ankle, heel and toe, both feet together. If
    there are no heels, or heels or toes are never seen, points stay at the ankle.
    """
    feet = [skeleton.heel_and_toe(shape.joints, side) for side in SIDES]
    if not all(feet):
        return shape
    heel, toe = (skeleton.without_side(shape.joints[at]) for at in feet[0])
    sides = []
    for one, other in (("ankle", heel), ("ankle", toe), (heel, toe)):
        apart = [place[f"{side}_{one}"] - place[f"{side}_{other}"] for side in SIDES]
        length = np.linalg.norm(np.concatenate(apart), axis=1)
        known = length[np.isfinite(length)]
        sides.append(float(np.median(known)) if len(known) else np.nan)
    if not np.isfinite(sides).all():
        return shape
    behind = (sides[0] ** 2 - sides[1] ** 2 + sides[2] ** 2) / (2 * sides[2])
    height = np.sqrt(max(sides[0] ** 2 - behind**2, 0.0))
    places = shape.places.copy()
    for of_side in feet:
        places[of_side] = [(-behind, -height, 0), (sides[2] - behind, -height, 0)]
    return replace(shape, places=places)


def with_points(
    shape: Shape,
    free: NDArray,
    origin: NDArray,
    turned: NDArray,
    xyz: NDArray,
    weight: NDArray,
) -> Shape:
    """Return the shape with its free points (J,) where poses of the model see them.

    `origin` (S, T, 3), `turned` (S, T, 3, 3) are poses, `xyz` (T, J, 3) m the measured points and
    `weight` (T, J) theirs, 0 where missing. Left and right mirror each other; a side that is never
    seen mirrors the other one.
    """
    places, seen = shape.places.copy(), np.count_nonzero(weight, axis=0) > 0
    for at in np.flatnonzero(free).tolist():
        segment, w = shape.segment_of[at], weight[:, at]
        if seen[at]:
            line = np.nan_to_num(xyz[:, at]) - origin[segment]
            own = np.einsum("tba,tb->ta", turned[segment], line)
            places[at] = w @ own / w.sum()
    mirrored = places.copy()
    for at, joint in enumerate(shape.joints):
        side, _, part = joint.partition("_")
        other = {"left": "right", "right": "left"}.get(side)
        if other and f"{other}_{part}" in shape.joints:
            there = shape.joints.index(f"{other}_{part}")
            share = 0.5 if seen[at] == seen[there] else float(seen[at])
            mirrored[at] = share * places[at] + (1 - share) * places[there] * [1, 1, -1]
        else:
            mirrored[at] = places[at] * [1, 1, 0]
    return replace(shape, places=np.where(free[:, None], mirrored, shape.places))
