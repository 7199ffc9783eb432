"""Names of joints in other programs: Pose2Sim's and OpenSim's `LKnee` for `left_knee`."""

from collections.abc import Sequence

SIDES = {"left": "L", "right": "R"}
ALSO = {"mid_hip": "CHip"}  # in BODY_25
OTHER = {"foot_index": "BigToe", "mid_hip": "Hip", "head_top": "Head"}


def side_and_part(joint: str) -> tuple[str, str]:
    """Return a joint's side, `left`, `right` or empty, and its name without it."""
    side, _, part = joint.partition("_")
    return (side, part) if side in SIDES and part else ("", joint)


def name(joint: str) -> str:
    """Return Pose2Sim's name of a joint: `LBigToe` for `left_foot_index`, `Neck` for `neck`."""
    side, part = side_and_part(joint)
    words = OTHER.get(part) or "".join(word.capitalize() for word in part.split("_"))
    return SIDES.get(side, "") + words


def names(joints: Sequence[str]) -> list[str]:
    """Return Pose2Sim's names of joints; raise `ValueError` if two joints get one name."""
    found = [name(joint) for joint in joints]
    for at, marker in enumerate(found):
        if marker in found[:at]:
            raise ValueError(
                f"two joints would be called {marker}: {joints[found.index(marker)]}, {joints[at]}"
            )
    return found


def joints_of(markers: Sequence[str], joints: Sequence[str]) -> list[int | None]:
    """Return for each joint the index of its marker; None if there is none.

    Markers are named as in a file: Pose2Sim's names, whatever their case, or the joints' own.
    """
    lower = [marker.lower() for marker in markers]
    wanted = [(joint, name(joint), ALSO.get(joint, joint)) for joint in joints]
    return [
        next((lower.index(word.lower()) for word in words if word.lower() in lower), None)
        for words in wanted
    ]
