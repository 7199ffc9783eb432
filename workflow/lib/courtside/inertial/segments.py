"""Segments of an inertial skeleton: their lengths, and how joints depend on them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.records.devices.hierarchy import Hierarchy
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

Shares = dict[str, list[tuple[int, float]]]  # per segment: joints and their shares in it
SIDES = ("left", "right")


@dataclass(frozen=True, eq=False)
class Frames:
    """A skeleton at the times of some frames, before correction."""

    facing: NDArray  # (N, 3, 3): turn about the vertical, from the body's heading
    facing_from_joint: NDArray  # (N, J, 3, 3)
    translation: NDArray  # (N, J, 3): of each joint in its parent, metres; a root's in the world
    velocity: NDArray  # (N, D, 3): of the observed joints, m/s: the effect of a clock shift


class Model:
    """The parameters of a correction and the skeleton they give.

    `observed` (D,) are the indices of the joints that vision sees, `up` (3,) the unit vector of the
    vertical in the device's world.

    Per frame, `slow` (P,) holds a rotation vector per segment, the heading and the root's shift.
    `fixed` (Q,) holds a rotation vector per segment, the logarithms of stretches, an offset per
    observed joint in the axes of its parent, the frame's tilt (rotation vector) and shift, and the
    clock's shift in seconds. The methods take `slow` as (N, P).
    """

    def __init__(
        self, hierarchy: Hierarchy, segments: Segments, observed: Iterable[int], up: NDArray
    ) -> None:
        self.parents = np.asarray(hierarchy.parents)
        self.segments, self.observed = segments, list(observed)
        self.up = np.asarray(up, float)
        n, d = len(segments.names), len(self.observed)
        self.slow, self.n_slow = _layout({"turn": 3 * n, "heading": 1, "shift": 3})
        sizes = {"mount": 3 * n, "stretch": len(segments.stretches), "offset": 3 * d}
        sizes |= {"tilt": 3, "place": 3, "lag": 1}
        self.fixed, self.n_fixed = _layout(sizes)
        self.paths = [path(hierarchy, joint) for joint in self.observed]
        self.owner = self._owners()

    def _owners(self) -> NDArray:
        owner = np.arange(len(self.parents))
        for joint, parent in enumerate(self.parents):
            if parent >= 0 and not self.segments.turned[joint]:
                owner[joint] = owner[parent]
        return owner

    def orient(self, frames: Frames, slow: NDArray, fixed: NDArray) -> NDArray:
        """Return corrected world rotations (N, J, 3, 3)."""
        turn, mount, heading = self._turns(slow, fixed)
        outer = (heading @ frames.facing)[:, None] @ rotations.rotation_from_rodrigues(turn)
        found = outer @ frames.facing_from_joint @ rotations.rotation_from_rodrigues(mount)
        for joint, owner in enumerate(self.owner):
            if owner != joint:
                measured = frames.facing_from_joint[:, owner].swapaxes(1, 2)
                found[:, joint] = found[:, owner] @ measured @ frames.facing_from_joint[:, joint]
        return found

    def stretches(self, fixed: NDArray) -> NDArray:
        """Return the factor on the bone that ends at each joint, (J,)."""
        return np.exp(self.segments.stretch @ fixed[self.fixed["stretch"]])

    def _turns(self, slow: NDArray, fixed: NDArray) -> tuple[NDArray, NDArray, NDArray]:
        turn = slow[:, self.slow["turn"]].reshape(len(slow), -1, 3)
        turn = np.einsum("jg,ngi->nji", self.segments.share, turn)
        mount = self.segments.share @ fixed[self.fixed["mount"]].reshape(-1, 3)
        heading = rotations.rotation_from_rodrigues(slow[:, self.slow["heading"]] * self.up)
        return turn, mount, heading

    def places(self, frames: Frames, slow: NDArray, fixed: NDArray) -> NDArray:
        """Return the joints as vision is expected to see them, (N, D, 3) metres."""
        world = self.orient(frames, slow, fixed)
        offsets = fixed[self.fixed["offset"]].reshape(-1, 3)
        factor = self.stretches(fixed)
        xyz = np.zeros((len(slow), len(self.observed), 3))
        for row, path in enumerate(self.paths):
            for parent, joint in pairwise(path):
                bone = factor[joint] * frames.translation[:, joint]
                xyz[:, row] += _turned(world[:, parent], bone + offsets[row] * (joint == path[-1]))
        xyz += (frames.translation[:, self.paths[0][0]] + slow[:, self.slow["shift"]])[:, None]
        tilt = rotations.rotation_from_rodrigues(fixed[self.fixed["tilt"]])
        return xyz @ tilt.T + fixed[self.fixed["place"]]

    def linear(
        self, frames: Frames, slow: NDArray, fixed: NDArray
    ) -> tuple[NDArray, NDArray, NDArray]:
        """Return `places` (N, D, 3), and its derivatives (N, D, 3, P) and (N, D, 3, Q)."""
        n = len(slow)
        xyz = np.zeros((n, len(self.observed), 3))
        by_slow = np.zeros((*xyz.shape, self.n_slow))
        by_fixed = np.zeros((*xyz.shape, self.n_fixed))
        world = self.orient(frames, slow, fixed)
        levers = self._levers(frames, slow, fixed)
        offsets = fixed[self.fixed["offset"]].reshape(-1, 3)
        factor = self.stretches(fixed)
        for row, path in enumerate(self.paths):
            for parent, joint in pairwise(path):
                last = joint == path[-1]
                bone = factor[joint] * frames.translation[:, joint]
                arm = _turned(world[:, parent], bone + offsets[row] * last)
                xyz[:, row] += arm
                self._add_turns(by_slow[:, row], by_fixed[:, row], self.owner[parent], arm, levers)
                along = _turned(world[:, parent], bone)[..., None]
                by_fixed[:, row, :, self.fixed["stretch"]] += along * self.segments.stretch[joint]
                if last:
                    start = self.fixed["offset"].start + 3 * row
                    by_fixed[:, row, :, start : start + 3] = world[:, parent]
            by_slow[:, row, :, self.slow["heading"]] = np.cross(self.up, xyz[:, row])[..., None]
        root = frames.translation[:, self.paths[0][0]] + slow[:, self.slow["shift"]]
        xyz += root[:, None]
        by_slow[..., self.slow["shift"]] = np.eye(3)
        return self._in_view(frames, xyz, by_slow, by_fixed, fixed)

    def _levers(self, frames: Frames, slow: NDArray, fixed: NDArray) -> tuple[NDArray, NDArray]:
        """Return the left Jacobians (N, J, 3, 3) of turn and mount per joint, in the world."""
        turn, mount, heading = self._turns(slow, fixed)
        facing = (heading @ frames.facing)[:, None]
        outer = facing @ rotations.left_jacobians(turn)
        measured = facing @ rotations.rotation_from_rodrigues(turn) @ frames.facing_from_joint
        return outer, measured @ rotations.left_jacobians(mount)

    def _add_turns(
        self,
        by_slow: NDArray,
        by_fixed: NDArray,
        joint: int,
        arm: NDArray,
        levers: tuple[NDArray, NDArray],
    ) -> None:
        cross = -rotations.cross_matrices(arm)
        turns, mounts = (cross @ lever[:, joint] for lever in levers)
        for segment in np.flatnonzero(self.segments.share[joint]):
            part = self.segments.share[joint, segment]
            start = 3 * segment
            by_slow[:, :, start : start + 3] += part * turns
            by_fixed[:, :, start : start + 3] += part * mounts

    def _in_view(
        self, frames: Frames, xyz: NDArray, by_slow: NDArray, by_fixed: NDArray, fixed: NDArray
    ) -> tuple[NDArray, NDArray, NDArray]:
        tilt = fixed[self.fixed["tilt"]]
        turned = rotations.rotation_from_rodrigues(tilt)
        by_fixed[..., self.fixed["lag"]] = frames.velocity[..., None]
        xyz, by_slow, by_fixed = xyz @ turned.T, turned @ by_slow, turned @ by_fixed
        lever = rotations.left_jacobians(tilt)
        by_fixed[..., self.fixed["tilt"]] = -rotations.cross_matrices(xyz) @ lever
        by_fixed[..., self.fixed["place"]] = np.eye(3)
        return xyz + fixed[self.fixed["place"]], by_slow, by_fixed


def _turned(matrices: NDArray, vectors: NDArray) -> NDArray:
    return np.einsum("nij,nj->ni", matrices, vectors)


def _layout(sizes: Mapping[str, int]) -> tuple[dict[str, slice], int]:
    """Return where each parameter stands in a vector of all, and the vector's length."""
    found, at = {}, 0
    for name, size in sizes.items():
        found[name] = slice(at, at + size)
        at += size
    return found, at


