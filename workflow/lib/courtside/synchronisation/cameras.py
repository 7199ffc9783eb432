"""Clock offsets and drifts of fixed cameras, from the people that they see."""

import warnings
from dataclasses import dataclass

import numpy as np

from courtside.geometry import epipolar
from courtside.records.devices.clocks import Clock
from courtside.statistics import autocorrelation
from courtside.study.errors import InputError
from courtside.synchronisation import clock_adjustment, smooth_tracks
from courtside.synchronisation.epipolar import Epipolar
from courtside.synchronisation.speed import Speeds

MAX_OFFSET_S = 10.0
MIN_SCORE = 0.3
FEWEST_FRAMES = 30
MAX_UNCERTAINTY_S = 0.02
PRIOR_DRIFT = (
    100e-6  # ASSUME: standard deviation of cameras' drifts; quartz clocks run within 200 ppm
)
HOPELESS = 10.0  # a drift less sure than so many priors is not sought
KNOWN_DRIFT = 0.5  # of the prior: less is found out, more is mostly assumed
READOUT_SPREAD_S = 0.01  # ASSUME: rolling shutters need up to 20 ms or so from top to bottom
SMOOTHING = 0.85  # of the longest frame interval: less would draw offsets to half frames
PARTS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")


def synchronise(views, cameras=None, *, max_offset_s=MAX_OFFSET_S, min_score=MIN_SCORE):
    """Find the clock of every camera against the first one's.

    Parameters
    ----------
    views : list of Keypoints2D, length C
        Tracklets need not be persons, nor of one number or order in all views.
    cameras : list of Camera, length C, optional
        In the order of `views`. Without them only the rhythm of the motion is compared.
    max_offset_s : float
        Offsets beyond are not tried.
    min_score : float
        Keypoints below it are not used.

    Returns
    -------
    clocks : dict of str to Clock
        By camera; `records.sync.fault_line` says whether they may be used.

    Raises
    ------
    InputError
        If a camera has hardly any frames.

    Notes
    -----
    First every offset is tried on a coarse grid, camera after camera, the surest first. Then offsets and
    drifts of all cameras are adjusted together: with cameras the epipolar distances of all joints are
    made least, without them the products of the joints' speeds largest. Sound is not used.
    """
    _check(views)
    time_s = _times(views[0].time_s)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "All-NaN|Mean of empty|Degrees of freedom")
        evidence = _evidence(views, cameras, min_score)
        placed = place(evidence.scan, len(views), max_offset_s, evidence.scan_step_s)
        sure = [camera for camera, at in placed.items() if not at.candidates_s]
        offset_s = [placed[c].offset_s if c in sure else 0.0 for c in range(len(views))]
        pairs = evidence.match(time_s + np.array(offset_s)[:, None], sure)
        sure = _connected(pairs)
        adjusted = _adjust(evidence, offset_s, sure, time_s)
    rows = [_row(view) for view in views]
    clocks = {views[0].camera: Clock(status="reference", note="the take's clock")}
    for camera in range(1, len(views)):
        if camera in sure:
            overlap = _overlap(views[camera], adjusted.own(camera, time_s), time_s)
            clock = _found(adjusted, camera, overlap, time_s, abs(rows[camera] - rows[0]))
        else:
            clock = _not_found(placed.get(camera))
        clocks[views[camera].camera] = clock
    return clocks


def _check(views):
    for view in views:
        if len(view.time_s) < FEWEST_FRAMES:
            raise InputError(
                f"camera {view.camera}: expected {FEWEST_FRAMES} frames or more to synchronise by, found "
                f"{len(view.time_s)}; record a longer take"
            )


