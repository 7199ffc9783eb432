"""Pictures in which nobody can be recognised: faces hidden, surroundings made coarse."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry.interpolation import window
from courtside.pose import stick_drawing
from courtside.records.keypoints.skeleton import TRUNK, Skeleton

# ASSUME: these cover hair, chin and limbs, and leave nothing to recognise.
REACH = 1.6  # radius of the mosaic, of the distance from the face's centre to its furthest joint
LEAST_SHARE = 0.012  # of the picture's height: the smallest radius
# Of a person's extent: the smallest radius, 15 cm, where few joints of a face are known.
HEAD = 0.09
GRAIN = 8  # mosaic cells across the face
COARSE = 1 / 60  # of the picture's height: cells that surroundings are reduced to
BODY = 0.18  # of a person's extent: width of the body around its bones
# Networks place a face that they see in part beside it, with good scores. So what lies above the
# shoulders is hidden as well.
ABOVE_M = 0.36  # from the middle of the shoulders to the crown of a head
BELOW_M = 0.1  # a chin may lie so far below that middle
ABOVE_GRAIN = 12  # mosaic cells across what is hidden there: 4 across a face
SHOULDERS_M, SIDE_M, EXTENT_M = 0.36, 0.55, 1.67  # between shoulders, shoulder to hip; standing
SHORT_M = 0.2  # a trunk that looks shorter points at the camera: the head may be all round
UPRIGHT = 0.5  # cosine: of a trunk that leans more in the picture, the head may be lower
NEAR = 1.0  # of the picture's size, from its middle: joints further away are left out
JUMP_S = 0.1  # a network places a face wrongly for a few frames; those so far away know better
UP = np.array([0.0, -1.0])  # in a picture


@dataclass(frozen=True)
class Body:
    """Which joints of a person are drawn, and which tell where the head is; as indices."""

    bones: tuple[tuple[int, int], ...]
    face: tuple[int, ...]
    trunks: tuple[tuple[int, ...], ...]  # left and right shoulder, left and right hip

    @classmethod
    def of(cls, skeleton: Skeleton, n_methods: int = 1) -> "Body":
        """Return that of a skeleton, or of the joints of several methods side by side."""
        starts = range(0, n_methods * len(skeleton.joints), len(skeleton.joints))
        bones, own = skeleton.bone_indices(), skeleton.index
        trunk = [own(joint) for joint in TRUNK] if set(TRUNK) <= set(skeleton.joints) else []
        return cls(
            tuple((first + start, second + start) for start in starts for first, second in bones),
            tuple(own(joint) + start for start in starts for joint in skeleton.groups["face"]),
            tuple(tuple(at + start for at in trunk) for start in starts if trunk),
        )


def around(time_s: NDArray, xy: NDArray, frame: int) -> NDArray:
    """Return joints (n, J, 2) in a frame and shortly before and after it, from (P, T, J, 2).

    Where a network places a face wrongly in a few frames only, these hide it too.
    """
    step_s = np.median(np.diff(time_s)) if len(time_s) > 1 else JUMP_S
    apart = max(1, window(JUMP_S, 1 / step_s))
    frames = np.unique(np.clip([frame - apart, frame, frame + apart], 0, len(time_s) - 1))
    return xy[:, frames].reshape(-1, *xy.shape[2:])


def hide_faces(image: NDArray, everybody: Sequence[NDArray] | NDArray, body: Body) -> NDArray:
    """Return a picture with the faces of all people hidden under mosaics.

    `everybody` (n, J, 2) are joints, px, NaN where unknown. A mosaic of at most 8 cells across
    destroys the detail; a Gaussian blur could be sharpened again.
    """
    result, size = image.copy(), np.array(image.shape[1::-1])
    for one in everybody:
        # A joint far beside the picture is wrong or not in it; it would hide all of the picture.
        seen = (np.abs(one / size - 0.5) <= NEAR).all(axis=-1, keepdims=True)
        xy = np.where(seen, one, np.nan)
        extent_px = _extent_px(xy)
        _hide_face(result, xy[list(body.face)], extent_px)
        for trunk in body.trunks:
            _hide_above(result, xy[list(trunk)], extent_px)
    return result


def _hide_face(image: NDArray, xy: NDArray, extent_px: float) -> None:
    """Hide one face, joints (K, 2) px, in place."""
    known = xy[np.isfinite(xy).all(axis=1)]
    if not len(known):
        return
    centre = (known.min(axis=0) + known.max(axis=0)) / 2
    reach = REACH * np.linalg.norm(known - centre, axis=1).max(initial=0.0)
    _cover(image, centre, max(reach, HEAD * extent_px), GRAIN)


def _hide_above(image: NDArray, trunk: NDArray, extent_px: float) -> None:
    """Hide what lies above the shoulders, joints (4, 2) px as in `Body.trunks`, in place.

    Of a trunk that is not upright in the picture, also what lies away from the hips.
    """
    shoulders, hips = trunk[:2], trunk[2:]
    known = stick_drawing.drawable(shoulders)
    if not known.any():
        return
    both = known & stick_drawing.drawable(hips)
    along = (shoulders - hips)[both].mean(axis=0) if both.any() else UP
    length_px = float(np.linalg.norm(along))
    apart_px = float(np.linalg.norm(shoulders[0] - shoulders[1])) if known.all() else 0.0
    metre_px = max(apart_px / SHOULDERS_M, length_px / SIDE_M)
    if not both.all():  # of these two, one at least is seen in almost its full length
        metre_px = max(metre_px, extent_px / EXTENT_M)
    short = both.any() and length_px < SHORT_M * metre_px
    upright = along @ UP >= UPRIGHT * length_px
    sides = [UP] if upright else [UP, along / length_px]
    below_px = np.inf if short else BELOW_M * metre_px
    radius_px = (ABOVE_M if known.all() else ABOVE_M + SHOULDERS_M / 2) * metre_px
    _cover(image, shoulders[known].mean(axis=0), radius_px, ABOVE_GRAIN, sides, below_px)


def _cover(
    image: NDArray,
    centre: NDArray,
    radius_px: float,
    grain: int,
    sides: Sequence[NDArray] = (),
    below_px: float = 0.0,
) -> None:
    """Lay a round mosaic of at most `grain` cells across on a picture, in place.

    With `sides`, directions (2,), only what lies on one of these sides of the centre, or less than
    `below_px` on the other.
    """
    radius = int(np.ceil(max(radius_px, LEAST_SHARE * image.shape[0])))
    x, y = np.round(centre).astype(int)
    top, left = max(0, y - radius), max(0, x - radius)
    patch = image[top : max(0, y + radius + 1), left : max(0, x + radius + 1)]
    if not patch.size:
        return
    shares = [length / (2 * radius) for length in patch.shape[1::-1]]
    cells = [min(grain, max(1, round(grain * share))) for share in shares]
    coarse = cv2.resize(patch, cells, interpolation=cv2.INTER_AREA)
    mosaic = cv2.resize(coarse, patch.shape[1::-1], interpolation=cv2.INTER_NEAREST)
    rows, columns = np.mgrid[: patch.shape[0], : patch.shape[1]]
    right, down = columns + left - x, rows + top - y
    inside = right**2 + down**2 <= radius**2
    if sides:
        inside &= np.any([right * a + down * b >= -below_px for a, b in sides], axis=0)
    patch[inside] = mosaic[inside]


def _extent_px(xy: NDArray) -> float:
    """Return the longer side of the box around a person's joints (J, 2) px; 0 if none is known."""
    known = xy[stick_drawing.drawable(xy)]
    return float(np.ptp(known, axis=0).max()) if len(known) else 0.0


