"""Errors of a virtual inertial suit: their sizes, and how they drift over time.

Six sensors measure the orientation of a segment: head, hips, both forearms (at the wrist), both
shanks (at the ankle). The app estimates everything else. `inertial_suit` and `inertial_estimate`
apply the errors.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from virtualgym.movement import easing


@dataclass(frozen=True)
class Errors:
    """Sizes of errors: standard deviations, or exact values where noted.

    `heading_s`, `tilt_s`, `swivel_s`, `guess_s` and `drift_s` are correlation times (to 1/e).

    Attributes
    ----------
    stature, bone : float
        Relative, of all lengths together, and of each kind of bone (left and right alike).
    mount_deg : float
        Misalignment of each sensor on its segment, per axis.
    drift_deg_min, heading_deg, heading_s : float
        Steady drift of each sensor's heading, with half of the variance common to all; random
        wander of heading. All headings are correct at the start.
    tilt_deg, tilt_s : float
        Random wander of a sensor's vertical, per axis.
    noise_deg : float
        Of each sensor and frame, per axis, before smoothing.
    smooth_s : float
        Standard deviation of the Gaussian window over which the app smooths all.
    latency_s : float
        Delay of everything shown (exact).
    elbow, knee : float
        Fraction of the joint's bend that the app misses (exact).
    swivel_deg, swivel_s : float
        Rotation of elbow or knee about the line from end to end of the limb.
    guess_deg, guess_s : float
        Rotation of estimated segments (upper arms, thighs, feet, clavicles, thorax), per axis.
    trunk, girdle : float
        Fraction of the bend between hips and thorax, and of the clavicles' movement, that the app
        misses (exact).
    skate : float
        Fraction of the estimated legs' errors that makes feet slide instead of moving the body
        (exact).
    drift_m_s, drift_s : float
        Velocity, per axis, at which the position drifts.
    disturbed_deg, disturbed_every_s : float
        Temporary change of heading of one or several sensors near iron; mean time between.
    leak : float
        Fraction of the hips' horizontal acceleration that their sensor takes for gravity (exact).
    slip : float
        Fraction of the trunk's bend by which the hips' sensor tilts on the belt (exact).
    """

    stature: float = 0.0
    bone: float = 0.0
    mount_deg: float = 0.0
    drift_deg_min: float = 0.0
    heading_deg: float = 0.0
    heading_s: float = 20.0
    tilt_deg: float = 0.0
    tilt_s: float = 3.0
    noise_deg: float = 0.0
    smooth_s: float = 0.0
    latency_s: float = 0.0
    elbow: float = 0.0
    knee: float = 0.0
    swivel_deg: float = 0.0
    swivel_s: float = 2.0
    guess_deg: float = 0.0
    guess_s: float = 1.0
    trunk: float = 0.0
    girdle: float = 0.0
    skate: float = 0.0
    drift_m_s: float = 0.0
    drift_s: float = 5.0
    disturbed_deg: float = 0.0
    disturbed_every_s: float = 8.0
    leak: float = 0.0
    slip: float = 0.0


MILD = Errors(
    stature=0.01,
    bone=0.02,
    mount_deg=1.5,
    drift_deg_min=1.0,
    heading_deg=1.5,
    tilt_deg=0.7,
    noise_deg=0.3,
    smooth_s=0.02,
    latency_s=0.03,
    elbow=0.08,
    knee=0.06,
    swivel_deg=4.0,
    guess_deg=2.0,
    trunk=0.12,
    girdle=0.3,
    skate=0.1,
    drift_m_s=0.003,
)
USUAL = Errors(
    stature=0.02,
    bone=0.04,
    mount_deg=3.0,
    drift_deg_min=2.5,
    heading_deg=3.5,
    tilt_deg=1.5,
    noise_deg=0.5,
    smooth_s=0.03,
    latency_s=0.05,
    elbow=0.16,
    knee=0.12,
    swivel_deg=8.0,
    guess_deg=4.0,
    trunk=0.25,
    girdle=0.6,
    skate=0.2,
    drift_m_s=0.006,
)
STRONG = Errors(
    stature=0.03,
    bone=0.07,
    mount_deg=5.0,
    drift_deg_min=6.0,
    heading_deg=7.0,
    tilt_deg=3.0,
    noise_deg=0.8,
    smooth_s=0.045,
    latency_s=0.08,
    elbow=0.28,
    knee=0.2,
    swivel_deg=14.0,
    guess_deg=7.0,
    trunk=0.4,
    girdle=1.0,
    skate=0.35,
    drift_m_s=0.015,
)
# ASSUME, and FROZEN: these values were set before any correction ran on the simulated recordings.
# Do not change them to suit a correction: a method that needs other values is reported as failing
# with these. `disturbed` holds errors that a slowly varying correction does not model: headings
# that jump for seconds, and a pelvis whose tilt follows acceleration and the trunk.
STRENGTHS = {
    "none": Errors(),
    "mild": MILD,
    "usual": USUAL,
    "strong": STRONG,
    "disturbed": replace(MILD, disturbed_deg=18.0, disturbed_every_s=7.0, leak=0.4, slip=0.25),
}
BOUT_S = 1.0, 4.0  # duration near iron
JUMP_S = 0.3  # duration of entering and of leaving the disturbed field
NEAR = 0.35  # probability of each other sensor to be near the same iron
# Part of a jump that the filter keeps after leaving the field, and its time constant.
LEFT_SHARE, LEFT_S = 0.3, 3.0


def wandering(
    rng: np.random.Generator,
    n: int,
    shape: tuple[int, ...],
    dt_s: float,
    memory_s: float,
    *,
    from_zero: bool = False,
) -> NDArray:
    """Draw Ornstein-Uhlenbeck processes of standard deviation 1, (n, *shape) float.

    Parameters
    ----------
    rng : numpy.random.Generator
    n : int
        Number of times.
    shape : tuple of int
        Of independent processes.
    dt_s : float
        Between times.
    memory_s : float
        Lag at which the correlation is 1/e.
    from_zero : bool
        All start at 0, and reach their spread after several `memory_s`.
    """
    keep = np.exp(-dt_s / memory_s)
    steps = rng.standard_normal((n, *shape)) * np.sqrt(1 - keep**2)
    steps[0] = 0.0 if from_zero else steps[0] / np.sqrt(1 - keep**2)
    # Imported here, as only suits need it: the import takes as long as a second of film.
    from scipy import signal

    return signal.lfilter([1.0], [1.0, -keep], steps, axis=0)


def disturbance(rng: np.random.Generator, time_s: NDArray, sensors: int, errors: Errors) -> NDArray:
    """Draw heading errors (T, sensors), radians, near iron: jumps for seconds, then a decay."""
    heading = np.zeros((len(time_s), sensors))
    if not errors.disturbed_deg:
        return heading
    start = time_s[0] + rng.exponential(errors.disturbed_every_s)
    while start < time_s[-1]:
        stop = start + rng.uniform(*BOUT_S)
        near = rng.random(sensors) < NEAR
        near[rng.integers(sensors)] = True
        size = np.radians(errors.disturbed_deg) * rng.standard_normal(sensors) * near
        rise, fall = (easing.step((time_s - at) / JUMP_S) for at in (start, stop))
        left = LEFT_SHARE * fall * np.exp(-np.maximum(time_s - stop, 0) / LEFT_S)
        heading += (rise - fall + left)[:, None] * size
        start = stop + rng.exponential(errors.disturbed_every_s)
    return heading
