"""The orientations of a body's segments, from six drifting sensors and an app's estimates."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from courtside.geometry.rotations import rodrigues_from_rotation, rotation_from_rodrigues
from courtside.records.devices.hierarchy import Hierarchy, PosedHierarchy, forward
from virtualgym.devices import inertial_errors
from virtualgym.devices.mocopi_skeleton import TORSO

SENSED = ("root", "head", "l_low_arm", "r_low_arm", "l_low_leg", "r_low_leg")
UP = np.array([0.0, 1.0, 0.0])
GRAVITY_M_S2 = 9.81
LEAK_S = 0.15  # ASSUME: smoothing of the acceleration that a sensor takes for gravity
LEAST_SINE = 1e-6  # against division by zero in straight limbs


@dataclass(frozen=True, eq=False)
class Turns:
    """A body in motion: rotations (T, J, 3, 3) in the suit's world, and root positions (T, 3) m."""

    hierarchy: Hierarchy
    world: np.ndarray
    root: np.ndarray

    def of(self, joint: str) -> NDArray:
        """Return the rotations (T, 3, 3) of a joint by its name."""
        return self.world[:, self.hierarchy.joints.index(joint)]

    def hung(self, hierarchy: Hierarchy) -> NDArray:
        """Return the joints (T, J, 3) m relative to the root, with the bones of a hierarchy."""
        parents = hierarchy.parents
        local = self.world.copy()
        local[:, 1:] = _inverse(self.world[:, parents[1:]]) @ self.world[:, 1:]
        shifts = np.repeat(hierarchy.offsets[None], len(local), axis=0)
        shifts[:, 0] = 0
        return forward(PosedHierarchy(hierarchy, np.arange(len(local)), shifts, local))[0]


def guess(
    true: Turns, step_s: float, errors: inertial_errors.Errors, rng: np.random.Generator
) -> tuple[Turns, NDArray]:
    """Return the app's estimate of a motion, before smoothing.

    Returns
    -------
    felt : Turns
        With the true path of the root.
    heading : (T,) float
        Heading error of the hips, radians.
    """
    felt, heading = _sensors(true, step_s, errors, rng)
    guesses = _Guesses(true, felt, step_s, errors, rng)
    guesses.trunk()
    for side in "lr":
        guesses.limb(f"{side}_up_arm", f"{side}_low_arm", f"{side}_hand", errors.elbow)
        guesses.limb(f"{side}_up_leg", f"{side}_low_leg", f"{side}_foot", errors.knee)
        guesses.follow(f"{side}_hand", f"{side}_low_arm", 0.0)
        guesses.follow(f"{side}_foot", f"{side}_low_leg", 1.0)
        guesses.follow(f"{side}_toes", f"{side}_foot", 0.0)
    world = np.stack([guesses.made[joint] for joint in true.hierarchy.joints], axis=1)
    return Turns(true.hierarchy, world, true.root), heading


def _sensors(
    true: Turns, step_s: float, errors: inertial_errors.Errors, rng: np.random.Generator
) -> tuple[dict[str, NDArray], NDArray]:
    """Return the sensors' orientations by joint, and the heading error of the first, the hips'."""
    n, count = len(true.root), len(SENSED)
    time_s = np.arange(n) * step_s
    rate = rng.standard_normal(count) * np.sqrt(0.5) + rng.standard_normal() * np.sqrt(0.5)
    heading = np.radians(errors.drift_deg_min) / 60 * rate * time_s[:, None]
    wander = inertial_errors.wandering(rng, n, (count,), step_s, errors.heading_s, from_zero=True)
    heading += np.radians(errors.heading_deg) * wander
    heading += inertial_errors.disturbance(rng, time_s, count, errors)
    tilt = inertial_errors.wandering(rng, n, (count, 3), step_s, errors.tilt_s)
    tilt *= np.radians(errors.tilt_deg) * (1 - UP)
    tilt[:, 0] += _leaked(true, step_s, errors) + _slipped(true, errors)
    mount = rotation_from_rodrigues(np.radians(errors.mount_deg) * rng.standard_normal((count, 3)))
    noise = rotation_from_rodrigues(
        np.radians(errors.noise_deg) * rng.standard_normal((n, count, 3))
    )
    felt = {}
    for row, joint in enumerate(SENSED):
        outer = rotation_from_rodrigues(heading[:, row, None] * UP) @ rotation_from_rodrigues(
            tilt[:, row]
        )
        felt[joint] = outer @ true.of(joint) @ mount[row] @ noise[:, row]
    return felt, heading[:, 0]