def _evidence(views, cameras, min_score):
    step_s = max(float(np.median(np.diff(view.time_s))) for view in views)
    tracks = []
    for at, view in enumerate(views):
        joints = [name.endswith(PARTS) for name in view.joints]
        joints = joints if any(joints) else [True] * len(joints)
        xy = np.where(view.score[..., None] >= min_score, view.xy, np.nan)[:, :, joints]
        xy = xy if len(xy) else np.full((1, *xy.shape[1:]), np.nan)
        xy = epipolar.straight_px(cameras[at], xy) if cameras else xy
        tracks.append(smooth_tracks.build(view.time_s, xy, SMOOTHING * step_s))
    return Epipolar(cameras, tracks) if cameras else Speeds(tracks)


def _times(time_s):
    """Return uniform times (T,) over those of the first camera."""
    step_s = float(np.median(np.diff(time_s)))
    return time_s[0] + step_s * np.arange(round((time_s[-1] - time_s[0]) / step_s) + 1)


def _connected(pairs):
    """Return the cameras that pairs connect with camera 0, directly or through others."""
    known = {0}
    for _ in pairs:
        known |= {camera for pair in pairs if known & set(pair) for camera in pair}
    return known


def _adjust(evidence, offset_s, sure, time_s):
    """Adjust the clocks of the sure cameras; with no hope for a drift, the offsets alone."""
    unknowns = np.array([2 * (camera in sure) for camera in range(len(offset_s))])
    unknowns[0] = 0
    adjusted = clock_adjustment.adjust(evidence.terms, offset_s, time_s, unknowns)
    spread = np.sqrt(np.diag(adjusted.covariance)[1::2])
    if spread.max() <= HOPELESS * PRIOR_DRIFT:
        return clock_adjustment.with_prior(adjusted, PRIOR_DRIFT)
    return clock_adjustment.adjust(evidence.terms, offset_s, time_s, np.minimum(unknowns, 1))


def _overlap(view, own, time_s):
    """Return the times of the reference clock at which a camera ran."""
    return time_s[(own >= view.time_s[0]) & (own <= view.time_s[-1])]


def _row(view):
    """Return at what share of the picture's height the persons usually are."""
    seen = np.isfinite(view.xy[..., 1])
    return float(np.median(view.xy[..., 1][seen])) / view.size[1] if seen.any() else 0.5


def _found(adjusted, camera, overlap, time_s, rows_apart):
    drift, at = adjusted.drift[camera], slice(2 * camera, 2 * camera + 2)
    covariance = adjusted.covariance[at, at]
    offset_s = adjusted.offset_s[camera] - drift * adjusted.centre_s
    ends = time_s[[0, -1]]
    lever = ends - adjusted.centre_s
    variance = covariance[0, 0] + 2 * lever * covariance[0, 1] + lever**2 * covariance[1, 1]
    drift_spread = float(np.sqrt(covariance[1, 1]))
    if not drift_spread > 0:
        drift_spread = PRIOR_DRIFT
        variance = variance + (PRIOR_DRIFT * (ends - overlap.mean())) ** 2
    uncertainty_s = float(np.sqrt(variance.max() + (READOUT_SPREAD_S * rows_apart) ** 2))
    sure = uncertainty_s <= MAX_UNCERTAINTY_S
    known = drift_spread < KNOWN_DRIFT * PRIOR_DRIFT
    note = (
        "offset and drift adjusted"
        if known
        else "offset adjusted; the take says little of the drift"
    )
    if not sure:
        note = (
            f"uncertain by {1e3 * uncertainty_s:.0f} ms: too little fast motion seen by two cameras"
        )
    return Clock(
        float(offset_s),
        float(1e6 * drift),
        uncertainty_s if np.isfinite(uncertainty_s) else np.nan,
        1e6 * drift_spread,
        "found" if sure else "unknown",
        note,
    )


def _not_found(placed):
    if placed is None or not placed.candidates_s:
        note = "it sees no person together with another camera"
        unknown = {"uncertainty_s": np.nan, "drift_uncertainty_ppm": np.nan}
        return Clock(**unknown, status="unknown", note=note)
    unknown = len(placed.candidates_s) >= MOST_CANDIDATES
    return Clock(
        placed.offset_s,
        0.0,
        np.nan,
        1e6 * PRIOR_DRIFT,
        "unknown" if unknown else "ambiguous",
        "no offset stands out" if unknown else "other offsets explain the motion about as well",
        placed.candidates_s,
    )


