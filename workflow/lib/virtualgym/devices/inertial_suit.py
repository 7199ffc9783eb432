"""A virtual inertial suit like mocopi: the recording that its app would write of a motion.

The errors of `inertial_errors` act on the true rotations of the segments: sensors drift, segments
without a sensor are estimated, bones have wrong lengths, feet slide, and all is smoothed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from courtside.records.devices.hierarchy import Hierarchy, PosedHierarchy
from virtualgym.body import pose_bones
from virtualgym.body.athlete import Athlete
from virtualgym.devices import inertial_errors, inertial_estimate, mocopi_skeleton
from virtualgym.devices.inertial_errors import Errors
from virtualgym.devices.inertial_estimate import Turns
from virtualgym.devices.mocopi_skeleton import Rig

PAD_S = 0.25  # before and after, for the smoothing: over four times its widest standard deviation
SUPPORT_M = 0.02  # ASSUME: a foot this much lower than the other carries 73 % of the body
KINDS = {  # groups of joints whose bones have the same length error
    "trunk": ("torso", "neck", "head"),
    "collar": ("shoulder", "up_arm"),
    "upper_arm": ("low_arm",),
    "forearm": ("hand",),
    "hips": ("up_leg",),
    "thigh": ("low_leg",),
    "shank": ("foot",),
    "foot": ("toes",),
}


@dataclass(frozen=True)
class InertialSuit:
    """Settings of a suit.

    Attributes
    ----------
    strength : str
        A key of `inertial_errors.STRENGTHS`.
    rate_hz : float
        Rows per second by its own clock: the app offers 30, 50 and 60.
    subject : str or None
        The person who wears it; None: the first player.
    """

    strength: str = "usual"
    rate_hz: float = 60.0
    subject: str | None = None

    def __post_init__(self) -> None:
        if self.strength not in inertial_errors.STRENGTHS or not self.rate_hz > 0:
            expected = list(inertial_errors.STRENGTHS)
            raise ValueError(
                f"expected a strength of {expected} and rate_hz > 0, "
                f"found {self.strength}, {self.rate_hz}"
            )

    def errors(self) -> Errors:
        """Return its error sizes."""
        return inertial_errors.STRENGTHS[self.strength]


@dataclass(frozen=True, eq=False)
class Recording:
    """A recording of an inertial suit, and its truth.

    Attributes
    ----------
    posed : PosedHierarchy
        Mocopi's joint names, metres; times by the suit's own clock, from 0. The first row is the
        rest pose.
    device_from_world : (3, 4) float
        At the start of the recording; later the suit's heading and position drift.
    latency_s : float
        Delay of everything shown, besides its clock's offset.
    """

    posed: PosedHierarchy
    device_from_world: np.ndarray
    latency_s: float


def record(
    athlete: Athlete, time_s: NDArray, rate_hz: float, errors: Errors, rng: np.random.Generator
) -> Recording:
    """Record a motion.

    Parameters
    ----------
    athlete : Athlete
    time_s : (T,) float
        Of each row of the file, on the athlete's clock.
    rate_hz : float
        Rows per second by the suit's own clock.
    errors : Errors
    rng : numpy.random.Generator
    """
    step_s = 1 / rate_hz
    pad = int(np.ceil(PAD_S * rate_hz)) if errors.smooth_s else 0
    shown_s = np.asarray(time_s, dtype=float) - errors.latency_s
    around = np.arange(1, pad + 1) * step_s
    shown_s = np.concatenate([shown_s[0] - around[::-1], shown_s, shown_s[-1] + around])
    rig = mocopi_skeleton.Rig.of(athlete.body.skeleton)
    shape = _scaled(rig.hierarchy, errors, rng)
    device_from_world, true = _true(athlete, rig, shown_s, pad)
    felt, heading = inertial_estimate.guess(true, step_s, errors, rng)
    root = _placed(true, felt, shape, heading, step_s, errors, rng)
    turns, root = _smoothed(felt.world, root, errors.smooth_s * rate_hz)
    inner = slice(pad, len(shown_s) - pad)
    posed = _posed(shape, turns[inner], root[inner], np.arange(len(time_s)) / rate_hz)
    return Recording(posed, device_from_world, errors.latency_s)


def _scaled(shape: Hierarchy, errors: Errors, rng: np.random.Generator) -> Hierarchy:
    """Return the hierarchy with length errors, left and right alike."""
    whole = np.exp(errors.stature * rng.standard_normal())
    factors = whole * np.exp(errors.bone * rng.standard_normal(len(KINDS)))
    offsets = shape.offsets.copy()
    for factor, names in zip(factors, KINDS.values(), strict=True):
        rows = [j for j, joint in enumerate(shape.joints) if _kind(joint) in names]
        offsets[rows] *= factor
    at = {name: row for row, name in enumerate(shape.joints)}
    legs = [at[name] for name in ("l_up_leg", "l_low_leg", "l_foot")]
    offsets[0, 1] += shape.offsets[legs, 1].sum() - offsets[legs, 1].sum()  # it stands on the floor
    return Hierarchy(shape.joints, shape.parents, offsets, shape.ends)


def _kind(joint: str) -> str:
    plain = joint[2:] if joint[1] == "_" else joint
    return plain.split("_")[0] if plain.startswith(("torso", "neck")) else plain


def _true(athlete: Athlete, rig: Rig, time_s: NDArray, start: int) -> tuple[NDArray, Turns]:
    """Return device_from_world at a frame, and the true rotations in the device's world."""
    bones = [pose_bones.pose(athlete.body.skeleton, athlete.motion.stance(t)) for t in time_s]
    world = np.array([rig.turns(each) for each in bones])
    root = np.array([rig.place(each) for each in bones])
    left = world[start, 0, :, 0] * [1.0, 1.0, 0.0]
    left /= np.linalg.norm(left)
    up = np.array([0.0, 0.0, 1.0])
    turn = np.stack([left, up, np.cross(left, up)])
    shift = -turn @ (root[start] * [1.0, 1.0, 0.0])
    true = Turns(rig.hierarchy, turn @ world, root @ turn.T + shift)
    return np.column_stack([turn, shift]), true


