"""Association of tracklets across cameras; tracklets that mix people are cut into pieces first."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera
from courtside.reconstruction.association import candidates, linking
from courtside.reconstruction.association.rows import describe
from courtside.study.errors import InputError

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
# Spacing of the instants at which rows are triangulated: costs grow with their number.
EVERY_S = 0.1
# Persons tracked beyond those wanted, so that a bystander does not take a subject's place.
EXTRA = 2
FAR_FROM_COURT_M = 2.0  # a person further beyond the lines is a bystander
ALONE = 4.0  # bonus (log-likelihood) of a row that alone followed the person in a frame
STILL_MS, STILL_WEIGHT = 0.15, 0.3  # the weight of a person whose mean speed (m/s) is below this

Place = tuple[NDArray, NDArray]  # instants (N,) s and places (N, 3) m of a person


@dataclass(frozen=True)
class Association:
    """Which row of which camera shows which person."""

    # Of each camera (K, T): row of each person in each frame; -1 where it does not show the person
    index: list[NDArray]
    # (K, T, 3): centre of the body, metres, accurate to 0.1 s; NaN for a person who was not found
    path: NDArray
    # (K,): share of the instants at which two or more views triangulated the person
    placed: NDArray
    # Number of other people who were followed for at least a tenth of the take and left out
    dropped: int

    def line(self, persons: Iterable[str]) -> str:
        """Return a log line: how often each person was found."""
        found = zip(persons, self.placed, strict=True)
        parts = [
            f"{name} in {s:.0%} of the take" if s > 0 else f"{name} not found" for name, s in found
        ]
        others = f"; {self.dropped} other people left out" if self.dropped else ""
        return f"placed from two views or more: {', '.join(parts)}{others}"


def associate(
    cameras: Sequence[Camera],
    xy: Sequence[NDArray],
    time_s: NDArray,
    n_persons: int,
    *,
    trunk: Sequence[int],
    mirror: Sequence[int] | None = None,
    court: Court | None = None,
) -> Association:
    """Find out which tracklets are one person, over all views and the whole take.

    `xy` has the tracklet rows (P, T, J, 2) of each camera at common, uniform times `time_s` (T,),
    distorted px, NaN where missing; P may differ. `trunk` are the indices of shoulders and hips.
    With `mirror` (J,), the index of the same joint of the other side, views with confused sides
    still agree. People other than the `n_persons` subjects are left out, and those far from the
    `court`; if this has a net, changing halves is taken as rare.

    The persons are in a fixed order: with a net by their median y (the half at y = 0 first), else
    by the instant of their first place, and by x within one second. An `InputError` if no person
    can be placed.

    At instants 0.1 s apart, rows of several views that meet in space become candidates
    (`candidates`). They are linked over time by a search that keeps several histories (`linking`);
    then each frame of a row gets the person whose path it follows. A row may change its person,
    because a tracker may swap two people where they overlap.
    """
    if n_persons == 1 and all(len(view) == 1 for view in xy):
        return _alone(xy, len(time_s))
    xy = [v if len(v) else np.full((1, *v.shape[1:]), np.nan) for v in xy]
    rows = [describe(view, trunk) for view in xy]
    instants, found = _candidates(cameras, xy, rows, time_s, mirror)
    found = _near_court(found, court)
    net = court.net["y_m"] if court is not None and court.net else None
    piece = np.stack(
        [
            np.where(found.row[:, c] >= 0, r.piece[found.row[:, c], instants[found.instant]], -1)
            for c, r in enumerate(rows)
        ],
        axis=1,
    )
    chosen = linking.link(found, piece, time_s[instants], n_persons + EXTRA, net)
    return _name_frames(cameras, rows, time_s, instants, found, chosen, n_persons, net)


def on_frames(index: NDArray, time_s: NDArray, frame_s: NDArray) -> NDArray:
    """Transfer row indices (K, T) of `associate` to a camera's own frames, as (K, F).

    The uniform common times `time_s` (T,) and the times `frame_s` (F,) of the frames are of one
    clock. A frame gets the row of the nearest common time. Where that one has no row, it gets the
    row of the time on the frame's other side, unless that row belongs to another person by then.
    """
    right = np.clip(np.searchsorted(time_s, frame_s), 0, len(time_s) - 1)
    left = np.maximum(right - 1, 0)
    nearer = np.abs(time_s[left] - frame_s) < np.abs(time_s[right] - frame_s)
    first, second = np.where(nearer, left, right), np.where(nearer, right, left)
    own, other = index[:, first], index[:, second]
    free = ~(other[:, None] == own[None]).any(axis=1)
    return np.where((own < 0) & free, other, own)


def _alone(xy: Sequence[NDArray], n_frames: int) -> Association:
    seen = [np.isfinite(view[..., 0]).any(axis=-1) for view in xy]
    return Association(
        index=[np.zeros((1, n_frames), int) for _ in xy],
        path=np.full((1, n_frames, 3), np.nan),
        placed=np.array([(np.sum(seen, axis=0) >= 2).mean()]),
        dropped=0,
    )


def _candidates(cameras, xy, rows, time_s, mirror) -> tuple[NDArray, candidates.Candidates]:
    step_s = np.median(np.diff(time_s)) if len(time_s) > 1 else EVERY_S
    instants = np.arange(0, len(time_s), max(1, round(EVERY_S / step_s)))
    parts = []
    for block in np.array_split(instants, max(1, len(instants) // 500)):
        start = np.searchsorted(instants, block[0])
        centres = [(r.centre[:, block], r.sigma_px) for r in rows]
        heights = [r.height_px[:, block] for r in rows]
        views = [view[:, block] for view in xy]
        places = candidates.find(cameras, views, centres, heights, mirror)
        for part in (places, candidates.rays(cameras, centres, places)):
            parts.append(replace(part, instant=part.instant + start))
    return instants, candidates.concatenate(parts)


def _near_court(found: candidates.Candidates, court: Court | None) -> candidates.Candidates:
    if court is None:
        return found
    low, high = -FAR_FROM_COURT_M, court.size_m + FAR_FROM_COURT_M
    near = ((found.xyz[:, :2] > low) & (found.xyz[:, :2] < high)).all(axis=1)
    near &= (found.xyz[:, 2] > -0.5) & (found.xyz[:, 2] < 4.0)
    return found.subset(near | found.is_ray)


def _name_frames(cameras, rows, time_s, instants, found, chosen, n_persons, net_y_m) -> Association:
    """Choose the subjects among the persons followed, and name every frame."""
    ray = (chosen >= 0) & found.is_ray[chosen] if len(found.instant) else chosen >= 0
    found_alone, chosen = np.where(ray, chosen, -1), np.where(ray, -1, chosen)
    known = (chosen >= 0).any(axis=1)
    found_alone, chosen = found_alone[known], chosen[known]
    if not len(chosen):
        raise InputError(
            f"{', '.join(camera.name for camera in cameras)}: expected people whom two views "
            "see at one place, found none; check the calibration, the synchronisation and the 2D "
            "keypoints"
        )
    places = [(time_s[instants[c >= 0]], found.xyz[c[c >= 0]]) for c in chosen]
    along = [linking.along(time_s, *place) for place in places]
    path, sigma_m = (np.stack(part) for part in zip(*along, strict=True))
    subjects = _subjects(places, n_persons)
    subjects = sorted(subjects, key=lambda s: _order(places[s], places, net_y_m))
    seen_alone = [(f[f >= 0], instants[f >= 0]) for f in found_alone]
    index = _index(
        cameras, rows, path, sigma_m, subjects, [(found.row[f], at) for f, at in seen_alone]
    )
    missing = n_persons - len(subjects)
    placed = (chosen[subjects] >= 0).mean(axis=1)
    others = [c for at, c in enumerate(chosen) if at not in subjects]
    return Association(
        index=[np.concatenate([i, np.full((missing, len(time_s)), -1)]) for i in index],
        path=np.concatenate([path[subjects], np.full((missing, *path.shape[1:]), np.nan)]),
        placed=np.concatenate([placed, np.zeros(missing)]),
        dropped=sum((c >= 0).mean() >= 0.1 for c in others),
    )


def _subjects(places: Sequence[Place], n_persons: int) -> list[int]:
    """Return the persons who were seen most; those who stand still count for less."""
    score = []
    for at_s, xyz in places:
        # Steps over half a second, with less noise.
        step_m = np.linalg.norm(np.diff(xyz[::5, :2], axis=0), axis=1)
        speed = step_m.sum() / max(at_s[-1] - at_s[0], EVERY_S)
        score.append(len(at_s) * (STILL_WEIGHT if speed < STILL_MS else 1.0))
    return np.argsort(-np.array(score), kind="stable")[:n_persons].tolist()


def _order(place: Place, places: Sequence[Place], net_y_m: float | None) -> tuple[float, float]:
    at_s, xyz = place
    if net_y_m is not None:
        return (float(np.median(xyz[:, 1])), 0.0)
    start_s = min(first[0] for first, _ in places)
    return (float((at_s[0] - start_s) // 1.0), float(xyz[0, 0]))


def _index(cameras, rows, path, sigma_m, subjects, seen_alone) -> list[NDArray]:
    wanted = np.isin(np.arange(len(path)), subjects)
    cost = [linking.costs(k, r, path, sigma_m, wanted) for k, r in zip(cameras, rows, strict=True)]
    for person, (row, frame) in enumerate(seen_alone):
        for c, view in enumerate(cost):
            here = row[:, c] >= 0
            view[row[here, c], frame[here], person] -= ALONE
    cut, present = (np.concatenate([getattr(r, name) for r in rows]) for name in ("cut", "present"))
    owner = linking.follow(np.concatenate(cost), cut, present)
    ends = np.cumsum([len(c) for c in cost])[:-1]
    parts = zip(np.split(owner, ends), cost, strict=True)
    return [linking.one_row_each(own, c)[subjects] for own, c in parts]
