"""Names of joints in other programs: Pose2Sim's and OpenSim's `LKnee` for `left_knee`."""

SIDES = {"left": "L", "right": "R"}
ALSO = {"mid_hip": "CHip"}  # in BODY_25
OTHER = {"foot_index": "BigToe", "mid_hip": "Hip", "head_top": "Head"}


def name(joint):
    """Return what Pose2Sim calls a joint: `left_foot_index` gives `LBigToe`, `neck` gives `Neck`."""
    side, _, part = joint.partition("_")
    if side not in SIDES or not part:
        side, part = "", joint
    words = OTHER.get(part) or "".join(word.capitalize() for word in part.split("_"))
    return SIDES.get(side, "") + words


def names(joints):
    """Return what Pose2Sim calls joints, list of str.

    Parameters
    ----------
    joints : sequence of str

    Raises
    ------
    ValueError
        If two joints get one name.
    """
    found = [name(joint) for joint in joints]
    for at, marker in enumerate(found):
        if marker in found[:at]:
            raise ValueError(
                f"two joints would be called {marker}: {joints[found.index(marker)]}, {joints[at]}"
            )
    return found


def joints_of(markers, joints):
    """Find the joints of a skeleton among markers.

    Parameters
    ----------
    markers : sequence of str
        As a file names them: Pose2Sim's names, whatever their case, or the joints' own.
    joints : sequence of str

    Returns
    -------
    place : list of int or None
        For each joint the place of its marker; None where there is none.
    """
    lower = [marker.lower() for marker in markers]
    wanted = [(joint, name(joint), ALSO.get(joint, joint)) for joint in joints]
    return [
        next((lower.index(word.lower()) for word in words if word.lower() in lower), None)
        for words in wanted
    ]
