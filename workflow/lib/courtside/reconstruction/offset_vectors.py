"""Vectors that the offset of a network's joint may be a combination of.

A network places a joint by what it sees, so a part of its error turns with the body, and another
part depends on the direction from which a camera sees it. Vectors of the first kind (`of_body`) are
the same for all cameras. Those of the second (`of_views`) differ between the cameras; they move the
triangulated joint by what the accepted views make of them. Shares of both kinds were fitted on
players around whom cameras stood far away, near, and high on stands: offsets of the body alone,
fitted with one layout, are wrong in another one (docs/measured/joints.md).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.geometry.camera import Camera

# Lines (from, to) of a joint's own side that may explain its offset; the first is the joint's limb.
BONES = {
    "shoulder": (("shoulder", "elbow"), ("elbow", "wrist")),
    "elbow": (("shoulder", "elbow"), ("elbow", "wrist"), ("wrist", "index"), ("wrist", "pinky")),
    "wrist": (("elbow", "wrist"), ("wrist", "index"), ("wrist", "pinky")),
    "hip": (("hip", "knee"), ("knee", "ankle")),
    "knee": (("hip", "knee"), ("knee", "ankle"), ("ankle", "heel"), ("ankle", "foot_index")),
    "ankle": (("knee", "ankle"), ("ankle", "heel"), ("ankle", "foot_index")),
}
ACROSS = {"shoulder": ("shoulder", "elbow"), "hip": ("hip", "knee")}  # and of the other side
TRUNK = ("out", "up", "forward")  # names of the trunk's vectors, each as long as the trunk
# Vectors with shares of opposite sign for men and women, besides the common shares: hips of
# development bodies left out of the fit are 20 mm off with them, 33 mm without.
BY_SEX = {"hip": TRUNK}
SIGN: dict[str | None, float] = {"m": 1.0, "f": -1.0}  # for others, the mean of both
# Lines that also count by their direction: if a part of the arm looks too short, the elbow is off.
DIRECTED = {"elbow": (("shoulder", "elbow"), ("elbow", "wrist"))}
# Of directions and of the vector along the world's z, for an adult: about a limb, any unit will do.
LENGTH_M = 0.3
TRUNK_M = 0.51  # mean of the eight development bodies' trunks, as the default network sees them
# ASSUME: sizes of adults, as a network sees them, are all 1; beyond the outer two, a size counts as
# it is. One person's differs by 0.1 between takes: offsets in proportion to it were no better for
# adults (0.3 +- 0.1 mm worse), and for children three times as near.
ADULTS = (0.76, 0.88, 1.12, 1.28), (0.76, 1.0, 1.0, 1.28)
# Products of two components of the direction of view; the third square follows from the others.
SQUARES = (("out", "out"), ("up", "up"), ("out", "forward"), ("up", "forward"), ("out", "up"))
# Trunks of the development bodies lean by the first at most. ASSUME: from the second on, offsets
# turn with the body: in a handstand, what is along z and along the trunk would add up.
LEANING_DEG = (30.0, 60.0)
SEEN = "seen "  # begins the names of vectors that depend on the view
# ASSUME: weight of a view that was not accepted, over one that was: enough for a joint between two
# gaps, where no view was accepted, and nothing beside an accepted one.
UNUSED = 1e-3
# ASSUME: along a direction in which views weigh less than this share of the best direction (two
# views within 26 degrees of one line), an offset counts less than the rays would make of it. There,
# small errors of the shares would become large offsets.
LEAST_STRENGTH = 0.05


@dataclass(frozen=True)
class Views:
    """From where the cameras of a take see one joint.

    `ways` (C, T, 3) are unit vectors from each camera to the joint, in the world. `gains`
    (C, T, 3, 3) tell how far the triangulated joint moves if one camera's ray is moved by 1 m at
    the joint: triangulation is taken as weighted least squares of the accepted views.
    """

    ways: NDArray
    gains: NDArray


def views(cameras: Sequence[Camera], xyz: NDArray, accepted: NDArray) -> Views:
    """Return from where cameras see a joint at `xyz` (T, 3) m; `accepted` (T, C) tells its views.

    NaN where the joint is missing.
    """
    ways, away = directions(cameras, xyz)
    focal_px = np.array([camera.K[0, 0] for camera in cameras])
    weight = np.where(accepted.T, 1.0, UNUSED) * (focal_px[:, None] / away) ** 2
    flat = weight[..., None, None] * (np.eye(3) - ways[..., :, None] * ways[..., None, :])
    whole = np.where(np.isfinite(flat).all(axis=(0, -2, -1))[:, None, None], flat.sum(0), np.eye(3))
    strength, axes = np.linalg.eigh(whole)
    strength = np.maximum(strength, LEAST_STRENGTH * strength[:, -1:])
    return Views(ways, axes / strength[:, None] @ np.swapaxes(axes, -2, -1) @ flat)


def directions(cameras: Sequence[Camera], xyz: NDArray) -> tuple[NDArray, NDArray]:
    """Return unit vectors (C, T, 3) from each camera to points `xyz` (T, 3) m, and distances, m."""
    lines = xyz - np.stack([camera.centre_in_world for camera in cameras])[:, None]
    away = np.linalg.norm(lines, axis=-1)
    return lines / away[..., None], away


def every(
    xyz: NDArray,
    joints: Sequence[str],
    side: str,
    joint: str,
    sex: str | None = None,
    cameras: Sequence[Camera] = (),
    accepted: NDArray | None = None,
    size: float = 1.0,
) -> dict[str, NDArray]:
    """Return all vectors (T, 3) m of one person's joint, by name: `of_body`, and `of_views`.

    `xyz` (T, J, 3) m; `accepted` (T, J, C) tells which views of the C `cameras` were used. Without
    cameras there are none of the second kind. The vectors are those of an adult: the person's own
    are `size` times as long (`size_of`).
    """
    found = of_body(xyz / size, joints, side, joint, sex)
    if cameras and accepted is not None:
        at = list(joints).index(f"{side}_{joint}")
        seen = views(cameras, xyz[:, at], accepted[:, at])
        found |= of_views(xyz, joints, side, joint, seen)
    return found


def size_of(xyz: NDArray, joints: Sequence[str]) -> float:
    """Return the size of one person `xyz` (T, J, 3) m over that of adults, for whom it is 1.

    By the median length of the trunk; 1 where it is never seen, and no offset is known either.
    """
    _, length = _trunk(dict(zip(joints, np.moveaxis(xyz, -2, 0), strict=True)), "left")
    known = length[np.isfinite(length)]
    size = np.median(known) / TRUNK_M if len(known) else 1.0
    return float(np.interp(size, *ADULTS) * size / np.clip(size, ADULTS[0][0], ADULTS[0][-1]))


def tilt_deg(xyz: NDArray, joints: Sequence[str]) -> NDArray:
    """Return the angle (...) between trunks of `xyz` (..., J, 3) and the world's z, degrees."""
    axes, _ = _trunk(dict(zip(joints, np.moveaxis(xyz, -2, 0), strict=True)), "left")
    return np.degrees(np.arccos(np.clip(axes["up"][..., 2], -1.0, 1.0)))


