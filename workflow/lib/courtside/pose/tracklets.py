"""Follow several people at once through the pictures of one fixed camera, as tracklets.

A tracklet certainly shows one body: it ends where its tracker may have changed to another one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from courtside.pose import tracking
from courtside.pose.detector import LandmarkNetwork, PersonDetector, Pose, Region
from courtside.pose.foreground import Foreground, Whole
from courtside.pose.tracking import Track

# ASSUME: for people who play or walk, filmed at 25 frames a second or more; shares are of a body's
# size in the picture.
SEARCH_EVERY = 5  # frames between two searches for people who are not followed yet
REST_S = 0.1  # a row stays empty for so long between two tracklets
JUMP = 0.25  # a body further from its prediction is another one
TWINS = 0.12  # poses closer than this, on the average of their joints, are one body
MEETING = 0.35  # bodies with middles closer than this may be taken for one another
STEADY = 0.5  # share of the old velocity in the new one
BODY_MARGIN = 0.15  # foreground this close to a body's joints is explained by it


@dataclass(frozen=True, eq=False)
class _Body:
    """One followed body: its row, its last pose, and its motion in px per frame."""

    row: int
    pose: Pose
    velocity: NDArray

    def off_px(self, pose: Pose) -> float:
        """Return how far a pose is from where this body's is predicted."""
        return float(np.linalg.norm(middle(pose) - (middle(self.pose) + self.velocity)))

    def moved(self, pose: Pose) -> _Body:
        """Return the body in its next pose."""
        step = middle(pose) - middle(self.pose)
        return replace(self, pose=pose, velocity=STEADY * self.velocity + (1 - STEADY) * step)

    @property
    def region(self) -> Region:
        x, y = self.velocity
        return replace(self.pose.region, x=self.pose.region.x + x, y=self.pose.region.y + y)


def middle(pose: Pose) -> NDArray:
    """Return the position of a pose, (2,) px: the median of its joints."""
    return np.median(pose.xy, axis=0)


def size_px(pose: Pose) -> float:
    """Return the longer side of the box around a pose's joints."""
    return float(np.ptp(pose.xy, axis=0).max())


def track_people(
    frames: Iterable[tuple[float, NDArray]],
    detector: PersonDetector,
    landmarks: LandmarkNetwork,
    foreground: Foreground | Whole,
    *,
    max_people: int,
    min_presence: float,
    redetect: bool = False,
) -> Track:
    """Follow several people through a video: a track whose arrays have a leading axis of P rows.

    A row holds tracklets one after another, at least 0.1 s apart: P stays a few more than
    `max_people`, however often tracklets end; a gap may change the person.

    A body is lost where the network doubts it, where it leaves the foreground or jumps off its
    course. Of two tracks on one body, the one further off its course is dropped. Where two bodies
    come close and where they part, both tracklets end: the other views decide who is who. At most
    `max_people` are followed at once; with 1, the result is that of `tracking.track_person`, which
    explains the other parameters.
    """
    if max_people == 1:
        track = tracking.track_person(
            frames, detector, landmarks, foreground, min_presence=min_presence, redetect=redetect
        )
        time_s, *arrays = vars(track).values()
        return Track(time_s, *(array[None] for array in arrays))
    crowd = _Crowd(detector, landmarks, foreground, max_people, min_presence)
    times: list[float] = []
    found: list[dict[int, tuple[NDArray, ...]]] = []
    for count, (time_s, image) in enumerate(frames):
        crowd.now_s = time_s
        if redetect:
            crowd.match(crowd.search(image, []))
        else:
            crowd.follow(image)
            if len(crowd.bodies) < max_people and count % SEARCH_EVERY == 0:
                crowd.match(crowd.search(image, [body.pose for body in crowd.bodies]), keep=True)
        crowd.part()
        times.append(time_s)
        found.append(
            {b.row: tracking.as_row(b.pose, landmarks.n_joints, image.shape) for b in crowd.bodies}
        )
    return _stacked(np.array(times), found, landmarks.n_joints)


def _stacked(
    time_s: NDArray, found: Sequence[dict[int, tuple[NDArray, ...]]], n_joints: int
) -> Track:
    n_rows = max((row + 1 for rows in found for row in rows), default=1)
    empty = tracking.as_row(None, n_joints, None)
    arrays = [np.repeat(np.repeat(v[None, None], len(time_s), 1), n_rows, 0) for v in empty]
    for at, rows in enumerate(found):
        for row, values in rows.items():
            for array, value in zip(arrays, values, strict=True):
                array[row, at] = value
    return Track(time_s, *arrays)


