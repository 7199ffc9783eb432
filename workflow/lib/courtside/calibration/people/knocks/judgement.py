"""What held-out joints say of a step: whether two poses of its camera are better than one."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from courtside.calibration.file_check import residuals
from courtside.calibration.people import held_out
from courtside.calibration.people.knocks import poses
from courtside.calibration.people.knocks.steps import Step, blocks
from courtside.calibration.people.views import Limits, Seen
from courtside.calibration.records.covariance import CameraCovariance
from courtside.geometry.camera import Camera, project

# ASSUME: limits that tell knocks of 0.4 degrees from none on development takes.
LEAST_CHANGE = 0.05  # of how far held-out joints disagree: what errors of cameras make is 1 to 2 %
LEAST_OF_SIDE = 0.3  # on one side of a knock: 0.4 degrees make 0.4 to 0.8, cameras' errors 0.1
ROWS_TO_JUDGE = 40  # of each half that fits: enough for a turn, and a quarter of the time
NOT_BETTER = {"joints": "not better"}


@dataclass(frozen=True, eq=False)
class Judged:
    """What held-out joints say of a step, as of `Knock`."""

    change: float  # of the clearer side of a step that is taken, else of all
    verdicts: dict[str, str]

    def order(self, step: Step) -> tuple[bool, float]:
        """Return what sorts steps: those taken first, by how clear they are; others by gain.

        A step for good is simpler: one that is put back must be clearer.
        """
        if held_out.better(self.verdicts):
            return False, self.change + LEAST_CHANGE * step.put_back
        return True, -step.gain


def judged(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    step: Step,
    one_pose: list[list[Camera]],
) -> Judged:
    """Return what held-out joints say of a step; `one_pose` is of `halves` without it.

    Judged is the step's camera alone, against joints that the others place: by the time on one side
    of the step, which may be too short to tell in all. The other must not be worse.
    """
    two_poses = halves(cameras, known, seen, limits, [step])
    before, after = (_score(halves, seen, step) for halves in (one_pose, two_poses))
    sides = sorted(_by_side(before, after, seen, step), key=lambda one: one[0])
    for (side, said), (other, _) in permutations(sides, 2):
        if side < -LEAST_OF_SIDE and held_out.better(said) and other < LEAST_CHANGE:
            return Judged(side, said)
    return Judged(after.typical() / before.typical() - 1, NOT_BETTER)


def halves(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    steps: Sequence[Step],
) -> list[list[Camera]]:
    """Return cameras with one pose, or two with a step, fitted to either half of the blocks."""
    block = blocks(seen)
    halves = [seen.of(block % 2 == odd).thinned(ROWS_TO_JUDGE) for odd in (0, 1)]
    return [poses.adjusted(cameras, known, half, limits, steps).cameras for half in halves]


def _by_side(
    before: held_out.Score, after: held_out.Score, seen: Seen, step: Step
) -> list[tuple[float, dict[str, str]]]:
    """Return the change and the verdicts of each side of a step, where it has a block."""
    block, behind, found = blocks(seen), step.during(seen.time_s), []
    for side in (~behind, behind):
        own = np.setdiff1d(block[side], block[~side])
        one, two = (score.of(own) for score in (before, after))
        if one.share and two.share:
            found.append((two.typical() / one.typical() - 1, held_out.verdicts(one, two)))
    return found


def _score(halves: list[list[Camera]], seen: Seen, step: Step) -> held_out.Score:
    """Score the step's camera in the blocks of the half that its cameras were not fitted to."""
    score, block, at = held_out.Score(), blocks(seen), step.camera
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
