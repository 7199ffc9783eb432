"""Signals of a body's motion that every device measures, whatever its axes, place and scale.

These are distances of joints, which no rotation changes; and, where a T-pose gives common axes,
places of the limbs relative to the trunk: they separate what a camera sees well, height and width,
from depth.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.body_frame import frame
from courtside.events import tpose
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.events import TPose
from courtside.records.keypoints.skeleton import TRUNK
from courtside.synchronisation import smooth_tracks

SMOOTH_S = 0.03  # ASSUME: least standard deviation of the Gaussian
SMOOTH_STEPS = 0.85  # of the longest frame interval: less would bias offsets to half frames
SLOW_S = 0.2  # ASSUME: slower changes are removed: errors of depth depend on where a body stands
LIMBS = tuple(
    f"{side}_{p}" for p in ("elbow", "wrist", "knee", "ankle") for side in ("left", "right")
)
CLIP = 6.0  # ASSUME: signals are limited to this many standard deviations
PAIRS = (
    ("left_wrist", "right_wrist"),
    ("left_wrist", "left_shoulder"),
    ("right_wrist", "right_shoulder"),
    ("left_wrist", "left_hip"),
    ("right_wrist", "right_hip"),
    ("left_wrist", "right_hip"),
    ("right_wrist", "left_hip"),
    ("left_elbow", "right_elbow"),
    ("left_ankle", "right_ankle"),
    ("left_knee", "right_knee"),
    ("left_ankle", "left_hip"),
    ("right_ankle", "right_hip"),
    ("left_ankle", "right_hip"),
    ("right_ankle", "left_hip"),
    ("left_knee", "right_hip"),
    ("right_knee", "left_hip"),
)


class Signals:
    """Loss of two devices from the products of their signals, for `clock_adjustment.adjust`.

    The rows of `axes` (2, 3, 3) are the same three directions in the frame of each device. Without
    them only distances are compared.
    """

    def __init__(
        self, first: DeviceMotion, second: DeviceMotion, axes: NDArray | None = None
    ) -> None:
        step_s = max(float(np.median(np.diff(each.time_s))) for each in (first, second))
        sigma_s = max(SMOOTH_S, SMOOTH_STEPS * step_s)
        names = set(first.joints.tolist()) & set(second.joints.tolist())
        pairs = [pair for pair in PAIRS if names.issuperset(pair)]
        values = [_distances(each, pairs) for each in (first, second)]
        if axes is not None:
            limbs = [name for name in LIMBS if name in names]
            values = [
                _places(each, limbs, rows) for each, rows in zip((first, second), axes, strict=True)
            ]
        self.tracks = [
            _track(each, value, sigma_s)
            for each, value in zip((first, second), values, strict=True)
        ]
        self.weight = np.ones(values[0].shape[1])

    def sampled(self, own: NDArray) -> list[list[NDArray]]:
        """Return value, slope, bend (T, K) of both devices at their clocks' times `own` (2, T)."""
        both = [
            [part[0, :, :, 0] for part in smooth_tracks.sample(track, time_s)]
            for track, time_s in zip(self.tracks, own, strict=True)
        ]
        known = np.isfinite(both[0][0]) & np.isfinite(both[1][0])
        return [[np.where(known, part, 0.0) for part in one] for one in both]

    def correlation(self, own: NDArray) -> NDArray:
        """Return the correlation (K,) of each signal where the clocks show `own` (2, T), else 0."""
        first, second = (one[0] for one in self.sampled(own))
        size = np.sqrt((first**2).sum(axis=0) * (second**2).sum(axis=0))
        return (first * second).sum(axis=0) / np.where(size > 0, size, np.inf)

    def weigh(self, own: NDArray) -> None:
        """Weight each signal by its ratio of common motion to noise, at roughly right clocks."""
        common = np.clip(self.correlation(own), 0.0, 0.99)
        self.weight = common / (1 - common**2)

    def terms(self, own: NDArray) -> dict[tuple[int, int], tuple[NDArray, ...]]:
        """Return slope, curvature, steepness (T,) of minus the products, by the second's offset."""
        terms = smooth_tracks.product_terms(*self.sampled(own))
        return {(0, 1): tuple(part @ self.weight for part in terms)}


def common_axes(motions: Sequence[DeviceMotion], spells: Sequence[TPose]) -> NDArray:
    """Return three directions (2, 3, 3) in two devices' frames along which noise is uncorrelated.

    Rows are directions in each device's frame: the principal axes of the noise of both at rest, in
    the two `spells` of the same T-pose, whose body axes join the devices' frames. They separate a
    camera's depth from width and height wherever it stood.
    """
    rows, noise = [], np.zeros((3, 3))
    for motion, spell in zip(motions, spells, strict=True):
        at = {name: motion.joint(name)[spell.frames] for name in tpose.JOINTS}
        still = {name: np.nanmedian(path, axis=0) for name, path in at.items()}
        hips, shoulders = (still[f"left_{p}"] + still[f"right_{p}"] for p in ("hip", "shoulder"))
        axes, unit_m = frame.axes(
            hips / 2, shoulders / 2, still["left_wrist"], still["right_wrist"]
        )
        for name, path in at.items():
            off = (path[np.isfinite(path).all(axis=1)] - still[name]) @ axes.T / unit_m
            noise += off.T @ off / max(1, len(off))
        rows.append(axes)
    _, own = np.linalg.eigh(noise)
    return np.array([own.T @ axes for axes in rows])


def _distances(motion: DeviceMotion, pairs: Sequence[tuple[str, str]]) -> NDArray:
    distances = [
        np.linalg.norm(motion.joint(one) - motion.joint(other), axis=1) for one, other in pairs
    ]
    return np.stack(distances, axis=1)


def _places(motion: DeviceMotion, limbs: Sequence[str], rows: NDArray) -> NDArray:
    """Return the places of limbs relative to the trunk along three directions, (T, 3 L)."""
    trunk = np.mean([motion.joint(name) for name in TRUNK], axis=0)
    places = [(motion.joint(name) - trunk) @ rows.T for name in limbs]
    return np.concatenate(places, axis=1)


def _track(motion: DeviceMotion, values: NDArray, sigma_s: float) -> smooth_tracks.Track:
    """Return signals (T, K) of a device as a Track (1, T, K, 1), of standard deviation 1."""
    values = np.where(motion.performed[:, None], values, np.nan)[None, :, :, None]
    fast = smooth_tracks.build(motion.time_s, values, sigma_s)
    slow = smooth_tracks.build(motion.time_s, values, SLOW_S)
    values = fast.values - slow.values
    usual = np.nanstd(values, axis=1, keepdims=True)
    usual = np.where(np.isfinite(usual) & (usual > 0), usual, 1.0)
    squeezed = CLIP * np.tanh(values / (CLIP * usual))
    return smooth_tracks.Track(fast.start_s, fast.step_s, squeezed)
