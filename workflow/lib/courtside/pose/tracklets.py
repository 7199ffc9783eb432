"""Follow everybody in the pictures of one fixed camera, as tracklets.

A tracklet certainly shows one body: it ends where its tracker may have changed to another one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from courtside.pose import tracking
from courtside.pose.clothing import Clothing
from courtside.pose.detector import LandmarkNetwork, PersonDetector, Pose, Region
from courtside.pose.foreground import Box, Foreground
from courtside.pose.search import MEETING, Search, are_close, are_twins, middle
from courtside.pose.tracking import Track

# ASSUME: for people who play or walk; shares are of a body's size in the picture.
HINT_S = 0.09  # between two looks at what differs from the background
SEARCH_S = 0.99  # between two searches of some tiles, and two looks of the detector at a body
CROWDED_S = 1.0  # the detector often looks at a body for so long after another one was lost there
REST_S = 0.1  # a row stays empty for so long between two tracklets
JUMP = 0.25  # a body further from its prediction is another one
STEADY = 0.5  # share of the old velocity in the new one
# A body with no other one closer than this is alone: a jump does not lead to another one.
ALONE = MEETING + JUMP
# A body is given up after so many looks in which the detector did not find it; the second number is
# for one that has left the foreground.
DOUBTS, STRAY_DOUBTS = 4, 3


@dataclass(frozen=True, eq=False)
class _Body:
    """One followed body: its row, its last pose, and its motion in px per frame."""

    row: int
    pose: Pose
    velocity: NDArray
    looked_s: float  # when the detector last looked for it
    doubts: int = 0  # looks since the detector last found it
    stray: bool = False  # whether it had left the foreground at the last look at that
    crowded_s: float = -np.inf  # until when the detector often looks for another one beside it

    def off_px(self, pose: Pose) -> float:
        """Return how far a pose is from where this body's is predicted."""
        return float(np.linalg.norm(middle(pose) - (middle(self.pose) + self.velocity)))

    def goes_on(self, pose: Pose) -> bool:
        """Return whether a pose lies on this body's course."""
        return self.off_px(pose) <= JUMP * pose.size_px

    def moved(self, pose: Pose) -> _Body:
        """Return the body in its next pose."""
        step = middle(pose) - middle(self.pose)
        return replace(self, pose=pose, velocity=STEADY * self.velocity + (1 - STEADY) * step)

    @property
    def region(self) -> Region:
        x, y = self.velocity
        return replace(self.pose.region, x=self.pose.region.x + x, y=self.pose.region.y + y)


def track_people(
    frames: Iterable[tuple[float, NDArray]],
    detector: PersonDetector,
    landmarks: LandmarkNetwork,
    foreground: Foreground,
    *,
    max_people: int,
    min_presence: float,
    redetect: bool = False,
    clothing: Clothing | None = None,
) -> Track:
    """Follow everybody through a video: a track whose arrays have a leading axis of P rows.

    People are searched for in tiles of all sizes at the start, in a part of them once a second, and
    where a body was lost; also where the picture differs from the background, ten times a second,
    as long as fewer than `max_people` are followed.

    A row holds tracklets one after another, at least 0.1 s apart: P stays a few more than
    `max_people`, however often tracklets end; a gap may change the person.

    A body is lost where the landmark network doubts it, or where the detector, which looks at it
    once a second and when it leaves the foreground, does not find it several times. Of two tracks
    on one body, the one further off its course is dropped. Where two bodies come close and where
    they part, both tracklets end: the other views decide who is who. So does that of a body that
    jumps off its course, unless it is alone. A body that is alone is looked for where it was, the
    others where their motion takes them.

    Parameters
    ----------
    frames : time in seconds, and picture (H, W, 3) uint8, BGR
    min_presence : below this confidence, 0 to 1, the landmark network's answer is dropped
    redetect : search in every frame instead of following: slower, and without memory
    clothing : takes the colours of each body's clothes
    """
    clothing = clothing or Clothing(())
    search = Search(detector, landmarks, foreground, min_presence)
    crowd = _Crowd(search, max_people)
    times: list[float] = []
    found: list[dict[int, tuple[NDArray, ...]]] = []
    for time_s, image in frames:
        crowd.now_s = time_s
        if redetect:
            crowd.find_again(image)
        else:
            crowd.follow(image)
        crowd.look(image)
        crowd.part()
        times.append(time_s)
        found.append({})
        for body in crowd.bodies:
            row = tracking.as_row(body.pose, landmarks.n_joints, image.shape)
            found[-1][body.row] = *row, clothing.colours(image, body.pose.xy)
    return _stacked(np.array(times), found, landmarks.n_joints)


