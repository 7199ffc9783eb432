"""Association of tracklets across cameras, after tracklets that mix people are cut into pieces."""

from dataclasses import dataclass, replace

import numpy as np

from courtside.reconstruction.association import candidates
from courtside.reconstruction.association import linking as labelling
from courtside.study.errors import InputError

EVERY_S = 0.1  # instants at which places are looked for
EXTRA = (
    2  # persons followed beyond those wanted, so that a bystander does not take a subject's place
)
FAR_FROM_COURT_M = 2.0  # beyond the lines, a person is a bystander
ALONE = 4.0  # what a frame gains where only this row followed the person
STILL_MS, STILL_WEIGHT = 0.15, 0.3  # slower persons on average count for less


@dataclass(frozen=True)
class Association:
    """Which row of which camera shows which person.

    Attributes
    ----------
    index : list of (K, T) int, length C
        Row of each person in each frame; -1 where that camera does not show the person.
    path : (K, T, 3) float
        Where the body's centre was, metres, to 0.1 s; NaN for a person who was not found.
    placed : (K,) float
        Share of the instants at which two views or more met in the person.
    dropped : int
        Other people who were followed for a tenth of the take or more, and left out.
    """

    index: list
    path: np.ndarray
    placed: np.ndarray
    dropped: int

    def line(self, persons):
        """Return one line on who was found how often, for a log."""
        found = zip(persons, self.placed, strict=True)
        parts = [
            f"{name} in {s:.0%} of the take" if s > 0 else f"{name} not found" for name, s in found
        ]
        others = f"; {self.dropped} other people left out" if self.dropped else ""
        return f"placed from two views or more: {', '.join(parts)}{others}"


def associate(cameras, xy, time_s, n_persons, *, trunk, mirror=None, court=None):
    """Find out which tracklets are one person, over all views and the whole take.

    Parameters
    ----------
    cameras : list of Camera, length C
    xy : list of (P, T, J, 2) float, length C
        Tracklet rows of each camera at common times, px, distorted; NaN where missing. P may differ.
    time_s : (T,) float
        Uniform.
    n_persons : int
        Subjects of the take; other people are left out.
    trunk : list of int
        Indices of shoulders and hips.
    mirror : list of int, length J, optional
        Index of the same joint of the other side; with it, views that took left for right still agree.
    court : courtside.calibration.court.court.Court, optional
        People far from it are left out; where it has a net, changing halves is held to be rare.

    Returns
    -------
    association : Association
        Persons in a fixed order: with a net, by their median y (the half at y = 0 first); without one, by
        the instant they are first placed at, and x among those within a second.

    Raises
    ------
    InputError
        If no person can be placed.

    Notes
    -----
    At instants 0.1 s apart, rows of several views that meet in space are candidates (`candidates`); these
    are linked over time with several histories kept (`linking`); each row's frames are then named by the
    paths that they follow (`labelling`). Nothing is taken for granted about a row: a tracker may exchange
    two people where they overlap, and then the row changes its person.
    """
    if n_persons == 1 and all(len(view) == 1 for view in xy):
        return _alone(xy, len(time_s))
    xy = [v if len(v) else np.full((1, *v.shape[1:]), np.nan) for v in xy]
    rows = [describe(view, trunk) for view in xy]
    instants, found = _candidates(cameras, xy, rows, time_s, mirror)
    found = _near(found, court)
    net = court.net["y_m"] if court is not None and court.net else None
    piece = np.stack(
        [
            np.where(found.row[:, c] >= 0, r.piece[found.row[:, c], instants[found.instant]], -1)
            for c, r in enumerate(rows)
        ],
        axis=1,
    )
    paths = labelling.link(found, piece, time_s[instants], n_persons + EXTRA, net)
    return _named(cameras, rows, time_s, instants, found, paths.chosen, n_persons, net)


def on_frames(index, time_s, frame_s):
    """Carry the rows of persons from common times over to a camera's own frames.

    Parameters
    ----------
    index : (K, T) int
        From `associate`.
    time_s : (T,) float
        Common times, uniform.
    frame_s : (F,) float
        Times of the camera's frames on the same clock.

    Returns
    -------
    index : (K, F) int
        That of the nearest common time, or where this has none, of the one on the frame's other side,
        unless that row is another person's by then.
    """
    right = np.clip(np.searchsorted(time_s, frame_s), 0, len(time_s) - 1)
    left = np.maximum(right - 1, 0)
    nearer = np.abs(time_s[left] - frame_s) < np.abs(time_s[right] - frame_s)
    first, second = np.where(nearer, left, right), np.where(nearer, right, left)
    own, other = index[:, first], index[:, second]
    free = ~(other[:, None] == own[None]).any(axis=1)
    return np.where((own < 0) & free, other, own)


