"""GLB (glTF 2.0, binary): a tree of joints in motion, with a skin of sticks, for 3D programs.

As the glTF 2.0 specification of the Khronos Group has nodes, skins, animations and binary files.
"""

import json
import struct
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.records.devices.hierarchy import NO_PARENT, PosedHierarchy, at_rest
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import atomic

MAGIC, VERSION = b"glTF", 2
FLOAT, SHORT = 5126, 5123  # component types: float32, uint16
VERTICES = 34962  # target of buffer views of a mesh
THICK = 0.12  # width of a stick, of its length
THIN_M, WIDE_M = 0.01, 0.05  # least and largest width
CONSTANT_M = 1e-6  # a joint that moves less in its parent needs no keys
WAIST = 0.2  # where a stick is widest, of its length
# A stick of length 1 along y, with six corners and eight faces.
CORNERS = [(0, 0, 0), (0.5, WAIST, 0), (0, WAIST, 0.5), (-0.5, WAIST, 0), (0, WAIST, -0.5)]
CORNERS += [(0, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1), (5, 2, 1), (5, 3, 2), (5, 4, 3), (5, 1, 4)]
LOOK = {"baseColorFactor": [0.85, 0.4, 0.1, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}
TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


def write(path: StrPath, posed: PosedHierarchy, name: str, zero_s: float | None = None) -> None:
    """Write a posed hierarchy, y up, as one animation called `name`.

    Each joint is a node: its offset, rotations as keys at the frames' times, translations as keys
    where they change (the root's). Times are those after `zero_s`, by default the first frame's;
    `extras` of the animation has the first frame's own (`start_s`). Between keys viewers
    interpolate, across missing frames too. Raises `InputError` if a value is missing, or times do
    not increase; without frames there is the pose at rest alone.
    """
    _check(path, posed)
    made: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "courtside"},
        "scene": 0,
        "scenes": [{"nodes": [len(posed.hierarchy.joints)]}],
        "nodes": [],
        "materials": [{"pbrMetallicRoughness": dict(LOOK)}],
        "accessors": [],
        "bufferViews": [],
    }
    binary = bytearray()
    _nodes(made, posed, name)
    _sticks(made, binary, posed)
    if len(posed.time_s):
        _animation(made, binary, posed, name, posed.time_s[0] if zero_s is None else zero_s)
    made["buffers"] = [{"byteLength": len(binary)}] if binary else []
    made = {key: value for key, value in made.items() if value != []}  # glTF has no empty lists
    text = json.dumps(made, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = [(b"JSON", text), *([(b"BIN\0", bytes(binary))] if binary else [])]
    size = 12 + sum(8 + len(content) for _, content in chunks)
    with atomic(path) as temporary, temporary.open("wb") as stream:
        stream.write(struct.pack("<4sII", MAGIC, VERSION, size))
        for kind, content in chunks:
            stream.write(struct.pack("<I4s", len(content), kind) + content)


def _check(path: StrPath, posed: PosedHierarchy) -> None:
    whole = np.isfinite(posed.translation).all() and np.isfinite(posed.parent_from_joint).all()
    if not (whole and (np.diff(posed.time_s) > 0).all()):
        raise InputError(
            f"{path}: expected frames at increasing times with a place and a rotation of every "
            f"joint, found {len(posed.time_s)} frames{'' if whole else ' with gaps'}; leave out "
            "frames without"
        )


def _nodes(made: dict[str, Any], posed: PosedHierarchy, name: str) -> None:
    """Add a node for each joint, in their order, as in the first frame, and one above them."""
    for joint, called in enumerate(posed.hierarchy.joints):
        place = posed.hierarchy.offsets[joint].tolist()
        made["nodes"].append({"name": called, "translation": place})
    if len(posed.time_s):
        turns = _quaternions(posed.parent_from_joint[:1])[0]
        for node, place, turn in zip(made["nodes"], posed.translation[0], turns, strict=True):
            node |= {"translation": place.tolist(), "rotation": turn.tolist()}
    for joint, parent in enumerate(posed.hierarchy.parents.tolist()):
        if parent != NO_PARENT:
            made["nodes"][parent].setdefault("children", []).append(joint)
    roots = np.flatnonzero(posed.hierarchy.parents == NO_PARENT).tolist()
    made["nodes"].append({"name": name, "children": roots})


def _sticks(made: dict[str, Any], binary: bytearray, posed: PosedHierarchy) -> None:
    """Add a stick for each bone and each tip: one mesh, skinned to the joints where they begin."""
    shape = posed.hierarchy
    rest = at_rest(shape)
    bones = [
        (int(parent), shape.offsets[joint])
        for joint, parent in enumerate(shape.parents)
        if parent != NO_PARENT
    ]
    bones += [(shape.joints.index(name), tip) for name, tip in shape.ends.items()]
    bones = [(joint, bone) for joint, bone in bones if np.linalg.norm(bone) > CONSTANT_M]
    if not bones:
        return
    # Every face has corners of its own, so that its normal is flat.
    corners = np.concatenate([rest[joint] + _stick(bone) for joint, bone in bones])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.repeat(normals / np.linalg.norm(normals, axis=1, keepdims=True), 3, axis=0)
    owners = np.zeros((len(normals), 4), dtype="<u2")
    owners[:, 0] = np.repeat([joint for joint, _ in bones], len(normals) // len(bones))
    values = {
        "POSITION": corners.reshape(-1, 3),
        "NORMAL": normals,
        "JOINTS_0": owners,
        "WEIGHTS_0": np.tile([1.0, 0, 0, 0], (len(normals), 1)),
    }
    attributes = {key: _accessor(made, binary, each, VERTICES) for key, each in values.items()}
    made["meshes"] = [{"name": "sticks", "primitives": [{"attributes": attributes, "material": 0}]}]
    _skin(made, binary, rest)
    made["scenes"][0]["nodes"].append(len(made["nodes"]))
    made["nodes"].append({"name": "sticks", "mesh": 0, "skin": 0})


def _skin(made: dict[str, Any], binary: bytearray, rest: NDArray) -> None:
    """Add the skin of all joints, (J, 3) at rest: programs make an armature of a skin alone."""
    inverse = np.tile(np.eye(4), (len(rest), 1, 1))
    inverse[:, 3, :3] = -rest  # columns first, as glTF has matrices
    skin = {"inverseBindMatrices": _accessor(made, binary, inverse)}
    # Blender takes the root's pose at rest from the skin only if `skeleton` is above the root.
    above = made["scenes"][0]["nodes"][0]
    made["skins"] = [skin | {"joints": list(range(len(rest))), "skeleton": above}]


def _stick(bone: NDArray) -> NDArray:
    """Return the corners of the faces of a stick from the origin along a bone, (8, 3, 3)."""
    length = float(np.linalg.norm(bone))
    wide = float(np.clip(THICK * length, THIN_M, WIDE_M))
    turn = scipy.spatial.transform.Rotation.align_vectors([bone / length], [[0.0, 1.0, 0.0]])[0]
    corners = turn.apply(np.array(CORNERS) * [wide, length, wide])
    return corners[np.array(FACES)]


def _animation(
    made: dict[str, Any], binary: bytearray, posed: PosedHierarchy, name: str, zero_s: float
) -> None:
    """Add the keys of every joint."""
    times = _accessor(made, binary, posed.time_s - zero_s)
    samplers: list[dict] = []
    channels: list[dict] = []
    turns = _quaternions(posed.parent_from_joint)
    moving = np.abs(posed.translation - posed.translation[:1]).max(axis=(0, 2)) > CONSTANT_M
    for joint in range(len(posed.hierarchy.joints)):
        keys = {"rotation": turns[:, joint]}
        keys |= {"translation": posed.translation[:, joint]} if moving[joint] else {}
        for path, values in keys.items():
            target = {"node": joint, "path": path}
            channels.append({"sampler": len(samplers), "target": target})
            samplers.append({"input": times, "output": _accessor(made, binary, values)})
    about = {"name": name, "extras": {"start_s": float(posed.time_s[0])}}
    made["animations"] = [{**about, "samplers": samplers, "channels": channels}]


def _accessor(
    made: dict[str, Any], binary: bytearray, values: ArrayLike, target: int | None = None
) -> int:
    """Add numbers (N,) or (N, K) to the buffer; return the index of their accessor."""
    whole = np.asarray(values).dtype.kind == "u"
    kept = np.asarray(values, "<u2" if whole else "<f4")
    rows = kept.reshape(len(kept), -1)
    view: dict[str, Any] = {"buffer": 0, "byteOffset": len(binary), "byteLength": kept.nbytes}
    made["bufferViews"].append(view | ({"target": target} if target else {}))
    binary += kept.tobytes() + b"\0" * (-kept.nbytes % 4)
    bounds = {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
    kind = {"componentType": SHORT if whole else FLOAT, "type": TYPES[rows.shape[1]]}
    at = {"bufferView": len(made["bufferViews"]) - 1, "count": len(rows)}
    made["accessors"].append({**at, **kind, **bounds})
    return len(made["accessors"]) - 1


def _quaternions(rotations: NDArray) -> NDArray:
    """Return (T, J, 3, 3) rotations as (T, J, 4), x y z w, without changes of sign over time."""
    turns = scipy.spatial.transform.Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_quat()
    turns = turns.reshape(*rotations.shape[:2], 4)
    opposed = (turns[1:] * turns[:-1]).sum(axis=-1) < 0
    turns[1:][np.cumsum(opposed, axis=0) % 2 == 1] *= -1
    return turns
