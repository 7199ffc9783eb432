"""Fit of the model to all frames of a take together: Gauss-Newton on a banded system."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.body_model import held as feet
from courtside.body_model import pose as poses
from courtside.body_model.held import Held
from courtside.body_model.pose import Pose
from courtside.body_model.segments import BALL, Model
from courtside.body_model.shape import Shape
from courtside.geometry.interpolation import window
from courtside.geometry.rotations import rodrigues_from_rotation
from courtside.records.keypoints.skeleton import without_side

LIMIT_SIGMA = np.radians(2.0)  # ASSUME: how far a joint gives way beyond its range
FAR = 2.0  # ASSUME: standard deviations beyond which a point loses weight (Huber)
LIFT = 1 / 6  # of the arm's elevation: the clavicle rises by 30 degrees of 180 (Inman 1944)
# ASSUME: the errors of frames within it count as those of one, when lengths are fitted.
# On `players-dev` 0.2 to 7 s serve alike.
ALIKE_S = 1.0
LONGEST = 0.5  # rad or m, of a step
CHUNK = 250  # frames whose derivatives are in memory at once
SETTLED = 1e-3  # rad or m: a largest median step below it ends the fit
# Of each segment's rotation: the joint whose cut-off it has, and a factor of it, chosen among a few
# by the errors of joints and angles on `players-dev`.
SHOWN = {
    "pelvis": ("hip", 0.6), "thorax": ("shoulder", 0.6), "clavicle": ("shoulder", 0.6),
    "head": ("shoulder", 0.6), "humerus": ("elbow", 0.5), "forearm": ("wrist", 0.5),
    "hand": ("wrist", 0.5), "femur": ("knee", 1.6), "tibia": ("ankle", 1.6), "foot": ("ankle", 1.6),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Data:
    """Measured points."""

    xyz: NDArray  # (T, J, 3) m
    information: NDArray  # (T, J, 3, 3): inverse of their covariance, 0 where missing
    noise: NDArray  # (T, J, 3, 3) m2: its part that counts in full in angles, the keypoints' own


@dataclass(frozen=True, eq=False)
class Spread:
    """Covariances (T, D + K, D + K) of coordinates and the shape's lengths.

    Of all errors, and of `Data.noise`.
    """

    total: NDArray
    noise: NDArray

    def frames(self, at: slice) -> "Spread":
        """Return some frames."""
        return Spread(self.total[at], self.noise[at])

    def points(self, by: NDArray) -> tuple[NDArray, NDArray]:
        """Return both for points, (T, J, 3, 3) m2, by their derivatives (T, J, 3, D + K)."""
        total, noise = (
            by @ one[:, None] @ np.swapaxes(by, 2, 3) for one in (self.total, self.noise)
        )
        return total, noise


def cutoffs(model: Model, cutoff_hz: Mapping[str, float]) -> NDArray:
    """Return the cut-off of each degree of freedom (D,) Hz, from those of joints by name."""
    found = np.empty(len(model.sigma))
    found[:3] = cutoff_hz["left_hip"]
    for at, name in enumerate(model.names):
        first = model.first[at]
        part = without_side(name)
        joint, factor = SHOWN[part]
        stop = first + len(model.joints[at].coordinates)
        found[first:stop] = factor * cutoff_hz[f"left_{joint}"]
    return found


def stiffness(normal: NDArray, cutoff_hz: NDArray, rate_hz: float, sigma: NDArray) -> NDArray:
    """Return the weights (D,) of squared second differences that filter at the cut-offs.

    A series measured with steady information I and fitted with weight w on its second differences
    passes 1 / (1 + w (2 sin(pi f / rate))^4 / I) of the frequency f: a zero-lag Butterworth filter
    of effective order 4 (Eilers 2003), whose gain is 1 / sqrt(2) at the cut-off with this w. I is
    the median over frames (T, D, D) that show the person of the information of each degree of
    freedom.
    """
    each = np.diagonal(normal[_shown(normal)], axis1=1, axis2=2)
    information = np.median(each, axis=0) + 1 / sigma**2
    gain = (2 * np.sin(np.pi * np.minimum(cutoff_hz / rate_hz, 0.5))) ** 4
    return (np.sqrt(2) - 1) * np.maximum(information, 1e-6) / gain


def _shown(normal: NDArray) -> NDArray:
    """Return which frames (T,) have a point: each tells where the root is. All, if none has."""
    shown = normal[:, 0, 0] > 0
    return shown if shown.any() else ~shown


def fit(
    model: Model,
    shape: Shape,
    data: Data,
    start: Pose,
    cutoff_hz: NDArray,
    rate_hz: float,
    steps: int,
    held: Held | None,
) -> Pose:
    """Return the most probable poses, after at most so many steps.

    It minimises the squared Mahalanobis distances of the points, Huber beyond `FAR`, the squared
    coordinates over their prior, what exceeds their ranges, the second differences (`stiffness`),
    and what standing feet move, unless they move too fast to stand.
    """
    pose, weights = start, None
    for _ in range(steps):
        normal, right, _ = _linearised(model, shape, data, pose)
        shown = _shown(normal)
        if weights is None:
            weights = stiffness(normal, cutoff_hz, rate_hz, model.sigma)
        below = np.zeros_like(normal[1:])
        if held is not None:
            origin, turned, points = feet.placed(model, shape, held, pose)
            tied = feet.doubted(held, points)
            more, pull, below = feet.linearised(model, shape, tied, origin, turned, points)
            normal, right = normal + more, right + pull
        step = _solve(model, pose, normal, right, weights, below)
        pose = poses.moved(model, pose, np.clip(step, -LONGEST, LONGEST))
        if np.median(np.abs(step[shown]), axis=0).max() < SETTLED:
            break
    return pose


def lengthened(model: Model, shape: Shape, data: Data, pose: Pose, rate_hz: float) -> Shape:
    """Return the shape with its most probable lengths, one step from poses that were fitted.

    Each frame says, whatever its pose, what it does of the lengths; the frames of `ALIKE_S` count
    as one. The shape's own lengths count with the standard deviations of `shape.lengths`, also when
    they were fitted before: the more often, the less the first lengths count.
    """
    normal, right, _ = _linearised(model, shape, data, pose, with_lengths=True)
    prior, slope = _prior(model, pose)
    n_free = len(model.sigma)
    own, cross = normal[:, :n_free, :n_free] + prior, normal[:, :n_free, n_free:]
    solved = np.linalg.solve(own, cross)
    said = normal[:, n_free:, n_free:] - np.swapaxes(cross, 1, 2) @ solved
    wanted = right[:, n_free:] - np.einsum("tdk,td->tk", solved, right[:, :n_free] + slope)
    alike = max(window(ALIKE_S, rate_hz), 1)
    known = said.sum(axis=0) / alike + np.diag(1 / shape.length_sigma_m**2)
    grown = np.linalg.solve(known, wanted.sum(axis=0) / alike)
    return replace(shape, offsets=shape.offsets + np.tensordot(grown, shape.by_length, 1))


def chunks(n_frames: int) -> list[slice]:
    """Return parts of at most `CHUNK` frames, in order."""
    return [slice(at, min(at + CHUNK, n_frames)) for at in range(0, n_frames, CHUNK)]


def spread(model: Model, shape: Shape, data: Data, pose: Pose) -> Spread:
    """Return the covariance of each frame's coordinates and of the lengths.

    Of each frame by itself: errors of joints last for some frames, so that what neighbours say is
    not new.
    """
    normal, _, noise = _linearised(model, shape, data, pose, with_lengths=True)
    n_free, known = len(model.sigma), np.arange(len(model.sigma), normal.shape[1])
    normal[:, :n_free, :n_free] += _prior(model, pose)[0]
    normal[:, known, known] += 1 / shape.length_sigma_m**2
    total = np.linalg.inv(normal)
    return Spread(total, total @ noise @ total)


def from_prior(model: Model, pose: Pose, spread: Spread) -> NDArray:
    """Return the part (T, D, D) of the coordinates' covariance that is that of their priors.

    It is the variance of what no point shows; the rest is that of the points' errors and lengths.
    """
    own = spread.total[:, : len(model.sigma), : len(model.sigma)]
    return own @ _prior(model, pose)[0] @ own


def derivatives(
    model: Model, shape: Shape, pose: Pose, with_lengths: bool = False
) -> tuple[NDArray, NDArray]:
    """Return the points (T, J, 3) m, and their derivatives (T, J, 3, D) by the coordinates.

    With lengths, (T, J, 3, D + K): by those of the shape, too.
    """
    origin, turned = poses.forward(model, pose, shape.offsets)
    points = poses.placed(origin, turned, shape.segment_of, shape.places)
    by = poses.derivatives(model, origin, turned, points, shape.segment_of)
    if with_lengths:
        still = replace(pose, root=np.zeros_like(pose.root))
        grown = [poses.forward(model, still, one)[0] for one in shape.by_length]
        more = [np.moveaxis(one[shape.segment_of], 0, 1) for one in grown]
        by = np.concatenate([by, np.stack(more, axis=3)], axis=3)
    return points, by


def _linearised(
    model: Model, shape: Shape, data: Data, pose: Pose, with_lengths: bool = False
) -> tuple[NDArray, NDArray, NDArray]:
    """Return the normal matrix (T, D, D) and right side (T, D) of the points, and its noise.

    The noise (T, D, D) is the right side's covariance from `Data.noise`.
    """
    parts: list[list[NDArray]] = [[], [], []]
    for at in chunks(len(pose.root)):
        points, by = derivatives(model, shape, pose.frames(at), with_lengths)
        residual = data.xyz[at] - points
        info = data.information[at]
        far = np.sqrt(np.einsum("tja,tjab,tjb->tj", residual, info, residual))
        weight = np.minimum(1.0, FAR / np.maximum(far, FAR))[..., None, None] * info
        flat = (len(by), -1, by.shape[3])
        weighted = weight @ by
        noisy = (data.noise[at] @ weighted).reshape(flat)
        weighted, by = weighted.reshape(flat), by.reshape(flat)
        parts[0].append(np.swapaxes(by, 1, 2) @ weighted)
        parts[1].append(np.einsum("tnd,tn->td", weighted, residual.reshape(len(by), -1)))
        parts[2].append(np.swapaxes(weighted, 1, 2) @ noisy)
    normal, right, noise = map(np.concatenate, parts)
    return normal, right, noise


def _prior(model: Model, pose: Pose) -> tuple[NDArray, NDArray]:
    """Return the normal matrix (T, D, D) and right side (T, D) of priors and ranges."""
    value, blocks = poses.coordinates(model, pose)
    beyond = value - np.clip(value, model.low, model.high)
    weight = 1 / model.sigma**2 + (beyond != 0) / LIMIT_SIGMA**2
    slope = (_girdle(model, pose) - value) / model.sigma**2 - beyond / LIMIT_SIGMA**2
    normal = np.zeros((*value.shape, value.shape[1]))
    right = slope.copy()
    diagonal = np.arange(value.shape[1])
    normal[:, diagonal, diagonal] = weight
    for at, joint in enumerate(model.joints):
        if joint.kind == BALL:
            own = slice(model.first[at], model.first[at] + 3)
            normal[:, own, own] = np.swapaxes(blocks[at], 1, 2) @ (
                weight[:, own, None] * blocks[at]
            )
            right[:, own] = np.einsum("tba,tb->ta", blocks[at], slope[:, own])
    return normal, right


def _girdle(model: Model, pose: Pose) -> NDArray:
    """Return where the prior of coordinates (T, D) has its mean: 0 but for the clavicles' lift."""
    found = np.zeros_like(pose.angle)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        clavicle, arm = (model.names.index(f"{side}_{name}") for name in ("clavicle", "humerus"))
        down = np.einsum("ta,ta->t", pose.local[clavicle][:, 1], pose.local[arm][:, :, 1])
        found[:, model.first[clavicle]] = sign * LIFT * np.arccos(np.clip(down, -1, 1))
    return found