@dataclass
class _Crowd:
    """The followed bodies of one camera."""

    detector: PersonDetector
    landmarks: LandmarkNetwork
    foreground: Foreground | Whole
    max_people: int
    min_presence: float
    bodies: list[_Body] = field(default_factory=list)
    now_s: float = 0.0
    ended_s: dict[int, float] = field(default_factory=dict)  # by row: when its last tracklet ended
    meeting: set[int] = field(default_factory=set)  # rows of bodies that are close to another

    def follow(self, image: NDArray) -> None:
        """Find the same bodies in the next picture."""
        boxes = self.foreground.boxes(image) if self.bodies else []
        kept = []
        for body in self.bodies:
            pose = self.landmarks.estimate(image, body.region)
            if pose.presence >= self.min_presence and not tracking.strayed(pose.xy, boxes):
                kept.append((body, pose))
        self._end(set(self.bodies) - {body for body, _ in kept})
        self.bodies = []
        for body, pose in self._without_twins(kept):
            followed = body.moved(pose)
            jumped = body.off_px(pose) > JUMP * size_px(pose)
            self.bodies.append(self._renewed(followed) if jumped else followed)

    def _without_twins(self, pairs: list[tuple[_Body, Pose]]) -> list[tuple[_Body, Pose]]:
        """Drop, of two bodies with one pose, the one further off its course; end both tracklets."""
        kept: list[tuple[_Body, Pose]] = []
        for body, pose in sorted(pairs, key=lambda pair: pair[0].off_px(pair[1])):
            twin = next((k for k in kept if _are_twins(k[1], pose)), None)
            if twin is None:
                kept.append((body, pose))
                continue
            self._end([body])
            kept[kept.index(twin)] = (self._renewed(twin[0]), twin[1])
        return kept

    def search(self, image: NDArray, known: list[Pose]) -> list[Pose]:
        """Return the poses of people who are not in `known`, largest foreground first."""
        poses: list[Pose] = []
        for box in self.foreground.boxes(image, [around(pose) for pose in known]):
            for region in tracking.regions_near(image, box, self.detector):
                if any(_inside(region, pose) for pose in known + poses):
                    continue
                pose = self.landmarks.estimate(image, region)
                if pose.presence < self.min_presence:
                    continue
                if not any(_are_twins(pose, other) for other in known + poses):
                    poses.append(pose)
        return poses[: self.max_people - len(known)]

    def match(self, poses: list[Pose], keep: bool = False) -> None:
        """Assign poses to the bodies they continue, and start new bodies with the rest."""
        # Imported here: one person needs none of it, and loading it takes as long as 15 frames.
        from scipy.optimize import linear_sum_assignment

        old: list[_Body] = [] if keep else self.bodies
        bodies = list(self.bodies) if keep else []
        cost = np.array([[body.off_px(pose) / size_px(pose) for pose in poses] for body in old])
        taken = set()
        for at, to in zip(*linear_sum_assignment(cost.reshape(len(old), len(poses))), strict=True):
            if cost[at, to] <= JUMP:
                bodies.append(old[at].moved(poses[to]))
                taken.add(to)
        rows = {body.row for body in bodies}
        self._end([body for body in old if body.row not in rows])
        self.bodies = bodies
        for to, pose in enumerate(poses):
            if to not in taken:
                self.bodies.append(_Body(self._free_row(), pose, np.zeros(2)))

    def part(self) -> None:
        """End the tracklets of bodies that begin or cease to be close."""
        close: set[int] = set()
        for at, one in enumerate(self.bodies):
            for other in self.bodies[at + 1 :]:
                apart = np.linalg.norm(middle(one.pose) - middle(other.pose))
                if apart < MEETING * max(size_px(one.pose), size_px(other.pose)):
                    close |= {one.row, other.row}
        changed = close ^ {row for row in self.meeting if row in {b.row for b in self.bodies}}
        self.meeting = close - changed
        for at, body in enumerate(self.bodies):
            if body.row in changed:
                self.bodies[at] = self._renewed(body)
                self.meeting |= {self.bodies[at].row} if body.row in close else set()

    def _renewed(self, body: _Body) -> _Body:
        """Return the body with a new tracklet."""
        row = self._free_row()
        self._end([body])
        self.meeting |= {row} if body.row in self.meeting else set()
        return replace(body, row=row)

    def _end(self, bodies: Iterable[_Body]) -> None:
        for body in bodies:
            self.ended_s[body.row] = self.now_s

    def _free_row(self) -> int:
        used = {body.row for body in self.bodies}
        row = 0
        while row in used or self.now_s - self.ended_s.get(row, -np.inf) < REST_S:
            row += 1
        self.ended_s[row] = np.inf  # not free until it ends
        return row


def _are_twins(one: Pose, other: Pose) -> bool:
    """Return whether two poses are of one body."""
    apart = np.linalg.norm(one.xy - other.xy, axis=1).mean()
    return bool(apart < TWINS * max(size_px(one), size_px(other)))


def around(pose: Pose) -> tuple[float, float, float, float]:
    """Return the box (x, y, width, height) that a pose explains, px."""
    margin = BODY_MARGIN * size_px(pose)
    low, high = pose.xy.min(axis=0) - margin, pose.xy.max(axis=0) + margin
    return (*low, *(high - low))


def _inside(region: Region, pose: Pose) -> bool:
    """Return whether a region shows the body of a pose."""
    apart = np.hypot(region.x - pose.region.x, region.y - pose.region.y)
    return apart < MEETING * size_px(pose) / 2