@dataclass(frozen=True, eq=False)
class Segments:
    """How corrections of segments act on the joints of a skeleton."""

    names: tuple[str, ...]  # length G: `pelvis`, `thorax`, `left_clavicle` and the like
    # (J, G): share of a segment's correction that a joint's frame takes; joints whose row is zero
    # keep their rotation against their parent.
    share: NDArray
    # Length B: `body` (all bones), `upper_arm` (both sides), `upper_arm difference` (left minus
    # right, halved) and the like.
    stretches: tuple[str, ...]
    # (J, B): share of each in the logarithm of the factor on the bone that ends at a joint.
    stretch: NDArray

    @property
    def turned(self) -> NDArray:
        """(J,) bool: joints whose frame is corrected itself, not only carried along."""
        return np.any(self.share, axis=1)


def path(hierarchy: Hierarchy, joint: int) -> list[int]:
    """Return the indices of joints from the root to `joint`, both included."""
    found = [joint]
    while hierarchy.parents[found[0]] >= 0:
        found.insert(0, int(hierarchy.parents[found[0]]))
    return found


def segments_of(hierarchy: Hierarchy, where: str = "skeleton") -> Segments:
    """Find the segments of a skeleton that names its limbs' joints as the study does.

    It holds the 12 limb joints (`skeleton.JOINTS`), and between the root and the shoulders any
    number of joints of the spine and clavicles. The spine's joints share the corrections of pelvis
    and thorax by their place between them. `where` begins error messages. An `InputError` if a
    joint is missing or is not below its expected parent.
    """
    joints = list(hierarchy.joints)
    missing = [name for name in skeleton.JOINTS if name not in joints]
    if missing:
        raise InputError(
            f"{where}: expected a joint {missing[0]}, found {', '.join(joints[:8])}, ...; "
            "name its joints by a map of config/skeletons"
        )
    paths = {name: path(hierarchy, joints.index(name)) for name in skeleton.JOINTS}
    parts = _trunk(paths) | _limbs(paths, joints, where)
    stretches = _stretches(paths, joints)
    share, stretch = (_matrix(shares, len(joints)) for shares in (parts, stretches))
    return Segments(tuple(parts), share, tuple(stretches), stretch)


