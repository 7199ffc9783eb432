"""The keypoints of a take at common times, and its persons triangulated by the other cameras.

C cameras, P persons, T frames, K middles between the same joint of both sides (shoulders, ...,
ankles), R tracklets of a camera. S of the T frames are used. Lengths in pictures are in px, or in
heights of the person there. Middles do not depend on left and right, which the fusion decides from
all cameras, including wrong ones.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import triangulation
from courtside.geometry.camera import Camera, project
from courtside.kinematics.filtering import runs
from courtside.reconstruction import fusion, person_height, resampling
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import skeleton as limbs
from courtside.records.keypoints.keypoints import Keypoints3D, while_there
from courtside.records.keypoints.skeleton import Skeleton

MOST_FRAMES = 600  # ASSUME: of all persons together; enough for shares known to 2 %
AGREED = 0.05  # heights: as `triangulate.max_error_share`
MIN_SCORE = 0.05  # of a keypoint that counts, as `triangulate.min_score`
HALF = 0.5  # of the middles: fewer do not show a person
ROUNDING_S = 1e-6  # of times that are converted between clocks
MARGIN = 0.05  # of the picture: somebody nearer to its border may be cut off
AWAY_S = 5.0  # ASSUME: no network misses somebody for so long in all pictures, but finds others
TOGETHER_S = 0.2  # ASSUME: people leave, or come back into, all pictures within no shorter time
MORE = 0.2  # bodies: one more in a fifth of the frames may be the person who is missed


@dataclass(frozen=True, eq=False)
class Seen:
    """What the cameras saw of a take."""

    cameras: Sequence[Camera]
    points: Keypoints3D  # of the limb joints only
    xy: NDArray  # (C, P, T, K, 2) px: keypoints by person, NaN where not followed
    score: NDArray  # (C, P, T, K)
    rows: Sequence[NDArray]  # of each camera (R, T, K, 2) px: keypoints by tracklet
    height_px: NDArray  # (C, P, T)
    filmed: NDArray  # (C, T): whether each camera ran
    at: NDArray  # (S,): the frames that are looked at
    # (C, P, S, K, 3) m: middles by all cameras but one and those of `out`; NaN where these disagree
    others: NDArray
    spread_m: NDArray  # (C, P, S, K): their standard deviation by keypoints of the usual error
    out: tuple[int, ...] = ()  # cameras that place nobody
    clock_doubts: tuple[str, ...] = ()  # what speaks against each camera's clock; or empty

    @property
    def followed(self) -> NDArray:
        """Whether each camera follows each person, (C, P, T)."""
        return shown(self.xy)

    @cached_property
    def present(self) -> NDArray:
        """Whether each person is there, (P, T): from the first to the last frame in two cameras.

        Who is followed in two cameras at no time is there all the time: lost, as far as is known.
        Who is away in between is not there.
        """
        followed = self.followed.sum(axis=0) >= 2
        return while_there(followed) & ~(_away(self) & followed.any(axis=1, keepdims=True))

    def expected(self, camera: int) -> NDArray:
        """Return whether a person is expected in a picture, (P, S): inside, or position unknown.

        Nobody is where the camera did not run, nor while a person is away.
        """
        middle = np.ma.median(np.ma.masked_invalid(self.others[camera]), axis=2).filled(np.nan)
        unknown = np.isnan(middle).any(axis=-1)
        size = np.array(self.cameras[camera].size)
        with np.errstate(invalid="ignore"):
            place = project(self.cameras[camera], middle)
            inside = ((place > MARGIN * size) & (place < (1 - MARGIN) * size)).all(axis=-1)
        return (inside | unknown) & self.filmed[camera, self.at] & self.present[:, self.at]

    def hardly_placed(self, camera: int) -> bool:
        """Return whether the others leave most middles open along a line.

        They stand too near each other, or face each other: the camera may see exactly along it.
        """
        spread_m = self.spread_m[camera][np.isfinite(self.others[camera, ..., 0])]
        return len(spread_m) > 0 and float(np.median(spread_m)) > fusion.WEAK_M

    def errors(self, camera: int, xy: NDArray, model: Camera | None = None) -> NDArray:
        """Return keypoints (P, S, K, 2) minus the others' projections, heights."""
        there = project(model or self.cameras[camera], self.others[camera])
        return (xy - there) / self.height_px[camera][:, self.at, None, None]


def _away(seen: Seen) -> NDArray:
    """Return when persons are away, (P, T): for long in no picture, and no network fails meanwhile.

    Then pictures show others, or everybody has left. Not if a camera then shows more bodies who are
    nobody: one of them may be the person, lost.
    """
    followed, time_s = seen.followed, seen.points.time_s
    bodies = np.stack([shown(rows).sum(axis=0) for rows in seen.rows])
    nobody, works = bodies - followed.sum(axis=1), bodies.any(axis=0) | _left(followed, time_s)
    away = np.zeros(followed.shape[1:], bool)
    for person, there in enumerate(np.any(followed, axis=0)):
        for start, stop in runs(~there) if there.any() else ():
            part = slice(start, stop)
            more = nobody[:, part].mean(axis=1) - nobody[:, there].mean(axis=1)
            long = np.ptp(time_s[part]) > AWAY_S
            away[person, part] = long and works[part].mean() >= HALF and more.max() < MORE
    return away


def _left(followed: NDArray, time_s: NDArray) -> NDArray:
    """Return when nobody is followed, (C, P, T), because everybody has left, (T,).

    People leave pictures one after another, and come back so. When light or a network fails, or
    works again, most of the bodies are last seen, or seen again, at one time.
    """
    total = followed.sum(axis=(0, 1))
    left = np.zeros(len(total), bool)
    for start, stop in runs(total == 0):
        before, after = time_s[start] - time_s[:start], time_s[stop:] - time_s[stop - 1]
        sides = [(before, total[:start]), (after, total[stop:])]
        most = [
            [number[away_s < most_s].max(initial=0) for most_s in (TOGETHER_S, AWAY_S)]
            for away_s, number in sides
            if len(number)
        ]
        left[start:stop] = bool(most) and all(0 < 2 * edge <= near for edge, near in most)
    return left