def _leaked(true: Turns, step_s: float, errors: inertial_errors.Errors) -> NDArray:
    """Return the tilt (T, 3) of the hips' sensor, which takes acceleration for gravity."""
    if not errors.leak:
        return np.zeros_like(true.root)
    path = gaussian_filter1d(true.root, LEAK_S / step_s, axis=0, mode="nearest")
    along = np.gradient(np.gradient(path, step_s, axis=0), step_s, axis=0) * (1 - UP)
    return errors.leak * np.cross(UP, along / GRAVITY_M_S2)


def _slipped(true: Turns, errors: inertial_errors.Errors) -> NDArray:
    """Return the tilt (T, 3) of the hips' sensor, which the trunk drags along with the belt."""
    return errors.slip * rodrigues_from_rotation(true.of(TORSO[-1]) @ _inverse(true.of("root")))


class _Guesses:
    """The estimated rotations of all joints, filled in one after the other."""

    def __init__(
        self,
        true: Turns,
        felt: dict[str, NDArray],
        step_s: float,
        errors: inertial_errors.Errors,
        rng: np.random.Generator,
    ) -> None:
        self.true, self.made = true, dict(felt)
        self.step_s, self.errors, self.rng = step_s, errors, rng

    def trunk(self) -> None:
        """Estimate the spine, which bends too little, and neck and clavicles from it."""
        root, wrong = self.true.of("root"), self._wandered()
        for rank, joint in enumerate(TORSO, start=1):
            bend = (1 - self.errors.trunk) * rodrigues_from_rotation(
                _inverse(root) @ self.true.of(joint)
            )
            turned = self.made["root"] @ rotation_from_rodrigues(bend)
            self.made[joint] = turned @ rotation_from_rodrigues(wrong * rank / len(TORSO))
        thorax = self.true.of(TORSO[-1])
        for joint in ("neck_1", "neck_2"):
            self.made[joint] = self.made[TORSO[-1]] @ _inverse(thorax) @ self.true.of(joint)
        for joint in ("l_shoulder", "r_shoulder"):
            moved = (1 - self.errors.girdle) * rodrigues_from_rotation(
                _inverse(thorax) @ self.true.of(joint)
            )
            self.made[joint] = (
                self.made[TORSO[-1]]
                @ rotation_from_rodrigues(moved)
                @ rotation_from_rodrigues(self._wandered())
            )

    def limb(self, upper: str, lower: str, end: str, missed: float) -> None:
        """Estimate the upper segment of a limb whose lower one carries a sensor.

        It follows the lower one, with part of the bend between them missed, a rotation about the
        line from the limb's start to its end, and random wander.
        """
        shape, lead = self.true.hierarchy, self.made[lower] @ _inverse(self.true.of(lower))
        bones = [shape.offsets[shape.joints.index(joint)] for joint in (lower, end)]
        first = lead @ self.true.of(upper)
        ways = [turns @ bone for turns, bone in zip((first, self.made[lower]), bones, strict=True)]
        units = [way / np.linalg.norm(way, axis=-1, keepdims=True) for way in ways]
        hinge = np.cross(units[0], units[1])
        sine = np.linalg.norm(hinge, axis=-1, keepdims=True)
        bend = np.arctan2(sine, (units[0] * units[1]).sum(axis=-1, keepdims=True))
        straighten = rotation_from_rodrigues(missed * bend * hinge / np.maximum(sine, LEAST_SINE))
        span = np.einsum("tij,tj->ti", straighten, ways[0]) + ways[1]
        span /= np.linalg.norm(span, axis=-1, keepdims=True)
        errors = self.errors
        swivel = inertial_errors.wandering(self.rng, len(span), (1,), self.step_s, errors.swivel_s)
        swivelled = rotation_from_rodrigues(np.radians(errors.swivel_deg) * swivel * span)
        self.made[upper] = (
            swivelled @ straighten @ first @ rotation_from_rodrigues(self._wandered())
        )

    def follow(self, joint: str, parent: str, share: float) -> None:
        """Keep a joint's true rotation from its parent, with a share of an estimate's error."""
        own = _inverse(self.true.of(parent)) @ self.true.of(joint)
        self.made[joint] = (
            self.made[parent] @ own @ rotation_from_rodrigues(share * self._wandered())
        )

    def _wandered(self) -> NDArray:
        """Return the error (T, 3) of one estimated segment, a rotation vector."""
        errors = self.errors
        n = len(self.true.root)
        wander = inertial_errors.wandering(self.rng, n, (3,), self.step_s, errors.guess_s)
        return np.radians(errors.guess_deg) * wander


def _inverse(turns: NDArray) -> NDArray:
    return np.swapaxes(turns, -1, -2)