def _stacked(
    time_s: NDArray, found: Sequence[dict[int, tuple[NDArray, ...]]], n_joints: int
) -> Track:
    n_rows = max((row + 1 for rows in found for row in rows), default=1)
    empty = *tracking.as_row(None, n_joints, None), np.full((2, 3), np.nan)
    arrays = [np.repeat(np.repeat(v[None, None], len(time_s), 1), n_rows, 0) for v in empty]
    for at, rows in enumerate(found):
        for row, values in rows.items():
            for array, value in zip(arrays, values, strict=True):
                array[row, at] = value
    return Track(time_s, *arrays)


@dataclass
class _Crowd:
    """The followed bodies of one camera."""

    search: Search
    max_people: int
    bodies: list[_Body] = field(default_factory=list)
    now_s: float = 0.0
    hinted_s: float = -np.inf  # when the foreground was last looked at
    searched_s: float = -np.inf  # when tiles were last searched
    lost: list[_Body] = field(default_factory=list)  # in this frame
    ended_s: dict[int, float] = field(default_factory=dict)  # by row: when its last tracklet ended
    meeting: set[int] = field(default_factory=set)  # rows of bodies that are close to another

    @property
    def poses(self) -> list[Pose]:
        return [body.pose for body in self.bodies]

    def follow(self, image: NDArray) -> None:
        """Find the same bodies in the next picture."""
        alone = {body.row for body in self.bodies if self._is_alone(body)}
        regions = [b.pose.region if b.row in alone else b.region for b in self.bodies]
        poses = self.search.landmarks.estimate_each(image, regions)
        found = zip(self.bodies, poses, strict=True)
        kept = [(b, pose) for b, pose in found if pose.presence >= self.search.min_presence]
        self.lost = [body for body in self.bodies if body not in {b for b, _ in kept}]
        self.bodies = []
        for body, pose in self._without_twins(kept):
            followed = body.moved(pose)
            steady = body.row in alone or body.goes_on(pose)
            self.bodies.append(followed if steady else self._renewed(followed))

    def _is_alone(self, body: _Body) -> bool:
        return not any(
            are_close(body.pose, other.pose, ALONE) for other in self.bodies if other is not body
        )

    def _without_twins(self, pairs: list[tuple[_Body, Pose]]) -> list[tuple[_Body, Pose]]:
        """Drop, of two bodies with one pose, the one further off its course; end both tracklets."""
        kept: list[tuple[_Body, Pose]] = []
        for body, pose in sorted(pairs, key=lambda pair: pair[0].off_px(pair[1])):
            twin = next((k for k in kept if are_twins(k[1], pose)), None)
            if twin is None:
                kept.append((body, pose))
                continue
            self._end([body])
            kept[kept.index(twin)] = (self._crowded(self._renewed(twin[0])), twin[1])
        return kept

    def find_again(self, image: NDArray) -> None:
        """Find everybody in the next picture without following them."""
        old, self.bodies, self.hinted_s = self.bodies, [], self.now_s
        boxes = self.search.foreground.boxes(image)
        poses = self.search.changed(image, [], self.now_s, boxes)
        for body in old:
            if not any(body.goes_on(pose) for pose in poses):
                poses += self.search.near(image, body.pose, poses)
        self.lost = old
        self.match(poses, old)
        self._end_lost()

    def look(self, image: NDArray) -> None:
        """Look at the bodies again, and for people who are not followed yet."""
        for body in self.lost:
            if self._free() and body.row not in {b.row for b in self.bodies}:
                self.match(self.search.near(image, body.pose, self.poses), self.lost)
        wait_s = HINT_S if self.bodies else 0.0
        if self.now_s - self.hinted_s > wait_s:
            self.hinted_s = self.now_s
            boxes = self.search.foreground.boxes(image)
            self._doubt(image, boxes)
            if self._free():
                found = self.search.changed(image, self.poses, self.now_s, boxes)
                self.match(found, self.lost)
        if self._free() and self.now_s - self.searched_s > SEARCH_S:
            search = self.search.part if np.isfinite(self.searched_s) else self.search.everywhere
            self.searched_s = self.now_s
            self.match(search(image, self.poses), [])
        self._end_lost()

    def _doubt(self, image: NDArray, boxes: Sequence[Box]) -> None:
        """Let the detector look at bodies once a second, and at those that leave the foreground."""
        others: list[Pose] = []
        for at, body in enumerate(self.bodies):
            stray = tracking.strayed(body.pose.xy, boxes)
            hurry = stray and (not body.stray or body.doubts > 0)
            self.bodies[at] = replace(body, stray=stray)
            due = hurry or self.now_s - body.looked_s > SEARCH_S
            if due or self.now_s < body.crowded_s:
                known = [*self.poses, *others]
                sure, beside = self.search.look_at(image, body.pose, known, body.doubts)
                others += beside
            if due:
                doubts = 0 if sure else body.doubts + 1
                self.bodies[at] = replace(body, stray=stray, looked_s=self.now_s, doubts=doubts)
        given_up = [b for b in self.bodies if b.doubts >= (STRAY_DOUBTS if b.stray else DOUBTS)]
        self._end(given_up)
        self.bodies = [body for body in self.bodies if body not in given_up]
        self.match(others, [])

    def match(self, poses: Sequence[Pose], lost: Sequence[_Body]) -> None:
        """Assign poses to the lost bodies that they continue, and start new bodies with the rest.

        At most `max_people` bodies are followed at once.
        """
        old = [body for body in lost if body.row not in {b.row for b in self.bodies}]
        taken = set()
        for at, to in _assigned(old, poses):
            body = replace(old[at].moved(poses[to]), looked_s=self.now_s, doubts=0)
            self.bodies.append(body)
            taken.add(to)
        for to, pose in enumerate(poses):
            if to not in taken and self._free():
                self.bodies.append(_Body(self._free_row(), pose, np.zeros(2), self.now_s))

    def part(self) -> None:
        """End the tracklets of bodies that begin or cease to be close."""
        close: set[int] = set()
        for at, one in enumerate(self.bodies):
            for other in self.bodies[at + 1 :]:
                if are_close(one.pose, other.pose):
                    close |= {one.row, other.row}
        changed = close ^ {row for row in self.meeting if row in {b.row for b in self.bodies}}
        self.meeting = close - changed
        for at, body in enumerate(self.bodies):
            if body.row in changed:
                self.bodies[at] = self._renewed(body)
                self.meeting |= {self.bodies[at].row} if body.row in close else set()

    def _free(self) -> bool:
        return len(self.bodies) < self.max_people

    def _crowded(self, body: _Body) -> _Body:
        return replace(body, crowded_s=self.now_s + CROWDED_S)

    def _end_lost(self) -> None:
        lost = [body for body in self.lost if body.row not in {b.row for b in self.bodies}]
        self._end(lost)
        self.lost = []
        for at, body in enumerate(self.bodies):
            if any(are_close(body.pose, other.pose) for other in lost):
                self.bodies[at] = self._crowded(body)

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
        used = {body.row for body in [*self.bodies, *self.lost]}
        row = 0
        while row in used or self.now_s - self.ended_s.get(row, -np.inf) < REST_S:
            row += 1
        self.ended_s[row] = np.inf  # not free until it ends
        return row


def _assigned(old: Sequence[_Body], poses: Sequence[Pose]) -> list[tuple[int, int]]:
    """Return which body goes on as which pose, by the least sum of distances."""
    if not old or not poses:
        return []
    # Imported here: one person needs none of it, and loading it takes as long as 15 frames.
    from scipy.optimize import linear_sum_assignment

    cost = np.array([[body.off_px(pose) / pose.size_px for pose in poses] for body in old])
    pairs = zip(*linear_sum_assignment(cost), strict=True)
    return [(int(at), int(to)) for at, to in pairs if cost[at, to] <= JUMP]