SEPARATE_S = 0.25  # minima closer than this are one
DISTINCT = 3.0  # standard deviations by which the best offset must beat another one
FEWEST = 0.15  # share of the times of a pair that must overlap at an offset
MOST_CANDIDATES = 5  # as many other offsets as this: nothing is known


@dataclass(frozen=True)
class Placed:
    """Where one camera came to lie.

    Attributes
    ----------
    offset_s : float
        To the step of the scan.
    candidates_s : tuple of float
        Other offsets that the recording does not rule out.
    distinct : float
        Standard deviations between the best offset and the next one.
    through : tuple of int
        Cameras that it was compared with.
    """

    offset_s: float
    candidates_s: tuple
    distinct: float
    through: tuple


def place(scan, n_cameras, max_offset_s, step_s):
    """Place all cameras against camera 0.

    Parameters
    ----------
    scan : callable
        `scan(a, b, lags_s)` returns the loss (N, L) of camera b against a, at N times of camera a and
        offsets of b's clock against a's; NaN where the two share nothing.
    n_cameras : int
    max_offset_s, step_s : float
        The offsets tried.

    Returns
    -------
    placed : dict of int to Placed
        In the order of placing, camera 0 first. A camera that no other can be compared with lacks.
    """
    count = int(np.ceil(max_offset_s / step_s))
    offsets_s = step_s * np.arange(-count, count + 1)
    placed = {0: Placed(0.0, (), np.inf, ())}
    losses = {camera: {} for camera in range(1, n_cameras)}
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


def _sure(placed):
    return [camera for camera, at in placed.items() if not at.candidates_s]


def choose(offsets_s, losses):
    """Choose the offset of one camera.

    Parameters
    ----------
    offsets_s : (L,) float
        Uniform.
    losses : dict of int to (N, L) float
        Against each camera that is placed; NaN where nothing is compared.

    Returns
    -------
    placed : Placed
        With an offset of NaN where nothing overlaps.
    """
    loss = np.concatenate(list(losses.values()))
    curve = _curve(loss)
    if not np.isfinite(curve).any():
        return Placed(np.nan, (), -np.inf, tuple(losses))
    order = minima(curve, max(1, round(SEPARATE_S / (offsets_s[1] - offsets_s[0]))))
    best, others = order[0], order[1 : 2 * MOST_CANDIDATES + 1]
    margins = np.array([_margin(loss[:, best], loss[:, other]) for other in others])
    near = [other for other, margin in zip(others, margins, strict=True) if margin < DISTINCT]
    return Placed(
        float(offsets_s[best]),
        tuple(float(offsets_s[at]) for at in near[:MOST_CANDIDATES]),
        float(margins.min(initial=99.0)),
        tuple(losses),
    )


def _curve(loss):
    """Return the mean loss (L,), drawn to that of an arbitrary offset where little overlaps."""
    known = np.isfinite(loss)
    count = known.sum(axis=0)
    few = FEWEST * max(count.max(), 1)
    usual = np.median(loss[known]) if known.any() else 0.0
    curve = (np.where(known, loss, 0.0).sum(axis=0) + few * usual) / (count + few)
    return np.where(count >= max(few, 3), curve, np.nan)


def minima(curve, apart):
    """Return the places of local minima of a curve (L,), lowest first, none within `apart` of a lower one."""
    filled = np.where(np.isfinite(curve), curve, np.inf)
    padded = np.pad(filled, 1, constant_values=np.inf)
    local = (filled <= padded[:-2]) & (filled <= padded[2:]) & np.isfinite(curve)
    kept = []
    for at in sorted(np.flatnonzero(local), key=lambda place: filled[place]):
        if all(abs(at - other) > apart for other in kept):
            kept.append(int(at))
    return kept


def _margin(best, other):
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
