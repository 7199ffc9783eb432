"""Strips of small pictures of each person found: by camera, at times spread over the take."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry import interpolation
from courtside.pose import privacy
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.people import People
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import StrPath
from courtside.video import reader

# ASSUME: enough to see who it is and whether it stays the same person.
COLUMNS = 6  # times at which each person is shown
HEIGHT_PX = 150
WIDEST = 1.2  # of the height
MARGIN = 0.2  # of the body's size, around it
QUALITY = 80  # of JPEG


@dataclass(frozen=True)
class Shot:
    """A person in one picture of one camera."""

    person: int
    column: int
    camera: str
    time_s: float  # of the camera's video
    at_px: tuple[float, float]  # on the person's body, px of the video
    size_px: float  # of the body
    picture: bytes  # JPEG, nobody's face to be recognised


def times(people: People, seen: Sequence[Footage], person: int, count: int = COLUMNS) -> NDArray:
    """Return the instants (N,), as indices of `people.time_s`, at which a person is shown.

    The take is divided into `count` parts; from each in which the person is seen comes the instant
    at which most cameras do, of several the one nearest to the part's middle.
    """
    n_views = np.zeros(len(people.time_s), int)
    for one in seen:
        at = frames_at(one, people.time_s)
        n_views += people.index[one.camera.name][person, at] >= 0
    found = []
    for part in np.array_split(np.arange(len(n_views)), min(count, len(n_views))):
        best = part[n_views[part] == n_views[part].max()]
        if n_views[best[0]]:
            found.append(best[np.abs(best - part.mean()).argmin()])
    return np.array(found, int)


def frames_at(one: Footage, time_s: NDArray) -> NDArray:
    """Return the frame of a camera nearest to each instant of the reference clock."""
    return interpolation.nearest(one.tracklets.time_s, one.clock.from_reference(time_s))


def pictures(
    one: Footage, video: StrPath, people: People, columns: dict[int, NDArray], skeleton: Skeleton
) -> Iterator[Shot]:
    """Cut the persons out of the pictures of one camera, faces and surroundings made coarse.

    `columns` are the instants of each person, as of `times`. A frame in which a tracklet has no
    joints has no picture.
    """
    view, index = one.tracklets, people.index[one.camera.name]
    body = privacy.Body.of(skeleton)
    wanted: dict[int, list[tuple[int, int]]] = {}
    for person, at in columns.items():
        for column, frame in enumerate(frames_at(one, people.time_s[at]).tolist()):
            row = index[person, frame]
            if row >= 0 and np.isfinite(view.xy[row, frame]).all(axis=1).any():
                wanted.setdefault(frame, []).append((person, column))
    frames = sorted(wanted)
    for frame, (_, image) in zip(
        frames, reader.read_frames(video, view.time_s[frames]), strict=True
    ):
        for person, column in wanted[frame]:
            xy = view.xy[index[person, frame], frame]
            near = privacy.around(view.time_s, view.xy, frame)
            hidden = privacy.hide(image, xy[None], near, body)
            known = xy[np.isfinite(xy).all(axis=1)]
            middle = np.median(known, axis=0)
            yield Shot(
                person,
                column,
                one.camera.name,
                float(view.time_s[frame]),
                (round(float(middle[0]), 1), round(float(middle[1]), 1)),
                float(np.ptp(known, axis=0).max()),
                _jpeg(cut(hidden, known)),
            )


def cut(image: NDArray, xy: NDArray) -> NDArray:
    """Return the part of a picture around joints (J, 2), made `HEIGHT_PX` tall."""
    height, width = image.shape[:2]
    low, high = xy.min(axis=0), xy.max(axis=0)
    margin = MARGIN * max(float((high - low).max()), 4.0)
    left, top = np.clip(np.floor(low - margin), 0, [width - 2, height - 2]).astype(int)
    right, bottom = np.clip(np.ceil(high + margin), [left + 2, top + 2], [width, height]).astype(
        int
    )
    part = image[top:bottom, left:right]
    scale = min(HEIGHT_PX / part.shape[0], WIDEST * HEIGHT_PX / part.shape[1])
    size = max(1, round(part.shape[1] * scale)), max(1, round(part.shape[0] * scale))
    return cv2.resize(part, size, interpolation=cv2.INTER_AREA)


def _jpeg(image: NDArray) -> bytes:
    return bytes(cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])[1])
