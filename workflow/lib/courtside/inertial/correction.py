"""An inertial skeleton corrected by what cameras see: bone lengths, slow turns of segments, heading, place.

The device is smooth and nearly right from frame to frame, but its bones, its heading and the turn of its
segments are off by what changes slowly or not at all; vision is right on the whole and noisy in each
frame. So corrections are constants and splines with a knot every half second or so, fitted to vision over
the whole take: what is fast stays the device's. How large corrections are and how noisy vision is are both
estimated, each in turn with the fit: a device that is right is left as it is.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from courtside.inertial import fit as vision_joints
from courtside.inertial import report
from courtside.inertial.fit import Fit
from courtside.inertial.segments import Frames
from courtside.records.devices.hierarchy import PosedHierarchy, forward

FLOOR_PERCENTILE = 5  # of the lower ankle's height: where the floor is


@dataclass(frozen=True)
class Settings:
    """What is believed before looking: sizes are standard deviations.

    Attributes
    ----------
    knot_s : float
        Distance of the splines' knots.
    turn_deg : dict of str to float
        Slowly changing turn of a segment. Pelvis, forearm and shank carry sensors.
    turn_memory_s, heading_deg, heading_memory_s, shift_m, shift_memory_s : float
        Memory of these turns; what is left of the heading and the root's path after a first estimate.
    mount_deg : dict of str to float
        Constant turn of a segment in its own axes. That of the upper arm is the swivel of the elbow, which
        no sensor sees.
    body, stretch, uneven : float
        Logarithm of the factor on all bones, on one kind of bone, and between left and right.
    offset_m : float
        Constant distance between vision's joint and the skeleton's, in the axes of the joint's parent.
    bias_m : float
        Constant error of vision's joint in vision's own axes: a depth camera sees skin, not joints.
    tilt_deg, place_m : float
        What a first estimate leaves of the turn and place between both frames.
    correlation_s : float
        Least time over which errors of vision are alike: a network errs alike while a pose lasts.
    window_s : float
        Of the first estimate of the heading.
    rounds : int
    tolerance_m : float
        Root mean square change of joints at which the rounds end.
    """

    knot_s: float = 0.5
    turn_deg: dict = field(
        default_factory=lambda: {
            "pelvis": 4.0,
            "thorax": 6.0,
            "clavicle": 5.0,
            "upper_arm": 10.0,
            "forearm": 6.0,
            "thigh": 8.0,
            "shank": 5.0,
        }
    )
    turn_memory_s: float = 2.0
    heading_deg: float = 5.0
    heading_memory_s: float = 5.0
    shift_m: float = 0.2
    shift_memory_s: float = 3.0
    mount_deg: dict = field(
        default_factory=lambda: {
            "pelvis": 4.0,
            "thorax": 6.0,
            "clavicle": 6.0,
            "upper_arm": 12.0,
            "forearm": 8.0,
            "thigh": 8.0,
            "shank": 6.0,
        }
    )
    body: float = 0.04
    stretch: float = 0.06
    uneven: float = 0.02
    offset_m: float = 0.01
    bias_m: float = 0.015
    tilt_deg: float = 5.0
    place_m: float = 0.5
    correlation_s: float = 0.25
    window_s: float = 1.5
    rounds: int = 15
    tolerance_m: float = 5e-4


def correct(
    posed,
    vision,
    *,
    sigma_m,
    lag_s=0.0,
    offsets_m=None,
    performed=None,
    up=(0, 1, 0),
    settings=None,
):
    """Correct an inertial skeleton by vision.

    Parameters
    ----------
    posed : PosedHierarchy
        Joints named as in the study; times on the reference clock.
    vision : DeviceMotion
        Joints with a place in space, times on the reference clock, any frame; joints that the skeleton
        does not name are not used.
    sigma_m : float or (T, J) float
        Standard deviation of vision's joints per axis. Its size per joint and axis is estimated again from
        the residuals; what counts is how it differs from frame to frame.
    lag_s : float
        Standard deviation of the offset between both clocks.
    offsets_m : dict of str to (3,) float, optional
        Known place of vision's joint from the skeleton's, in the axes of the joint's parent.
    performed : (T,) bool, optional
        False for frames of `posed` that show no motion, as mocopi's first row: there only bones change.
    up : (3,) float
        Vertical in the device's world.
    settings : Settings, optional

    Returns
    -------
    corrected : PosedHierarchy
        In the device's world; its times are those of `posed`, less the clock's shift found.
    report : courtside.inertial.report.CorrectionReport

    Raises
    ------
    InputError
        If vision has too little in common with the skeleton, or nothing to say about place.
    """
    settings = settings or Settings()
    up = np.asarray(up, float) / np.linalg.norm(up)
    performed = np.ones(len(posed.time_s), bool) if performed is None else performed
    moving = _only(posed, performed)
    fit = Fit(
        moving, vision_joints.observe(moving, vision, sigma_m), up, lag_s, offsets_m or {}, settings
    )
    fit.run()
    corrected = _whole(posed, performed, _applied(fit), fit)
    return corrected, report.describe(fit, moving, _only(corrected, performed))


def _only(posed, at):
    return replace(
        posed,
        time_s=posed.time_s[at],
        translation=posed.translation[at],
        parent_from_joint=posed.parent_from_joint[at],
    )


def _applied(fit):
    """Return the performed frames with the correction as found, in the device's world."""
    lag_s = fit.fixed[fit.model.fixed["lag"]]
    time_s = fit.posed.time_s - lag_s
    slow = fit.slow_at(time_s)
    frames = Frames(fit.facing, fit.local, fit.translation, fit.velocity)
    world = fit.model.orient(frames, slow, fit.fixed)
    parents = np.asarray(fit.posed.hierarchy.parents)
    local = world.copy()
    below = parents >= 0
    local[:, below] = world[:, parents[below]].swapaxes(2, 3) @ world[:, below]
    translation = fit.translation * fit.model.stretches(fit.fixed)[:, None]
    translation[:, ~below] = fit.posed.translation[:, ~below]
    translation[:, 0] = fit.translation[:, 0] + slow[:, fit.model.slow["shift"]] + fit.centre
    return PosedHierarchy(fit.posed.hierarchy, time_s, translation, local)


def _whole(posed, performed, applied, fit):
    """Put corrected frames among those that nobody performed, on bones of the corrected lengths."""
    factor = fit.model.stretches(fit.fixed)
    below = np.asarray(posed.hierarchy.parents) >= 0
    factor = np.where(below, factor, 1.0)[:, None]
    hierarchy = replace(posed.hierarchy, offsets=posed.hierarchy.offsets * factor)
    lag_s = fit.fixed[fit.model.fixed["lag"]]
    translation, local = posed.translation * factor, posed.parent_from_joint.copy()
    translation[performed], local[performed] = applied.translation, applied.parent_from_joint
    translation[performed, 0] += _lift(fit, applied) * fit.up
    return PosedHierarchy(hierarchy, posed.time_s - lag_s, translation, local)


def _lift(fit, applied):
    """Return how far to raise the body, metres, so that longer or shorter legs stand on the same floor."""
    names = list(fit.posed.hierarchy.joints)
    ankles = [names.index("left_ankle"), names.index("right_ankle")]
    heights = [
        (forward(posed)[0][:, ankles] @ fit.up).min(axis=1) for posed in (fit.posed, applied)
    ]
    before, after = (np.percentile(height, FLOOR_PERCENTILE) for height in heights)
    return before - after
