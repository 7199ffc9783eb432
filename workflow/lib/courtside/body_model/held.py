"""Points of standing feet, which keep their places on the floor from frame to frame."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.body_model import pose as poses
from courtside.body_model.pose import Pose
from courtside.body_model.segments import SIDES, Model
from courtside.body_model.shape import Shape
from courtside.records.keypoints import skeleton

# Chosen on `players-dev`: held by 0.005, ankles err more around landings; by 0.05, standing feet
# move twice as far.
DRIFT_M = 0.02  # per axis, of a standing point within one second
FLOOR_M = 0.01  # of a standing point's height
# Speeds per axis of points that are held rightly and wrongly, standard deviations, m/s: chosen on
# `players-dev` with three cameras, where feet that swing are sometimes taken for standing ones.
HELD_M_S, SWING_M_S = 0.5, 1.5
SURE = 1 - 1e-6  # ASSUME: largest probability that contacts are right


@dataclass(frozen=True, eq=False)
class Held:
    """How strongly standing heels and toes are held in each frame; 0 where they swing."""

    points: NDArray  # (H,) int: rows of the shape's points
    between: NDArray  # (T - 1, H) 1/m2: of the squared way to the next frame
    floor: NDArray  # (T, H) 1/m2: of the squared height above `height`
    height: NDArray  # (H,) m
    rate_hz: float


def of_contacts(
    joints: Sequence[str], stands: NDArray, floor_m: NDArray, rate_hz: float
) -> Held | None:
    """Return what contacts hold; None if the shape has no heels and toes.

    `stands` (T, 2, 2) are the probabilities that heel and toe of each foot stand, `floor_m` (2, 2)
    their heights of the flat foot: of `records.footwork.Contacts`, NaN where unknown. What two
    frames say counts with the probability that the point stands in both.
    """
    feet = [skeleton.heel_and_toe(joints, side) for side in SIDES]
    if not all(feet):
        return None
    chance = np.nan_to_num(stands).reshape(len(stands), -1)
    return Held(
        np.concatenate(feet),
        chance[1:] * chance[:-1] * rate_hz / DRIFT_M**2,
        chance * np.isfinite(floor_m).ravel() / FLOOR_M**2,
        np.nan_to_num(floor_m).ravel(),
        rate_hz,
    )


def placed(model: Model, shape: Shape, held: Held, pose: Pose) -> tuple[NDArray, NDArray, NDArray]:
    """Return the segments' origins and rotations (`pose.forward`), and the points (T, H, 3) m."""
    origin, turned = poses.forward(model, pose, shape.offsets)
    segment = shape.segment_of[held.points]
    return origin, turned, poses.placed(origin, turned, segment, shape.places[held.points])


def doubted(held: Held, points: NDArray) -> Held:
    """Return weaker holds of points (T, H, 3) m that move as only swinging feet do.

    The probability that a point stands becomes, by Bayes' rule, that given its speed too, and never
    grows. A frame's height counts with the lesser of the steps to its neighbours.
    """
    square = (np.diff(points, axis=0) ** 2).sum(axis=2) * held.rate_hz**2
    chance = np.minimum(held.between * DRIFT_M**2 / held.rate_hz, SURE)
    odds = np.exp(-square / 2 * (1 / HELD_M_S**2 - 1 / SWING_M_S**2)) * (SWING_M_S / HELD_M_S) ** 3
    share = np.minimum(1.0, odds / (chance * odds + 1 - chance))
    share = np.where(chance > 0, share, 1.0)
    none = np.ones_like(share[:1])
    lesser = np.minimum(np.concatenate([none, share]), np.concatenate([share, none]))
    return replace(held, between=held.between * share, floor=held.floor * lesser)


def linearised(
    model: Model, shape: Shape, held: Held, origin: NDArray, turned: NDArray, points: NDArray
) -> tuple[NDArray, NDArray, NDArray]:
    """Return normal matrix (T, D, D) and right side (T, D), and blocks (T - 1, D, D) below it.

    A block is of the next frame's rows and the frame's own columns. What `placed` returns is given.
    """
    by = poses.derivatives(model, origin, turned, points, shape.segment_of[held.points])
    flat = by.reshape(len(by), -1, by.shape[3])
    before, after = flat[:-1], flat[1:]
    weight = np.repeat(held.between, 3, axis=1)
    pull = weight * np.diff(points, axis=0).reshape(weight.shape)
    weighted = weight[..., None] * after
    up, away = by[:, :, 2], held.height - points[..., 2]
    normal = np.swapaxes(up, 1, 2) @ (held.floor[..., None] * up)
    normal[1:] += np.swapaxes(after, 1, 2) @ weighted
    normal[:-1] += np.swapaxes(before, 1, 2) @ (weight[..., None] * before)
    right = np.einsum("thd,th->td", up, held.floor * away)
    right[1:] -= np.einsum("tnd,tn->td", after, pull)
    right[:-1] += np.einsum("tnd,tn->td", before, pull)
    return normal, right, -np.swapaxes(weighted, 1, 2) @ before
