"""Clock offsets and drifts of fixed cameras, from the people that they see."""

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import epipolar
from courtside.geometry.camera import Camera
from courtside.records.devices import clocks
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.statistics import autocorrelation
from courtside.study.errors import InputError
from courtside.synchronisation import clock_adjustment, clock_doubts, lost_frames, smooth_tracks
from courtside.synchronisation.epipolar import FIRST_FADE, Epipolar
from courtside.synchronisation.speed import Speeds

MAX_OFFSET_S = 10.0  # ASSUME: cameras are started by hand within this time
MIN_SCORE = 0.3  # the default of Pose2Sim
MAX_UNCERTAINTY_S = 0.02  # ASSUME: an offset less certain than half a frame at 25 Hz is not used
# ASSUME: standard deviation of cameras' drifts; quartz clocks run within 200 ppm.
PRIOR_DRIFT = 100e-6
HOPELESS = 10.0  # ASSUME: drifts are not estimated where they are less certain than 10 priors
KNOWN_DRIFT = 0.5  # share of the prior: a larger uncertainty means a mostly assumed drift
READOUT_SPREAD_S = 0.01  # ASSUME: rolling shutters need up to about 20 ms from top to bottom
# A network errs with the pose, alike through a take, which looks like a shift in time. 3 ms are the
# likeliest for 86 clocks of virtual development takes (players-dev, -stands, -near): 93 % of them
# are in their stated 90 % (84 % without this term). Of 30 of repeats and players-b, held out, 97 %
# are (90 % without). ASSUME: other networks and real people err as much.
NETWORK_S = 0.003
SMOOTHING = 0.85  # of the longest frame interval: less would bias offsets to half frames
MOVED = "a camera was moved since, or clicked on another court or from the other end"
REFERENCE = Clock(status="reference", note="the take's clock")


def synchronise(
    views: Sequence[Keypoints2D],
    cameras: Sequence[Camera] | None = None,
    *,
    max_offset_s: float = MAX_OFFSET_S,
    min_score: float = MIN_SCORE,
    fixed: Mapping[str, Clock] | None = None,
) -> dict[str, Clock]:
    """Find the clock of every camera against the first one's.

    Tracklets of the views may differ in number, order and persons. `cameras` are in the order of
    the views; without them only the rhythm of the motion is compared. Offsets larger than
    `max_offset_s`, against a camera whose clock is known, are not tried, keypoints below
    `min_score` not used. Clocks that are `fixed` stay. Whether the clocks may be used tells
    `records.devices.clocks.fault_line`. An `InputError` if a camera has fewer than
    `clocks.FEWEST_FRAMES` frames.

    First every offset is tried on a coarse grid, camera after camera, the surest first. Then
    offsets and drifts of all cameras are adjusted together: with cameras, to minimise the epipolar
    distances of all joints; without, to maximise the products of the joints' speeds. Sound is not
    used.
    """
    for view in views:
        if len(view.time_s) < clocks.FEWEST_FRAMES:
            raise InputError(
                f"camera {view.camera}: expected {clocks.FEWEST_FRAMES} frames or more to "
                f"synchronise by, found {len(view.time_s)}; record a longer take, or state the "
                "`clocks` of all cameras but the first"
            )
    time_s = _times(views[0].time_s)
    still = {at: fixed[v.camera] for at, v in enumerate(views) if fixed and v.camera in fixed}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "All-NaN|Mean of empty|Degrees of freedom")
        evidence = _evidence(views, cameras, min_score)
        middle_s = float(time_s.mean())
        known_s = {c: float(still[c].from_reference(middle_s)) - middle_s for c in still}
        placed = place(evidence.scan, len(views), max_offset_s, evidence.scan_step_s, known_s)
        sure = _sure(placed)
        offset_s = [placed[c].offset_s if c in sure else 0.0 for c in range(len(views))]
        pairs = evidence.match(time_s + np.array(offset_s)[:, None], sure)
        sure = sorted(_connected(pairs, {0, *still}))
        motion = _adjust(evidence, offset_s, sure, time_s, still)
        adjusted = clock_adjustment.with_prior(motion, PRIOR_DRIFT)
    found = {views[0].camera: REFERENCE}
    stated_s = max((clock.uncertainty_s for clock in still.values()), default=0.0)
    for camera in range(1, len(views)):
        if camera in still:
            clock = still[camera]
        elif camera in sure:
            clock = _found(adjusted, camera, views, time_s, stated_s)
        else:
            clock = _not_found(placed.get(camera), max_offset_s, calibrated=cameras is not None)
        found[views[camera].camera] = clock
    return _doubted(found, evidence, motion)


