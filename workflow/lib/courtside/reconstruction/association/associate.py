"""Association of tracklets across cameras; tracklets that mix people are cut into pieces first."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera
from courtside.reconstruction.association import appearance, candidates, identity, lengths, linking
from courtside.reconstruction.association.rows import Rows, describe
from courtside.study.errors import InputError
from courtside.study.execution import log

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
# Spacing of the instants at which rows are triangulated: costs grow with their number.
EVERY_S = 0.1
# Persons followed beyond the rows that one camera shows at once: they come and go, and cameras see
# different ones.
EXTRA = 2
MOST_PEOPLE = 40  # followed at once; each costs time in every history
FAR_FROM_COURT_M = 6.0  # places further beyond the lines are not triangulated well
ALONE = 4.0  # bonus (log-likelihood) of a row that alone followed the person in a frame
LEARNED_FROM = 200  # instants: from which colours of clothes are learned
COUNTS = 0.1  # share of the take from which somebody counts as a person in it


@dataclass(frozen=True)
class Association:
    """The row of each camera that shows each person; persons in descending order of frames seen."""

    # Of each camera (K, T): row of each person in each frame; -1 where it does not show the person
    index: list[NDArray]
    time_s: NDArray  # (N,): instants of the reference clock, 0.1 s apart
    # (K, N, 3): centre of the body, metres; NaN where fewer than two views agree on it
    path: NDArray
    placed: NDArray  # (K,): share of the instants at which two or more views agree on the person
    doubts: NDArray  # (D, 5) as in `People`

    def line(self) -> str:
        """Return a log line: how many people were found, and how often."""
        if not self.placed.any():
            return "nobody placed from two views or more"
        shares = ", ".join(f"{share:.0%}" for share in self.placed[self.placed >= COUNTS])
        few = int((self.placed < COUNTS).sum())
        more = f"; {few} more in less than {COUNTS:.0%}" if few else ""
        n = int((self.placed >= COUNTS).sum())
        return f"{n} people found, placed from two views or more in {shares or 0} of the take{more}"


def associate(
    cameras: Sequence[Camera],
    xy: Sequence[NDArray],
    time_s: NDArray,
    *,
    trunk: Sequence[int],
    mirror: Sequence[int] | None = None,
    court: Court | None = None,
    bones: Sequence[tuple[int, int]] = (),
    clothing: Sequence[NDArray] | None = None,
    strides: Sequence[int] = (),
) -> Association:
    """Find everybody whom two cameras see, and which tracklets show them, over the whole take.

    `xy` has the tracklet rows (P, T, J, 2) of each camera at common, uniform times `time_s` (T,),
    distorted px, NaN where missing; P may differ. `trunk` are the indices of shoulders and hips.
    With `mirror` (J,), the index of the same joint of the other side, views with confused sides
    still agree. If the `court` has a net, changing halves is assumed to be rare; people far from
    the court are left out. `bones`, pairs of joints of constant distance, distinguish people of
    different size in `doubts`. `clothing` are the colours of the rows' clothes (P, T, 2, 3) in each
    camera. `strides` are the common times per own frame of each camera, 1 unless it is slower.

    At instants 0.1 s apart, rows of several views that meet in space become candidates
    (`candidates`). They are linked over time by a search that keeps several histories (`linking`);
    then each frame of a row gets the person whose path it follows. A row may change its person,
    because a tracker may swap two people where they overlap.

    Raises `InputError` if nobody can be triangulated. If each camera has only one row, these rows
    are returned instead as one person without positions, so that the calibration can be checked.
    """
    alone = all(len(view) == 1 for view in xy)
    xy = [v if len(v) else np.full((1, *v.shape[1:]), np.nan) for v in xy]
    rows = _rows(xy, trunk, strides)
    instants = _instants(time_s)
    looks = _looks(cameras, xy, rows, instants, mirror, clothing)
    found = _near_court(_candidates(cameras, xy, rows, instants, mirror, looks), court)
    net = court.net["y_m"] if court is not None and court.net else None
    piece = _pieces(rows, found, instants)
    chosen = linking.link(found, piece, time_s[instants], _slots(cameras, rows), net, looks)
    is_ray = found.is_ray[chosen] if len(found.instant) else np.zeros_like(chosen, bool)
    ray = (chosen >= 0) & is_ray
    seen_alone, chosen = np.where(ray, chosen, -1), np.where(ray, -1, chosen)
    order = np.argsort(-(chosen >= 0).sum(axis=1), kind="stable")
    order = order[(chosen[order] >= 0).any(axis=1)]
    if not len(order):
        return _unplaced(cameras, xy, time_s, instants, alone)
    people = identity.Followed(chosen[order], seen_alone[order], found, piece)
    index = _index(cameras, rows, time_s, instants, people, looks)
    path = people.path()
    return Association(
        index=index,
        time_s=time_s[instants],
        path=path,
        placed=np.isfinite(path[..., 0]).mean(axis=1),
        doubts=identity.doubts(
            people, time_s[instants], lengths.of_people(cameras, xy, instants, people, bones), looks
        ),
    )


def on_frames(index: NDArray, time_s: NDArray, frame_s: NDArray) -> NDArray:
    """Transfer row indices (K, T) of `associate` to a camera's own frames, as (K, F).

    The uniform common times `time_s` (T,) and the times `frame_s` (F,) of the frames are of one
    clock. A frame gets the row of the nearest common time. Where that one has no row, it gets the
    row of the time on the frame's other side, unless that row belongs to another person by then.
    Frames further than `EVERY_S` outside of the common times get none: nobody checks a row there.
    """
    right = np.clip(np.searchsorted(time_s, frame_s), 0, len(time_s) - 1)
    left = np.maximum(right - 1, 0)
    nearer = np.abs(time_s[left] - frame_s) < np.abs(time_s[right] - frame_s)
    first, second = np.where(nearer, left, right), np.where(nearer, right, left)
    own, other = index[:, first], index[:, second]
    free = ~(other[:, None] == own[None]).any(axis=1)
    inside = (frame_s >= time_s[0] - EVERY_S) & (frame_s <= time_s[-1] + EVERY_S)
    return np.where(inside, np.where((own < 0) & free, other, own), -1)


def crowd(at_once: Mapping[str, int]) -> str:
    """Return what is wrong with more people at once than can be followed, by camera; or empty."""
    name = max(at_once, key=lambda one: at_once[one])
    if at_once[name] + EXTRA <= MOST_PEOPLE:
        return ""
    return (
        f"camera {name}: expected at most {MOST_PEOPLE - EXTRA} people at once, found "
        f"{at_once[name]}; only {MOST_PEOPLE} are followed, who may be taken for others; leave "
        "spectators out of the pictures"
    )


def _rows(xy, trunk, strides) -> list[Rows]:
    strides = strides or [1] * len(xy)
    return [describe(view, trunk, stride) for view, stride in zip(xy, strides, strict=True)]


def _slots(cameras: Sequence[Camera], rows: Sequence[Rows]) -> int:
    """Return how many people may be in a take: as many as a camera shows at once, and some more."""
    shown = [int(r.present.sum(axis=0).max(initial=0)) for r in rows]
    if line := crowd({camera.name: n for camera, n in zip(cameras, shown, strict=True)}):
        log.logger.warning("%s", line)
    return min(max(*shown, 1) + EXTRA, MOST_PEOPLE)


def _unplaced(cameras, xy, time_s, instants, alone: bool) -> Association:
    """Return the single rows of all cameras as one person without positions."""
    if not alone:
        raise InputError(nowhere(camera.name for camera in cameras))
    return Association(
        index=[np.zeros((1, len(time_s)), int) for _ in xy],
        time_s=time_s[instants],
        path=np.full((1, len(instants), 3), np.nan),
        placed=np.zeros(1),
        doubts=np.zeros((0, 5)),
    )


def nowhere(cameras: Iterable[str]) -> str:
    """Return the line of a take in which nobody was placed."""
    return (
        f"{', '.join(cameras)}: expected people whom two views see at one place, found none; check "
        "the calibration, the synchronisation and the 2D keypoints, and that cameras neither stand "
        "within a few degrees, as seen from the people, nor face each other"
    )


def _pieces(rows: Sequence[Rows], found: candidates.Candidates, instants: NDArray) -> NDArray:
    """Return the uncut piece (M, C) of each candidate's row in each camera; -1 without one."""
    at = instants[found.instant]
    each = [
        np.where(found.row[:, c] >= 0, r.piece[found.row[:, c], at], -1) for c, r in enumerate(rows)
    ]
    return np.stack(each, axis=1)


