"""Cameras knocked during a take or between takes: found, measured and judged by people.

A knocked camera turned in place: it has one pose before and another after. In each row, the joints
seen by two cameras give epipolar residuals, linear in the turn of either camera. Their normal
equations, summed over time, tell for each camera and each time how much better a step fits than
none: the cost is linear in rows. No video is needed. Several takes, in their order, are treated as
one take in which knocks can only be where two takes meet.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.file_check import residuals
from courtside.calibration.people import adjustment, held_out, prior
from courtside.calibration.people.adjustment import LOSS
from courtside.calibration.people.views import Limits, Seen, check, joined
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry import camera as camera_models
from courtside.geometry import epipolar, rotations
from courtside.geometry.camera import Camera, project
from courtside.records.devices.clocks import Clock
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA
from courtside.study.errors import InputError

# ASSUME: limits that tell knocks of 0.4 degrees from none on development takes.
LEAST_S = 1.0  # of people seen on either side of a knock
LEAST_GAIN = 15.0  # of a step, chi-squared of 3, to be tried: errors of cameras make 20 to 200
LEAST_RAD = np.radians(0.1)  # smaller steps are how a network errs in different postures
LEAST_CHANGE = 0.05  # of how far held-out joints disagree: what errors of cameras make is 1 to 2 %
LEAST_OF_SIDE = 0.3  # on one side of a knock: 0.4 degrees make 0.4 to 0.8, cameras' errors 0.1
USUAL_RAD = np.radians(0.5)  # about each axis: keeps a turn small that is badly seen
SAME_M, SAME_LENS = 0.002, 0.03  # a knocked camera keeps its place, and its lens: share of sigma
BLOCK_S = 1.0  # residuals err alike within it
SURE = 3.0  # standard errors, of turns measured together
MOST_TRIED = 4  # candidates, each of another camera, and one of a camera that is put back
GRID = 60  # times at which a camera may be turned or put back, before the best are refined
ROWS_TO_JUDGE = 40  # of each half that fits: enough for a turn, and a quarter of the time
MOST = 3  # knocks per take
NOT_BETTER = {"joints": "not better"}


@dataclass(frozen=True, eq=False)
class Knock:
    """A camera was turned in place and stayed so."""

    camera: int  # its index
    time_s: float  # of the first instant after it, as `Seen.time_s`
    turn: NDArray  # (3,): rotation vector, rad, camera axes before to those after
    sigma: NDArray  # (3,): its standard deviation, rad
    change: float  # of how far held-out joints disagree, as a share
    verdicts: dict[str, str]  # of held-out joints, as of `held_out`

    @property
    def taken(self) -> bool:
        """Whether held-out joints say that two poses are better than one."""
        return held_out.better(self.verdicts)


@dataclass(frozen=True, eq=False)
class _Step:
    """A candidate: the turn (3,) rad of a camera at a time, and its chi-squared of 3."""

    camera: int
    time_s: float
    turn: NDArray
    gain: float
    until_s: float = np.inf  # when it is put back
    others: tuple["_Step", ...] = ()  # of cameras turned at the same time, to measure with it

    @property
    def put_back(self) -> bool:
        """Whether the camera is put back within the take."""
        return bool(np.isfinite(self.until_s))

    def during(self, time_s: NDArray) -> NDArray:
        """Return at which times the camera is turned."""
        return (time_s >= self.time_s) & (time_s < self.until_s)


@dataclass(frozen=True, eq=False)
class _Judged:
    """What held-out joints say of a step, as of `Knock`."""

    change: float  # of the clearer side of a step that is taken, else of all
    verdicts: dict[str, str]

    def order(self, step: _Step) -> tuple[bool, float]:
        """Return what sorts steps: those taken first, by how clear they are; others by gain.

        A step for good is simpler: one that is put back must be clearer.
        """
        if held_out.better(self.verdicts):
            return False, self.change + LEAST_CHANGE * step.put_back
        return True, -step.gain


def find(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    at_s: Sequence[float] | None = None,
) -> list[Knock]:
    """Find the knocks of a take, each in keypoints without those before it.

    They can be at any time, or at the times `at_s`, of every camera at each. A camera that is put
    back within the take is found as a whole, and has two.

    Steps are looked for with the cameras as they are and as people refine them: errors of cameras
    change with the place of people. Those that stand out are adjusted with all cameras, and taken
    where held-out joints then agree better than with one pose. The last may be one that is not
    taken: what was found is told. There are none where people cannot tell (`views.check`).
    """
    found: list[Knock] = []
    try:
        check(cameras, seen, limits.score)
    except InputError:  # told where all takes are checked together
        return found
    left, most = seen, len(cameras) * len(at_s) if at_s else MOST
    while len(found) < most:
        tried = _candidates(cameras, known, left, limits, at_s)
        if not tried:
            break
        one_pose = _halves(cameras, known, left, limits, ())
        judged = [_judged(cameras, known, left, limits, step, one_pose) for step in tried]
        step, said = min(zip(tried, judged, strict=True), key=lambda one: one[1].order(one[0]))
        turn, sigma = _measured(cameras, known, left, limits, [step, *step.others])[0]
        new = [Knock(step.camera, step.time_s, turn, sigma, said.change, said.verdicts)]
        if new[0].taken and step.put_back:
            new.append(replace(new[0], time_s=step.until_s, turn=-turn))
        found += new
        if not new[0].taken:
            break
        left = undone(cameras, left, new)
    return _together(cameras, known, seen, limits, found)


def between(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    takes: Mapping[str, Seen],
    limits: Limits,
) -> tuple[Seen, list[dict[str, Any]]]:
    """Find knocks between takes; return what was seen in all, without them, and the knocks' rows.

    Takes are in their order. Each take after a knock has a row: its camera was turned before it.
    """
    names, parts, start_s = list(takes), [], [0.0]
    for part in takes.values():
        first, last = part.time_s.min(initial=np.inf), part.time_s.max(initial=-np.inf)
        parts.append(replace(part, time_s=part.time_s - first + start_s[-1]))
        start_s.append(start_s[-1] + max(last - first, 0.0) + BLOCK_S)
    seen, at_s, rows = joined(parts), start_s[1:-1], []
    found = find(cameras, known, seen, limits, at_s) if at_s else []
    for knock in found:
        after = at_s.index(knock.time_s)
        told = row(knock, cameras, {}) | {"after": names[after]}
        rows += [{"take": name, **told} for name in names[after + 1 :]]
    return undone(cameras, seen, found), rows


def row(knock: Knock, cameras: Sequence[Camera], clocks: Mapping[str, Clock]) -> dict[str, Any]:
    """Return a knock as a row of `records.cameras.knock_table`, but for its take.

    Without the camera's clock it was before the take: its time is 0.
    """
    camera = cameras[knock.camera].name
    turn, sigma = np.degrees(knock.turn), np.degrees(knock.sigma)
    return {
        "camera": camera,
        "time_s": float(clocks[camera].from_reference(knock.time_s)) if clocks else 0.0,
        **{f"turn_{axis}_deg": float(size) for axis, size in zip("xyz", turn, strict=True)},
        **{f"sigma_{axis}_deg": float(size) for axis, size in zip("xyz", sigma, strict=True)},
        "joints_percent": 100 * knock.change,
        "joints": knock.verdicts["joints"],
        "taken": int(knock.taken),
    }


def undone(cameras: Sequence[Camera], seen: Seen, knocks: Sequence[Knock]) -> Seen:
    """Return keypoints where cameras would have seen them without the knocks taken."""
    xy = seen.xy.copy()
    for knock in (one for one in knocks if one.taken):
        after = seen.time_s >= knock.time_s
        camera = cameras[knock.camera]
        xy[knock.camera, after] = camera_models.turned_back(
            camera, xy[knock.camera, after], knock.turn
        )
    return replace(seen, xy=xy)


def _candidates(cameras, known, seen: Seen, limits: Limits, at_s) -> list[_Step]:
    """Return the clearest steps, each of another camera, and the clearest that is put back."""
    refined = _adjusted(cameras, known, seen.thinned(2 * ROWS_TO_JUDGE), limits, ()).cameras
    steps = [step for some in (cameras, refined) for step in _steps(some, seen, limits.score, at_s)]
    steps.sort(key=lambda one: one.gain)
    steps = _of_turned(cameras, known, seen, limits, steps)
    best = {step.camera: step for step in steps if not step.put_back}
    return list(best.values())[-MOST_TRIED:] + [step for step in steps if step.put_back][-1:]


def _steps(
    cameras: Sequence[Camera], seen: Seen, min_score: float, at_s: Sequence[float] | None
) -> list[_Step]:
    """Return each camera's clearest step, or those at given times, where they stand out."""
    equations = _equations(cameras, seen, min_score)
    times, row = np.unique(seen.time_s, return_inverse=True)
    order = np.argsort(row, kind="stable")
    first = np.flatnonzero(np.diff(row[order], prepend=-1))
    sums = [np.add.reduceat(part[:, order], first, axis=1) for part in equations]
    found = []
    for camera, (matrix, right) in enumerate(zip(*sums, strict=True)):
        when = [(one, np.inf) for one in at_s] if at_s else _spans(matrix, right, times)
        for span in when:
            step = _step(equations, seen, camera, *span)
            if step and step.gain >= LEAST_GAIN and np.linalg.norm(step.turn) >= LEAST_RAD:
                found.append(step)
    return found


