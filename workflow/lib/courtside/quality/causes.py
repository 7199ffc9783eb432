"""Tests of why a camera disagrees with the others: detection, identity, clock, calibration, video.

Each test changes one property of one camera and checks whether its keypoints then match the joints
from the other cameras. Errors are in heights of the person in that picture. What checks of its
calibration say of a camera decides where no test does.
"""

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.quality import measures, moved_cameras
from courtside.quality import seen as views
from courtside.quality.seen import Seen
from courtside.study.execution.verdicts import CALIBRATION, CLOCK, EXCHANGED

DETECTION, IDENTITY, UNKNOWN = "detection", "identity", "unknown"
# ASSUME: usual takes have 0.012 to 0.03 (`verdict.LIMITS`); another body is 0.3 away and more.
FITS = 0.08
NEARER = 0.6  # a change explains an error if at most this share of it is left,
SAME = 0.15  # and no more heights than this: half of what another body is away
# and, of a camera that agrees, if it explains more heights than this, 9 mm of a person: of cameras
# as they are it explains at most 0.003, of cameras 67 to 100 ms late mostly 0.009 and more
TELLING = 0.005
LEAST = 0.3  # a test needs the person in this share of the frames looked at
SOME = 0.02  # share of frames without anybody that is worth a word
MOST_S = 0.5  # clocks are searched to either side
FINEST_S = 0.008  # and not in finer steps than this, or a frame
TURNED = 0.04  # ASSUME: heights that a mere rotation leaves at most; else the camera was moved, too
MOST_DEG = 15.0  # a camera that is turned further is not recognised
MOST_POINTS = 3000  # of the fit of a direction
SPREAD = 0.02  # heights: errors beyond it weigh less in that fit
OTHERS = (
    "it disagrees with cameras whose calibration is off by the check of the calibration file: "
    "correct these first"
)
UNCHECKED = "the other cameras stand too near each other, or face each other, to check it"


@dataclass(frozen=True)
class Cause:
    """The likelier cause of a camera's disagreement."""

    name: str  # `detection`, `identity`, `clock`, `calibration`, `exchanged` (video), `unknown`
    sentence: str  # what the test found
    is_shown: bool = True  # by a test, not only what is left when all tests failed


@dataclass(frozen=True, eq=False)
class _Camera:
    """Data that the tests of one camera share."""

    seen: Seen
    at: int
    expected: NDArray  # (P, S): where the person should be in the picture
    followed: NDArray  # (P, S, K, 2) px
    nearest: NDArray  # (P, S, K, 2) px: the tracklet whose keypoints are nearest, found or not
    row: NDArray  # (P, S): its number, -1 without one

    def left(self, xy: NDArray, model: camera_models.Camera | None = None) -> float:
        """Return the median error over the frames of keypoints (P, S, K, 2); NaN if too few."""
        frames = views.typical(self.seen.errors(self.at, xy, model))
        known = np.isfinite(frames)
        enough = known.sum() >= max(LEAST * self.expected.sum(), 2)
        return float(np.median(frames[known])) if enough else float("nan")


def find(
    seen: Seen, camera: int, *, found_limit: float, doubt: str = "", others: bool = False
) -> Cause:
    """Return the likelier cause of a camera's disagreement with the others.

    `found_limit` is the share of persons found below which detection alone explains it. If the
    other cameras cannot triangulate the person, or there are only two cameras, the cause is
    unknown. `doubt` is what is said against the camera's calibration, as a clause; `others` states
    that the check of a calibration file names faults of other cameras, which shift the joints.
    """
    cause = _by_people(seen, camera, found_limit)
    if not cause.is_shown and (moved := moved_cameras.find(seen, camera)):
        cause = _elsewhere(moved)
    if cause.is_shown and cause.name != CALIBRATION:
        return cause
    if doubt:
        return Cause(CALIBRATION, f"its calibration is off: {doubt}")
    return Cause(CALIBRATION, OTHERS) if others else cause


def _elsewhere(moved: moved_cameras.Moved) -> Cause:
    return Cause(CALIBRATION, f"its calibration is off: {moved}")


