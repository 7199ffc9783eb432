"""BVH: joints and rotations, for animation programs and the readers of mocopi's files."""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import atomic

INDENT = "  "
ORDER, UNIT_M = "ZXY", 0.01  # of rotations; of lengths
NO_TIP = np.zeros(3)
EVEN_S = 1e-4  # deviation of a frame from an even grid: BVH has one frame time. ASSUME: harmless


def write(path: StrPath, posed: PosedHierarchy, *, only_root_moves: bool = False) -> None:
    """Write a posed hierarchy with one root, its frames even in time.

    Every joint gets six channels, as in mocopi's files: its position in its parent, cm, then its
    rotation R = Rz Rx Ry, with six decimals each. With `only_root_moves` other joints have the
    rotation alone and stay at their offsets, and the root's offset is zero: some programs
    (three.js) add a position to the offset, others (Blender, bvhio) put it in its place. Joints
    stand depth first, each chain to its end. BVH has no start time: the first frame's time is lost.
    A joint at the end of a chain without a tip gets one of length zero, because many readers
    require one. If the middle angle is 90 degrees the other two are not unique; the last is then
    zero. Raises `InputError` if a value is missing, two joints have one name, a name is blank or
    has blanks in it, or the frames are not even in time, `ValueError` if there is not one root at
    the front.
    """
    shape = posed.hierarchy
    if list(shape.parents).count(NO_PARENT) != 1:
        raise ValueError(f"expected one root, found parents {shape.parents}")
    frame_time_s = _check(path, posed)
    sequence = _depth_first(shape.parents)
    placed = sequence
    if only_root_moves:
        placed, root = sequence[:1], shape.parents == NO_PARENT
        shape = replace(shape, offsets=np.where(root[:, None], 0.0, shape.offsets))
    head = ["HIERARCHY", *_lines(shape, sequence, placed), "MOTION"]
    head += [f"Frames: {len(posed.time_s)}", f"Frame Time: {frame_time_s:.9g}"]
    values = np.concatenate(
        [posed.translation / UNIT_M, _angles_deg(posed.parent_from_joint)], axis=-1
    )
    columns = [values[:, joint, 0 if joint in placed else 3 :] for joint in sequence]
    rows = np.concatenate(columns, axis=1)
    with atomic(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as stream:
        stream.write("\n".join(head) + "\n")
        np.savetxt(stream, rows, fmt="%.6f")


def _check(path: StrPath, posed: PosedHierarchy) -> float:
    """Check what BVH can hold; return the frame time, zero without two frames."""
    joints = posed.hierarchy.joints
    bad = [name for at, name in enumerate(joints) if name.split() != [name] or name in joints[:at]]
    if bad:
        raise InputError(
            f"{path}: expected names of joints that differ, without blanks, found {bad[0]!r}; "
            "rename it"
        )
    whole = np.isfinite(posed.translation).all(axis=2)
    whole &= np.isfinite(posed.parent_from_joint).all(axis=(2, 3))
    if not whole.all():
        frame, joint = np.argwhere(~whole)[0]
        raise InputError(
            f"{path}: expected a place and a rotation of every joint in every frame, found none of "
            f"{joints[joint]!r} in frame {frame}; BVH cannot hold gaps: fill them first"
        )
    time_s = posed.time_s
    if len(time_s) < 2:
        return 0.0
    frame_time_s = (time_s[-1] - time_s[0]) / (len(time_s) - 1)
    away = np.abs(time_s - time_s[0] - np.arange(len(time_s)) * frame_time_s).max()
    if not (away <= EVEN_S and frame_time_s > 0):
        raise InputError(
            f"{path}: expected frames even in time within {EVEN_S * 1000:g} ms, found one "
            f"{away * 1000:.3g} ms away; resample them first"
        )
    return float(frame_time_s)


def _depth_first(parents: NDArray) -> list[int]:
    """Return the joints in BVH's order: each chain to its end."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(parents):
        children.setdefault(int(parent), []).append(joint)
    waiting = list(children[NO_PARENT])
    sequence: list[int] = []
    while waiting:
        sequence.append(waiting.pop())
        waiting += reversed(children.get(sequence[-1], []))
    return sequence


def _lines(shape: Hierarchy, sequence: Sequence[int], placed: Sequence[int]) -> Iterator[str]:
    """Yield the lines of the hierarchy."""
    turns = " ".join(f"{axis}rotation" for axis in ORDER)
    inner = set(shape.parents.tolist())
    open_joints: list[int] = []
    for joint in sequence:
        while open_joints and open_joints[-1] != shape.parents[joint]:
            open_joints.pop()
            yield INDENT * len(open_joints) + "}"
        indent = INDENT * len(open_joints)
        yield f"{indent}{'JOINT' if open_joints else 'ROOT'} {shape.joints[joint]}"
        yield f"{indent}{{"
        yield f"{indent}{INDENT}OFFSET {_three(shape.offsets[joint] / UNIT_M)}"
        channels = f"6 Xposition Yposition Zposition {turns}" if joint in placed else f"3 {turns}"
        yield f"{indent}{INDENT}CHANNELS {channels}"
        open_joints.append(joint)
        if joint not in inner or shape.joints[joint] in shape.ends:
            tip = shape.ends.get(shape.joints[joint], NO_TIP) / UNIT_M
            yield from (f"{indent}{INDENT}{line}" for line in ("End Site", "{"))
            yield f"{indent}{INDENT * 2}OFFSET {_three(tip)}"
            yield f"{indent}{INDENT}}}"
    while open_joints:
        open_joints.pop()
        yield INDENT * len(open_joints) + "}"


def _three(values: NDArray) -> str:
    return " ".join(f"{value:.6f}" for value in values)


def _angles_deg(rotations: NDArray) -> NDArray:
    """Return the angles of (T, J, 3, 3) rotations in their channels' order, (T, J, 3) degrees.

    Programs interpolate each channel alone. Of all angles of the same rotation those nearest to the
    frame before are taken, also beyond 180 degrees.
    """
    if not len(rotations):
        return np.empty(rotations.shape[:3])
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock", category=UserWarning)
        turns = scipy.spatial.transform.Rotation.from_matrix(rotations.reshape(-1, 3, 3))
        angles = turns.as_euler(ORDER, degrees=True).reshape(rotations.shape[:3])
    same = np.stack([angles, angles * [1, -1, 1] + 180])  # Tait-Bryan angles have these two
    for frame in range(1, len(angles)):
        before = angles[frame - 1]
        near = before + (same[:, frame] - before + 180) % 360 - 180
        first = np.abs(near - before).sum(axis=-1).argmin(axis=0)
        angles[frame] = near[first, np.arange(len(first))]
    return angles