def of_take(
    views: Sequence[Keypoints2D],
    cameras: Mapping[str, Camera] | None,
    *,
    synchronised: bool,
    stated: Mapping[str, Mapping[str, Any]],
    **options: Any,
) -> dict[str, Clock]:
    """Return the clocks of a take's cameras, by name.

    One clock where the session says that they are `synchronised`; else those found by
    `synchronise`, with `options`, but for those `stated`. Stated clocks are as good as their
    source: they help to find only those that are not found without. `cameras` by name where they
    are known.
    """
    if synchronised:
        return clocks.one_clock([view.camera for view in views])
    if clocks.are_stated([view.camera for view in views], stated):
        return {views[0].camera: REFERENCE} | clocks.stated(stated)
    known = [cameras[view.camera] for view in views] if cameras else None
    found, fixed = synchronise(views, known, **options), clocks.stated(stated)
    missed = [name for name, clock in found.items() if not clock.usable and name not in fixed]
    if fixed and missed:
        again = synchronise(views, known, fixed=fixed, **options)
        found |= {name: again[name] for name in missed}
    found |= fixed
    if known and not all(clock.usable for clock in found.values()):
        found = _against_calibration(found, synchronise(views, None, **options))
    return found


def _against_calibration(found: dict[str, Clock], rhythm: Mapping[str, Clock]) -> dict[str, Clock]:
    """Return clocks; of one that is not `found`, but by the `rhythm` of the motion, what it means.

    Any offset contradicts a wrong calibration.
    """
    told = dict(found)
    for name, clock in found.items():
        if not clock.usable and rhythm[name].usable:
            note = (
                f"by the rhythm of the motion its offset_s is {rhythm[name].offset_s:.3f}, which "
                "contradicts its calibration, or that of the cameras it is compared with: "
                f"{MOVED}; calibrate again"
            )
            told[name] = replace(clock, status="unknown", note=note, candidates_s=())
    return told


def _evidence(views, cameras, min_score) -> Epipolar | Speeds:
    step_s = max(float(np.median(np.diff(view.time_s))) for view in views)
    tracks = []
    for at, view in enumerate(views):
        joints = [name.endswith(skeleton.LIMBS) for name in view.joints]
        joints = joints if any(joints) else [True] * len(joints)
        xy = np.where(view.score[..., None] >= min_score, view.xy, np.nan)[:, :, joints]
        xy = xy if len(xy) else np.full((1, *xy.shape[1:]), np.nan)
        xy = epipolar.straight_px(cameras[at], xy) if cameras else xy
        tracks.append(smooth_tracks.build(view.time_s, xy, SMOOTHING * step_s))
    return Epipolar(cameras, tracks) if cameras else Speeds(tracks)


def _times(time_s: NDArray) -> NDArray:
    """Return uniform times (T,) over those of the first camera."""
    step_s = float(np.median(np.diff(time_s)))
    return time_s[0] + step_s * np.arange(round((time_s[-1] - time_s[0]) / step_s) + 1)


def _connected(pairs: list[tuple[int, int]], known: set[int]) -> set[int]:
    """Return the cameras that pairs connect with known ones, directly or through others."""
    for _ in pairs:
        known |= {camera for pair in pairs if known & set(pair) for camera in pair}
    return known


