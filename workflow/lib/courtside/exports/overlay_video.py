"""A take's video with the network's keypoints and the reprojected 3D skeleton drawn in."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry import interpolation
from courtside.geometry.camera import project
from courtside.pose import privacy, stick_drawing
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import InputError

BRIDGED_S = 1.0  # ASSUME: a face unseen for longer may be anywhere, and is not guessed
LINE = 1 / 540  # of the picture's height
LETTER = 1 / 1400  # size of the letters, of the picture's shorter side
UNDER = 1.6  # thickness of the 3D skeleton relative to the keypoints drawn over it
DETECTED, REPROJECTED, NOT_USED = "detected", "3D skeleton", "view not used"


@dataclass(frozen=True, eq=False)
class Track:
    """What is drawn on the pictures of one camera, frame by frame."""

    camera: str
    own_s: NDArray  # (T,): time of each frame on the camera's own clock
    reference_s: NDArray  # (T,): and on the reference clock
    detected: NDArray  # (P, T, J, 2): px; NaN where missing
    reprojected: NDArray  # (P, T, J, 2): px; NaN where missing
    used: NDArray  # (P, T, J) bool: whether the 3D point rests on this camera's keypoint
    everybody: NDArray  # (F, T, J, 2): all whose faces may be in the picture, px, gaps bridged
    body: privacy.Body


def track(seen: Footage, points: Keypoints3D, skeleton: Skeleton) -> Track:
    """Gather what is drawn on one camera's pictures.

    Faces of all tracklets are hidden, those of bystanders as well. Persons are in the order of
    `points.person_id`. The 3D skeleton is that of each frame's own time, between neighbouring
    points, in the camera as it was turned then; there is none beyond their ends. Raises
    `ValueError` if `points` do not rest on this camera, or persons do not fit.
    """
    camera, view, assigned = seen.camera, seen.tracklets, seen.view
    if camera.name not in points.cameras or assigned.xy.shape[0] != len(points.person_id):
        raise ValueError(f"{camera.name}: points and 2D keypoints of other cameras or persons")
    reference_s = seen.clock.to_reference(view.time_s)
    xyz = between(points.time_s, points.xyz, reference_s)
    reprojected = project(camera, xyz)
    if seen.turns is not None:
        for frame in range(len(view.time_s)):
            reprojected[:, frame] = project(seen.standing(frame), xyz[:, frame])
    at = np.interp(reference_s, points.time_s, np.arange(len(points.time_s))).round().astype(int)
    column = points.cameras.tolist().index(camera.name)
    everybody = np.concatenate([view.xy, reprojected])
    return Track(
        camera.name,
        view.time_s,
        reference_s,
        assigned.xy,
        reprojected,
        points.accepted[..., column][:, at],
        np.array([bridged(view.time_s, one) for one in everybody]).reshape(everybody.shape),
        privacy.Body.of(skeleton),
    )


def between(time_s: NDArray, xyz: NDArray, wanted_s: NDArray) -> NDArray:
    """Interpolate positions (P, T, J, 3) at times (T,) linearly at other times (W,).

    NaN where a neighbour is missing, and more than half a frame outside the times.
    """
    if len(time_s) < 2:
        return np.where((wanted_s == time_s)[:, None, None], xyz, np.nan)
    before, share = interpolation.shares(time_s, wanted_s)
    # Near a sample, a missing neighbour on its other side does not matter.
    near = np.abs(share - share.round()) < 1e-3
    found = interpolation.linear(time_s, xyz.swapaxes(0, 1), wanted_s)
    found[near] = xyz[:, before[near] + share[near].round().astype(int)].swapaxes(0, 1)
    half_s = np.median(np.diff(time_s)) / 2
    found[(wanted_s < time_s[0] - half_s) | (wanted_s > time_s[-1] + half_s)] = np.nan
    return found.swapaxes(0, 1)


def bridged(time_s: NDArray, xy: NDArray) -> NDArray:
    """Fill short gaps in paths (T, K, 2) px, so that a face stays hidden while it is not seen.

    They become straight lines, and the nearest known position beyond the ends; NaN where no frame
    within 1 s has the joint.
    """
    result = np.array(xy, dtype=float)
    for joint in range(xy.shape[1]):
        known = np.flatnonzero(np.isfinite(xy[:, joint]).all(axis=1))
        if not len(known):
            continue
        away_s = np.abs(time_s[known[interpolation.nearest(time_s[known], time_s)]] - time_s)
        for axis in range(2):
            filled = np.interp(time_s, time_s[known], xy[known, joint, axis])
            result[:, joint, axis] = np.where(away_s <= BRIDGED_S, filled, np.nan)
    return result


def pictures(
    frames: Iterable[tuple[float, NDArray]],
    track: Track,
    *,
    colours: Sequence[tuple[int, int, int]],
    hide_faces: bool,
    keep_background: bool = False,
) -> Iterator[NDArray]:
    """Draw on pictures (H, W, 3) uint8, BGR, as they come; only one is in memory.

    They come with times on the camera's own clock. `colours` are those of detected joints, of the
    3D skeleton, and of views that were not used. With `keep_background` surroundings stay sharp
    where faces are hidden: for videos that show nobody else. An odd height or width grows by a
    pixel, as H.264 requires. Raises `InputError` if `track` has no frame at a frame's time: a face
    might show.
    """
    step_s = np.median(np.diff(track.own_s)) if len(track.own_s) > 1 else 1.0
    for time_s, image in frames:
        at = int(np.abs(track.own_s - time_s).argmin())
        if abs(track.own_s[at] - time_s) > step_s / 4:
            raise InputError(
                f"camera {track.camera}: expected 2D keypoints for the frame at {time_s:.4f} s, "
                f"found the nearest at {track.own_s[at]:.4f} s; detect the pose in this video again"
            )
        if hide_faces:
            if not keep_background:
                persons = np.concatenate([track.detected[:, at], track.reprojected[:, at]])
                image = privacy.only_persons(image, persons, track.body)
            everybody = privacy.around(track.own_s, track.everybody, at)
            image = privacy.hide_faces(image, everybody, track.body)
        yield _drawn(image, track, at, colours)


def _drawn(
    image: NDArray, track: Track, at: int, colours: Sequence[tuple[int, int, int]]
) -> NDArray:
    height, width = image.shape[:2]
    odd = height % 2, width % 2
    image = cv2.copyMakeBorder(image, 0, odd[0], 0, odd[1], cv2.BORDER_REPLICATE)
    thick = max(1, round(height * LINE))
    detected, reprojected = track.detected[:, at], track.reprojected[:, at]
    bones, under = track.body.bones, round(UNDER * thick)
    stick_drawing.draw(image, reprojected, bones, colours[1], under, 3 * thick)
    stick_drawing.draw(image, detected, bones, colours[0], thick, 2 * thick)
    drawn = stick_drawing.drawable(detected) & stick_drawing.drawable(reprojected)
    apart = drawn & ~track.used[:, at]
    for start, stop in zip(detected[apart], reprojected[apart], strict=True):
        ends = stick_drawing.pixel(start), stick_drawing.pixel(stop)
        cv2.line(image, *ends, colours[2], thick, cv2.LINE_AA)
    _caption(image, track, at, colours)
    return image


def _caption(
    image: NDArray, track: Track, at: int, colours: Sequence[tuple[int, int, int]]
) -> None:
    """Write camera, time and colours into the upper left corner, on a dark ground."""
    words = [f"{track.camera}  {track.reference_s[at]:.3f} s  frame {at}"]
    names = DETECTED, REPROJECTED, NOT_USED
    scale = max(0.4, min(image.shape[:2]) * LETTER)
    thick, line = max(1, round(scale * 1.4)), round(32 * scale)
    white = (255, 255, 255)
    texts = [*zip(words, [white], strict=True), *zip(names, colours, strict=True)]
    font = cv2.FONT_HERSHEY_SIMPLEX
    width = max(cv2.getTextSize(text, font, scale, thick)[0][0] for text, _ in texts)
    corner = image[: line * len(texts) + line // 2, : width + line]
    corner[:] = corner // 4
    for row, (text, colour) in enumerate(texts, start=1):
        place = line // 2, row * line
        cv2.putText(image, text, place, font, scale, colour, thick, cv2.LINE_AA)