def late(seen: Seen, camera: int) -> Cause | None:
    """Return that the clock of a camera is off, where its keypoints agree; None if it is not.

    In a tenth of a second people move no further than poor keypoints are off, but another time then
    explains most of the error. Two cameras are compared with each other.
    """
    if len(seen.points.time_s) < 2:
        return None
    if len(seen.cameras) < 3:
        return _two_late(seen, camera)
    there = np.isfinite(seen.others[camera]).all(axis=-1).mean(axis=-1) >= views.HALF
    one = _of_camera(seen, camera, there & seen.expected(camera))
    shift_s, left = _best_shift(one, one.followed)
    # The same frames: in a short take a shift leaves some out, and they may be the worst.
    moved = _moved(seen, camera, round(shift_s * seen.points.rate_hz))
    before = one.left(np.where(np.isfinite(moved), one.followed, np.nan))
    return _clock(shift_s, before, left)


def _two_late(seen: Seen, camera: int) -> Cause | None:
    """Return the same of both cameras: the second is moved, and either clock may be the wrong one.

    None of a single camera.
    """
    if len(seen.cameras) < 2:
        return None

    def error(keypoints: NDArray) -> float:
        xy = seen.xy.copy()
        xy[1][:, seen.at] = keypoints
        return float(np.nan_to_num(views.disagreement(replace(seen, xy=xy), (0, 1)), nan=np.inf))

    left, _, frames = min((error(_moved(seen, 1, at)), abs(at), at) for at in _shifts(seen))
    same = np.where(np.isfinite(_moved(seen, 1, frames)), seen.xy[1][:, seen.at], np.nan)
    sign = 1 if camera == 1 else -1
    return _clock(sign * float(frames) / seen.points.rate_hz, error(same), left)


def _clock(shift_s: float, before: float, left: float) -> Cause | None:
    known = np.isfinite([before, left]).all()
    if not (known and left <= min(NEARER * before, before - TELLING)):
        return None
    fell = f"the error falls from {before:.3f} to {left:.3f} of a person's height"
    return Cause(CLOCK, f"its clock is off: moved by {shift_s:+.3f} s {fell}")


def _by_people(seen: Seen, camera: int, found_limit: float) -> Cause:
    there = np.isfinite(seen.others[camera]).all(axis=-1).mean(axis=-1) >= views.HALF
    expected = seen.expected(camera)
    some = np.any(views.shown(seen.rows[camera][:, seen.at]), axis=0)
    wanted = np.any(expected, axis=0)
    absent = float((wanted & ~some).sum() / max(wanted.sum(), 1))
    if absent > 1 - found_limit:
        return Cause(DETECTION, _absent(absent))
    if len(seen.cameras) < 3:
        words = (
            "two cameras contradict each other, and no third camera shows which of them is wrong"
        )
        return late(seen, camera) or Cause(UNKNOWN, words, is_shown=False)
    if not (there & expected).any() and not seen.followed[camera].any():
        words = "people are found there, but none of them is followed"
        return Cause(IDENTITY, words, is_shown=False)
    if not (there & expected).any():
        words = "the other cameras do not agree on where the person is"
        return Cause(UNKNOWN, words, is_shown=False)
    return _by_tests(_of_camera(seen, camera, there & expected), absent)


def _of_camera(seen: Seen, camera: int, expected: NDArray) -> _Camera:
    followed = np.where(expected[..., None, None], seen.xy[camera][:, seen.at], np.nan)
    return _Camera(seen, camera, expected, followed, *_nearest(seen, camera, expected, camera))


def _nearest(seen: Seen, camera: int, expected: NDArray, video: int) -> tuple[NDArray, NDArray]:
    """Return the tracklets of a video that are nearest to where a camera should see the persons.

    Their keypoints (P, S, K, 2) px and their numbers (P, S), -1 without one.
    """
    rows = seen.rows[video][:, seen.at]
    nearest = np.full((*expected.shape, *rows.shape[2:]), np.nan)
    if not len(rows):
        return nearest, np.full(expected.shape, -1)
    errors = np.stack([seen.errors(camera, row[None]) for row in rows])
    frames = np.nan_to_num(views.typical(errors), nan=np.inf)
    best = np.where(np.isfinite(frames.min(axis=0)) & expected, frames.argmin(axis=0), -1)
    picked = rows[np.maximum(best, 0), np.arange(len(seen.at))]
    return np.where((best >= 0)[..., None, None], picked, nearest), best