def only_persons(image: NDArray, persons: NDArray, body: Body) -> NDArray:
    """Return a picture that is sharp at some persons only, so that nobody else can be recognised.

    `persons` (n, J, 2) are joints, px, NaN where unknown. Surroundings and faces are reduced to 60
    cells along the height, then drawn smoothly. No detector looks for others: it misses those in
    the background most often.
    """
    height, width = image.shape[:2]
    cell = max(1.0, height * COARSE)
    cells = max(1, round(width / cell)), max(1, round(height / cell))
    small = cv2.resize(image, cells, interpolation=cv2.INTER_AREA)
    result = cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR)
    sharp = np.zeros((height, width), np.uint8)
    for xy in np.array(persons, dtype=float):
        wide = max(2, round(BODY * _extent_px(xy)))
        xy[list(body.face)] = np.nan  # a face placed wrongly lies beside the true one
        stick_drawing.draw(sharp, [xy], body.bones, 255, wide, wide // 2)
    cv2.copyTo(image, sharp, result)
    return result


def hide(image: NDArray, persons: NDArray, everybody: NDArray, body: Body) -> NDArray:
    """Return a picture in which neither these persons nor anybody else can be recognised.

    Arguments are as for `only_persons` and `hide_faces`.
    """
    return hide_faces(only_persons(image, persons, body), everybody, body)
