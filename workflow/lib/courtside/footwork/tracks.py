"""Position, velocity and height of heel and toe of one foot, between frames too, with variances."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import interpolation
from courtside.kinematics import filtering
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D

GRID_HZ = 120.0  # of the times between frames at which contact is looked for
SLOW_M_S = 0.5  # ASSUME: below it a point of the foot may stand
STANDING_SHARE = 0.25  # ASSUME: quantile of a slow point's heights: a heel often stands raised
# ASSUME: no higher above z = 0 is the heel or toe of a flat foot seen: in the study's takes at most
# 0.09 m, and the world may be some centimetres off. Feet that are higher, as of a handstand, are in
# the air.
HIGHEST_M = 0.2
LEAST_FRAMES = 9  # ASSUME: of a run of known frames in which contact is looked for
UNKNOWN_M = 0.03  # ASSUME: standard deviation per axis where the keypoints state none


@dataclass(frozen=True, eq=False)
class Track:
    """Heel and toe of one foot over a run of known frames."""

    frames: slice  # of the take
    time_s: NDArray  # (N,): `GRID_HZ` or more; every `step`-th is a frame
    step: int
    place: NDArray  # (N, 2, 3): heel, toe; m
    velocity: NDArray  # (N, 2, 3): m/s
    variance: NDArray  # (N, 2, 3): of the place, per axis, m2
    height: NDArray  # (N, 2): above that of the flat foot, m
    cutoff_hz: float  # of the filter that the skeletons went through

    @property
    def frame_s(self) -> float:
        """Time from one frame to the next."""
        return float(self.time_s[self.step] - self.time_s[0])

    @property
    def velocity_variance(self) -> NDArray:
        """Variance of the velocity (N, 2, 3), m2/s2; errors have a flat spectrum to the cut-off."""
        return self.variance * (2 * np.pi * self.cutoff_hz) ** 2 / 3


def tracks(
    points: Keypoints3D, person: int, side: str, cutoff_hz: Sequence[float]
) -> tuple[list[Track], NDArray]:
    """Return the tracks of a foot, one for each run of frames in which heel and toe are known.

    `points` are filtered skeletons with uniform times, `cutoff_hz` (J,) the filter's cut-offs. The
    second value (2,) m is the height of heel and toe above z = 0 while the foot is flat, NaN if the
    foot is never known. It is a quantile of their heights below `HIGHEST_M` while they are slow, so
    it includes the common error of the cameras at the floor.
    """
    chosen = skeleton.heel_and_toe(points.joints.tolist(), side)
    if not chosen or len(points.time_s) < 2:
        return [], np.full(2, np.nan)
    known = np.isfinite(points.xyz[person][:, chosen]).all(axis=(1, 2))
    runs = [run for run in filtering.runs(known) if run[1] - run[0] >= LEAST_FRAMES]
    own_hz = max(cutoff_hz[joint] for joint in chosen)
    noise = np.diagonal(points.covariance_2d[person][:, chosen], axis1=2, axis2=3)
    variance = np.nan_to_num(noise, nan=UNKNOWN_M**2)
    found = [_track(points, person, chosen, slice(*run), own_hz, variance) for run in runs]
    floor = _floor(found)
    return [replace(one, height=one.place[..., 2] - floor) for one in found], floor


def _track(
    points: Keypoints3D,
    person: int,
    chosen: list[int],
    frames: slice,
    cutoff_hz: float,
    variance: NDArray,
) -> Track:
    """Return a track by cubic splines through the frames; its heights are above z = 0."""
    own_s, step = points.time_s[frames], max(1, int(np.ceil(GRID_HZ / points.rate_hz - 1e-6)))
    time_s = np.interp(np.arange(step * (len(own_s) - 1) + 1) / step, range(len(own_s)), own_s)
    spline = scipy.interpolate.CubicSpline(own_s, points.xyz[person, frames][:, chosen])
    variance = interpolation.linear(own_s, variance[frames], time_s)
    place = spline(time_s)
    return Track(frames, time_s, step, place, spline(time_s, 1), variance, place[..., 2], cutoff_hz)


def _floor(found: Sequence[Track]) -> NDArray:
    """Return the height of heel and toe (2,) m above z = 0; NaN without tracks."""
    if not found:
        return np.full(2, np.nan)
    height = np.concatenate([one.place[..., 2] for one in found])
    speed = np.concatenate([np.linalg.norm(one.velocity, axis=2) for one in found])
    level = np.quantile(height, 0.05, axis=0)  # of feet that are never slow
    for at in range(2):
        slow = height[(speed[:, at] < SLOW_M_S) & (height[:, at] < HIGHEST_M), at]
        level[at] = np.quantile(slow, STANDING_SHARE) if len(slow) else level[at]
    return np.minimum(level, HIGHEST_M)
