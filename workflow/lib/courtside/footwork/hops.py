"""Hops and jumps of both feet at once: flights, which single feet hardly show or show too long.

A low hop, as of a split step, lasts three to six frames, and lifts the feet by a few centimetres:
too short and too low for the speeds and heights of one foot. But the body falls freely meanwhile:
the hips rise fastest as the feet leave the floor and fall fastest as they land, both feet are up at
the same time, and the body goes hardly anywhere. Feet that jump leave and land at 2 m/s and more,
where the contact of single feet, made for steps, is 0.03 to 0.05 s off at either end.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.footwork.stances import Stance
from courtside.kinematics import filtering
from courtside.records.footwork import FEET
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D

GRID_HZ = 240.0
LEAST_FRAMES = 9  # ASSUME: of a run of known frames in which hops are looked for
# Chosen on rallies of the development bodies, in which all hops and nothing else pass.
DROP_M_S = 0.5  # from the fastest rise of the hips to their fastest fall
LASTS_S = (0.04, 0.42)  # between these two, in filtered skeletons
# ASSUME: a jump lasts up to this long, 1 m high; meanwhile the hips fall at this share of g or
# more. Made jumps of 0.4 to 0.7 s have 0.83 to 1; no development take has such a fall.
JUMP_LASTS_S, FALLS = 0.9, 0.7
UP_M = 0.012  # both feet at once, over where they were before and after
TOGETHER_S = 0.07  # the feet are highest within this of one another
TRAVEL_M_S = 1.5  # of the hips, mean; steps of a run look alike otherwise
AROUND_S = 0.1  # before and after: where the feet stand, and where their speeds are looked for
# The means of hips' and feet's times are early (positive) by this, with these standard deviations.
EARLY_S, SIGMA_S = {"off": -0.006, "land": 0.009}, {"off": 0.010, "land": 0.012}
JUMP_SIGMA_S = 0.02  # ASSUME: of longer ones; made jumps of 0.4 to 0.7 s err by up to 0.03 s
LEAST_HZ = 20.0  # ASSUME: at lower frame rates a hop has too few frames
USUAL_HZ = 30.0  # frame rate of those rallies; errors grow with the frame interval
NEAR_S = 0.15  # an end or onset of a stance this near to a hop is that hop's
AGAIN_S = 0.03  # a stance that ends this long after the landing has seen no hop


@dataclass(frozen=True)
class Hop:
    """One hop: the feet leave the floor, and land; standard deviations."""

    off_s: float
    off_sigma_s: float
    land_s: float
    land_sigma_s: float


def find(points: Keypoints3D, person: int) -> list[Hop] | None:
    """Return the hops and jumps of a person, by the person's index, from filtered skeletons.

    None: they cannot be seen, without heels, at a low frame rate or in fewer than `LEAST_FRAMES`.
    """
    names = points.joints.tolist()
    feet = [skeleton.heel_and_toe(names, side) for side in FEET]
    if not all(feet) or len(points.time_s) < LEAST_FRAMES or points.rate_hz < LEAST_HZ:
        return None
    hips = [names.index(f"{side}_hip") for side in FEET]
    xyz = points.xyz[person]
    paths = np.stack([xyz[:, chosen].mean(axis=1) for chosen in (hips, *feet)])
    slower, found = max(1.0, USUAL_HZ / points.rate_hz), []
    for start, stop in filtering.runs(np.isfinite(paths).all(axis=(0, 2))):
        if stop - start >= LEAST_FRAMES:
            run = _Run.of(points.time_s[start:stop], paths[:, start:stop])
            found += [_timed(run, *each, slower) for each in _flights(run)]
    return found


@dataclass(frozen=True, eq=False)
class _Run:
    """Hips, left and right foot (3, N, 3) in a run of frames, on a fine grid: m, and m/s."""

    time_s: NDArray
    place: NDArray
    velocity: NDArray

    @classmethod
    def of(cls, time_s: NDArray, paths: NDArray) -> "_Run":
        spline = scipy.interpolate.CubicSpline(time_s, paths, axis=1)
        grid = np.arange(time_s[0], time_s[-1], 1 / GRID_HZ)
        return cls(grid, spline(grid), spline(grid, 1))


def _flights(run: _Run) -> Iterator[tuple[int, int]]:
    """Yield where on the grid the hips rise and fall fastest, of each hop."""
    rising = run.velocity[0, :, 2]
    tops, lows = (scipy.signal.find_peaks(sign * rising)[0] for sign in (1, -1))
    for top in tops:
        after = lows[lows > top]
        if len(after) and _is_hop(run, int(top), int(after[0])):
            yield int(top), int(after[0])


def _is_hop(run: _Run, top: int, low: int) -> bool:
    rising, inside, near = run.velocity[0, :, 2], slice(top, low + 1), round(AROUND_S * GRID_HZ)
    lasts_s, drop_m_s = (low - top) / GRID_HZ, rising[top] - rising[low]
    if not LASTS_S[0] <= lasts_s <= JUMP_LASTS_S or drop_m_s < DROP_M_S:
        return False
    is_long = _is_long(top, low)
    if is_long and drop_m_s < FALLS * scipy.constants.g * lasts_s:
        return False
    height = run.place[1:, :, 2]
    before = height[:, max(top - near, 0) : top + 1].min(axis=1)
    after = height[:, low : low + near].min(axis=1)
    up = height[:, inside] - np.maximum(before, after)[:, None]
    apart_s = abs(np.diff(up.argmax(axis=1))[0]) / GRID_HZ
    travel = np.linalg.norm(run.velocity[0, inside, :2], axis=1).mean()
    together = up.min(axis=0).max() >= UP_M and apart_s <= TOGETHER_S
    return bool(together and (is_long or travel <= TRAVEL_M_S))


def _is_long(top: int, low: int) -> bool:
    """Return whether a flight is longer than a hop: its free fall shows it, wherever it goes."""
    return (low - top) / GRID_HZ > LASTS_S[1]


def _timed(run: _Run, top: int, low: int, slower: float) -> Hop:
    """Return the hop: means of when the hips and when the feet rise, and fall, fastest."""
    near = round(AROUND_S * GRID_HZ)
    rising = run.velocity[1:, :, 2].mean(axis=0)
    highest = top + int(run.place[1:, top : low + 1, 2].mean(axis=0).argmax())
    first = max(top - near, 0)
    off = first + int(rising[first : highest + 1].argmax())
    land = highest + int(rising[highest : low + near].argmin())
    times = {"off": (top + off) / 2, "land": (low + land) / 2}
    off_s, land_s = (
        float(run.time_s[0] + at / GRID_HZ + EARLY_S[key]) for key, at in times.items()
    )
    sigma_s = dict.fromkeys(SIGMA_S, JUMP_SIGMA_S) if _is_long(top, low) else SIGMA_S
    return Hop(off_s, slower * sigma_s["off"], land_s, slower * sigma_s["land"])


def cut(stances: Sequence[Stance], hops: Sequence[Hop]) -> list[Stance]:
    """Return the stances of one foot, in order, ended and begun anew at each hop.

    Ends and onsets near a hop are moved to it. A stance that saw no hop becomes two. Where the foot
    is not seen to stand between the hop and its next step, it is left as it is.
    """
    made = list(stances)
    for hop in hops:
        starts = [each.since_s for each in made]
        at = int(np.searchsorted(starts, hop.off_s - AGAIN_S)) - 1
        if at < 0:
            continue
        own, later = made[at], made[at + 1] if at + 1 < len(made) else None
        before = replace(own, end_s=hop.off_s, end_sigma_s=hop.off_sigma_s)
        if own.until_s > hop.land_s + AGAIN_S:
            made[at : at + 1] = [before, _landed(own, hop)]
        elif later and later.until_s > hop.land_s and _are_of(own, later, hop):
            made[at : at + 2] = [before, _landed(later, hop)]
    return made


def _are_of(own: Stance, later: Stance, hop: Hop) -> bool:
    return own.end_s >= hop.off_s - NEAR_S and later.onset_s <= hop.land_s + NEAR_S


def _landed(stance: Stance, hop: Hop) -> Stance:
    return replace(stance, onset_s=hop.land_s, onset_sigma_s=hop.land_sigma_s)


def lifted(
    time_s: NDArray, probability: NDArray, stances: Sequence[Stance], hops: Sequence[Hop]
) -> NDArray:
    """Return probabilities of contact (T, 3) that agree with the stances of `cut` near hops."""
    made = probability.copy()
    stands = np.zeros(len(time_s), bool)
    for each in stances:
        stands |= (time_s >= each.since_s) & (time_s <= each.until_s)
    for hop in hops:
        near = (time_s > hop.off_s - NEAR_S) & (time_s < hop.land_s + NEAR_S)
        flies = near & ~stands & (probability[:, 0] > 0.5)
        made[flies] = 1 - probability[flies, :1]
        rests = near & stands & (probability[:, 0] <= 0.5)
        made[rests] = np.maximum(probability[rests], 1 - probability[rests, :1])
    return made
