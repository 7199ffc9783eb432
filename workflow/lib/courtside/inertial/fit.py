"""Fit the correction of an inertial suit to what cameras or a depth camera see meanwhile."""

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.geometry.interpolation import linear
from courtside.inertial import heading as heading_drift
from courtside.inertial import splines
from courtside.inertial.segments import Frames, Model, segments_of
from courtside.inertial.vision import Seen, estimate_noise, stated_noise
from courtside.records.devices.hierarchy import PosedHierarchy, forward
from courtside.records.keypoints import skeleton

CHUNK = 500  # frames whose derivatives are held at once: bounds the memory
SAMPLES = 6  # ASSUME: draws, to tell how much of a correction the data determine
SEED = 5  # any; fixed so that a fit is repeatable
PRIOR_COEFFICIENTS = 5.0  # ASSUME: that the stated size of a correction counts for
SIZE_RANGE = (0.02, 4.0)  # ASSUME: of the stated size, that the estimated one may take
PAD_S = 1.0  # ASSUME: of the splines beyond the recording: the clock may shift
FIRST_ROUNDS = 2  # ASSUME: with the stated sizes
# Prior standard deviations of the corrections, and settings of the fit, chosen on virtual suits of
# mild and usual errors, seeds 1 to 3; others serve as tests.
KNOT_S = 0.5  # distance of the splines' knots
# Slow turn of a segment. Pelvis, forearm and shank carry sensors.
TURN_DEG = {
    "pelvis": 4.0,
    "thorax": 6.0,
    "clavicle": 5.0,
    "upper_arm": 10.0,
    "forearm": 6.0,
    "thigh": 8.0,
    "shank": 5.0,
}
TURN_MEMORY_S = 2.0  # memory of these turns
HEADING_DEG = 5.0  # slow turn about the vertical that a first estimate of the heading leaves
HEADING_MEMORY_S = 5.0
SHIFT_M = 0.2  # slow error of the root's path that a first estimate leaves
SHIFT_MEMORY_S = 3.0
# Constant turn of a segment in its own axes. That of the upper arm is the swivel of the elbow,
# which no sensor sees.
MOUNT_DEG = {
    "pelvis": 4.0,
    "thorax": 6.0,
    "clavicle": 6.0,
    "upper_arm": 12.0,
    "forearm": 8.0,
    "thigh": 8.0,
    "shank": 6.0,
}
BODY = 0.04  # logarithm of the factor on all bones
STRETCH = 0.06  # the same on one kind of bone
UNEVEN = 0.02  # the same between left and right
# Constant offset of vision's joint from the skeleton's, in the axes of the joint's parent. One in
# vision's axes would pay for bones that shrink: a player faces a depth camera.
OFFSET_M = 0.01
TILT_DEG = 5.0  # what a first estimate leaves of the turn between both frames
PLACE_M = 0.5  # what a first estimate leaves of the shift between both frames
# Least correlation time of vision's errors: a network errs alike while a pose lasts.
CORRELATION_S = 0.25
WINDOW_S = 1.5  # of the first estimate of the heading
MOST_ROUNDS = 15
TOLERANCE_M = 5e-4  # root mean square change of joints at which the rounds end


