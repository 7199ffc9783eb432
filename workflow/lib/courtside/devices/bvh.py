"""BVH: a body's joints and their motion, as mocopi and other suits write it.

`bvh_text` checks the file and brings it to one form; bvhio then reads the joints from that: names, which
hangs from which, channels. Three things are not left to bvhio. Numbers are taken from the text, because bvhio
keeps them in single precision. The rows are read by numpy and solved for all frames at once, because bvhio
makes an object of every joint in every frame. And what bvhio refuses or mistakes (lower case, blanks before
colons, names that are not ASCII) never reaches it.
"""

import tempfile
from pathlib import Path
from urllib.parse import unquote

import bvhio
import numpy as np

from courtside.devices import bvh_text
from courtside.records.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy

CENTIMETRES_M = 0.01
TURNED = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}  # the columns that a turn about an axis mixes


def read(path, *, unit_m=CENTIMETRES_M):
    """Read a BVH file.

    Parameters
    ----------
    path : str or Path
    unit_m : float
        Length of the file's unit, metres. BVH does not say it; mocopi's is the centimetre.

    Returns
    -------
    posed : PosedHierarchy
        Joints in the file's order, by the file's names, which need not differ; axes as in the file; time
        from zero. Position channels replace the offset, axis by axis.

    Raises
    ------
    InputError
        If the file is not BVH; see `bvh_text.read`.

    Notes
    -----
    Meredith & Maddock 2001. Rotations are about the joint's own turned axes in the order of its CHANNELS:
    Zrotation Xrotation Yrotation is R = Rz Rx Ry, Tait-Bryan, not the proper Euler angles (z-x-z) of some
    descriptions.
    """
    text = bvh_text.read(path)
    names, parents, channels = _joints(text)
    hierarchy = Hierarchy(
        joints=tuple(names),
        parents=np.array(parents),
        offsets=text.offsets * unit_m,
        ends={names[at]: text.ends[at] * unit_m for at in sorted(text.ends, reverse=True)},
    )
    columns = {}  # (joint, channel) -> column
    for joint, own in enumerate(channels):
        for channel in own:
            columns[joint, channel] = len(columns)
    return PosedHierarchy(
        hierarchy=hierarchy,
        time_s=np.arange(len(text.rows)) * text.frame_time_s,
        translation=_translations(text, columns) * unit_m,
        parent_from_joint=_rotations(text.rows, channels, columns),
    )


def _joints(text):
    """Return the names, parents and channels of the joints, as bvhio finds them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hierarchy.bvh"
        path.write_text(f"{text.hierarchy}\nMOTION\nFrames: 0\nFrame Time: 0\n", encoding="ascii")
        root = bvhio.readAsBvh(str(path)).Root
    names, parents, channels = [], [], []
    waiting = [(root, NO_PARENT)]
    while waiting:
        joint, parent = waiting.pop()
        waiting += [(child, len(names)) for child in reversed(joint.Children)]
        names.append(unquote(joint.Name))
        parents.append(parent)
        channels.append(joint.Channels)
    return names, parents, channels


def _translations(text, columns):
    """Return each joint's origin in its parent, (T, J, 3) in the file's unit."""
    found = np.repeat(text.offsets[None], len(text.rows), axis=0)
    for (joint, channel), column in columns.items():
        if channel.endswith("position"):
            found[:, joint, bvh_text.AXES.index(channel[0])] = text.rows[:, column]
    return found


def _rotations(rows, channels, columns):
    """Return each joint's rotation in its parent, (T, J, 3, 3); joints of one order are turned together."""
    found = np.tile(np.eye(3), (len(rows), len(channels), 1, 1))
    orders = [tuple(c for c in own if c.endswith("rotation")) for own in channels]
    for order in set(orders) - {()}:
        joints = [joint for joint, own in enumerate(orders) if own == order]
        turned = np.zeros((3, 3, len(joints), len(rows)))
        turned[range(3), range(3)] = 1.0
        for channel in order:
            angle = np.radians(rows[:, [columns[joint, channel] for joint in joints]].T)
            first, second = TURNED[channel[0]]
            cosine, sine = np.cos(angle), np.sin(angle)
            before = turned[:, first].copy()
            turned[:, first] = cosine * before + sine * turned[:, second]
            turned[:, second] = cosine * turned[:, second] - sine * before
        found[:, joints] = np.moveaxis(turned, (3, 2), (0, 1))
    return found
