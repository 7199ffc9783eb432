"""Hierarchies in motion as animation programs want them: of joints, y up, even in time."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import interpolation, rotations
from courtside.geometry.similarity import kabsch
from courtside.records.devices.hierarchy import (
    NO_PARENT,
    Hierarchy,
    PosedHierarchy,
    at_rest,
    forward,
    still,
)
from courtside.records.keypoints.skeleton import Skeleton

ROOTS = ("waist", "root", "pelvis", "mid_hip", "left_hip")  # the first that a skeleton has
EVEN_S = 5e-5  # ASSUME: harmless; half of what `bvh.write` takes
TINY_M = 1e-9  # a bone shorter than this has no direction
FEEBLE = 1e-6  # weight of a parent's turn: decides only what directions of bones leave open
Y_UP_FROM_Z = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
# Axes to the left, backwards and up (columns) in those of a segment: forwards, up, to the right
Z_UP_IN_SEGMENT = np.array([[0.0, -1, 0], [0, 0, 1], [-1, 0, 0]])


def turned(posed: PosedHierarchy) -> PosedHierarchy:
    """Return the same motion with y up in place of z, in the world and in the pose at rest.

    At rest it stands on the floor at the origin: programs that retarget take the height of the root
    at rest as the size of the body.
    """
    shape, turn = posed.hierarchy, Y_UP_FROM_Z
    ends = {name: turn @ tip for name, tip in shape.ends.items()}
    shape = replace(shape, offsets=shape.offsets @ turn.T, ends=ends)
    places = at_rest(shape)
    tips = [places[shape.joints.index(name)] + tip for name, tip in ends.items()]
    floor_m = np.vstack([places, *tips])[:, 1].min()
    shape.offsets[shape.parents == NO_PARENT] -= [0, floor_m, 0]
    return PosedHierarchy(
        shape, posed.time_s, posed.translation @ turn.T, turn @ posed.parent_from_joint @ turn.T
    )


def rested(posed: PosedHierarchy, rest: NDArray) -> PosedHierarchy:
    """Return the motion of a skeletal model, world z up, with another pose at rest.

    `rest` (J, 3, 3) are the rotations of the segments in their parents in this pose, in which all
    now have the same axes: to the left, backwards and up. Programs that retarget expect a T-pose.
    """
    shape = posed.hierarchy
    in_body = forward(still(shape, rest))[1][0]
    axes = np.swapaxes(in_body, 1, 2) @ Z_UP_IN_SEGMENT
    root = (shape.parents == NO_PARENT)[:, None, None]
    back = np.swapaxes(np.where(root, np.eye(3), axes[shape.parents]), 1, 2)
    ends = {name: axes[shape.joints.index(name)].T @ tip for name, tip in shape.ends.items()}
    offsets = np.einsum("jab,jb->ja", back, shape.offsets)
    places = np.einsum("jab,tjb->tja", back, posed.translation)
    turns = back @ posed.parent_from_joint @ axes
    return PosedHierarchy(replace(shape, offsets=offsets, ends=ends), posed.time_s, places, turns)


def even(posed: PosedHierarchy) -> PosedHierarchy:
    """Return the motion at even times, from the first frame to the last, for BVH.

    The step is the time between two frames. Frames that are missing or off these times are
    interpolated: rotations along the shortest way, places linearly.
    """
    if len(posed.time_s) < 3:
        return posed
    known, step_s = posed.time_s, interpolation.frame_step_s(posed.time_s)
    count = round((known[-1] - known[0]) / step_s) + 1
    time_s = np.linspace(known[0], known[-1], count)
    if count == len(known) and np.abs(time_s - known).max() <= EVEN_S:
        return posed
    turns = rotations.interpolate(known, posed.parent_from_joint, time_s)
    places = interpolation.linear(known, posed.translation, time_s)
    return replace(posed, time_s=time_s, translation=places, parent_from_joint=turns)


class Node(NamedTuple):
    """A node of the tree: at a joint, perhaps only to turn the bone from there to another."""

    name: str
    parent: int
    joint: int
    target: int  # its joint, or where the bone that it turns ends


def of_joints(time_s: NDArray, xyz: NDArray, skeleton: Skeleton) -> PosedHierarchy:
    """Return joints (T, J, 3) as a tree of bones with constant lengths, for sources without axes.

    The tree follows the skeleton's bones from the hips; joints without a bone to them are left out.
    A bone has its median length and points to the measured joint; where several hang on a joint, it
    turns as they do together (Kabsch 1976), and each has a node of its own there (`hip_to_knee`).
    Turns about a bone are not measured: they are its parent's. Missing joints are bridged linearly
    about the root; the bone of one that is never known goes on with its parent. Frames without the
    root are left out. Its rest pose is that of the frame with most joints.
    """
    nodes = _tree(skeleton)
    parents = np.array([node.parent for node in nodes])
    at = np.array([node.joint for node in nodes])
    target = np.array([node.target for node in nodes])
    known = np.isfinite(xyz[:, at[0]]).all(axis=1)
    time_s, xyz = time_s[known], xyz[known]
    above = np.maximum(parents, 0)
    length = np.linalg.norm(xyz[:, target] - xyz[:, at[above]], axis=2)
    median = np.ma.median(np.ma.masked_invalid(length), axis=0).filled(0.0)
    median = np.where(at == target, median, 0.0)
    about = _bridged(time_s, xyz - xyz[:, at[:1]])
    bones = about[:, target] - about[:, at[above]]
    length = np.linalg.norm(bones, axis=2, keepdims=True)
    pointing = np.nan_to_num(bones / np.maximum(length, TINY_M))
    best = _at_rest(pointing, np.isfinite(xyz).all(axis=2).sum(axis=1))
    names = tuple(node.name for node in nodes)
    shape = Hierarchy(names, parents, median[:, None] * best)
    turns = np.tile(np.eye(3), (len(xyz), len(nodes), 1, 1))
    for node in range(len(nodes)):
        ends = np.flatnonzero(parents == node)
        together = np.einsum("tki,kj->tij", pointing[:, ends], best[ends])
        turns[:, node] = kabsch(together + FEEBLE * turns[:, above[node]])[0]
    local = np.swapaxes(turns[:, above], 2, 3) @ turns
    local[:, 0] = turns[:, 0]
    places = np.repeat(shape.offsets[None], len(xyz), axis=0)
    places[:, 0] = xyz[:, at[0]]
    return PosedHierarchy(shape, time_s, places, local)


def _bridged(time_s: NDArray, xyz: NDArray) -> NDArray:
    """Return joints (T, J, 3) without gaps; before the first and after the last known the nearest.

    A joint that is known in fewer than two frames stays as it is.
    """
    bridged = xyz.copy()
    for joint in range(xyz.shape[1]):
        known = np.isfinite(xyz[:, joint]).all(axis=1)
        if known.sum() > 1:
            bridged[:, joint] = interpolation.linear(time_s[known], xyz[known, joint], time_s)
    return bridged


def _at_rest(pointing: NDArray, n_joints: NDArray) -> NDArray:
    """Return the directions (N, 3) of bones in the frame with most joints, else the first known."""
    if not len(pointing):
        return np.zeros(pointing.shape[1:])
    best = pointing[n_joints.argmax()]
    first = np.argmax(pointing.any(axis=2), axis=0)
    return np.where(best.any(axis=1)[:, None], best, pointing[first, np.arange(len(best))])


def _tree(skeleton: Skeleton) -> list[Node]:
    """Return the tree over the skeleton's bones, the root first."""
    root = next(name for name in ROOTS if name in skeleton.joints)
    order, parents = [skeleton.index(root)], [NO_PARENT]
    for place, joint in enumerate(order):  # grows while it is walked
        for bone in skeleton.bone_indices():
            if joint in bone:
                other = bone[0] if bone[1] == joint else bone[1]
                if other not in order:
                    order.append(other)
                    parents.append(place)
    nodes: list[Node] = []
    placed: list[int] = []
    for joint, parent in zip(order, parents, strict=True):
        above, name = placed[parent] if placed else NO_PARENT, skeleton.joints[joint]
        if parents.count(parent) > 1:
            there = order[parent]
            nodes.append(Node(f"{skeleton.joints[there]}_to_{name}", above, there, joint))
            above = len(nodes) - 1
        placed.append(len(nodes))
        nodes.append(Node(name, above, joint, joint))
    return nodes