def _of_turned(cameras, known, seen: Seen, limits: Limits, steps: list[_Step]) -> list[_Step]:
    """Return steps, at the time of the last only of cameras turned then.

    Cameras that are turned make steps of others, too. All are measured together, then those without
    the one that stands out least: the fewer there are, the surer are their turns.
    """
    at_once = [one for one in steps if abs(one.time_s - steps[-1].time_s) < BLOCK_S]
    turned = {
        at: replace(steps[-1], camera=at, turn=np.zeros(3))
        for at in sorted({one.camera for one in at_once})
    }
    while len(turned) > 1:
        found = _measured(cameras, known, seen, limits, list(turned.values()))
        sure = [float(np.max(np.abs(turn) / sigma)) for turn, sigma in found]
        if min(sure) >= SURE:
            break
        del turned[list(turned)[sure.index(min(sure))]]
    kept = [one for one in steps if one.camera in turned or one not in at_once]
    others = {at: tuple(turned[k] for k in turned if k != at) for at in turned}
    return [replace(s, others=others[s.camera]) if s in at_once else s for s in kept]


def _together(cameras, known, seen: Seen, limits: Limits, found: Sequence[Knock]) -> list[Knock]:
    """Return knocks of which those taken are measured together, each camera's in order of time.

    Each was measured while those found after it were still in the keypoints. Those of one camera at
    one time are one.
    """
    taken = [one for one in found if one.taken]
    if len(taken) < 2:
        return list(found)
    first = {(one.camera, one.time_s): one for one in reversed(taken)}
    steps = []
    for camera, time_s in sorted(first):
        whole = np.eye(3)
        for one in taken:
            if one.camera == camera and one.time_s <= time_s:
                whole = whole @ rotations.rotation_from_rodrigues(one.turn)
        steps.append(_Step(camera, time_s, rotations.rodrigues_from_rotation(whole), 0.0))
    turns = _measured(cameras, known, seen, limits, steps)
    again = [
        replace(first[step.camera, step.time_s], turn=turn, sigma=sigma)
        for step, (turn, sigma) in zip(steps, turns, strict=True)
    ]
    return again + [one for one in found if not one.taken]


