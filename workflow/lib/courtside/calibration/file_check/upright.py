"""Whether z of a file's world is up, by the bodies of people and by the pictures together.

All views agree also if another axis is up; only heights, floors and what lies along them are wrong.
People may lie, and cameras may look straight down: either alone says nothing.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import vertical
from courtside.calibration.people import metric_scale
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.geometry.triangulation import triangulate_all
from courtside.records.keypoints import skeleton

FEWEST, MOST = 60, 600  # ASSUME: postures that say something, and those that say all
ALIKE = 0.8  # ASSUME: length of the median of unit vectors along bodies that are upright
FAR = np.cos(np.radians(45))  # ASSUME: of the angle between z and up, at most, if z is up
NEAR = np.cos(np.radians(30))  # ASSUME: of the angle between two directions that are one, at least
WALKED_M = 1.5  # ASSUME: extent of paths of people who do not lie
# How the axis that is up becomes z, by its name: rotations, no mirror images.
TURNS = {
    "x": "(-z, y, x)",
    "-x": "(z, y, -x)",
    "y": "(x, -z, y)",
    "-y": "(x, z, -y)",
    "-z": "(x, -y, -z)",
}
ENDS = ("shoulder", "hip", "ankle")


def warning(cameras: Sequence[Camera], xy: NDArray) -> str:
    """Return a line if another axis than z seems to be up; empty if not, or if it is not clear.

    `xy` (C, N, J, 2) px are the limb joints `skeleton.JOINTS` of all persons at all times, NaN
    where unseen.
    """
    head, low = _bodies(cameras, xy)
    along = np.median(rotations.unit(head - low), axis=0) if len(low) >= FEWEST else np.zeros(3)
    if np.linalg.norm(along) < ALIKE:
        return ""
    up, shown = rotations.unit(along), vertical.up_in_pictures(cameras)
    if max(up[2], shown[2]) > FAR or up @ shown < NEAR:
        return ""
    looking = np.mean([camera.cam_from_world[2, :3] for camera in cameras], axis=0)
    if -looking[2] > NEAR and _extent(low, up) < WALKED_M:
        return ""  # cameras above people who lie look the same
    return (
        f"the world of the file: expected z up, found {_words(up)}, by the bodies of people and by "
        "the pictures, so that heights and the floor are wrong; export the calibration with z up, "
        f"or turn its world{_turn(up)}"
    )


def _bodies(cameras: Sequence[Camera], xy: NDArray) -> tuple[NDArray, NDArray]:
    """Return the middles of shoulders, and of ankles or else hips, (n, 3) each, of postures."""
    names = [f"{side}_{part}" for part in ENDS for side in ("left", "right")]
    joints = xy[:, :, [skeleton.JOINTS.index(name) for name in names]]
    seen = np.isfinite(joints).all(axis=-1).sum(axis=0) >= 2
    times = np.flatnonzero(seen[:, :4].all(axis=1))
    times = times[np.linspace(0, len(times) - 1, min(len(times), MOST)).astype(int)]
    xyz = triangulate_all(cameras, joints[:, times])
    place = {name: xyz[:, at] for at, name in enumerate(names)}
    head, hip, ankle = (metric_scale.middle(place, part) for part in ENDS)
    low = np.where(np.isfinite(ankle), ankle, hip)
    known = np.isfinite(head).all(axis=1) & np.isfinite(low).all(axis=1)
    return head[known], low[known]


def _extent(places: NDArray, up: NDArray) -> float:
    """Return how far places (n, 3) m are spread across up."""
    across = places - np.median(places, axis=0)
    across = across - (across @ up)[:, None] * up
    return 2 * float(np.quantile(np.linalg.norm(across, axis=1), 0.9))


def _axis(up: NDArray) -> str:
    """Return the name of the axis that is up, empty if none is."""
    at = int(np.argmax(np.abs(up)))
    return ("-" if up[at] < 0 else "") + "xyz"[at] if abs(up[at]) >= NEAR else ""


def _words(up: NDArray) -> str:
    if axis := _axis(up):
        return f"{axis} up"
    tilt = np.degrees(np.arccos(np.clip(up[2], -1, 1)))
    return f"up tilted from z by {tilt:.0f} degrees"


def _turn(up: NDArray) -> str:
    axis = _axis(up)
    return f" so that (x, y, z) becomes {TURNS[axis]}" if axis in TURNS else ""