def _by_tests(one: _Camera, absent: float) -> Cause:
    """Return the cause whose test leaves the smallest error."""
    own = one.left(one.followed)
    nearest = one.left(one.nearest)
    if np.isnan(own) and nearest <= FITS:
        return Cause(IDENTITY, _not_followed(one))
    tested = one.followed if np.isfinite(own) else one.nearest
    before = own if np.isfinite(own) else nearest
    if np.isnan(before) and absent <= SOME:
        return Cause(UNKNOWN, "too few frames show the person to compare it", is_shown=False)
    if np.isnan(before):
        return Cause(DETECTION, _absent(absent))
    shift_s, clock = _best_shift(one, tested)
    angle_deg, turned = _best_turn(one, tested)
    explained = np.nanmin([clock, turned, np.inf]) <= FITS / 3
    videos, exchanged = _best_exchange(one, explained)
    left = {CLOCK: clock, CALIBRATION: turned, EXCHANGED: exchanged}
    left |= {IDENTITY: nearest} if _is_other(one) else {}
    name = min(left, key=lambda key: np.nan_to_num(left[key], nan=np.inf))
    if not left[name] <= min(NEARER * before, SAME):
        return _unexplained(one, before, absent)
    if name == CALIBRATION and turned > TURNED and (moved := moved_cameras.find(one.seen, one.at)):
        return _elsewhere(moved)
    words = {
        IDENTITY: "it follows somebody else: with another person found there",
        CLOCK: f"its clock is off: moved by {shift_s:+.3f} s",
        CALIBRATION: f"its calibration is off: turned by {angle_deg:.1f} degrees",
        EXCHANGED: f"{videos} (correct the session's file): with the people found there",
    }[name]
    fell = f"the error falls from {before:.2f} to {left[name]:.2f} of a person's height"
    return Cause(name, f"{words} {fell}")


def _is_other(one: _Camera) -> bool:
    """Return whether the nearest tracklet mostly belongs to another person than the tracked one."""
    apart_px = np.linalg.norm(one.nearest.mean(axis=2) - one.followed.mean(axis=2), axis=-1)
    apart = apart_px / one.seen.height_px[one.at][:, one.seen.at]
    known = np.isfinite(apart)
    return bool(known.any() and (apart[known] > FITS).mean() > LEAST)


def _unexplained(one: _Camera, before: float, absent: float) -> Cause:
    """Return the cause if no test succeeds: nobody matches, or keypoints are poor or missing."""
    if one.seen.hardly_placed(one.at):
        return Cause(UNKNOWN, UNCHECKED, is_shown=False)
    if before > FITS:
        words = "nobody found in it is the person that the other cameras see"
        return Cause(DETECTION, words, is_shown=False)
    if absent > SOME:
        return Cause(DETECTION, _absent(absent), is_shown=False)
    errors = np.linalg.norm(one.seen.errors(one.at, one.nearest), axis=-1)
    poor = float((errors > views.AGREED)[np.isfinite(errors)].mean())
    if poor <= SOME:
        return _incomplete(one)
    words = f"its keypoints are poor: {poor:.0%} of them are not where the other cameras see them"
    return Cause(DETECTION, words, is_shown=False)


def _incomplete(one: _Camera) -> Cause:
    """Return the cause if all keypoints that can be compared are right."""
    share = measures.of_camera(one.seen, one.at)
    if share["followed"] < share["found"] - SOME:
        words = "people are found there, but followed in {:.0%} of the frames only"
        return Cause(IDENTITY, words.format(share["followed"]), is_shown=False)
    if share["found"] < 1 - SOME:
        words = "the network found {:.0%} of the persons who should be in its picture"
        return Cause(DETECTION, words.format(share["found"]), is_shown=False)
    return Cause(UNKNOWN, "no test shows why it disagrees with the others", is_shown=False)


def _absent(share: float) -> str:
    return f"the network found nobody in {share:.0%} of the frames that should show somebody"


def _not_followed(one: _Camera) -> str:
    follows = views.shown(one.followed)[one.expected].mean()
    return (
        f"the person is found there, but followed in {follows:.0%} of the frames only: "
        "the tracks were not joined"
    )