def _measured(
    cameras, known, seen: Seen, limits: Limits, steps: Sequence[_Step]
) -> list[tuple[NDArray, NDArray]]:
    """Return turns (3,) rad, and their sigma, as the adjustment of all cameras measures steps.

    Each turn is without those before it of its camera. Steps as for `_adjusted`.
    """
    found, measured = _adjusted(cameras, known, seen, limits, steps), []
    count = len(found.cameras)
    spread = camera_covariance.of_network([str(at) for at in range(count)], found.covariance)
    both = spread.covariance.reshape(count, len(PARAMETERS), count, len(PARAMETERS))
    pose = [camera.cam_from_world[:, :3] for camera in found.cameras]
    for new, old in enumerate(_poses_before(len(cameras), steps), start=len(cameras)):
        still = pose[steps[new - len(cameras)].camera]
        turn = rotations.rodrigues_from_rotation(still @ pose[old].T @ pose[new] @ still.T)
        ends = both[[old, new]][:, :3][:, :, [old, new]][..., :3]
        variance = ends[0, :, 0] + ends[1, :, 1] - ends[0, :, 1] - ends[1, :, 0]
        measured.append((turn, np.sqrt(np.diag(variance))))
    return measured


def _poses_before(n_cameras: int, steps: Sequence[_Step]) -> list[int]:
    """Return which pose each step's camera has before it: poses are cameras, then steps."""
    last, found = list(range(n_cameras)), []
    for number, step in enumerate(steps, start=n_cameras):
        found.append(last[step.camera])
        last[step.camera] = number
    return found


