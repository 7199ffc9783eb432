"""Upper-body poses of a right-handed player, and smooth courses through them.

Vectors are in the axes of the thorax (left, up, forward) and need not be unit vectors. ASSUME: the
poses below were written by hand to look like badminton; no source is recorded.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from virtualgym.movement import two_bone_ik

Vector = tuple[float, float, float]
ARM_ROWS = ("upper_arm", "forearm", "hand", "palm")
# ASSUME: standard deviations of a performed pose about the scripted one, of unit vectors and of
# angles.
SCATTER, SCATTER_DEG = 0.05, 3.0


@dataclass(frozen=True)
class Arm:
    """Directions of an arm: upper arm, forearm, hand (None: as the forearm), out of the palm."""

    upper_arm: Vector
    forearm: Vector
    palm: Vector
    hand: Vector | None = None

    def rows(self) -> NDArray:
        """Return unit vectors (4, 3) in the order of ARM_ROWS."""
        hand = self.forearm if self.hand is None else self.hand
        ways = (self.upper_arm, self.forearm, hand, self.palm)
        return np.array([two_bone_ik.unit(way) for way in ways])


@dataclass(frozen=True)
class Pose:
    """One pose.

    Attributes
    ----------
    left, right : Arm
    racket : (3,) float
        From butt to top.
    twist, lean, roll : float
        Of the thorax: to the left from the pelvis, forward and to the right from the vertical,
        degrees.
    look : (float, float)
        Of the head: to the left from the heading, and down, degrees.
    height : float
        Of the hip joints over the ankles, in leg lengths; legs that must reach further lower it.
    swing : (float, float)
        Swing of left and right arm with the opposite leg, 0..1.
    """

    left: Arm
    right: Arm
    racket: Vector
    twist: float = 0.0
    lean: float = 0.0
    roll: float = 0.0
    look: tuple[float, float] = (0.0, 0.0)
    height: float = 0.9
    swing: tuple[float, float] = (0.6, 0.3)

    def vector(self) -> NDArray:
        """Return all values (35,): nine unit vectors, five angles in radians, height and swing."""
        angles = np.radians([self.twist, self.lean, self.roll, *self.look])
        arms = np.vstack([self.left.rows(), self.right.rows(), two_bone_ik.unit(self.racket)])
        return np.concatenate([arms.ravel(), angles, [self.height, *self.swing]])

    def but(self, **changes: Any) -> "Pose":
        """Return the pose with some attributes changed."""
        return replace(self, **changes)


@dataclass(frozen=True, eq=False)
class Course:
    """A smooth course through poses, constant before the first and after the last.

    Attributes
    ----------
    times_s : (n,) float
        Increasing, at least two.
    vectors : (n, 35) float
        `Pose.vector` at these times.
    """

    times_s: np.ndarray
    vectors: np.ndarray
    _curve: CubicHermiteSpline = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if len(self.times_s) == 1 or np.min(np.diff(self.times_s)) <= 0:
            raise ValueError(f"expected two or more increasing times, found {self.times_s}")
        slopes = _slopes(self.times_s, self.vectors)
        object.__setattr__(self, "_curve", CubicHermiteSpline(self.times_s, self.vectors, slopes))

    def at(self, time_s: float) -> "Moment":
        """Return the pose at a time."""
        clipped = np.clip(time_s, self.times_s[0], self.times_s[-1])
        values = self._curve(clipped)
        ways = values[:27].reshape(9, 3)
        ways = ways / np.linalg.norm(ways, axis=1, keepdims=True)
        twist, lean, roll = values[27:30]
        return Moment(
            ways[:4],
            ways[4:8],
            ways[8],
            twist,
            lean,
            roll,
            values[30:32],
            values[32],
            values[33:],
        )


@dataclass(frozen=True, eq=False)
class Moment:
    """A pose as numbers: arms (4, 3) in the order of ARM_ROWS, angles in radians; see `Pose`."""

    left: np.ndarray
    right: np.ndarray
    racket: np.ndarray
    twist: float
    lean: float
    roll: float
    look: np.ndarray
    height: float
    swing: np.ndarray


def course(
    keys: Sequence[tuple[float, Pose]], rng: np.random.Generator, *, scatter: float = 1.0
) -> Course:
    """Return a course through poses, each performed with random deviations.

    Parameters
    ----------
    keys : list of (time_s, Pose)
        In order of time.
    rng : numpy.random.Generator
    scatter : float
        Factor on the usual deviations; 0: exactly as scripted.
    """
    vectors = np.array([pose.vector() for _, pose in keys])
    spread = np.full(vectors.shape[1], SCATTER)
    spread[27:32] = np.radians(SCATTER_DEG)
    spread[32:] = 0.012, 0.05, 0.05
    noise = scatter * spread * rng.standard_normal(vectors.shape)
    for i in range(1, len(keys)):  # a pose that is held stays held
        if keys[i][1] is keys[i - 1][1]:
            noise[i] = noise[i - 1]
    return Course(np.array([time for time, _ in keys], float), vectors + noise)


def _slopes(times_s: NDArray, vectors: NDArray) -> NDArray:
    """Return the slopes (n, d) at the keys: of the parabola through three; 0 at ends and holds."""
    lasts = np.diff(times_s)[:, None]
    chords = np.diff(vectors, axis=0) / lasts
    slopes = np.zeros_like(vectors)
    slopes[1:-1] = (lasts[1:] * chords[:-1] + lasts[:-1] * chords[1:]) / (lasts[1:] + lasts[:-1])
    held = np.all(chords == 0, axis=1)
    slopes[:-1][held] = slopes[1:][held] = 0.0
    return slopes


def mirror(arm: Arm) -> Arm:
    """Return the same arm of the other side."""
    upper_arm, forearm, palm = (
        (-way[0], way[1], way[2]) for way in (arm.upper_arm, arm.forearm, arm.palm)
    )
    hand = None if arm.hand is None else (-arm.hand[0], arm.hand[1], arm.hand[2])
    return Arm(upper_arm, forearm, palm, hand)


HANGING = Arm((0.17, -0.98, 0.02), (0.12, -0.96, 0.22), (-1.0, -0.1, 0.0))
CARRYING = Arm((-0.22, -0.93, 0.1), (0.05, -0.45, 0.9), (1.0, 0.0, 0.1))
BALANCE = Arm((0.6, -0.75, 0.3), (0.15, 0.1, 0.98), (-0.6, -0.8, 0.0))
RAISED = Arm((0.5, 0.55, 0.65), (0.2, 0.9, 0.4), (-0.2, -0.4, 0.9))
TUCKED = Arm((0.45, -0.8, 0.35), (-0.55, 0.1, 0.8), (-0.7, -0.2, -0.6))
OUT_BEHIND = Arm((0.75, -0.35, -0.55), (0.8, -0.1, -0.45), (0.1, -1.0, 0.0))
GUARD = Arm((-0.42, -0.8, 0.42), (0.25, 0.3, 0.92), (0.9, -0.2, -0.2))

STAND = Pose(HANGING, mirror(HANGING), (0, -0.4, 0.9), height=0.995, swing=(1.0, 1.0))
WALK = Pose(HANGING, CARRYING, (0.15, 0.55, 0.8), lean=3, height=0.985, swing=(1.0, 0.35))
FREE_WALK = Pose(HANGING, mirror(HANGING), (0, -0.4, 0.9), lean=3, height=0.985, swing=(1.0, 0.9))
READY = Pose(
    BALANCE, GUARD, (0.3, 0.75, 0.6), lean=22, look=(0, -6), height=0.88, swing=(0.5, 0.25)
)
RUN = Pose(
    Arm((0.42, -0.85, 0.1), (0.05, -0.25, 0.97), (-0.9, -0.4, 0.0)),
    Arm((-0.45, -0.82, 0.25), (0.1, 0.15, 0.98), (0.9, -0.2, 0.0)),
    (0.2, 0.75, 0.65),
    lean=18,
    height=0.9,
    swing=(0.8, 0.4),
)
NET_REACH = Pose(
    OUT_BEHIND,
    Arm((-0.35, 0.15, 0.92), (-0.1, 0.2, 0.97), (0.2, -0.95, 0.2)),
    (0.15, 0.35, 0.92),
    twist=18,
    lean=26,
    look=(0, 8),
    height=0.72,
    swing=(0.1, 0.0),
)
SIDE_REACH = NET_REACH.but(
    right=Arm((-0.65, -0.15, 0.75), (-0.45, -0.1, 0.9), (0.75, -0.1, 0.65)),
    racket=(-0.1, 0.25, 0.95),
    twist=-5,
    height=0.76,
)
PREPARE = Pose(
    RAISED,
    Arm((-0.9, -0.15, -0.4), (-0.3, 0.93, 0.1), (0.2, 0.1, 0.95)),
    (0.35, 0.9, 0.1),
    twist=-32,
    lean=-8,
    roll=4,
    look=(45, -24),
    height=0.9,
    swing=(0.1, 0.1),
)
COCKED = PREPARE.but(
    left=Arm((0.6, -0.05, 0.8), (0.2, 0.5, 0.85), (-0.4, -0.7, 0.5)),
    right=Arm((-0.8, 0.5, 0.1), (-0.25, 0.35, -0.9), (0.6, 0.7, 0.3)),
    racket=(0.1, -0.75, -0.65),
    twist=-12,
    lean=-10,
    height=0.95,
)
IMPACT = PREPARE.but(
    left=Arm((0.6, -0.45, 0.65), (-0.1, 0.25, 0.95), (-0.5, -0.7, 0.2)),
    right=Arm((-0.4, 0.88, 0.3), (-0.15, 0.93, 0.34), (0.1, -0.3, 0.95)),
    racket=(0.15, 0.93, 0.35),
    twist=18,
    lean=6,
    roll=-10,
    look=(10, -18),
    height=0.98,
)
FOLLOW = IMPACT.but(
    left=TUCKED,
    right=Arm((0.2, -0.35, 0.92), (0.6, -0.65, 0.5), (0.3, -0.4, -0.85), hand=(0.65, -0.75, 0.2)),
    racket=(0.75, -0.65, -0.1),
    twist=30,
    lean=24,
    roll=4,
    look=(-8, -4),
    height=0.9,
)