def _alone(xy, n_frames):
    seen = [np.isfinite(view[..., 0]).any(axis=-1) for view in xy]
    return Association(
        index=[np.zeros((1, n_frames), int) for _ in xy],
        path=np.full((1, n_frames, 3), np.nan),
        placed=np.array([(np.sum(seen, axis=0) >= 2).mean()]),
        dropped=0,
    )


def _candidates(cameras, xy, rows, time_s, mirror):
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
    return instants, candidates.together(parts)


def _near(found, court):
    if court is None:
        return found
    low, high = -FAR_FROM_COURT_M, court.size_m + FAR_FROM_COURT_M
    near = ((found.xyz[:, :2] > low) & (found.xyz[:, :2] < high)).all(axis=1)
    near &= (found.xyz[:, 2] > -0.5) & (found.xyz[:, 2] < 4.0)
    return found.of(near | found.is_ray)


def _named(cameras, rows, time_s, instants, found, chosen, n_persons, net_y_m):
    """Choose the subjects among the persons followed, and name every frame."""
    ray = (chosen >= 0) & found.is_ray[chosen] if len(found.instant) else chosen >= 0
    found_alone, chosen = np.where(ray, chosen, -1), np.where(ray, -1, chosen)
    known = (chosen >= 0).any(axis=1)
    found_alone, chosen = found_alone[known], chosen[known]
    if not len(chosen):
        raise InputError(
            f"{', '.join(camera.name for camera in cameras)}: expected people whom two views see at one "
            "place, found none; check the calibration, the synchronisation and the 2D keypoints"
        )
    places = [(time_s[instants[c >= 0]], found.xyz[c[c >= 0]]) for c in chosen]
    along = [labelling.along(time_s, *place) for place in places]
    path, sigma_m = (np.stack(part) for part in zip(*along, strict=True))
    subjects = _subjects(places, n_persons)
    subjects = sorted(subjects, key=lambda s: _order(*places[s], places, net_y_m))
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


def _subjects(places, n_persons):
    """Return the persons who were seen most; those who stand about count for less."""
    score = []
    for at_s, xyz in places:
        step_m = np.linalg.norm(
            np.diff(xyz[::5, :2], axis=0), axis=1
        )  # over half a second: less noise
        speed = step_m.sum() / max(at_s[-1] - at_s[0], EVERY_S)
        score.append(len(at_s) * (STILL_WEIGHT if speed < STILL_MS else 1.0))
    return np.argsort(-np.array(score), kind="stable")[:n_persons].tolist()