def _judged(cameras, known, seen: Seen, limits: Limits, step: _Step, one_pose) -> _Judged:
    """Return what held-out joints say of a step.

    Judged is the step's camera alone, against joints that the others place: by the time on one side
    of the step, which may be too short to tell in all. The other must not be worse.
    """
    two_poses = _halves(cameras, known, seen, limits, [step])
    before, after = (_score(halves, seen, step) for halves in (one_pose, two_poses))
    sides = sorted(_by_side(before, after, seen, step), key=lambda one: one[0])
    for (side, said), (other, _) in permutations(sides, 2):
        if side < -LEAST_OF_SIDE and held_out.better(said) and other < LEAST_CHANGE:
            return _Judged(side, said)
    return _Judged(after.typical() / before.typical() - 1, NOT_BETTER)


def _by_side(
    before: held_out.Score, after: held_out.Score, seen: Seen, step: _Step
) -> list[tuple[float, dict[str, str]]]:
    """Return the change and the verdicts of each side of a step, where it has a block."""
    block, behind, found = _blocks(seen), step.during(seen.time_s), []
    for side in (~behind, behind):
        own = np.setdiff1d(block[side], block[~side])
        one, two = (score.of(own) for score in (before, after))
        if one.share and two.share:
            found.append((two.typical() / one.typical() - 1, held_out.verdicts(one, two)))
    return found


def _halves(cameras, known, seen: Seen, limits: Limits, steps) -> list[list[Camera]]:
    """Return cameras with one pose, or two with a step, fitted to either half of the blocks."""
    block = _blocks(seen)
    halves = [seen.of(block % 2 == odd).thinned(ROWS_TO_JUDGE) for odd in (0, 1)]
    return [_adjusted(cameras, known, half, limits, steps).cameras for half in halves]


def _score(halves: list[list[Camera]], seen: Seen, step: _Step) -> held_out.Score:
    """Score the step's camera in the blocks of the half that its cameras were not fitted to."""
    score, block, at = held_out.Score(), _blocks(seen), step.camera
    for odd, found in enumerate(halves):
        rows = block % 2 != odd
        views = seen.xy[:, rows]
        xyz = residuals.placed_by_others(found[: len(views)], views, at)
        last = found[-1] if len(found) > len(seen.xy) else found[at]
        after = step.during(seen.time_s[rows])[:, None, None]
        there = np.where(after, project(last, xyz), project(found[at], xyz))
        off = np.linalg.norm(views[at] - there, axis=-1) / seen.height_px[at, rows, None]
        for one in np.unique(block[rows]):
            part = off[block[rows] == one]
            if np.isfinite(part).any():
                score.share[int(one)] = float(np.nanmedian(part))
    return score


