"""Cameras with one more pose after each step, adjusted with the people that they film."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people import adjustment, prior
from courtside.calibration.people.knocks.steps import USUAL_RAD, Step
from courtside.calibration.people.views import Limits, Seen
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry import camera as camera_models
from courtside.geometry import rotations
from courtside.geometry.camera import Camera

# ASSUME: a knocked camera keeps its place, and its lens: a share of its sigma
SAME_M, SAME_LENS = 0.002, 0.03


def measured(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    steps: Sequence[Step],
) -> list[tuple[NDArray, NDArray]]:
    """Return turns (3,) rad, and their sigma, as the adjustment of all cameras measures steps.

    Each turn is without those before it of its camera. Steps as for `adjusted`.
    """
    found, measured = adjusted(cameras, known, seen, limits, steps), []
    count = len(found.cameras)
    spread = camera_covariance.of_network([str(at) for at in range(count)], found.covariance)
    both = spread.covariance.reshape(count, len(PARAMETERS), count, len(PARAMETERS))
    pose = [camera.cam_from_world[:, :3] for camera in found.cameras]
    for new, old in enumerate(_poses_before(len(cameras), steps), start=len(cameras)):
        still = pose[steps[new - len(cameras)].camera]
        turn = rotations.rodrigues_from_rotation(still @ pose[old].T @ pose[new] @ still.T)
        ends = both[[old, new]][:, :3][:, :, [old, new]][..., :3]
        variance = ends[0, :, 0] + ends[1, :, 1] - ends[0, :, 1] - ends[1, :, 0]
        measured.append((turn, np.sqrt(np.diag(variance))))
    return measured


def adjusted(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    steps: Sequence[Step],
) -> adjustment.Refined:
    """Return cameras adjusted with people; the pose after each step is one more camera.

    Steps of one camera are in order of time, and their turns from the camera's first pose.
    """
    if not steps:
        return adjustment.refine(cameras, seen, prior.knowledge(cameras, known), limits)
    size = len(PARAMETERS)
    covariance = known.of([one.name for one in cameras]).covariance
    for step, before in zip(steps, _poses_before(len(cameras), steps), strict=True):
        again = np.r_[: len(covariance), size * before : size * (before + 1)]
        own = np.sqrt(np.diag(covariance)[size * step.camera : size * (step.camera + 1)])
        covariance = covariance[np.ix_(again, again)]
        more = np.r_[[USUAL_RAD] * 3, [SAME_M] * 3, SAME_LENS * own[6:]]
        covariance[-size:, -size:] += np.diag(more**2)
    after = [
        replace(cameras[step.camera], name=f"{cameras[step.camera].name}, after {step.time_s}")
        for step in steps
    ]
    poses = [*cameras, *after]
    all_known = CameraCovariance([one.name for one in poses], covariance)
    turned = [camera_models.turned(one, step.turn) for one, step in zip(after, steps, strict=True)]
    parts, stated = _split(seen, steps), prior.knowledge(poses, all_known)
    return adjustment.refine([*cameras, *turned], parts, stated, limits)


def _poses_before(n_cameras: int, steps: Sequence[Step]) -> list[int]:
    """Return which pose each step's camera has before it: poses are cameras, then steps."""
    last, found = list(range(n_cameras)), []
    for number, step in enumerate(steps, start=n_cameras):
        found.append(last[step.camera])
        last[step.camera] = number
    return found


def _split(seen: Seen, steps: Sequence[Step]) -> Seen:
    """Return what was seen after each step by its camera as seen by one more camera."""
    n_cameras = len(seen.xy)
    which = np.r_[:n_cameras, [step.camera for step in steps]]
    gone = np.zeros((len(which), len(seen.time_s)), dtype=bool)
    for new, old in enumerate(_poses_before(n_cameras, steps), start=n_cameras):
        after = steps[new - n_cameras].during(seen.time_s)
        gone[old] |= after
        gone[new] |= ~after
    xy, score = seen.xy[which], seen.score[which]
    xy[gone], score[gone] = np.nan, np.nan
    return replace(seen, xy=xy, score=score, height_px=seen.height_px[which], offset_px=None)