def _adjust(evidence, offset_s, sure, time_s, still) -> clock_adjustment.Adjusted:
    """Adjust the clocks of the sure cameras; offsets alone where a drift cannot be determined.

    Those of the cameras `still` stay. The step of the scan is so coarse that two cameras which face
    each other can end in a wrong minimum: offsets alone are adjusted first, with wide weights.
    """
    unknowns = np.array([2 * (camera in sure) for camera in range(len(offset_s))])
    unknowns[[0, *still]] = 0
    drift = np.array(
        [1e-6 * still[c].drift_ppm if c in still else 0.0 for c in range(len(unknowns))]
    )
    if isinstance(evidence, Epipolar):
        wide = partial(evidence.terms, fade=FIRST_FADE)
        first = clock_adjustment.adjust(wide, offset_s, time_s, np.minimum(unknowns, 1), drift)
        offset_s = first.offset_s
    while True:
        adjusted = clock_adjustment.adjust(evidence.terms, offset_s, time_s, unknowns, drift)
        spread = np.sqrt(np.diag(adjusted.covariance)[1::2])
        lost = (unknowns == 2) & ~(spread <= HOPELESS * PRIOR_DRIFT)
        if not lost.any():
            return adjusted
        # One undetermined drift makes all of them infinite: that of the least evidence goes first.
        told = np.isfinite(spread[lost]).all()
        known = -spread if told else _of_drifts(evidence, offset_s, time_s)
        unknowns[np.argmin(np.where(lost, known, np.inf))] = 1


def _of_drifts(evidence, offset_s, time_s) -> NDArray:
    """Return how much each camera's evidence (C,) tells of its drift: its spread over time."""
    weight = np.zeros((len(offset_s), len(time_s)))
    for pair, (_, _, steepness) in evidence.terms(time_s + np.array(offset_s)[:, None]).items():
        weight[list(pair)] += steepness
    centre_s = weight @ time_s / np.maximum(weight.sum(axis=1), 1e-300)
    return (weight * (time_s - centre_s[:, None]) ** 2).sum(axis=1)


def _row(view: Keypoints2D) -> float:
    """Return the persons' median y, as a share of the picture's height."""
    seen = np.isfinite(view.xy[..., 1])
    return float(np.median(view.xy[..., 1][seen])) / view.size[1] if seen.any() else 0.5


def _found(adjusted, camera, views, time_s, stated_s) -> Clock:
    """Return the clock, with its uncertainty at the ends of the times that the camera filmed.

    `stated_s` is that of the clocks that others are found by.
    """
    own, filmed_s = adjusted.own(camera, time_s), views[camera].time_s
    overlap = time_s[(own >= filmed_s[0]) & (own <= filmed_s[-1])]
    overlap = overlap if len(overlap) else time_s
    readout_s = READOUT_SPREAD_S * abs(_row(views[camera]) - _row(views[0]))
    beside_s = math.hypot(readout_s, NETWORK_S, stated_s)
    drift, at = adjusted.drift[camera], slice(2 * camera, 2 * camera + 2)
    covariance = adjusted.covariance[at, at]
    offset_s = adjusted.offset_s[camera] - drift * adjusted.centre_s
    ends = overlap[[0, -1]]
    lever = ends - adjusted.centre_s
    variance = covariance[0, 0] + 2 * lever * covariance[0, 1] + lever**2 * covariance[1, 1]
    drift_spread = float(np.sqrt(covariance[1, 1]))
    if not drift_spread > 0:
        drift_spread = PRIOR_DRIFT
        variance = variance + (PRIOR_DRIFT * (ends - overlap.mean())) ** 2
    uncertainty_s = float(np.sqrt(variance.max() + beside_s**2))
    sure = uncertainty_s <= MAX_UNCERTAINTY_S
    known = drift_spread < KNOWN_DRIFT * PRIOR_DRIFT
    note = "offset and drift adjusted"
    if not known:
        note = "offset adjusted; the take says little of the drift"
    if not sure:
        much = f" by {1e3 * uncertainty_s:.0f} ms" if np.isfinite(uncertainty_s) else ""
        note = f"uncertain{much}: too little fast motion seen by two cameras"
    return Clock(
        float(offset_s),
        float(1e6 * drift),
        uncertainty_s if np.isfinite(uncertainty_s) else np.nan,
        1e6 * drift_spread,
        "found" if sure else "unknown",
        note,
    )


def _doubted(
    found: dict[str, Clock], evidence: Epipolar | Speeds, motion: clock_adjustment.Adjusted
) -> dict[str, Clock]:
    """Return the clocks, with what speaks against those that are used.

    `motion` are the clocks without a prior: it spreads an impossible drift of one over all.
    """
    own = list(found.values())
    doubts = _lost_frames(evidence, own, list(found))
    estimated = np.diag(motion.covariance)[1::2] > 0
    known = [
        at
        for at, clock in enumerate(own)
        if clock.usable and at not in doubts and (estimated[at] or clock.status != "found")
    ]
    doubts |= _drifts(motion, known)
    return {
        name: replace(clock, doubt=doubts.get(at, ""))
        for at, (name, clock) in enumerate(found.items())
    }


