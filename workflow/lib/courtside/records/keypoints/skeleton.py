"""Skeletons: ordered joints and bones, the limbs that all skeletons share, and symmetric pairs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, pairwise
from pathlib import Path

from courtside.study.configuration import schemas
from courtside.study.errors import InputError, StrPath

SIDES = {"left_": "right_", "right_": "left_"}


@dataclass(frozen=True)
class Skeleton:
    """A joint list as one network or device gives it."""

    name: str  # as in the file name
    joints: tuple[str, ...]  # names in order; sides are prefixes, `left_wrist`
    bones: tuple[tuple[str, str], ...]  # pairs of joints drawn as lines
    # Rigid limb segments, for checks of constant length
    segments: dict[str, tuple[str, str]]
    groups: dict[str, tuple[str, ...]]  # named sets of joints, such as `limbs` or `face`
    # Names of joints in the device's own files, where they differ from ours
    names: dict[str, str] = field(default_factory=dict)

    def index(self, joint: str) -> int:
        """Return the position of a joint; raise `ValueError` if there is none of that name."""
        return self.joints.index(joint)

    def device_names(self) -> list[str]:
        """Return the device's names of the joints, in the order of `joints`."""
        return [self.names.get(joint, joint) for joint in self.joints]

    def bone_indices(self) -> list[tuple[int, int]]:
        """Return the bones as pairs of positions in `joints`."""
        return [(self.joints.index(start), self.joints.index(end)) for start, end in self.bones]

    def mirror(self) -> list[int]:
        """Return for each joint the index of its counterpart on the other side, else its own."""
        return mirror(self.joints)

    def side_groups(self) -> list[list[str]]:
        """Return the sets of joints whose sides a network swaps together: upper body and legs."""
        legs = set(self.groups["legs"]) | {"left_hip", "right_hip"}
        return [[j for j in self.joints if j not in legs], [j for j in self.joints if j in legs]]

    def by_group(self, values: Mapping[str, float]) -> list[float]:
        """Return the value of each joint's group; `InputError` if a group or a joint is in none."""
        owner = {
            joint: value for name, value in values.items() for joint in self.groups.get(name, ())
        }
        missing = [joint for joint in self.joints if joint not in owner]
        unknown = [name for name in values if name not in self.groups]
        if missing or unknown:
            raise InputError(
                f"skeleton {self.name}: expected groups of {sorted(self.groups)} that hold every "
                f"joint, found {sorted(values)}; joints without a value: {missing}"
            )
        return [owner[joint] for joint in self.joints]


def mirror(joints: Sequence[str]) -> list[int]:
    """Return for each joint the index of its counterpart on the other side, else its own."""
    return [joints.index(other_side(joint)) for joint in joints]


def without_side(name: str) -> str:
    """Return the name of a joint, segment or angle without its side."""
    return name.removeprefix("left_").removeprefix("right_")


def other_side(joint: str) -> str:
    """Return the name of the counterpart on the other side, else the same name."""
    for side, other in SIDES.items():
        if joint.startswith(side):
            return other + joint.removeprefix(side)
    return joint


def read(path: StrPath) -> Skeleton:
    """Read a skeleton file: YAML with `joints`, `bones`, `segments`, `groups`, perhaps `names`.

    An `InputError` if the file is not as its schema says, a bone, segment or group names a joint
    that is not in `joints`, a side has no mirror, or `names` gives two joints one name.
    """
    content = schemas.read(path, "skeleton")
    skeleton = Skeleton(
        name=Path(path).stem,
        joints=tuple(content["joints"]),
        bones=tuple((start, end) for start, end in content["bones"]),
        segments={name: (start, end) for name, (start, end) in content["segments"].items()},
        groups={name: tuple(joints) for name, joints in content["groups"].items()},
        names=content.get("names", {}),
    )
    _check(path, skeleton)
    return skeleton


def _check(path: StrPath, skeleton: Skeleton) -> None:
    used = [*skeleton.bones, *skeleton.segments.values(), *skeleton.groups.values()]
    used += [tuple(skeleton.names), tuple(map(other_side, skeleton.joints))]
    for joint in chain(*used):
        if joint not in skeleton.joints:
            raise InputError(
                f"{path}: expected joints from the list `joints`, found {joint!r}; "
                "add it there or correct the name"
            )
    called = skeleton.device_names()
    for at, name in enumerate(called):
        if name in called[:at]:
            raise InputError(
                f"{path}: names: expected a name for each joint that no other joint has, found "
                f"{name!r}; correct it"
            )


CHAINS = ("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")
LIMBS = tuple(limb for chain in CHAINS for limb in chain)
SEGMENTS = {  # of limbs: the joint that each begins at, and the one that it ends at
    "upper_arm": ("shoulder", "elbow"),
    "forearm": ("elbow", "wrist"),
    "thigh": ("hip", "knee"),
    "shank": ("knee", "ankle"),
}
PARENT = {stop: start for chain in CHAINS for start, stop in pairwise(chain)}
JOINTS = tuple(f"{side}_{limb}" for side in ("left", "right") for limb in LIMBS)
TOES = ("foot_index", "big_toe")  # what networks call the toe; each has one of them
TRUNK = ("left_shoulder", "right_shoulder", "left_hip", "right_hip")


def heel_and_toe(joints: Sequence[str], side: str) -> list[int]:
    """Return the positions of heel and toe of a side; empty if the skeleton lacks one."""
    toe = [f"{side}_{name}" for name in TOES if f"{side}_{name}" in joints]
    if not toe or f"{side}_heel" not in joints:
        return []
    return [joints.index(f"{side}_heel"), joints.index(toe[0])]