class Fit:
    """State of the fit of one take.

    Made of the performed frames only, on the reference clock; `up` (3,); and the standard deviation
    of the clocks' offset.
    """

    def __init__(self, posed: PosedHierarchy, seen: Seen, up: NDArray, lag_s: float) -> None:
        self.posed, self.seen, self.up = posed, seen, up
        self.segments = segments_of(posed.hierarchy, seen.source)
        observed = [list(posed.hierarchy.joints).index(joint) for joint in seen.joints]
        self.model = Model(posed.hierarchy, self.segments, observed, up)
        self._align()
        start, stop = posed.time_s[0] - PAD_S, posed.time_s[-1] + PAD_S
        self.basis = splines.basis_over(start, stop, KNOT_S)
        self.coefficients = np.zeros((self.basis.n, self.model.n_slow))
        self._slow_prior()
        self._fixed_prior(lag_s)
        self.fixed = np.zeros(self.model.n_fixed)
        self.rate_hz = 1 / np.median(np.diff(seen.time_s))
        self.rms_change_m: list[float] = []

    def _align(self) -> None:
        """Move vision's joints into the device's world; turn the device by its drifting heading."""
        xyz, world = forward(self.posed)
        time_s, seen_s = self.posed.time_s, self.seen.time_s
        device = linear(time_s, xyz[:, self.model.observed], seen_s)
        self.alignment = heading_drift.estimate(
            seen_s, device, self.seen.xyz, self.up, window_s=WINDOW_S
        )
        heading = self.alignment.heading_at(time_s)
        turn = rotations.rotation_from_rodrigues(heading[:, None] * self.up)[:, None]
        root = heading_drift.turn_path(xyz[:, 0], heading, self.up)
        placed = root[:, None] + (turn @ (xyz - xyz[:, :1])[..., None])[..., 0]
        self.translation = self.posed.translation.copy()
        self.centre = root.mean(axis=0)
        self.translation[:, 0] = root - self.centre
        self.facing = rotations.rotation_from_rodrigues(facings(turn[:, 0] @ world[:, 0], self.up))
        self.local = self.facing.swapaxes(1, 2)[:, None] @ turn @ world
        observed = placed[:, self.model.observed] - self.centre
        self.velocity = np.gradient(observed, time_s, axis=0)
        vision = self.seen.xyz @ self.alignment.vision_from_device
        self.place = np.nanmedian(vision - linear(time_s, observed, seen_s), axis=(0, 1))
        self.vision = vision - self.place

    def _slow_prior(self) -> None:
        kinds = [skeleton.without_side(name) for name in self.segments.names]
        names = [kind for kind in kinds for _ in range(3)] + ["heading"] + ["shift"] * 3
        sizes = {kind: np.radians(size) for kind, size in TURN_DEG.items()}
        sizes |= {"heading": np.radians(HEADING_DEG), "shift": SHIFT_M}
        memory = dict.fromkeys(kinds, TURN_MEMORY_S)
        memory |= {"heading": HEADING_MEMORY_S, "shift": SHIFT_MEMORY_S}
        self.kinds = {
            kind: np.flatnonzero(np.array(names) == kind) for kind in dict.fromkeys(names)
        }
        self.stated = {kind: sizes[kind] for kind in self.kinds}
        self.size = dict(self.stated)
        band = {tau: splines.precision(self.basis, tau) for tau in set(memory.values())}
        self.band = np.stack([band[memory[name]] for name in names], axis=2)  # (K, 4, P)

    def _fixed_prior(self, lag_s: float) -> None:
        layout, deviation = self.model.fixed, np.zeros(self.model.n_fixed)
        kinds = [skeleton.without_side(name) for name in self.segments.names]
        mounts = [MOUNT_DEG[kind] for kind in kinds]
        deviation[layout["mount"]] = np.radians(np.repeat(mounts, 3))
        deviation[layout["stretch"]] = [
            BODY if name == "body" else UNEVEN if "diff" in name else STRETCH
            for name in self.segments.stretches
        ]
        deviation[layout["offset"]] = OFFSET_M
        deviation[layout["tilt"]] = np.radians(TILT_DEG)
        deviation[layout["place"]] = PLACE_M
        deviation[layout["lag"]] = max(lag_s, 1e-6)
        self.fixed_precision = deviation**-2

    def run(self) -> None:
        """Fit: in each round the noise, a Gauss-Newton step, and the sizes of the corrections."""
        rng = np.random.default_rng(SEED)
        self.first = before = self.predicted()
        for number in range(1, MOST_ROUNDS + 1):
            self.round = number
            residual = (self.vision - before) / self.seen.sigma_m[..., None]
            estimate = stated_noise if number <= FIRST_ROUNDS else estimate_noise
            self.noise = estimate(residual, self.rate_hz, CORRELATION_S)
            solution = self._step(before)
            if number > FIRST_ROUNDS:
                self._resize(solution, rng)
            after = self.predicted()
            self.rms_change_m.append(float(np.sqrt(np.mean((after - before) ** 2))))
            before = after
            if number > 2 * FIRST_ROUNDS and self.rms_change_m[-1] < TOLERANCE_M:
                break
        self.last, self.border_covariance = before, solution.border_covariance

    def frames(self, part: slice = slice(None)) -> Frames:
        """Return the uncorrected skeleton at vision's times, by the current clock offset."""
        wanted = self.seen.time_s[part] + self.fixed[self.model.fixed["lag"]]
        time_s = self.posed.time_s
        return Frames(
            rotations.interpolate(time_s, self.facing, wanted),
            rotations.interpolate(time_s, self.local, wanted),
            linear(time_s, self.translation, wanted),
            linear(time_s, self.velocity, wanted),
        )

    def slow_at(self, time_s: NDArray) -> NDArray:
        """Return the slow parameters (T, P) at times of the reference clock."""
        return self.basis.evaluate(self.coefficients, time_s)

    def predicted(self) -> NDArray:
        """Return the predicted joints of vision, (N, D, 3) m, in the device's centred world."""
        slow = self.slow_at(self.seen.time_s)
        return np.concatenate(
            [self.model.places(self.frames(part), slow[part], self.fixed) for part in self._parts()]
        )

    def _parts(self) -> list[slice]:
        n = len(self.seen.time_s)
        return [slice(start, min(start + CHUNK, n)) for start in range(0, n, CHUNK)]

    def _step(self, predicted: NDArray) -> splines.Solution:
        first, values = self.basis.at(self.seen.time_s)
        slow = self.slow_at(self.seen.time_s)
        white = self.noise.whitening() / self.seen.sigma_m[..., None, None]
        residual = np.nan_to_num(self.vision - predicted)
        white = np.nan_to_num(white)
        n, size, n_fixed = self.basis.n, self.model.n_slow, self.model.n_fixed
        blocks, border = np.zeros((n, splines.REACH, size, size)), np.zeros((n, size, n_fixed + 1))
        fixed = np.zeros((n_fixed, n_fixed + 1))
        for part in self._parts():
            _, by_slow, by_fixed = self.model.linear(self.frames(part), slow[part], self.fixed)
            rows = len(by_slow)
            by_slow = (white[part] @ by_slow).reshape(rows, -1, size)
            by_fixed = (white[part] @ by_fixed).reshape(rows, -1, n_fixed)
            left = (white[part] @ residual[part][..., None]).reshape(rows, -1, 1)
            across = np.concatenate([by_fixed, left], axis=2)
            per_frame = by_slow.swapaxes(1, 2) @ by_slow
            vector = by_slow.swapaxes(1, 2) @ across
            splines.gather(blocks, border, first[part], values[part], per_frame, vector)
            flat = by_fixed.reshape(-1, n_fixed)
            fixed += flat.T @ across.reshape(len(flat), -1)
        return self._solve(blocks, border, fixed)

    def _solve(self, blocks: NDArray, border: NDArray, fixed: NDArray) -> splines.Solution:
        scale = self._inverse_squares()
        diagonal = np.arange(self.model.n_slow)
        blocks[:, :, diagonal, diagonal] += self.band * scale
        right = border[..., -1] - scale * splines.times(self.band, self.coefficients)
        matrix = fixed[:, :-1] + np.diag(self.fixed_precision)
        rest = fixed[:, -1] - self.fixed_precision * self.fixed
        solution = splines.solve(blocks, right, border[..., :-1], matrix, rest)
        self.coefficients = self.coefficients + solution.inner
        self.fixed = self.fixed + solution.border
        return solution

    def _inverse_squares(self) -> NDArray:
        scale = np.zeros(self.model.n_slow)
        for kind, columns in self.kinds.items():
            scale[columns] = self.size[kind] ** -2
        return scale

    def _resize(self, solution: splines.Solution, rng: np.random.Generator) -> None:
        """Estimate the size of each kind of slow correction.

        MacKay 1992: its energy over the number of coefficients that the data determine.
        """
        draws = solution.samples(SAMPLES, rng)
        energy = np.sum(self.coefficients * splines.times(self.band, self.coefficients), axis=0)
        free = np.mean(
            [np.sum(draw * splines.times(self.band, draw), axis=0) for draw in draws], axis=0
        )
        for kind, columns in self.kinds.items():
            stated = self.stated[kind]
            known = self.basis.n * len(columns) - free[columns].sum() / self.size[kind] ** 2
            squared = energy[columns].sum() + PRIOR_COEFFICIENTS * stated**2
            squared /= max(known, 0.0) + PRIOR_COEFFICIENTS
            self.size[kind] = float(np.clip(np.sqrt(squared), *(stated * np.array(SIZE_RANGE))))


def facings(matrices: NDArray, up: NDArray) -> NDArray:
    """Return the part about the vertical of rotations (T, 3, 3), as rotation vectors (T, 3)."""
    quaternion = scipy.spatial.transform.Rotation.from_matrix(matrices).as_quat()
    angle = 2 * np.arctan2(quaternion[:, :3] @ up, quaternion[:, 3])
    return np.unwrap(angle)[:, None] * up