def _placed(
    true: Turns,
    felt: Turns,
    shape: Hierarchy,
    heading: NDArray,
    step_s: float,
    errors: Errors,
    rng: np.random.Generator,
) -> NDArray:
    """Return the app's root positions (T, 3): it moves as the standing foot demands."""
    names = list(shape.joints)
    feet = [names.index(name) for name in ("l_foot", "r_foot")]
    real, ours = true.hung(true.hierarchy)[:, feet], felt.hung(shape)[:, feet]
    height = (true.root[:, None] + real)[..., 1]
    left = 1 / (1 + np.exp(np.clip((height[:, 0] - height[:, 1]) / SUPPORT_M, -50, 50)))
    carries = np.stack([left, 1 - left], axis=1)[..., None]
    about = Rotation.from_rotvec(heading[:, None] * [0.0, 1.0, 0.0]).as_matrix()
    middle = about[:-1]
    moved = np.einsum("tij,tj->ti", middle, np.diff(true.root, axis=0))
    turned = np.einsum("tij,tfj->tfi", middle, np.diff(real, axis=0))
    slid = ((carries[1:] + carries[:-1]) / 2 * (np.diff(ours, axis=0) - turned)).sum(axis=1)
    moved -= (1 - errors.skate) * slid
    wander = inertial_errors.wandering(rng, len(moved), (3,), step_s, errors.drift_s)
    moved += errors.drift_m_s * step_s * wander
    root = true.root[0] + np.concatenate([np.zeros((1, 3)), np.cumsum(moved, axis=0)])
    # The floor fixes the height: the lower ankle has its true height.
    root[:, 1] = true.root[:, 1] - (carries * (ours - real)).sum(axis=1)[:, 1]
    return root


def _smoothed(world: NDArray, root: NDArray, sigma: float) -> tuple[NDArray, NDArray]:
    if not sigma:
        return world, root
    mean = gaussian_filter1d(world, sigma, axis=0, mode="nearest")
    left, _, right = np.linalg.svd(mean)
    return left @ right, gaussian_filter1d(root, sigma, axis=0, mode="nearest")


def _posed(shape: Hierarchy, world: NDArray, root: NDArray, time_s: NDArray) -> PosedHierarchy:
    """Return the local rotations, with the rest pose in the first row."""
    parents = shape.parents
    local = world.copy()
    local[:, 1:] = np.swapaxes(world[:, parents[1:]], -1, -2) @ world[:, 1:]
    translation = np.repeat(shape.offsets[None], len(time_s), axis=0)
    translation[:, 0] = root
    local[0], translation[0] = np.eye(3), shape.offsets
    return PosedHierarchy(shape, time_s, translation, local)
