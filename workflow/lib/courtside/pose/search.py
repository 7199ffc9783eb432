"""Where people are looked for in the pictures of one fixed camera, and whether one is there.

A difference from the background says where to look first. It is never a condition: the tiles of the
whole picture are searched as well, and a person who stands in the background is found in them.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.pose import tiles, tracking
from courtside.pose.detector import LandmarkNetwork, PersonDetector, Pose, Region
from courtside.pose.foreground import Box, Foreground

# ASSUME: this block has no source but the development takes; shares are of a body's size.
TWINS = 0.12  # poses closer than this, on the average of their joints, are one body
MEETING = 0.35  # bodies with middles closer than this may be taken for one another
CLOSE = 0.08  # a second person is searched for where regions' centres are at least this far apart
PART = 0.85  # a pose smaller than this within another is a part of that body
BODY_MARGIN = 0.15  # foreground this close to a body's joints is explained by it
# A body is looked at in a square of so many times its size, in turns: the detector's answers to
# different ones are nearly independent.
CROPS = (2.0, 1.7, 2.5)
TILES_A_SEARCH = 3  # of a search once a second: a twentieth of the time of following one person
EXPLAINED = 0.7  # foreground of which a body covers this share shows nobody else
VAIN_S = 1.0  # a place where nobody was found is left alone for so long
VAIN_OVERLAP = 0.5  # intersection over union of places that are the same


def middle(pose: Pose) -> NDArray:
    """Return the position of a pose, (2,) px: the median of its joints."""
    return np.median(pose.xy, axis=0)


def are_twins(one: Pose, other: Pose) -> bool:
    """Return whether two poses are of one body."""
    apart = np.linalg.norm(one.xy - other.xy, axis=1).mean()
    return bool(apart < TWINS * max(one.size_px, other.size_px))


def are_close(one: Pose, other: Pose, share: float = MEETING) -> bool:
    """Return whether two bodies are close: at MEETING, they may be taken for one another."""
    apart = np.linalg.norm(middle(one) - middle(other))
    return bool(apart < share * max(one.size_px, other.size_px))


def around(pose: Pose) -> tuple[float, float, float, float]:
    """Return the box (x, y, width, height) that a pose explains, px."""
    margin = BODY_MARGIN * pose.size_px
    low, high = pose.xy.min(axis=0) - margin, pose.xy.max(axis=0) + margin
    return (*low, *(high - low))


def inside(region: Region, pose: Pose, reach: float = MEETING / 2) -> bool:
    """Return whether a region shows the body of a pose: whether their centres are close."""
    return _apart_px(region, pose) < reach * pose.size_px


def confirms(region: Region, pose: Pose, others: Iterable[Pose]) -> bool:
    """Return whether a region shows the body of a pose, and none of the others' more closely.

    So one person found by the detector does not confirm two poses.
    """
    apart = _apart_px(region, pose)
    return inside(region, pose) and not any(_apart_px(region, other) < apart for other in others)


def _apart_px(region: Region, pose: Pose) -> float:
    """Return how far the centres of a region and a pose are apart: of their boxes, if it has one.

    The centre of BlazePose's regions is the middle of the hips.
    """
    if region.box is None:
        return float(np.hypot(region.x - pose.region.x, region.y - pose.region.y))
    x, y = (pose.xy.min(axis=0) + pose.xy.max(axis=0)) / 2
    return float(np.hypot(region.x - x, region.y - y))


def _is_part(pose: Pose, whole: Pose) -> bool:
    """Return whether a pose is a smaller one within another: a part taken for a whole body."""
    x, y, width, height = around(whole)
    low, high = pose.xy.min(axis=0) >= (x, y), pose.xy.max(axis=0) <= (x + width, y + height)
    return bool(low.all() and high.all() and pose.size_px < PART * whole.size_px)


class Search:
    """Looks for people in pictures of one camera; a pose counts from the `min_presence`, 0 to 1."""

    def __init__(
        self,
        detector: PersonDetector,
        landmarks: LandmarkNetwork,
        foreground: Foreground,
        min_presence: float,
    ) -> None:
        self.detector, self.landmarks = detector, landmarks
        self.foreground, self.min_presence = foreground, min_presence
        self._tiles: list[Region] = []
        self._next = 0
        self._vain: list[tuple[float, Box]] = []

    def everywhere(self, image: NDArray, known: Sequence[Pose]) -> list[Pose]:
        """Return the poses of people in all tiles of a picture who are not in `known`."""
        height, width = image.shape[:2]
        self._tiles, self._next = tiles.tiles(width, height), 0
        return self._in_tiles(image, self._tiles, known)

    def part(self, image: NDArray, known: Sequence[Pose]) -> list[Pose]:
        """Do the same for the next few tiles; later calls go on with the others, in turns."""
        count = min(TILES_A_SEARCH, len(self._tiles))
        chosen = [self._tiles[(self._next + at) % len(self._tiles)] for at in range(count)]
        self._next += count
        return self._in_tiles(image, chosen, known)

    def _in_tiles(
        self, image: NDArray, among: Iterable[Region], known: Sequence[Pose]
    ) -> list[Pose]:
        regions = tiles.search(image, among, self.detector)
        return self._poses(image, regions, known, sure=True)

    def changed(
        self, image: NDArray, known: Sequence[Pose], now_s: float, boxes: Sequence[Box]
    ) -> list[Pose]:
        """Return the poses of people who are not in `known`, where the background has changed.

        `boxes` are all that has changed. People in the largest foreground come first. A place where
        nobody was found is left alone for a second. While nobody at all is known, the largest
        foreground is taken for a person, even if the detector does not find one in it.
        """
        self._vain = [(at, box) for at, box in self._vain if now_s - at < VAIN_S]
        if known:
            explained = [around(pose) for pose in known]
            if all(any(_covered(box, e) > EXPLAINED for e in explained) for box in boxes):
                return []
            boxes = self.foreground.boxes(image, explained)
        poses: list[Pose] = []
        for count, box in enumerate(boxes):
            lonely = not known and not count
            if not lonely and any(_overlap(box, vain) > VAIN_OVERLAP for _, vain in self._vain):
                continue
            regions = tracking.regions_near(image, box, self.detector, fallback=lonely)
            found = self._poses(image, regions, [*known, *poses], sure=False)
            poses += found
            if not found:
                self._vain.append((now_s, box))
        return poses

    def behind(self, background: NDArray, image: NDArray, xy: NDArray) -> list[Pose]:
        """Return people whom the background itself shows, where a picture gives reason to look.

        That is where the picture differs from it, and where persons with joints `xy` (P, J, 2) px
        stand in it; NaN where unknown.
        """
        regions = []
        for box in self.foreground.boxes(image):
            regions += tracking.regions_near(background, box, self.detector, fallback=False)
        for person in xy[np.isfinite(xy).all(axis=2).any(axis=1)]:
            regions += tiles.look(background, _square(person), self.detector)
        return self._poses(background, regions, [], sure=True)

    def near(self, image: NDArray, pose: Pose, known: Sequence[Pose]) -> list[Pose]:
        """Return the poses of people who are not in `known`, around the place of a lost pose."""
        regions = tiles.look(image, surroundings(pose), self.detector)
        return self._poses(image, regions, known, sure=False)

    def look_at(
        self, image: NDArray, pose: Pose, known: Sequence[Pose], turn: int = 0
    ) -> tuple[bool, list[Pose]]:
        """Let the detector look at a pose: whether it finds a person there, and who else it finds.

        The others are people who are not in `known`, such as one whom this person covers in part.
        The square that it looks at changes with the `turn`.
        """
        regions = tiles.look(image, surroundings(pose, turn), self.detector)
        others = [other for other in known if other is not pose]
        confirmed = any(confirms(region, pose, others) for region in regions)
        return confirmed, self._poses(image, regions, known, sure=True)

    def _poses(
        self, image: NDArray, regions: Iterable[Region], known: Sequence[Pose], sure: bool
    ) -> list[Pose]:
        """Return the poses in regions that are of nobody else.

        Where they must be `sure`, and close to other people, two looks have to agree.
        """
        poses: list[Pose] = []
        reach = CLOSE if sure else MEETING / 2
        for region in regions:
            others = [*known, *poses]
            if any(inside(region, pose, reach) for pose in others):
                continue
            pose = self.landmarks.estimate(image, region)
            if sure and pose.presence >= self.min_presence:
                pose = self.landmarks.estimate(image, pose.region)
            if pose.presence < self.min_presence or any(are_twins(pose, o) for o in others):
                continue
            doubtful = sure or any(are_close(pose, other) for other in others)
            if not doubtful or self._confirmed(image, pose, others):
                poses.append(pose)
        return poses

    def _confirmed(self, image: NDArray, pose: Pose, others: Sequence[Pose]) -> bool:
        """Return whether a pose is no part of another one, and the detector finds its person."""
        if any(_is_part(pose, other) for other in others):
            return False
        regions = tiles.look(image, surroundings(pose), self.detector)
        return any(confirms(region, pose, others) for region in regions)


def surroundings(pose: Pose, turn: int = 0) -> Region:
    """Return the square in which the detector looks for the person of a pose."""
    return _square(pose.xy, turn)


def _square(xy: NDArray, turn: int = 0) -> Region:
    low, high = np.nanmin(xy, axis=0), np.nanmax(xy, axis=0)
    x, y = (low + high) / 2
    crop = CROPS[turn % len(CROPS)]
    return Region(float(x), float(y), max(1.0, crop * float((high - low).max())))


def _overlap(one: Box, other: Box) -> float:
    """Return the intersection over union of two boxes."""
    shared = _shared(one, other)
    return shared / (one[2] * one[3] + other[2] * other[3] - shared)


def _covered(box: Box, other: Sequence[float]) -> float:
    """Return the share of a box that another covers."""
    return _shared(box, other) / (box[2] * box[3])


def _shared(one: Sequence[float], other: Sequence[float]) -> float:
    """Return the area that two boxes share, px^2."""
    width = min(one[0] + one[2], other[0] + other[2]) - max(one[0], other[0])
    height = min(one[1] + one[3], other[1] + other[3]) - max(one[1], other[1])
    return max(0.0, width) * max(0.0, height)
