"""Skeletons: ordered joints and bones, the limbs that all skeletons share, and symmetric pairs."""

from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from courtside.study.configuration import yaml_files
from courtside.study.errors import InputError, reading

SIDES = {"left_": "right_", "right_": "left_"}


@dataclass(frozen=True)
class Skeleton:
    """A joint list as one network or device gives it.

    Attributes
    ----------
    name : str
        As in the file name.
    joints : tuple of str
        Names in order; sides are prefixes, `left_wrist`.
    bones : tuple of (str, str)
        Pairs of joints drawn as lines.
    segments : dict of str to (str, str)
        Rigid limb segments, for checks of constant length.
    groups : dict of str to tuple of str
        Named sets of joints, such as `limbs` or `face`.
    names : dict of str to str
        What the device's own files call a joint, for the joints that they call otherwise.
    """

    name: str
    joints: tuple
    bones: tuple
    segments: dict
    groups: dict
    names: dict = field(default_factory=dict)

    def index(self, joint):
        """Return the position of a joint; raise `ValueError` if the skeleton has none of that name."""
        return self.joints.index(joint)

    def device_names(self):
        """Return what the device calls each joint, in the order of `joints`, list of str."""
        return [self.names.get(joint, joint) for joint in self.joints]

    def bone_indices(self):
        """Return the bones as pairs of positions in `joints`."""
        return [(self.joints.index(start), self.joints.index(end)) for start, end in self.bones]

    def mirror(self):
        """Return for each joint the index of the same joint of the other body side, (J,) list of int.

        A joint without sides maps to itself.
        """
        return [self.joints.index(_other_side(joint)) for joint in self.joints]

    def side_groups(self):
        """Return the sets of joints whose sides a network confuses together: upper body and legs."""
        legs = set(self.groups["legs"]) | {"left_hip", "right_hip"}
        return [[j for j in self.joints if j not in legs], [j for j in self.joints if j in legs]]

    def by_group(self, values):
        """Spread values of joint groups over the joints.

        Parameters
        ----------
        values : dict of str to float
            One value for each group; together the groups must hold every joint.

        Returns
        -------
        per_joint : list of float, length J

        Raises
        ------
        InputError
            If a group is unknown or a joint is in none of the groups named.
        """
        owner = {
            joint: value for name, value in values.items() for joint in self.groups.get(name, ())
        }
        missing = [joint for joint in self.joints if joint not in owner]
        unknown = [name for name in values if name not in self.groups]
        if missing or unknown:
            raise InputError(
                f"skeleton {self.name}: expected groups of {sorted(self.groups)} that hold every joint, "
                f"found {sorted(values)}; joints without a value: {missing}"
            )
        return [owner[joint] for joint in self.joints]


def _other_side(joint):
    for side, other in SIDES.items():
        if joint.startswith(side):
            return other + joint.removeprefix(side)
    return joint


def read(path):
    """Read a skeleton file.

    Parameters
    ----------
    path : str or Path
        YAML with `joints`, `bones`, `segments`, `groups`, and for a device's `names`.

    Returns
    -------
    skeleton : Skeleton

    Raises
    ------
    InputError
        If a key is missing, a joint stands twice in `joints`, a bone or segment is no pair, a bone, segment
        or group names a joint that is not in `joints`, a side has no mirror, or `names` gives two joints one
        name.
    """
    content = yaml_files.read(path)
    what = "lists `joints` and `bones` and mappings `segments` and `groups`, bones and segments of two joints"
    with reading(path, what, "see the files beside it"):
        skeleton = Skeleton(
            name=Path(path).stem,
            joints=tuple(content["joints"]),
            bones=tuple((start, end) for start, end in content["bones"]),
            segments={name: (start, end) for name, (start, end) in content["segments"].items()},
            groups={name: tuple(joints) for name, joints in content["groups"].items()},
            names=dict(content.get("names", {}).items()),
        )
        _check(path, skeleton)
    return skeleton


def _check(path, skeleton):
    for at, joint in enumerate(skeleton.joints):
        if not isinstance(joint, str) or joint in skeleton.joints[:at]:
            raise InputError(
                f"{path}: joints: expected names that differ, found {joint!r}; rename it"
            )
    used = [*skeleton.bones, *skeleton.segments.values(), *skeleton.groups.values()]
    used.append(tuple(skeleton.names))
    used.append(tuple(_other_side(joint) for joint in skeleton.joints))
    for joints in used:
        for joint in joints:
            if joint not in skeleton.joints:
                raise InputError(
                    f"{path}: expected joints from the list `joints`, found {joint!r}; "
                    "add it there or correct the name"
                )
    called = skeleton.device_names()
    for at, name in enumerate(called):
        if not isinstance(name, str) or name in called[:at]:
            raise InputError(
                f"{path}: names: expected a name for each joint that no other joint has, found {name!r}; "
                "correct it"
            )


CHAINS = ("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")
LIMBS = tuple(limb for chain in CHAINS for limb in chain)
PARENT = {stop: start for chain in CHAINS for start, stop in pairwise(chain)}
JOINTS = tuple(f"{side}_{limb}" for side in ("left", "right") for limb in LIMBS)
