"""Cameras knocked during a take or between takes: found, measured and judged by people.

No video is needed. Several takes, in their order, are treated as one take in which knocks can only
be where two takes meet.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people import held_out
from courtside.calibration.people.knocks import judgement, poses
from courtside.calibration.people.knocks.steps import BLOCK_S, Step, clearest
from courtside.calibration.people.views import Limits, Seen, check, joined
from courtside.calibration.records.covariance import CameraCovariance
from courtside.geometry import camera as camera_models
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.records.devices.clocks import Clock
from courtside.study.errors import InputError

MOST = 3  # ASSUME: knocks per take
MOST_TRIED = 4  # candidates, each of another camera, and one of a camera that is put back
SURE = 3.0  # standard errors, of turns measured together


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
        one_pose = judgement.halves(cameras, known, left, limits, ())
        judged = [judgement.judged(cameras, known, left, limits, step, one_pose) for step in tried]
        step, said = min(zip(tried, judged, strict=True), key=lambda one: one[1].order(one[0]))
        turn, sigma = poses.measured(cameras, known, left, limits, [step, *step.others])[0]
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


def _candidates(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    at_s: Sequence[float] | None,
) -> list[Step]:
    """Return the clearest steps, each of another camera, and the clearest that is put back."""
    thinned = seen.thinned(2 * judgement.ROWS_TO_JUDGE)
    refined = poses.adjusted(cameras, known, thinned, limits, ()).cameras
    steps = [
        step for some in (cameras, refined) for step in clearest(some, seen, limits.score, at_s)
    ]
    steps.sort(key=lambda one: one.gain)
    steps = _of_turned(cameras, known, seen, limits, steps)
    best = {step.camera: step for step in steps if not step.put_back}
    return list(best.values())[-MOST_TRIED:] + [step for step in steps if step.put_back][-1:]


def _of_turned(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    steps: list[Step],
) -> list[Step]:
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
        found = poses.measured(cameras, known, seen, limits, list(turned.values()))
        sure = [float(np.max(np.abs(turn) / sigma)) for turn, sigma in found]
        if min(sure) >= SURE:
            break
        del turned[list(turned)[sure.index(min(sure))]]
    kept = [one for one in steps if one.camera in turned or one not in at_once]
    others = {at: tuple(turned[k] for k in turned if k != at) for at in turned}
    return [replace(s, others=others[s.camera]) if s in at_once else s for s in kept]


def _together(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    found: Sequence[Knock],
) -> list[Knock]:
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
        steps.append(Step(camera, time_s, rotations.rodrigues_from_rotation(whole), 0.0))
    turns = poses.measured(cameras, known, seen, limits, steps)
    again = [
        replace(first[step.camera, step.time_s], turn=turn, sigma=sigma)
        for step, (turn, sigma) in zip(steps, turns, strict=True)
    ]
    return again + [one for one in found if not one.taken]