def _best_shift(one: _Camera, tested: NDArray) -> tuple[float, float]:
    """Return the clock shift (s) with the smallest remaining error, and this error."""
    seen = one.seen
    if len(seen.points.time_s) < 2:
        return 0.0, float("nan")
    followed = np.isfinite(one.left(one.followed))
    found = []
    for frames in _shifts(seen):
        moved = _moved(seen, one.at, frames) if followed else _moved_rows(one, frames)
        error = one.left(np.where(one.expected[..., None, None], moved, np.nan))
        found.append((np.nan_to_num(error, nan=np.inf), abs(frames), frames))
    error, _, frames = min(found)
    return float(frames / seen.points.rate_hz), float(error)


def _shifts(seen: Seen) -> NDArray:
    """Return the shifts of a clock that are tried, frames."""
    step = max(1, round(FINEST_S * seen.points.rate_hz))
    most = int(MOST_S * seen.points.rate_hz) // step
    return step * np.arange(-most, most + 1)


def _moved(seen: Seen, camera: int, frames: int) -> NDArray:
    """Return the keypoints (P, S, K, 2) px of a camera so many frames later."""
    at, inside = _later(seen, frames)
    moved = np.full(seen.xy[camera][:, seen.at].shape, np.nan)
    moved[:, inside] = seen.xy[camera][:, at]
    return moved


def _moved_rows(one: _Camera, frames: int) -> NDArray:
    """Return the same of the tracklets that are nearest to the persons, whoever they are."""
    at, inside = _later(one.seen, frames)
    moved = np.full(one.followed.shape, np.nan)
    rows, row = one.seen.rows[one.at][:, at], one.row[:, inside]
    picked = rows[np.maximum(row, 0), np.arange(len(at))]
    moved[:, inside] = np.where((row >= 0)[..., None, None], picked, np.nan)
    return moved


def _later(seen: Seen, frames: int) -> tuple[NDArray, NDArray]:
    """Return the frames so many later, and which (S,) of those looked at have one."""
    at = seen.at + frames
    inside = (at >= 0) & (at < seen.xy.shape[2])
    return at[inside], inside


def _best_exchange(one: _Camera, explained: bool) -> tuple[str, float]:
    """Return which videos, if exchanged, leave the smallest error here, and this error.

    If no other video fits this camera, and nothing else explains its error, those of two cameras
    may be exchanged that agree with each other all the same, but place everybody wrongly.
    """
    seen, found = one.seen, [(np.inf, "")]
    names = [camera.name for camera in seen.cameras]
    for video in (at for at in range(len(names)) if at != one.at):
        error = one.left(_nearest(seen, one.at, one.expected, video)[0])
        found.append((np.nan_to_num(error, nan=np.inf), f"its video is given for {names[video]}"))
    if min(found)[0] > FITS and not explained:
        for a, b in combinations([at for at in range(len(names)) if at not in seen.out], 2):
            right = views.with_exchanged(seen, a, b)
            here = _of_camera(right, one.at, right.expected(one.at))
            error = np.nan_to_num(here.left(here.nearest), nan=np.inf)
            if error <= FITS:  # another clock or a mirrored movement leaves 0.09 and more
                found.append((error, f"the videos of {names[a]} and {names[b]} are exchanged"))
    error, videos = min(found)
    return videos, float(error)


def _best_turn(one: _Camera, tested: NDArray) -> tuple[float, float]:
    """Return the camera rotation (degrees) with the smallest remaining error, and this error."""
    camera, seen = one.seen.cameras[one.at], one.seen
    known = np.isfinite(seen.errors(one.at, tested)).all(axis=-1)
    if known.sum() < 10:
        return float("nan"), float("nan")
    chosen = np.flatnonzero(known)[:: max(1, int(known.sum()) // MOST_POINTS)]
    xyz, xy = seen.others[one.at].reshape(-1, 3)[chosen], tested.reshape(-1, 2)[chosen]
    height_px = np.broadcast_to(seen.height_px[one.at][:, seen.at, None], known.shape).ravel()[
        chosen
    ]

    def residual(vector: NDArray) -> NDArray:
        there = camera_models.project(camera_models.turned(camera, vector), xyz)
        return np.nan_to_num((xy - there) / height_px[:, None], nan=1.0).ravel()

    most = np.deg2rad(MOST_DEG)
    options = {"loss": "soft_l1", "f_scale": SPREAD, "bounds": (-most, most), "x_scale": 0.01}
    vector = scipy.optimize.least_squares(residual, np.zeros(3), **options).x
    angle_deg = float(np.rad2deg(np.linalg.norm(vector)))
    return angle_deg, one.left(tested, camera_models.turned(camera, vector))
