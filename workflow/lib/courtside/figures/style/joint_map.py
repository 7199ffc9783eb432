"""Common joints in each skeleton: six pairs of limb joints, and derived ones."""

from collections.abc import Mapping, Sequence
from itertools import groupby

import pandas as pd

from courtside.records.keypoints.derived_joints import DerivedJoints
from courtside.records.keypoints.skeleton import Skeleton

SIDES = ("left", "right")


def limbs(skeletons: Sequence[Skeleton]) -> list[str]:
    """Return the limb joints of all skeletons, without side, in the order of the first one."""
    parts = [[joint.partition("_")[2] for joint in one.groups["limbs"]] for one in skeletons]
    return [part for part in dict.fromkeys(parts[0]) if all(part in other for other in parts)]


def rows(skeletons: list[Skeleton], table: DerivedJoints) -> pd.DataFrame:
    """Return the map, one row for each common joint and skeleton.

    common; skeleton; numbers, joints, device_names, weights: tuples, of the skeleton's joints that
    represent it; definition: empty for a joint that the skeleton has itself; same: whether all
    skeletons share the definition. Derived joints of `table` that a skeleton does not define are
    left out.
    """
    found = []
    for part in limbs(skeletons):
        for skeleton in skeletons:
            joints = [f"{side}_{part}" for side in SIDES]
            found.append(_row(part, skeleton, joints, (1.0, 1.0), "", True))
    for name, by_skeleton in table.joints.items():
        if not all(skeleton.name in by_skeleton for skeleton in skeletons):
            continue
        used = [by_skeleton[skeleton.name] for skeleton in skeletons]
        for skeleton, definition in zip(skeletons, used, strict=True):
            weights = table.definitions[definition]
            about = skeleton, list(weights), tuple(weights.values())
            found.append(_row(name, *about, definition, len(set(used)) == 1))
    return pd.DataFrame(found)


def _row(common, skeleton, joints, weights, definition, same):
    numbers = tuple(skeleton.index(joint) for joint in joints)
    called = skeleton.device_names()
    return {
        "common": common,
        "skeleton": skeleton.name,
        "numbers": numbers,
        "joints": tuple(joints),
        "device_names": tuple(called[number] for number in numbers),
        "weights": tuple(weights),
        "definition": definition,
        "same": same,
    }


def cell(row: Mapping) -> str:
    """Return a row of `rows` in short: numbers, the device's other names, `*` if computed."""
    if not row["definition"]:
        pairs = zip(row["numbers"], row["joints"], row["device_names"], strict=True)
        return ", ".join(f"{n}" if own == name else f"{n} {own}" for n, name, own in pairs)
    weighted = list(zip(row["weights"], row["numbers"], strict=True))
    terms = []
    for weight, group in groupby(weighted, key=lambda pair: pair[0]):
        members = [f"{number}" for _, number in group]
        inner = "+".join(members)
        if weight != 1.0:
            inner = f"{weight:g}({inner})" if len(members) > 1 else f"{weight:g} × {inner}"
        terms.append(inner)
    return " + ".join(terms) + (" *" if len(weighted) > 1 else "")