def _adjusted(cameras, known, seen: Seen, limits: Limits, steps: Sequence[_Step]):
    """Return cameras adjusted with people; the pose after each step is one more camera.

    Steps of one camera are in order of time, and their turns from the camera's first pose.
    """
    if not steps:
        return adjustment.refine(cameras, seen, prior.knowledge(cameras, known), limits)
    size = len(PARAMETERS)
    covariance = known.of([one.name for one in cameras]).covariance
    for step, before in zip(steps, _poses_before(len(cameras), steps), strict=True):
        again = np.r_[: len(covariance), size * before : size * (before + 1)]
        own = np.sqrt(np.diag(covariance)[size * step.camera : size * (step.camera + 1)])
        covariance = covariance[np.ix_(again, again)]
        more = np.r_[[USUAL_RAD] * 3, [SAME_M] * 3, SAME_LENS * own[6:]]
        covariance[-size:, -size:] += np.diag(more**2)
    after = [
        replace(cameras[step.camera], name=f"{cameras[step.camera].name}, after {step.time_s}")
        for step in steps
    ]
    poses = [*cameras, *after]
    all_known = CameraCovariance([one.name for one in poses], covariance)
    turned = [camera_models.turned(one, step.turn) for one, step in zip(after, steps, strict=True)]
    parts, stated = _split(seen, steps), prior.knowledge(poses, all_known)
    return adjustment.refine([*cameras, *turned], parts, stated, limits)


def _split(seen: Seen, steps: Sequence[_Step]) -> Seen:
    """Return what was seen after each step by its camera as seen by one more camera."""
    n_cameras = len(seen.xy)
    which = np.r_[:n_cameras, [step.camera for step in steps]]
    gone = np.zeros((len(which), len(seen.time_s)), dtype=bool)
    for new, old in enumerate(_poses_before(n_cameras, steps), start=n_cameras):
        after = steps[new - n_cameras].during(seen.time_s)
        gone[old] |= after
        gone[new] |= ~after
    xy, score = seen.xy[which], seen.score[which]
    xy[gone], score[gone] = np.nan, np.nan
    return replace(seen, xy=xy, score=score, height_px=seen.height_px[which], offset_px=None)