def shown(xy: NDArray) -> NDArray:
    """Return where keypoints (..., K, 2) show half of the middles or more, (...)."""
    return np.isfinite(xy).all(axis=-1).mean(axis=-1) >= HALF


def typical(errors: NDArray) -> NDArray:
    """Return the median length (...) of errors (..., K, 2); NaN where few middles have one."""
    length = np.ma.masked_invalid(np.linalg.norm(errors, axis=-1))
    enough = (~np.ma.getmaskarray(length)).mean(axis=-1) >= HALF
    return np.where(enough, np.ma.median(length, axis=-1).filled(np.nan), np.nan)


def gather(footage: Sequence[Footage], points: Keypoints3D, skeleton: Skeleton) -> Seen:
    """Bring a take together; `footage` are the cameras of `points`, in its order."""
    cameras = [one.camera for one in footage]
    views, clocks = [one.view for one in footage], [one.clock for one in footage]
    xy, score = resampling.resample_all(views, clocks, points.time_s)
    height_px = person_height.in_pictures(cameras, xy, score, skeleton.joints)
    sides = [[skeleton.index(side + limb) for limb in limbs.LIMBS] for side in ("left_", "right_")]
    tracks = [resampling.resample(one.tracklets, points.time_s, one.clock)[0] for one in footage]
    rows = [(track[:, :, sides[0]] + track[:, :, sides[1]]) / 2 for track in tracks]
    xy = (xy[:, :, :, sides[0]] + xy[:, :, :, sides[1]]) / 2
    score = np.minimum(score[:, :, :, sides[0]], score[:, :, :, sides[1]])
    own_s = [clock.from_reference(points.time_s) for clock in clocks]
    filmed = [
        (time_s > view.time_s[0] - ROUNDING_S) & (time_s < view.time_s[-1] + ROUNDING_S)
        for time_s, view in zip(own_s, views, strict=True)
    ]
    step = max(1, len(points.time_s) * max(xy.shape[1], 1) // MOST_FRAMES)
    at = np.arange(0, len(points.time_s), step)
    nowhere = np.full((*xy[:, :, at].shape[:-1], 3), np.nan)
    limb_points = points.some_joints(sides[0] + sides[1])
    ran = np.stack(filmed)
    unknown = nowhere, nowhere[..., 0]
    found = Seen(cameras, limb_points, xy, score, rows, height_px, ran, at, *unknown)
    return without(replace(found, clock_doubts=tuple(clock.doubt for clock in clocks)), ())


def without(seen: Seen, out: tuple[int, ...]) -> Seen:
    """Return the same take with the cameras `out` left out of the triangulation of persons."""
    found, spread_m = np.full(seen.others.shape, np.nan), np.full(seen.spread_m.shape, np.nan)
    xy, score = seen.xy[:, :, seen.at], seen.score[:, :, seen.at]
    for camera in range(len(seen.cameras)):
        rest = [at for at in range(len(seen.cameras)) if at != camera and at not in out]
        if len(rest) > 1:
            placed = _placed(seen, rest, xy, score)
            found[camera] = placed.xyz.reshape(found[camera].shape)
            spread_m[camera] = triangulation.spread(placed).reshape(spread_m[camera].shape)
    return replace(seen, others=found, spread_m=spread_m, out=out)


def with_exchanged(seen: Seen, one: int, other: int) -> Seen:
    """Return the same take with the videos of two cameras exchanged."""
    order = list(range(len(seen.cameras)))
    order[one], order[other] = other, one
    videos = {key: getattr(seen, key)[order] for key in ("xy", "score", "height_px", "filmed")}
    rows = [seen.rows[at] for at in order]
    return without(replace(seen, rows=rows, **videos), seen.out)


def disagreement(seen: Seen, used: Sequence[int]) -> float:
    """Return the disagreement of some cameras with equal weights, in heights of the person.

    It is the median over the middles of the root mean square residual per degree of freedom; NaN if
    no middle is seen by two of them.
    """
    xy = seen.xy[list(used)][:, :, seen.at].reshape(len(used), -1, 2)
    cameras = [seen.cameras[at] for at in used]
    xyz = triangulation.triangulate_all(cameras, xy)
    there = np.stack([project(camera, xyz) for camera in cameras])
    n_middles = seen.xy.shape[3]
    height_px = np.repeat(
        seen.height_px[list(used)][:, :, seen.at].reshape(len(used), -1), n_middles, axis=1
    )
    square = np.square((xy - there) / height_px[..., None]).sum(axis=-1)
    n_views = np.isfinite(square).sum(axis=0)
    left = np.nansum(square, axis=0)[n_views > 1] / (2 * n_views[n_views > 1] - 3)
    return float(np.sqrt(np.median(left))) if len(left) else float("nan")


def _placed(seen: Seen, rest: list[int], xy: NDArray, score: NDArray) -> triangulation.Triangulated:
    """Triangulate the middles (P S K) by some cameras."""
    limit_px = AGREED * seen.height_px[rest][:, :, seen.at]
    return triangulation.triangulate_robust(
        [seen.cameras[at] for at in rest],
        xy[rest].reshape(len(rest), -1, 2),
        score[rest].reshape(len(rest), -1),
        max_error_px=np.repeat(limit_px.reshape(len(rest), -1), score.shape[-1], axis=1),
        min_score=MIN_SCORE,
    )
