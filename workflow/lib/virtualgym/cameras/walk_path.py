"""The walked camera: carried past the fixed cameras, aimed at the court's centre."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from courtside.calibration.court.court import Court
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, look_at
from virtualgym.cameras import layouts, lens_errors, row_warp
from virtualgym.presets import Preset

# ASSUME: path, speed and shake of a person who films carefully with a phone; no source is recorded.
BESIDE_M = 0.8  # distance of the path from each fixed camera
SAMPLE_M = 0.05
ROUNDING_M = 1.0  # people cut corners
# Where the straight path comes nearer to the court's centre than this factor times its nearer end,
# the path goes round instead.
ARC_BELOW = 0.85
HEIGHT_M, AIM_M = 1.62, 1.25
USUAL_KMH = 2.0  # the amplitudes below hold at this speed
STEP_HZ = 0.9  # of strides (left and right step); the body bobs at twice that
STABILISED = 1 / 5  # what a stabiliser leaves of the rotations by walking
DIFFERENCE_S = 1e-4  # half the interval of the numerical derivative
# Slow changes (amplitude, period s) of place along x, y, z and of aim along x, y, z, metres.
SWAY = (((0.35, 23.0), (0.15, 9.0)), ((0.35, 19.0), (0.15, 11.0)), ((0.05, 13.0),))
WANDER = (((0.5, 11.0),), ((0.5, 8.0),), ((0.25, 7.0),))
# Amplitudes at a stride's and at a step's frequency: place m; turn about the camera's x, y, z deg.
BOB = (((0.012, 1.0),), ((0.012, 1.0),), ((0.015, 2.0),))
SHAKE_DEG = (((0.3, 1.0), (0.7, 2.0)), ((0.7, 1.0), (0.3, 2.0)), ((0.6, 1.0), (0.3, 2.0)))
TREMOR_DEG, TREMOR_HZ = 0.02, (4.1, 5.7, 7.3)
SHIFT = ((1.26, 17.0), (0.63, 6.5))  # of variance 1
# ASSUME: standard deviation of the focal length while a phone refocuses between 10 and 25 m, as a
# share; no source is recorded.
BREATH = 0.001
ROWS = ((1.26, 5.3), (0.63, 1.7))  # of variance 1: changes of a stabiliser's error


@dataclass(frozen=True, eq=False)
class Waves:
    """A sum of sines in several dimensions.

    Attributes
    ----------
    amplitude, hertz, phase : (D, N) float
        Of the N sines of each of D dimensions; phases in radians.
    """

    amplitude: np.ndarray
    hertz: np.ndarray
    phase: np.ndarray

    def at(self, time_s: float) -> NDArray:
        """Return the value (D,) at a time."""
        return (self.amplitude * np.sin(2 * np.pi * self.hertz * time_s + self.phase)).sum(axis=1)

    def scaled(self, factor: float) -> "Waves":
        """Return the same waves with `factor` times the amplitude."""
        return replace(self, amplitude=self.amplitude * factor)


def _still(dimensions: int) -> Waves:
    nothing = np.zeros((dimensions, 1))
    return Waves(nothing, nothing, nothing)


@dataclass(frozen=True, eq=False)
class Walk:
    """One walk with the mobile camera, a smooth function of time.

    Attributes
    ----------
    duration_s : float
    size : (int, int)
        Width and height of the pictures, px.
    K, dist : (3, 3) float, (5,) float
        The lens, without the stabiliser's shift of the principal point.
    route : scipy.interpolate.CubicSpline
        Time -> (x, y) m of the mean path.
    aim_at : (3,) float
        Point at which the camera is aimed, m.
    sway, shake : tuple of Waves
        Of place (3) m; of the camera's own rotation (3) rad. Each is summed.
    wander, shift : Waves
        Of the aim (3) m; of the principal point (2) px.
    breath, rows : Waves
        Of the focal length (1), as a share; of the stabiliser's rows (4) px, in the order of
        `row_warp.shifts`.
    """

    duration_s: float
    size: tuple[int, int]
    K: np.ndarray
    dist: np.ndarray
    route: CubicSpline
    aim_at: np.ndarray
    sway: tuple[Waves, ...]
    wander: Waves
    shake: tuple[Waves, ...]
    shift: Waves
    breath: Waves = field(default_factory=lambda: _still(1))
    rows: Waves = field(default_factory=lambda: _still(4))

    def pose(self, time_s: float) -> NDArray:
        """Return cam_from_world (3, 4) at a time, metres."""
        place = np.append(self.route(time_s), HEIGHT_M)
        place = place + sum(waves.at(time_s) for waves in self.sway)
        upright = look_at(place, self.aim_at + self.wander.at(time_s))[:, :3]
        turn = sum(waves.at(time_s) for waves in self.shake)
        rotation = rotations.rotation_from_rodrigues(turn) @ upright
        return np.column_stack([rotation, -rotation @ place])

    def twist(self, time_s: float) -> tuple[NDArray, NDArray]:
        """Return the velocity of the camera at a time.

        Returns
        -------
        angular_rad_s : (3,) float
            About the camera's own axes: after a short dt, world_from_cam is multiplied from the
            right by the rotation of vector angular_rad_s * dt.
        velocity_m_s : (3,) float
            Of the camera's centre, in the world.
        """
        before, after = (self.pose(time_s + step) for step in (-DIFFERENCE_S, DIFFERENCE_S))
        before_from_after = before[:, :3] @ after[:, :3].T
        angular = rotations.rodrigues_from_rotation(before_from_after) / (2 * DIFFERENCE_S)
        moved = rotations.invert(after)[:, 3] - rotations.invert(before)[:, 3]
        return angular, moved / (2 * DIFFERENCE_S)

    def principal_point_px(self, time_s: float) -> NDArray:
        """Return the principal point (2,) px at a time."""
        return self.K[:2, 2] + self.shift.at(time_s)

    def focal_scale(self, time_s: float) -> float:
        """Return the focal length at a time over that of `K`."""
        return float(1 + self.breath.at(time_s)[0])

    def row_warp_px(self, time_s: float) -> NDArray | None:
        """Return how the stabiliser bends the rows at a time, (2, 2) px; None: not at all."""
        return self.rows.at(time_s).reshape(2, 2) if self.rows.amplitude.any() else None

    def camera(self, time_s: float) -> Camera:
        """Return the camera, named "walk", at a time, before the stabiliser bends its rows."""
        matrix = self.K.copy()
        matrix[[0, 1], [0, 1]] *= self.focal_scale(time_s)
        matrix[:2, 2] = self.principal_point_px(time_s)
        return Camera("walk", self.size, matrix, self.dist, self.pose(time_s))

    def grid(self, n_frames: int) -> NDArray:
        """Return `n_frames` times, s, evenly from start to end."""
        return np.linspace(0.0, self.duration_s, n_frames)


def plan(
    fixed: Sequence[Camera],
    court: Court,
    size_px: tuple[int, int],
    preset: Preset,
    rng: np.random.Generator,
    *,
    speed_kmh: float = USUAL_KMH,
    stabiliser: bool = True,
) -> Walk:
    """Plan a walk past fixed cameras.

    Parameters
    ----------
    fixed : sequence of Camera
        In the order of the walk, at least two.
    court : Court
    size_px : (int, int)
        Width and height of the walked camera's pictures.
    preset : Preset
    rng : numpy.random.Generator
    speed_kmh : float
        Shake is proportional to it.
    stabiliser : bool
        Whether the camera damps its rotations to a fifth and, in turn, moves its principal point.

    Returns
    -------
    walk : Walk
        From 0.8 m beside the first camera to 0.8 m beside the last.

    Raises
    ------
    ValueError
        If there are fewer than two cameras or the speed is not positive.
    """
    if len(fixed) < 2 or not speed_kmh > 0:
        raise ValueError(
            f"expected two cameras and a speed, found {len(fixed)} and {speed_kmh} km/h"
        )
    centre = layouts.court_centre(court)
    points = way([camera.centre_in_world[:2] for camera in fixed], centre[:2])
    speed_m_s, vigour = speed_kmh / 3.6, speed_kmh / USUAL_KMH
    time_s = _lengths(points) / speed_m_s
    matrix, dist = layouts.lens(size_px, preset, rng)
    slow = _waves(SWAY, rng, period=True), _waves(WANDER, rng, period=True)
    bob, shake = _waves(BOB, rng).scaled(vigour), _waves(SHAKE_DEG, rng)
    tremor = _waves([[(TREMOR_DEG, hertz / STEP_HZ)] for hertz in TREMOR_HZ], rng)
    damping = preset.jitter_scale * np.radians(1.0) * (STABILISED if stabiliser else 1.0)
    shift_px = preset.stabiliser_px * size_px[0] / 1280 if stabiliser else 0.0
    shift = _waves((SHIFT, SHIFT), rng, period=True)
    return Walk(
        duration_s=float(time_s[-1]),
        size=(size_px[0], size_px[1]),
        K=matrix,
        dist=dist,
        route=CubicSpline(time_s, points),
        aim_at=centre + np.array([0, 0, AIM_M]),
        sway=(slow[0], bob),
        wander=slow[1],
        shake=(shake.scaled(vigour * damping), tremor.scaled(damping)),
        shift=shift.scaled(shift_px),
    )


def worsened(
    walked: Walk,
    rng: np.random.Generator,
    *,
    lens: float = 0.0,
    breathing: float = 0.0,
    stabiliser: float = 0.0,
) -> Walk:
    """Return a walk whose camera is wrong by these strengths; see `worlds.World`."""
    breath, rows = _waves((SHIFT,), rng, period=True), _waves((ROWS,) * 4, rng, period=True)
    return replace(
        walked,
        dist=lens_errors.added(walked.dist, lens, rng),
        breath=breath.scaled(breathing * BREATH),
        rows=rows.scaled(stabiliser * row_warp.WARP_PX * walked.size[0] / 1280),
    )


def way(places: Sequence[NDArray], centre: NDArray) -> NDArray:
    """Return the mean path past the cameras' places on the floor.

    Parameters
    ----------
    places : sequence of (2,) float
        Metres, in the order of the walk.
    centre : (2,) float
        Of the court, m.

    Returns
    -------
    points : (N, 2) float
        About every 5 cm, smooth; from 0.8 m beside the first place to 0.8 m beside the last, 0.8 m
        inside of those between; round the court where the straight path would come too near to it.
    """
    nodes = [np.subtract(place, centre) for place in places]
    for at in range(1, len(nodes) - 1):
        nodes[at] = nodes[at] * (1 - BESIDE_M / np.linalg.norm(nodes[at]))
    corners = [nodes[0]]
    for start, end in pairwise(nodes):
        corners += [*_round(start, end), end]
    rough = _resample(np.array(corners))
    padded = _resample(_prolonged(rough))
    smooth = gaussian_filter1d(padded, ROUNDING_M / SAMPLE_M, axis=0, mode="nearest")
    lengths = _lengths(smooth)
    first = np.linalg.norm(smooth - rough[0], axis=1).argmin()
    last = np.linalg.norm(smooth - rough[-1], axis=1).argmin()
    ends_m = lengths[first] + BESIDE_M, lengths[last] - BESIDE_M
    return centre + _resample(smooth, *ends_m)


def _round(start: NDArray, end: NDArray) -> list[NDArray]:
    """Return points of the path round the court, every two degrees; none if it may be straight."""
    nearest = min(np.linalg.norm(start), np.linalg.norm(end))
    if np.linalg.norm((start + end) / 2) > ARC_BELOW * nearest:
        return []
    from_deg, to_deg = (np.degrees(np.arctan2(point[1], point[0])) for point in (start, end))
    turn_deg = (to_deg - from_deg + 180) % 360 - 180
    # From a place farther out, the path first goes in to the circle.
    enter = 0.2 if np.linalg.norm(start) > 1.1 * nearest else 0.0
    angles = np.radians(from_deg + turn_deg * np.linspace(enter, 1, max(3, int(abs(turn_deg) / 2))))
    return list(nearest * np.column_stack([np.cos(angles), np.sin(angles)])[1:-1])


def _prolonged(points: NDArray) -> NDArray:
    """Return points with a straight extension at both ends, so that smoothing keeps the ends."""
    reach = 5 * ROUNDING_M / SAMPLE_M
    head, tail = points[0] - points[1], points[-1] - points[-2]
    return np.vstack([points[0] + reach * head, points, points[-1] + reach * tail])


def _lengths(points: NDArray) -> NDArray:
    return np.append(0.0, np.linalg.norm(np.diff(points, axis=0), axis=1).cumsum())


def _resample(points: NDArray, start_m: float = 0.0, stop_m: float | None = None) -> NDArray:
    lengths = _lengths(points)
    stop_m = lengths[-1] if stop_m is None else stop_m
    wanted = np.linspace(start_m, stop_m, max(2, round((stop_m - start_m) / SAMPLE_M) + 1))
    return np.column_stack([np.interp(wanted, lengths, column) for column in points.T])


def _waves(
    table: Sequence[Sequence[tuple[float, float]]],
    rng: np.random.Generator,
    *,
    period: bool = False,
) -> Waves:
    """Return waves of (amplitude, multiple of STEP_HZ, or period in s), with random phases."""
    amplitude = np.zeros((len(table), max(map(len, table))))
    hertz, phase = np.zeros_like(amplitude), rng.uniform(0, 2 * np.pi, amplitude.shape)
    for row, sines in enumerate(table):
        for column, (size, rate) in enumerate(sines):
            amplitude[row, column] = size
            hertz[row, column] = 1 / rate if period else rate * STEP_HZ
    return Waves(amplitude, hertz, phase)