def _order(at_s, xyz, places, net_y_m):
    if net_y_m is not None:
        return (float(np.median(xyz[:, 1])), 0.0)
    start_s = min(first[0] for first, _ in places)
    return (float((at_s[0] - start_s) // 1.0), float(xyz[0, 0]))


def _index(cameras, rows, path, sigma_m, subjects, seen_alone):
    wanted = np.isin(np.arange(len(path)), subjects)
    cost = [
        labelling.costs(k, r, path, sigma_m, wanted) for k, r in zip(cameras, rows, strict=True)
    ]
    for person, (row, frame) in enumerate(seen_alone):
        for c, view in enumerate(cost):
            here = row[:, c] >= 0
            view[row[here, c], frame[here], person] -= ALONE
    cut, present = (np.concatenate([getattr(r, name) for r in rows]) for name in ("cut", "present"))
    owner = labelling.follow(np.concatenate(cost), cut, present)
    ends = np.cumsum([len(c) for c in cost])[:-1]
    parts = zip(np.split(owner, ends), cost, strict=True)
    return [labelling.one_row_each(own, c)[subjects] for own, c in parts]


JUMP = (
    0.15  # of the body's height: a centre that is further from where it was heading is another body
)
CLOSE = 0.4  # of the body's height: rows with centres closer than this may exchange their bodies
AROUND = 2  # frames before and after a close meeting in which they may still do so
STEADY = 2  # frames before and after that steady a centre
MIN_SHARE = 0.4  # of the joints must be seen for a row to count
SIGMA_SHARE, SIGMA_PX = (
    0.02,
    2.0,
)  # standard deviation of a joint: share of the body's height, and a floor


@dataclass(frozen=True)
class Rows:
    """What is known of the P rows of one camera in T frames before any are compared across views.

    Attributes
    ----------
    present : (P, T) bool
        Whether the row shows a body.
    centre : (P, T, 2) float
        Mean of the trunk's joints over five frames at most, px; NaN where absent.
    height_px : (P, T) float
        From the highest to the lowest joint; NaN where absent.
    sigma_px : (P,) float
        Standard deviation to expect of a joint, per axis.
    cut : (P, T) bool
        True where the row may show another body than in the frame before.
    piece : (P, T) int
        Number of the uncut piece, unlike those of other rows of this camera; -1 where absent.
    """

    present: np.ndarray
    centre: np.ndarray
    height_px: np.ndarray
    sigma_px: np.ndarray
    cut: np.ndarray
    piece: np.ndarray


def describe(xy, trunk):
    """Describe the rows of one camera.

    Parameters
    ----------
    xy : (P, T, J, 2) float
        Keypoints in px; NaN where missing.
    trunk : list of int
        Joints whose mean is the body's centre: shoulders and hips.

    Returns
    -------
    rows : Rows

    Notes
    -----
    A row is cut after each frame without a body, where its centre jumps off its course, and in every frame
    in which another body is so close that a tracker may confuse them.
    """
    seen = np.isfinite(xy[..., 0])
    present = seen.mean(axis=-1) >= MIN_SHARE
    centre = np.where(present[..., None], _centre(xy, seen, trunk), np.nan)
    present &= np.isfinite(centre[..., 0])
    ys = xy[..., 1]
    height = np.fmax.reduce(ys, axis=-1) - np.fmin.reduce(ys, axis=-1)
    height = np.where(present & (height > 0), height, np.nan)
    typical = np.array(
        [np.median(h[np.isfinite(h)]) if np.isfinite(h).any() else 0 for h in height]
    )
    before = np.zeros_like(present)
    before[:, 1:] = present[:, :-1]
    limit = (JUMP * typical + SIGMA_PX)[:, None]
    broken = present & (~before | (_off_course(centre) > limit))
    cut = broken | (present & _meeting(centre, typical))
    centre = _steadied(centre, np.where(present, np.cumsum(broken, axis=1), -1))
    number = np.cumsum(cut, axis=1) + np.cumsum(cut.sum(axis=1))[:, None] - cut.sum(axis=1)[:, None]
    piece = np.where(present, number, -1)
    return Rows(present, centre, height, SIGMA_SHARE * typical + SIGMA_PX, cut, piece)


def _centre(xy, seen, trunk):
    """Return the mean of the trunk's joints, or of all joints where less than half of the trunk is seen."""
    mean = []
    for joints in (list(trunk), list(range(xy.shape[2]))):
        count = seen[:, :, joints].sum(axis=-1)[..., None]
        enough = count * 2 >= len(joints) if not mean else count > 0
        total = np.nansum(xy[:, :, joints], axis=2)
        mean.append(np.where(enough, total / np.maximum(count, 1), np.nan))
    return np.where(np.isfinite(mean[0]), mean[0], mean[1])


def _off_course(centre):
    """Return (P, T) how far each centre is from where two frames before it point, 0 where unknown, px."""
    off = np.zeros(centre.shape[:2])
    bend = centre[:, 2:] - 2 * centre[:, 1:-1] + centre[:, :-2]
    off[:, 2:] = np.nan_to_num(np.linalg.norm(bend, axis=-1))
    step = np.linalg.norm(np.diff(centre, axis=1), axis=-1)
    # After a gap there is no course yet: then the place itself must not jump twice as far.
    alone = np.isfinite(step[:, 1:]) & ~np.isfinite(bend[..., 0])
    off[:, 2:] = np.where(alone, step[:, 1:] / 2, off[:, 2:])
    return off


def _steadied(centre, run):
    """Return the mean over neighbouring frames of one unbroken run, as many before as after."""
    total, count = centre.copy(), np.ones(run.shape)
    for shift in range(1, STEADY + 1):
        whole = np.zeros(run.shape, dtype=bool)
        middle = slice(shift, -shift)
        whole[:, middle] = (run[:, : -2 * shift] == run[:, 2 * shift :]) & (run[:, middle] >= 0)
        whole[:, middle] &= run[:, middle] == run[:, 2 * shift :]
        pair = np.zeros_like(centre)
        pair[:, middle] = np.nan_to_num(centre[:, : -2 * shift] + centre[:, 2 * shift :])
        total += np.where(whole[..., None], pair, 0.0)
        count += 2 * whole
    return total / count[..., None]


def _meeting(centre, typical):
    """Return (P, T) bool: another row of this camera is close."""
    close = np.zeros(centre.shape[:2], dtype=bool)
    for one in range(len(centre)):
        for other in range(one + 1, len(centre)):
            apart = np.linalg.norm(centre[one] - centre[other], axis=-1)
            near = np.nan_to_num(apart, nan=np.inf) < CLOSE * max(typical[one], typical[other])
            close[one] |= near
            close[other] |= near
    wide = close.copy()
    for shift in range(1, AROUND + 1):
        wide[:, shift:] |= close[:, :-shift]
        wide[:, :-shift] |= close[:, shift:]
    return wide