def of_body(
    xyz: NDArray, joints: Sequence[str], side: str, joint: str, sex: str | None = None
) -> dict[str, NDArray]:
    """Return the vectors (..., 3) m that are the same for all cameras, by name.

    `xyz` (..., J, 3) m are skeletons in the world with the named `joints` (J,); `joint` is one of
    `skeleton.LIMBS`, of the `side` left or right; `sex` is "m", "f" or None. Trunk axes have the
    trunk's length (`out`: to the joint's own side; `up`; `forward`); `upright` is the world's z
    for trunks that lean as far as those of the fit (`LEANING_DEG`), and the trunk's axis beyond.
    There are lines between joints of the own side (`hip-knee`) and of the other (`other hip-knee`),
    if the network has these joints; `way elbow-wrist` and the like, lines of `DIRECTED` with length
    `LENGTH_M`; `lean up forward` and the like, the trunk's axis `forward` times the component along
    `up` of the joint's limb; and `sex up` and the like, those of `BY_SEX` with the sign of the sex.
    """
    place = dict(zip(joints, np.moveaxis(xyz, -2, 0), strict=True))
    axes, length = _trunk(place, side)
    found = {name: axes[name] * length for name in TRUNK}
    found["upright"] = LENGTH_M * _upright(axes["up"])
    other = {"left": "right", "right": "left"}[side]
    found |= _lines(place, side, BONES[joint])
    if joint in ACROSS:
        across = _lines(place, other, [ACROSS[joint]])
        found |= {f"other {name}": line for name, line in across.items()}
    for start, stop in DIRECTED.get(joint, ()):
        found[f"way {start}-{stop}"] = LENGTH_M * rotations.unit(found[f"{start}-{stop}"])
    limb = rotations.unit(found["-".join(BONES[joint][0])])
    for along, name in product(TRUNK, TRUNK):
        found[f"lean {along} {name}"] = LENGTH_M * _dot(limb, axes[along]) * axes[name]
    sign = SIGN.get(sex, 0.0)
    return found | {f"sex {name}": sign * found[name] for name in BY_SEX.get(joint, ())}


def of_views(
    xyz: NDArray, joints: Sequence[str], side: str, joint: str, seen: Views
) -> dict[str, NDArray]:
    """Return the vectors (T, 3) m that depend on the directions of view, by name.

    They are those of each camera (`of_each_view`), times what triangulation makes of its ray.
    """
    each = _of_each_view(xyz, joints, side, joint, seen.ways)
    moved = np.einsum("ctij,ctjm->mti", seen.gains, np.stack(list(each.values()), axis=-1))
    return dict(zip((SEEN + name for name in each), LENGTH_M * moved, strict=True))