def _blocks(seen: Seen, fewest: int = held_out.BLOCKS) -> NDArray:
    """Return the block of time of its track (T,) int of each row: of 1 s, in short takes less."""
    long_s = min(BLOCK_S, np.ptp(seen.time_s) / fewest)
    block = np.stack([seen.track, seen.time_s // long_s])
    return np.unique(block, axis=1, return_inverse=True)[1].ravel()


def _equations(cameras: Sequence[Camera], seen: Seen, min_score: float) -> list[NDArray]:
    """Return normal equations of each camera's turn in each row, (C, T, 3, 3) and (C, T, 3).

    Of epipolar residuals; a view's scatter is in heights of the person.
    """
    rays = []
    for camera, xy in zip(cameras, seen.xy, strict=True):
        straight = camera_models.undistort(camera, xy)
        rays.append(rotations.unit(np.insert(straight, 2, 1.0, axis=-1)))
    shape = len(cameras), len(seen.track)
    matrix, right = np.zeros((*shape, 3, 3)), np.zeros((*shape, 3))
    used = np.nan_to_num(seen.score) >= min_score
    for pair in combinations(range(len(cameras)), 2):
        a, b = (cameras[at] for at in pair)
        base = rotations.unit(b.centre_in_world - a.centre_in_world)
        of_a, of_b = (
            rays[at] @ one.cam_from_world[:, :3] for at, one in zip(pair, (a, b), strict=True)
        )
        slopes = np.cross(of_b, base), np.cross(base, of_a)  # of the residual, by either ray
        variance = sum(
            (seen.height_px[at] / epipolar.focal_px(cameras[at]))[:, None] ** 2
            * (slope**2).sum(axis=-1)
            / np.maximum(seen.score[at], min_score)
            for at, slope in zip(pair, slopes, strict=True)
        )
        off = np.cross(of_a, of_b) @ base / np.sqrt(variance)
        known = np.isfinite(off) & used[pair[0]] & used[pair[1]]
        if not known.any():
            continue
        scatter = MEDIAN_TO_SIGMA * np.median(np.abs(off[known])) + np.finfo(float).tiny
        off = np.where(known, off, 0.0) / scatter
        weight = known / (1 + (off / LOSS) ** 2)
        for at, ray, slope in zip(pair, (of_a, of_b), slopes, strict=True):
            by_turn = np.cross(ray, slope) @ cameras[at].cam_from_world[:, :3].T
            by_turn = np.nan_to_num(by_turn / (scatter * np.sqrt(variance))[..., None])
            matrix[at] += np.einsum("tj,tji,tjk->tik", weight, by_turn, by_turn)
            right[at] += np.einsum("tj,tji,tj->ti", weight, by_turn, off)
    return [matrix, right]


def _spans(matrix: NDArray, right: NDArray, times: NDArray) -> list[tuple[float, float]]:
    """Return when a camera is best turned: for good, and until it is put back, if it can be."""
    ahead = [np.cumsum(np.concatenate([0 * part[:1], part]), axis=0) for part in (matrix, right)]
    rows = np.flatnonzero((times >= times[0] + LEAST_S) & (times <= times[-1] - LEAST_S))
    if not len(rows):
        return []
    first = rows[_gains(ahead, rows, len(times)).argmax()]
    spans = [(float(times[first]), np.inf)]
    grid = rows[np.unique(np.linspace(0, len(rows) - 1, GRID).astype(int))]
    starts, stops = np.array(list(combinations(grid, 2)), dtype=int).reshape(-1, 2).T
    long = times[stops] - times[starts] >= LEAST_S
    if not long.any():
        return spans
    stop = stops[long][_gains(ahead, starts[long], stops[long]).argmax()]
    for _ in range(2):  # refined in turn
        early = rows[times[rows] <= times[stop] - LEAST_S]
        start = early[_gains(ahead, early, stop).argmax()]
        late = rows[times[rows] >= times[start] + LEAST_S]
        stop = late[_gains(ahead, start, late).argmax()]
    return [*spans, (float(times[start]), float(times[stop]))]


def _gains(ahead: Sequence[NDArray], first, stop) -> NDArray:
    """Return how much turns from rows up to others lower the cost (N,), from sums before rows."""
    matrix, right = ahead
    ridge = (1e-6 * np.trace(matrix[-1]) + 1e-12) * np.eye(3)  # also of a camera that sees nobody

    def cost(one: NDArray, other: NDArray) -> NDArray:
        return (np.linalg.solve(one + ridge, other[..., None])[..., 0] * other).sum(axis=-1)

    during = matrix[stop] - matrix[first], right[stop] - right[first]
    return cost(*during) + cost(matrix[-1] - during[0], right[-1] - during[1])


def _step(equations, seen: Seen, camera: int, time_s: float, until_s: float) -> _Step | None:
    """Return the step at a time; None where a side says too little.

    Residuals err alike: its covariance is from their sums over blocks of time.
    """
    after, turns, spread = (seen.time_s >= time_s) & (seen.time_s < until_s), [], []
    block = _blocks(seen, fewest=1)
    for side in (~after, after):
        matrix, right = (part[camera, side] for part in equations)
        total = matrix.sum(axis=0)
        if np.linalg.matrix_rank(total) < 3:
            return None
        turns.append(np.linalg.solve(total, right.sum(axis=0)))
        left = right - matrix @ turns[-1]
        sums = np.stack([np.bincount(block[side], axis) for axis in left.T], axis=1)
        inverse = np.linalg.inv(total)
        spread.append(inverse + inverse @ sums.T @ sums @ inverse)
    step, information = turns[1] - turns[0], np.linalg.inv(spread[0] + spread[1])
    shrunk = np.linalg.solve(information + np.eye(3) / USUAL_RAD**2, information @ step)
    return _Step(camera, time_s, shrunk, float(step @ information @ step), until_s)