def _matrix(shares: Shares, n_joints: int) -> NDArray:
    matrix = np.zeros((n_joints, len(shares)))
    for column, members in enumerate(shares.values()):
        for joint, share in members:
            matrix[joint, column] = share
    return matrix


def _spine(paths: Mapping[str, list[int]]) -> list[int]:
    """Return the joints from the root to the last common one of both shoulders."""
    both = zip(paths["left_shoulder"], paths["right_shoulder"], strict=False)
    return [left for left, right in both if left == right]


def _trunk(paths: Mapping[str, list[int]]) -> Shares:
    spine = _spine(paths)
    along = np.linspace(0, 1, len(spine)) if len(spine) > 1 else np.zeros(1)
    parts: Shares = {}
    parts["pelvis"] = [(joint, 1 - part) for joint, part in zip(spine, along, strict=True)]
    if len(spine) > 1:
        parts["thorax"] = list(zip(spine, along, strict=True))
    for side in SIDES:
        girdle = paths[f"{side}_shoulder"][len(spine) : -1]
        if girdle:
            parts[f"{side}_clavicle"] = [(joint, 1.0) for joint in girdle]
    return parts


def _limbs(paths: Mapping[str, list[int]], joints: list[str], where: str) -> Shares:
    parts = {}
    for side in SIDES:
        for name, (start, stop) in skeleton.SEGMENTS.items():
            start, stop = f"{side}_{start}", f"{side}_{stop}"
            if joints.index(start) not in paths[stop]:
                raise InputError(
                    f"{where}: expected {stop} below {start}, found it below "
                    f"{joints[paths[stop][-2]]}; mend the map of joint names"
                )
            below = paths[stop][len(paths[start]) - 1 : -1]
            parts[f"{side}_{name}"] = [(joint, 1.0) for joint in below]
    return parts


def _stretches(paths: Mapping[str, list[int]], joints: list[str]) -> Shares:
    spine = _spine(paths)
    found = {"body": [(joint, 1.0) for joint in range(len(joints))]}
    found["trunk"] = [(joint, 1.0) for joint in spine[1:]]
    limbs = skeleton.SEGMENTS
    bones = {"girdle": len(spine), "pelvis": 1} | dict.fromkeys(limbs)
    ends = {"girdle": "shoulder", "pelvis": "hip"} | {name: limbs[name][1] for name in limbs}
    for name, end in ends.items():
        members = {}
        for side in SIDES:
            first = bones[name] or len(paths[f"{side}_{limbs[name][0]}"])
            members[side] = paths[f"{side}_{end}"][first:]
        found[name] = [(joint, 1.0) for side in SIDES for joint in members[side]]
        found[f"{name} difference"] = [(j, 0.5) for j in members["left"]]
        found[f"{name} difference"] += [(j, -0.5) for j in members["right"]]
    return found
