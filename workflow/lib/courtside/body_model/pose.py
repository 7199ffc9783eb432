"""Poses of the model: forward kinematics and derivatives, over all frames at once."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.body_model.segments import BALL, Model
from courtside.geometry import rotations


@dataclass(frozen=True, eq=False)
class Pose:
    """Motion of the model over T frames."""

    root: NDArray  # (T, 3) m: the pelvis' origin
    local: NDArray  # (S, T, 3, 3): each segment's rotation in its parent
    angle: NDArray  # (T, D) rad: coordinates of hinges; others unused

    def frames(self, at: slice) -> "Pose":
        """Return some frames."""
        return Pose(self.root[at], self.local[:, at], self.angle[at])


def about(axis: int, angle: NDArray) -> NDArray:
    """Return rotations (T, 3, 3) about a coordinate axis by angles (T,)."""
    found = np.tile(np.eye(3), (len(angle), 1, 1))
    one, other = (axis + 1) % 3, (axis + 2) % 3
    found[:, one, one] = found[:, other, other] = np.cos(angle)
    found[:, other, one] = np.sin(angle)
    found[:, one, other] = -found[:, other, one]
    return found


def hinged(model: Model, angle: NDArray, local: NDArray) -> NDArray:
    """Return rotations (S, T, 3, 3) whose hinges stand at angles (T, D)."""
    local = local.copy()
    for at, joint in enumerate(model.joints):
        if joint.kind != BALL:
            first = model.first[at]
            pair = [about(axis, angle[:, first + k]) for k, axis in enumerate(joint.axes)]
            local[at] = pair[0] @ pair[1]
    return local


def moved(model: Model, pose: Pose, step: NDArray) -> Pose:
    """Return a pose after steps (T, D): metres of the root, rotation vectors, angles."""
    angle, local = pose.angle + step, pose.local.copy()
    for at, joint in enumerate(model.joints):
        if joint.kind == BALL:
            first = model.first[at]
            turn = rotations.rotation_from_rodrigues(step[:, first : first + 3])
            local[at] = pose.local[at] @ turn
    return replace(
        pose, root=pose.root + step[:, :3], local=hinged(model, angle, local), angle=angle
    )


def forward(model: Model, pose: Pose, offsets: NDArray) -> tuple[NDArray, NDArray]:
    """Return the segments' origins (S, T, 3) m and rotations (S, T, 3, 3) in the world.

    `offsets` (S, 3) m are the origins in the parents.
    """
    turned, origin = np.empty_like(pose.local), np.empty(pose.local.shape[:3])
    for at, parent in enumerate(model.parents):
        if parent < 0:
            turned[at], origin[at] = pose.local[at], pose.root
        else:
            turned[at] = turned[parent] @ pose.local[at]
            origin[at] = origin[parent] + turned[parent] @ offsets[at]
    return origin, turned


def placed(origin: NDArray, turned: NDArray, segment_of: NDArray, places: NDArray) -> NDArray:
    """Return the points (T, J, 3) m at places (J, 3) of their segments (J,)."""
    points = origin[segment_of] + np.einsum("jtab,jb->jta", turned[segment_of], places)
    return np.moveaxis(points, 0, 1)


def axes(model: Model, turned: NDArray) -> NDArray:
    """Return the world's axes (T, D, 3) about which degrees of freedom turn; zero of places."""
    found = np.zeros((turned.shape[1], len(model.sigma), 3))
    for at, joint in enumerate(model.joints):
        first = model.first[at]
        if joint.kind == BALL:
            found[:, first : first + 3] = np.swapaxes(turned[at], 1, 2)
        else:  # the first axis stands in the parent, the second in the segment
            found[:, first] = turned[model.parents[at]][:, :, joint.axes[0]]
            found[:, first + 1] = turned[at][:, :, joint.axes[1]]
    return found


def derivatives(
    model: Model, origin: NDArray, turned: NDArray, points: NDArray, segment_of: NDArray
) -> NDArray:
    """Return the derivatives (T, J, 3, D) of points (T, J, 3) by the steps of `moved`."""
    found = np.zeros((*points.shape[:2], len(model.sigma), 3))
    found[:, :, :3] = np.eye(3)
    world = axes(model, turned)
    for at, joint in enumerate(model.joints):
        own = slice(model.first[at], model.first[at] + len(joint.coordinates))
        below = np.flatnonzero(model.moves[own.start, segment_of])
        arm = points[:, below] - origin[at][:, None]
        found[:, below, own] = np.cross(world[:, None, own], arm[:, :, None])
    return np.swapaxes(found, 2, 3)


def coordinates(model: Model, pose: Pose) -> tuple[NDArray, NDArray]:
    """Return the coordinates (T, D) rad, and blocks (S, T, 3, 3) of their derivatives for balls.

    Of a ball joint: the rotation vector from its rest, in the segment's axes. Those of the root are
    zero.
    """
    found, blocks = pose.angle.copy(), np.tile(np.eye(3), (*pose.local.shape[:2], 1, 1))
    found[:, :6] = 0.0
    for at, joint in enumerate(model.joints):
        if joint.kind == BALL and at > 0:
            vector = rotations.rodrigues_from_rotation(model.rest[at].T @ pose.local[at])
            first = model.first[at]
            found[:, first : first + 3] = vector
            blocks[at] = np.linalg.inv(rotations.left_jacobians(-vector))
    return found, blocks