def _instants(time_s: NDArray) -> NDArray:
    """Return the frames at which rows are triangulated."""
    step_s = np.median(np.diff(time_s)) if len(time_s) > 1 else EVERY_S
    return np.arange(0, len(time_s), max(1, round(EVERY_S / step_s)))


def _looks(cameras, xy, rows, instants, mirror, clothing) -> appearance.Looks | None:
    """Return the model of colours, learned where geometry is unambiguous; frames are instants."""
    if clothing is None:
        return None
    few = np.arange(0, len(instants), max(1, len(instants) // LEARNED_FROM))
    found = _candidates(cameras, xy, rows, instants[few], mirror, None)
    found = found.subset(candidates.is_sure(found))
    return appearance.learn(clothing, instants, replace(found, instant=few[found.instant]))


def _candidates(cameras, xy, rows, instants, mirror, looks) -> candidates.Candidates:
    parts = []
    for block in np.array_split(instants, max(1, len(instants) // 500)):
        start = np.searchsorted(instants, block[0])
        centres = [(r.centre[:, block], r.sigma_px) for r in rows]
        heights = [r.height_px[:, block] for r in rows]
        views = [view[:, block] for view in xy]
        more = partial(looks.view_cost, start=start) if looks else None
        places = candidates.find(cameras, views, centres, heights, mirror, more)
        for part in (places, candidates.rays(cameras, centres, places)):
            parts.append(replace(part, instant=part.instant + start))
    return candidates.concatenate(parts)


def _near_court(found: candidates.Candidates, court: Court | None) -> candidates.Candidates:
    if court is None:
        return found
    low, high = -FAR_FROM_COURT_M, court.size_m + FAR_FROM_COURT_M
    near = ((found.xyz[:, :2] > low) & (found.xyz[:, :2] < high)).all(axis=1)
    near &= (found.xyz[:, 2] > -0.5) & (found.xyz[:, 2] < 4.0)
    return found.subset(near | found.is_ray)


def _index(cameras, rows, time_s, instants, people, looks) -> list[NDArray]:
    """Return the row (K, T) of each person in each frame of each camera."""
    places = [(time_s[instants[c >= 0]], people.candidates.xyz[c[c >= 0]]) for c in people.chosen]
    along = [linking.along(time_s, *place) for place in places]
    path, sigma_m = (np.stack(part) for part in zip(*along, strict=True))
    wanted = (people.chosen >= 0).mean(axis=1) >= COUNTS
    wanted |= wanted.size == 1
    cost = [linking.costs(k, r, path, sigma_m, wanted) for k, r in zip(cameras, rows, strict=True)]
    if looks:
        worn = looks.worn(people.chosen, people.candidates)
        cost = [
            np.where(r.present[..., None], k + looks.row_cost(c, worn), 0.0)
            for c, (k, r) in enumerate(zip(cost, rows, strict=True))
        ]
    for person, found in enumerate(people.seen_alone):
        row, frame = people.candidates.row[found[found >= 0]], instants[found >= 0]
        for c, view in enumerate(cost):
            here = row[:, c] >= 0
            view[row[here, c], frame[here], person] -= ALONE
    cut, present = (np.concatenate([getattr(r, name) for r in rows]) for name in ("cut", "present"))
    owner = linking.follow(np.concatenate(cost), cut, present)
    ends = np.cumsum([len(c) for c in cost])[:-1]
    parts = zip(np.split(owner, ends), cost, strict=True)
    return [linking.one_row_each(own, c) for own, c in parts]