def _second_differences(model: Model, pose: Pose) -> NDArray:
    """Return the second differences (T - 2, D) of the motion."""
    found = np.diff(pose.angle, 2, axis=0)
    found[:, :3] = np.diff(pose.root, 2, axis=0)
    for at, joint in enumerate(model.joints):
        if joint.kind == BALL:
            first = model.first[at]
            turns = np.swapaxes(pose.local[at, :-1], 1, 2) @ pose.local[at, 1:]
            found[:, first : first + 3] = np.diff(rodrigues_from_rotation(turns), axis=0)
    return found


def _solve(
    model: Model,
    pose: Pose,
    normal: NDArray,
    right: NDArray,
    weights: NDArray,
    next_rows: NDArray,
) -> NDArray:
    """Return the step (T, D): banded Cholesky, linear in the frames.

    `next_rows` (T - 1, D, D) are what ties each frame to the next.
    """
    n_frames, n_free = right.shape
    prior, slope = _prior(model, pose)
    normal, right = normal + prior, right + slope
    each = np.arange(n_free)
    normal[:, each, each] += 1e-9 * np.median(normal[:, each, each])
    band = np.zeros((2 * n_free + 1, n_frames * n_free), order="F")
    if n_frames > 2:
        bend = weights * _second_differences(model, pose)
        for shift, factor in ((0, 1.0), (1, -2.0), (2, 1.0)):
            right[shift : n_frames - 2 + shift] -= factor * bend
        second = scipy.sparse.diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(n_frames - 2, n_frames))
        square = (second.T @ second).todia()
        for shift in range(3):
            values = np.zeros(n_frames)
            values[: n_frames - shift] = square.diagonal(-shift)
            band[shift * n_free] += np.outer(values, weights).ravel()
    for below in range(n_free):
        block = band[below].reshape(n_frames, n_free)
        block[:, : n_free - below] += normal[:, each[below:], each[: n_free - below]]
    for lag in range(1 - n_free, n_free):
        own = each[max(0, -lag) : n_free - max(0, lag)]
        band[n_free + lag].reshape(n_frames, n_free)[:-1, own] += next_rows[:, own + lag, own]
    found = scipy.linalg.solveh_banded(
        band, right.ravel(), overwrite_ab=True, lower=True, check_finite=False
    )
    return found.reshape(n_frames, n_free)
