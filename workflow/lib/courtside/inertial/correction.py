"""Correct an inertial skeleton by vision: bone lengths, slow turns of segments, heading, place.

The device is smooth and nearly right from frame to frame, but errors of its bones, its heading and
its segments' turns are constant or change slowly. Vision is right on average and noisy in each
frame. Corrections are therefore constants, and splines with a knot every half second or so, fitted
to vision over the whole take; fast motion stays the device's. The size of the corrections and the
noise of vision are both estimated, in alternation with the fit: a device that is right stays as it
is.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.inertial import report
from courtside.inertial.fit import Fit
from courtside.inertial.segments import Frames
from courtside.inertial.vision import observe
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.hierarchy import PosedHierarchy, forward

UP = np.array([0.0, 1.0, 0.0])  # vertical in the suit's world
FLOOR_PERCENTILE = 5  # ASSUME: of the lower ankle's height: where the floor is


def correct(
    posed: PosedHierarchy,
    vision: DeviceMotion,
    *,
    sigma_m: ArrayLike,
    lag_s: float = 0.0,
    performed: NDArray | None = None,
) -> tuple[PosedHierarchy, report.CorrectionReport]:
    """Correct an inertial skeleton by vision; return it, and what was found.

    `posed` has joints named as in the study; `vision` joints with a place in space, in any frame,
    of which those that the skeleton does not name are not used; both have times on the reference
    clock. `sigma_m`, a number or (T, J), is the standard deviation of vision's joints per axis: its
    size per joint and axis is estimated again from the residuals; what counts is how it differs
    from frame to frame. `lag_s` is the standard deviation of the offset between both clocks. In
    frames not `performed` (T,), without motion as mocopi's first row, only the bones change.

    The corrected skeleton is in the device's world; its times are those of `posed`, less the
    clock's shift found. An `InputError` if vision has too little in common with the skeleton, or
    nothing to say about place.
    """
    performed = np.ones(len(posed.time_s), bool) if performed is None else performed
    moving = _only(posed, performed)
    seen = observe(moving, vision, sigma_m)
    fit = Fit(moving, seen, UP, lag_s)
    fit.run()
    corrected = _whole(posed, performed, _applied(fit), fit)
    return corrected, report.describe(fit, moving, _only(corrected, performed))


def _only(posed: PosedHierarchy, at: NDArray) -> PosedHierarchy:
    return replace(
        posed,
        time_s=posed.time_s[at],
        translation=posed.translation[at],
        parent_from_joint=posed.parent_from_joint[at],
    )


def _applied(fit: Fit) -> PosedHierarchy:
    """Return the performed frames with the correction applied, in the device's world."""
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


def _whole(
    posed: PosedHierarchy, performed: NDArray, applied: PosedHierarchy, fit: Fit
) -> PosedHierarchy:
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


def _lift(fit: Fit, applied: PosedHierarchy) -> float:
    """Return how far to raise the body, m, so that its new legs stand on the same floor."""
    names = list(fit.posed.hierarchy.joints)
    ankles = [names.index("left_ankle"), names.index("right_ankle")]
    heights = [
        (forward(posed)[0][:, ankles] @ fit.up).min(axis=1) for posed in (fit.posed, applied)
    ]
    before, after = (np.percentile(height, FLOOR_PERCENTILE) for height in heights)
    return before - after