def _drifts(motion: clock_adjustment.Adjusted, cameras: list[int]) -> dict[int, str]:
    """Return what is said of cameras that drift as no clock does, by their index.

    These are the ones that drift against more than half of the others, or against the most: of two
    cameras both. The first one, against which drifts are estimated, may be wrong as any other.
    """
    at = 2 * np.array(cameras, int) + 1
    covariance, drift = motion.covariance[np.ix_(at, at)], motion.drift[cameras]
    apart, variance = drift[:, None] - drift, np.diag(covariance)
    spread = np.sqrt(np.maximum(variance[:, None] + variance - 2 * covariance, 0))
    wrong = np.abs(apart) > clock_doubts.MOST_DRIFT * PRIOR_DRIFT + DISTINCT * spread
    count = wrong.sum(axis=1)
    least = max(1, min(count.max(initial=0), (len(cameras) + 1) // 2))
    return {
        cameras[row]: clock_doubts.drift(1e6 * np.median(apart[row, wrong[row]]), PRIOR_DRIFT)
        for row in np.flatnonzero(count >= least)
    }


def _lost_frames(
    evidence: Epipolar | Speeds, own: Sequence[Clock], names: Sequence[str]
) -> dict[int, str]:
    """Return what is said of cameras that lost frames, by their index.

    The others see it of the worst, too: they are asked again without it. Of two, it may be either.
    """
    used, doubts = [at for at, clock in enumerate(own) if clock.usable], {}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "All-NaN|Mean of empty|Degrees of freedom")
        while used:
            said = {at: lost_frames.doubt(evidence, at, own, used) for at in used}
            worst = max(used, key=lambda at: said[at][0])
            if not said[worst][1]:
                break
            doubts[worst] = said[worst][1]
            used.remove(worst)
            if len(used) == 1:
                doubts[worst] += f"; or {names[used[0]]}'s video lacks them: two cannot tell"
    return doubts


def _not_found(placed: "Placed | None", max_offset_s: float, *, calibrated: bool) -> Clock:
    doubt = f"; else its calibration may be off: {MOVED}" if calibrated else ""
    if placed is None or not placed.candidates_s:
        return Clock(
            uncertainty_s=np.nan,
            drift_uncertainty_ppm=np.nan,
            status="unknown",
            note="it sees no person together with another camera" + doubt,
        )
    unknown = len(placed.candidates_s) >= MOST_CANDIDATES
    note = "other offsets explain the motion about as well"
    if unknown:
        note = (
            f"no offset stands out among those of up to {max_offset_s:g} s, which are tried; if it "
            f"was started earlier or later, raise `synchronise_cameras: max_offset_s`{doubt}"
        )
    return Clock(
        placed.offset_s,
        0.0,
        np.nan,
        1e6 * PRIOR_DRIFT,
        "unknown" if unknown else "ambiguous",
        note,
        placed.candidates_s,
    )


# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
SEPARATE_S = 0.25  # minima closer than this are one
DISTINCT = 3.0  # standard deviations: of an offset better than all others, of an impossible drift
FEWEST = 0.15  # share of the times of a pair that must overlap at an offset
MOST_CANDIDATES = 5  # with this many other offsets, the offset is unknown


@dataclass(frozen=True)
class Placed:
    """Coarse offset `offset_s` of one camera, to the step of the scan.

    `candidates_s` are other offsets that the recording does not rule out, `distinct` the standard
    deviations between the best offset and the next one.
    """

    offset_s: float
    candidates_s: tuple[float, ...]
    distinct: float


def place(
    scan: Callable[[int, int, NDArray], NDArray],
    n_cameras: int,
    max_offset_s: float,
    step_s: float,
    known_s: Mapping[int, float] | None = None,
) -> dict[int, Placed]:
    """Find coarse offsets of all cameras against camera 0; some are known (`known_s`).

    `scan(a, b, lags_s)` returns the loss (N, L) of camera b against a, at N times of camera a and
    offsets of b's clock against a's; NaN where they have nothing in common. Offsets up to
    `max_offset_s` against a known camera are tried in steps of `step_s`. The result is in the order
    of placing, camera 0 first, without cameras that no other can be compared with.
    """
    count = int(np.ceil(max_offset_s / step_s))
    known_s = {0: 0.0} | dict(known_s or {})
    about = [round(offset_s / step_s) for offset_s in known_s.values()]
    tried = [at + np.arange(-count, count + 1) for at in about]
    offsets_s = step_s * np.unique(np.concatenate(tried))
    placed = {camera: Placed(offset_s, (), np.inf) for camera, offset_s in known_s.items()}
    losses: dict[int, dict[int, NDArray]]
    losses = {camera: {} for camera in range(n_cameras) if camera not in placed}
    while losses:
        for camera, known in losses.items():
            for other in _sure(placed):
                if other not in known:
                    known[other] = scan(other, camera, offsets_s - placed[other].offset_s)
        choices = {camera: choose(offsets_s, known) for camera, known in losses.items()}
        surest = max(choices, key=lambda camera: choices[camera].distinct)
        if np.isfinite(choices[surest].offset_s):
            placed[surest] = choices[surest]
        del losses[surest]
    return placed


def _sure(placed: dict[int, Placed]) -> list[int]:
    return [camera for camera, at in placed.items() if not at.candidates_s]


def choose(offsets_s: NDArray, losses: Mapping[int, NDArray]) -> Placed:
    """Choose the offset of one camera among uniform `offsets_s` (L,).

    `losses` (N, L) against each placed camera are NaN where nothing is compared. The offset is NaN
    where nothing overlaps.
    """
    loss = np.concatenate(list(losses.values()))
    curve = _curve(loss)
    if not np.isfinite(curve).any():
        return Placed(np.nan, (), -np.inf)
    order = minima(curve, max(1, round(SEPARATE_S / (offsets_s[1] - offsets_s[0]))))
    best, others = order[0], order[1 : 2 * MOST_CANDIDATES + 1]
    margins = np.array([_margin(loss[:, best], loss[:, other]) for other in others])
    near = [other for other, margin in zip(others, margins, strict=True) if margin < DISTINCT]
    return Placed(
        float(offsets_s[best]),
        tuple(float(offsets_s[at]) for at in near[:MOST_CANDIDATES]),
        float(margins.min(initial=99.0)),
    )


def _curve(loss: NDArray) -> NDArray:
    """Return the mean loss (L,), shrunk to that of an arbitrary offset where little overlaps."""
    known = np.isfinite(loss)
    count = known.sum(axis=0)
    few = FEWEST * max(count.max(), 1)
    usual = np.median(loss[known]) if known.any() else 0.0
    curve = (np.where(known, loss, 0.0).sum(axis=0) + few * usual) / (count + few)
    return np.where(count >= max(few, 3), curve, np.nan)


def minima(curve: NDArray, apart: int) -> list[int]:
    """Return local minima of a curve (L,), lowest first, none within `apart` of a lower one."""
    filled = np.where(np.isfinite(curve), curve, np.inf)
    padded = np.pad(filled, 1, constant_values=np.inf)
    local = (filled <= padded[:-2]) & (filled <= padded[2:]) & np.isfinite(curve)
    kept: list[int] = []
    for at in sorted(np.flatnonzero(local), key=lambda place: filled[place]):
        if all(abs(at - other) > apart for other in kept):
            kept.append(int(at))
    return kept


def _margin(best: NDArray, other: NDArray) -> float:
    """Return by how many standard deviations the loss `other` (N,) is above `best` (N,)."""
    both = np.isfinite(best) & np.isfinite(other)
    if both.sum() >= max(10, 0.3 * np.isfinite(best).sum()):
        return autocorrelation.distinct((other - best)[both])
    best, other = best[np.isfinite(best)], other[np.isfinite(other)]
    spread = [
        autocorrelation.covariance_of_sum((x - x.mean())[:, None])[0, 0] / len(x) ** 2
        for x in (best, other)
    ]
    return float((other.mean() - best.mean()) / np.sqrt(max(sum(spread), 1e-300)))