def of_each_view(
    xyz: NDArray, joints: Sequence[str], side: str, joint: str, ways: NDArray
) -> dict[str, NDArray]:
    """Return the vectors (C, T, 3) m that depend on the direction of view, of each camera, by name.

    `xyz` (T, J, 3) m is one person, `ways` (C, T, 3) are unit vectors from each camera to the
    joint. `seen out up` and the like: the trunk's axis `up` times the component along `out` of the
    direction of view; `seen out out up` with a product of two components. `seen along hip-knee`: a
    limb times the cosine to the direction of view, and times its square (`seen square hip-knee`).
    `seen across hip-knee`: perpendicular to limb and view, alone and times a component (`seen
    across out hip-knee`); its sign is that of the left side.
    """
    each = _of_each_view(xyz, joints, side, joint, ways)
    return {SEEN + name: LENGTH_M * vector for name, vector in each.items()}


def _of_each_view(xyz, joints, side, joint, ways: NDArray) -> dict[str, NDArray]:
    """Return the vectors of `of_each_view` without `SEEN` in their names, and without unit."""
    place = dict(zip(joints, np.moveaxis(xyz, -2, 0), strict=True))
    axes, _ = _trunk(place, side)
    part = {name: _dot(ways, axes[name]) for name in TRUNK}
    each = {f"{a} {name}": part[a] * axes[name] for a, name in product(TRUNK, TRUNK)}
    for (a, b), name in product(SQUARES, TRUNK):
        each[f"{a} {b} {name}"] = part[a] * part[b] * axes[name]
    for name, line in _lines(place, side, BONES[joint]).items():
        limb = rotations.unit(line)
        cosine = _dot(ways, limb)
        each[f"along {name}"], each[f"square {name}"] = cosine * limb, cosine**2 * limb
        across = np.cross(ways, limb) * (1.0 if side == "left" else -1.0)
        each[f"across {name}"] = across
        each |= {f"across {a} {name}": part[a] * across for a in TRUNK}
    return each


def names(joint: str) -> list[str]:
    """Return the names of all vectors of a joint."""
    lines = ["-".join(bone) for bone in BONES[joint]]
    found = [*TRUNK, "upright", *lines]
    found += [f"other {'-'.join(ACROSS[joint])}"] if joint in ACROSS else []
    found += [f"way {start}-{stop}" for start, stop in DIRECTED.get(joint, ())]
    pairs = [f"{a} {name}" for a, name in product(TRUNK, TRUNK)]
    found += [f"lean {pair}" for pair in pairs]
    found += [f"sex {name}" for name in BY_SEX.get(joint, ())]
    seen = [*pairs, *(f"{a} {b} {name}" for (a, b), name in product(SQUARES, TRUNK))]
    for line in lines:
        seen += [f"along {line}", f"square {line}", f"across {line}"]
        seen += [f"across {a} {line}" for a in TRUNK]
    return [*found, *(SEEN + name for name in seen)]


def _trunk(place: dict[str, NDArray], side: str) -> tuple[dict[str, NDArray], NDArray]:
    """Return the trunk's axes (..., 3), unit vectors, and its length (..., 1) m."""
    hips, shoulders = (
        (place[f"left_{part}"] + place[f"right_{part}"]) / 2 for part in ("hip", "shoulder")
    )
    along = shoulders - hips
    length = np.linalg.norm(along, axis=-1, keepdims=True)
    across = place["left_shoulder"] - place["right_shoulder"]
    across = across + place["left_hip"] - place["right_hip"]
    forward = rotations.unit(np.cross(across, along))
    left = np.cross(along / length, forward)
    out = left if side == "left" else -left
    return dict(zip(TRUNK, (out, along / length, forward), strict=True)), length


def _upright(up: NDArray) -> NDArray:
    """Return the world's z, or where trunks `up` (..., 3) lean further than in the fit, their axes.

    In between it turns from one to the other.
    """
    tilt = np.arccos(np.clip(up[..., 2:], -1.0, 1.0))
    first, last = np.radians(LEANING_DEG)
    off = np.interp(tilt, (0.0, first, last), (0.0, first, 0.0))
    share = np.sin(off) / np.maximum(np.sin(tilt), np.finfo(float).tiny)
    return np.cos(off) * up + share * (np.array([0.0, 0.0, 1.0]) - np.cos(tilt) * up)


def _lines(place, side, bones) -> dict[str, NDArray]:
    """Return the lines of one side between those joints that the network has, by name."""
    ends = {f"{a}-{b}": (f"{side}_{a}", f"{side}_{b}") for a, b in bones}
    return {name: place[b] - place[a] for name, (a, b) in ends.items() if {a, b} <= set(place)}


def _dot(first: NDArray, second: NDArray) -> NDArray:
    """Return the dot products (..., 1) of vectors (..., 3)."""
    return np.sum(first * second, axis=-1, keepdims=True)
