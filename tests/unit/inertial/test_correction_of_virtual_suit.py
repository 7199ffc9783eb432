"""A virtual athlete in a virtual suit: the corrected skeleton is nearer the truth than the suit's.

The method was made without the suit's errors; seeds 1 to 3, mild and usual, served to choose its
settings.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.inertial import correction
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.skeleton import JOINTS as LIMB_JOINTS
from fixtures.people import mannequin, moved_bodies, performers
from virtualgym.body import athlete, shapes, skinned_body
from virtualgym.devices import inertial_errors, inertial_suit
from virtualgym.movement import single_view
from virtualgym.movement.player import Player

pytestmark = pytest.mark.slow
SEED = 11
CAM_FROM_WORLD = Rotation.from_euler("xz", [-82, 195], degrees=True).as_matrix()
STRENGTHS = ["mild", "usual", "strong"]
NOT_MODELLED = "disturbed"


@cache
def performed():
    """Return the athlete, the times (T,) of the suit's rows, the true joints (T, 12, 3)."""
    figure = skinned_body.Body.read(mannequin.folder(), shapes.BODIES["m2"])
    player = Player(figure.proportions, performers.COURT, np.random.default_rng(SEED))
    motion = single_view.perform(player, free_s=20.0, claps=2)
    mover = athlete.Athlete(figure, motion, racket=False)
    time_s = np.arange(1.0, motion.seconds - 0.5, 1 / 60)
    chosen = [list(skinned_body.JOINTS).index(joint) for joint in LIMB_JOINTS]
    return mover, time_s, np.array([mover.joints(t)[chosen] for t in time_s])


def lasting(rng, shape, keep):
    noise = rng.standard_normal(shape)
    for frame in range(1, len(noise)):
        noise[frame] = keep * noise[frame - 1] + np.sqrt(1 - keep**2) * noise[frame]
    return noise


@cache
def vision():
    """Return a depth camera's joints: lasting errors along the view, biases, gaps."""
    _, time_s, true = performed()
    rng = np.random.default_rng([SEED, 99])
    xyz = (true[12:-12:2] - true.mean(axis=(0, 1))) @ CAM_FROM_WORLD.T + [0, 0, 4.0]
    fast = lasting(rng, xyz.shape, np.exp(-1 / (30 * 0.15))) * [0.012, 0.012, 0.028]
    slow = lasting(rng, xyz.shape, np.exp(-1 / (30 * 1.5))) * [0.008, 0.008, 0.015]
    xyz += fast + slow + rng.standard_normal((12, 3)) * [0.01, 0.01, 0.02]
    wild = rng.uniform(size=xyz.shape[:2]) < 0.02
    xyz[wild] += 0.3 * rng.standard_normal((wild.sum(), 3))
    xyz[rng.uniform(size=xyz.shape[:2]) < 0.06] = np.nan
    every, reason = np.ones(len(xyz), bool), np.zeros(xyz.shape[:2], np.uint8)
    return DeviceMotion(
        "d415-depth", "rgbd", np.array(LIMB_JOINTS), time_s[12:-12:2], xyz, reason, every
    )


@cache
def errors_m(strength):
    """Return the median error of the suit and of its correction, after one common alignment."""
    mover, time_s, true = performed()
    errors = inertial_errors.STRENGTHS[strength]
    rng = np.random.default_rng([SEED, len(strength)])
    recording = inertial_suit.record(mover, time_s, 60.0, errors, rng)
    names = skeleton.read(mannequin.ROOT / "config" / "skeletons" / "mocopi27.yaml")
    studied = dict(zip(names.device_names(), names.joints, strict=True))
    shape = recording.posed.hierarchy
    rows = slice(1, None)  # the first shows the rest pose
    posed = replace(
        recording.posed,
        hierarchy=replace(shape, joints=tuple(studied.get(joint, joint) for joint in shape.joints)),
        time_s=time_s[rows] - recording.latency_s + 0.004,
        translation=recording.posed.translation[rows],
        parent_from_joint=recording.posed.parent_from_joint[rows],
    )
    corrected, _ = correction.correct(posed, vision(), sigma_m=0.025, lag_s=0.006)
    return [median_error_m(each, time_s, true) for each in (posed, corrected)]


def median_error_m(posed, time_s, true):
    paths = moved_bodies.limbs(posed).reshape(len(posed.time_s), -1).T
    at = np.array([np.interp(time_s, posed.time_s, path) for path in paths]).T.reshape(true.shape)
    return np.median(np.linalg.norm(moved_bodies.aligned(at, true) - true, axis=2))


@pytest.mark.parametrize("strength", STRENGTHS)
def test_the_correction_is_worth_a_third(strength):
    raw, corrected = errors_m(strength)
    assert raw > 0.01
    assert corrected < 0.7 * raw


def test_what_the_method_does_not_model_does_no_harm():
    raw, corrected = errors_m(NOT_MODELLED)
    assert corrected <= raw
