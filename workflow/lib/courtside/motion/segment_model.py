"""Where a corrected skeleton's joints lie, and how they move with every parameter of the correction.

Each segment's rotation is corrected in the world, not against its parent: a forearm that carries a sensor
stays as it was when the upper arm, which the device guessed, is turned. For segment i, parameters u, m of
all segments, heading h:

    world_from_segment = H(h) F exp(sum of shares of u) F^-1 measured_i exp(sum of shares of m)

F is the way the body faces: a segment that leans too far forward does so whichever way the body turns.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from courtside.geometry import rotations as rotation_vectors
from courtside.motion import body_segments


@dataclass(frozen=True, eq=False)
class Frames:
    """A skeleton at the times of some frames, before correction.

    Attributes
    ----------
    facing : (N, 3, 3) float
        Turn about the vertical, from the body's heading.
    facing_from_joint : (N, J, 3, 3) float
    translation : (N, J, 3) float
        Of each joint in its parent, metres; a root's in the world.
    velocity : (N, D, 3) float
        Of the observed joints, metres per second: what a shift of the clock does.
    """

    facing: np.ndarray
    facing_from_joint: np.ndarray
    translation: np.ndarray
    velocity: np.ndarray


class Model:
    """The parameters of a correction and the skeleton they give.

    Parameters
    ----------
    hierarchy : courtside.records.hierarchy.Hierarchy
    segments : courtside.motion.body_segments.Segments
    observed : sequence of int, length D
        Indices of the joints that vision sees.
    up : (3,) float
        Unit vector of the vertical in the device's world.

    Notes
    -----
    Per frame, `slow` (P,) holds a rotation vector per segment, the heading and the root's shift; `fixed`
    (Q,) a rotation vector per segment, the logarithms of stretches, an offset per observed joint in the
    axes of its parent and one in vision's, the frame's tilt (rotation vector) and shift, and the clock's
    shift in seconds.
    """

    def __init__(self, hierarchy, segments, observed, up):
        self.parents = np.asarray(hierarchy.parents)
        self.segments, self.observed = segments, list(observed)
        self.up = np.asarray(up, float)
        n, d = len(segments.names), len(self.observed)
        self.slow = _layout({"turn": 3 * n, "heading": 1, "shift": 3})
        sizes = {"mount": 3 * n, "stretch": len(segments.stretches), "offset": 3 * d}
        self.fixed = _layout(sizes | {"bias": 3 * d, "tilt": 3, "place": 3, "lag": 1})
        self.n_slow, self.n_fixed = (layout["n"] for layout in (self.slow, self.fixed))
        self.paths = [body_segments.path(hierarchy, joint) for joint in self.observed]
        self.owner = self._owners()

    def _owners(self):
        owner = np.arange(len(self.parents))
        for joint, parent in enumerate(self.parents):
            if parent >= 0 and not self.segments.turned[joint]:
                owner[joint] = owner[parent]
        return owner

    def orient(self, frames, slow, fixed):
        """Return corrected world rotations (N, J, 3, 3).

        Parameters
        ----------
        frames : Frames
        slow : (N, P) float
        fixed : (Q,) float
        """
        turn, mount, heading = self._turns(slow, fixed)
        outer = (heading @ frames.facing)[:, None] @ rotation_vectors.matrices_from_vectors(turn)
        found = outer @ frames.facing_from_joint @ rotation_vectors.matrices_from_vectors(mount)
        for joint, owner in enumerate(self.owner):
            if owner != joint:
                measured = frames.facing_from_joint[:, owner].swapaxes(1, 2)
                found[:, joint] = found[:, owner] @ measured @ frames.facing_from_joint[:, joint]
        return found

    def stretches(self, fixed):
        """Return the factor on the bone that ends at each joint, (J,)."""
        return np.exp(self.segments.stretch @ fixed[self.fixed["stretch"]])

    def _turns(self, slow, fixed):
        turn = slow[:, self.slow["turn"]].reshape(len(slow), -1, 3)
        turn = np.einsum("jg,ngi->nji", self.segments.share, turn)
        mount = self.segments.share @ fixed[self.fixed["mount"]].reshape(-1, 3)
        return (
            turn,
            mount,
            rotation_vectors.matrices_from_vectors(slow[:, self.slow["heading"]] * self.up),
        )

    def places(self, frames, slow, fixed):
        """Return where vision should see the joints, (N, D, 3) metres.

        Parameters
        ----------
        frames : Frames
        slow : (N, P) float
        fixed : (Q,) float
        """
        world = self.orient(frames, slow, fixed)
        offsets = fixed[self.fixed["offset"]].reshape(-1, 3)
        factor = self.stretches(fixed)
        xyz = np.zeros((len(slow), len(self.observed), 3))
        for row, path in enumerate(self.paths):
            for parent, joint in pairwise(path):
                bone = factor[joint] * frames.translation[:, joint]
                xyz[:, row] += _turned(world[:, parent], bone + offsets[row] * (joint == path[-1]))
        xyz += (frames.translation[:, self.paths[0][0]] + slow[:, self.slow["shift"]])[:, None]
        tilt = rotation_vectors.matrices_from_vectors(fixed[self.fixed["tilt"]])
        return xyz @ tilt.T + self._shift(fixed)

    def linear(self, frames, slow, fixed):
        """Return where vision should see the joints, and the derivatives.

        Parameters
        ----------
        frames : Frames
        slow : (N, P) float
        fixed : (Q,) float

        Returns
        -------
        xyz : (N, D, 3) float
            Metres.
        by_slow, by_fixed : (N, D, 3, P), (N, D, 3, Q) float
        """
        n = len(slow)
        xyz = np.zeros((n, len(self.observed), 3))
        by_slow = np.zeros((*xyz.shape, self.n_slow))
        by_fixed = np.zeros((*xyz.shape, self.n_fixed))
        world = self.orient(frames, slow, fixed)
        inner = self._levers(frames, slow, fixed)
        offsets = fixed[self.fixed["offset"]].reshape(-1, 3)
        factor = self.stretches(fixed)
        for row, path in enumerate(self.paths):
            for parent, joint in pairwise(path):
                last = joint == path[-1]
                bone = factor[joint] * frames.translation[:, joint]
                arm = _turned(world[:, parent], bone + offsets[row] * last)
                xyz[:, row] += arm
                self._add_turns(by_slow[:, row], by_fixed[:, row], self.owner[parent], arm, inner)
                stretched = (
                    _turned(world[:, parent], bone)[..., None] * self.segments.stretch[joint]
                )
                by_fixed[:, row, :, self.fixed["stretch"]] += stretched
                if last:
                    start = self.fixed["offset"].start + 3 * row
                    by_fixed[:, row, :, start : start + 3] = world[:, parent]
            by_slow[:, row, :, self.slow["heading"]] = np.cross(self.up, xyz[:, row])[..., None]
        root = frames.translation[:, self.paths[0][0]] + slow[:, self.slow["shift"]]
        xyz += root[:, None]
        by_slow[..., self.slow["shift"]] = np.eye(3)
        return self._in_view(frames, xyz, by_slow, by_fixed, fixed)

    def _levers(self, frames, slow, fixed):
        """Return, per joint, what turns a change of its vectors into a small rotation in the world."""
        turn, mount, heading = self._turns(slow, fixed)
        facing = (heading @ frames.facing)[:, None]
        outer = facing @ rotation_vectors.left_jacobians(turn)
        measured = facing @ rotation_vectors.matrices_from_vectors(turn) @ frames.facing_from_joint
        return outer, measured @ rotation_vectors.left_jacobians(mount)

    def _add_turns(self, by_slow, by_fixed, joint, arm, inner):
        cross = -rotation_vectors.cross_matrices(arm)
        turns, mounts = (cross @ lever[:, joint] for lever in inner)
        for segment in np.flatnonzero(self.segments.share[joint]):
            part = self.segments.share[joint, segment]
            start = 3 * segment
            by_slow[:, :, start : start + 3] += part * turns
            by_fixed[:, :, start : start + 3] += part * mounts

    def _in_view(self, frames, xyz, by_slow, by_fixed, fixed):
        tilt = fixed[self.fixed["tilt"]]
        turned = rotation_vectors.matrices_from_vectors(tilt)
        by_fixed[..., self.fixed["lag"]] = frames.velocity[..., None]
        xyz, by_slow, by_fixed = xyz @ turned.T, turned @ by_slow, turned @ by_fixed
        by_fixed[..., self.fixed["tilt"]] = -rotation_vectors.cross_matrices(
            xyz
        ) @ rotation_vectors.left_jacobians(tilt)
        by_fixed[..., self.fixed["place"]] = np.eye(3)
        for row in range(len(self.observed)):
            start = self.fixed["bias"].start + 3 * row
            by_fixed[:, row, :, start : start + 3] = np.eye(3)
        return xyz + self._shift(fixed), by_slow, by_fixed

    def _shift(self, fixed):
        return fixed[self.fixed["place"]] + fixed[self.fixed["bias"]].reshape(-1, 3)


def _turned(rotations, vectors):
    return np.einsum("nij,nj->ni", rotations, vectors)


def _layout(sizes):
    found, at = {}, 0
    for name, size in sizes.items():
        found[name] = slice(at, at + size)
        at += size
    return found | {"n": at}
