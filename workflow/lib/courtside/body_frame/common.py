"""All sources of a take in one body frame: the same T-pose for all, the reference's clock."""

import numpy as np

from courtside.body_frame import frame as bodyframe
from courtside.events import tpose as tposes
from courtside.records.keypoints.body_motion import BodyMotion
from courtside.study.errors import InputError

SAME_S = 0.3  # two devices' spells that overlap by that are one T-pose


def common(happened, clocks, motions=None):
    """Choose the T-pose that all sources show best.

    Parameters
    ----------
    happened : dict of str to courtside.events.detect.Events
        Of each source; the first is the reference.
    clocks : dict of str to courtside.records.devices.clocks.Clock
        Against the reference.
    motions : dict of str to courtside.records.devices.device_motion.DeviceMotion, optional
        Where nobody performs a T-pose, the rest poses that these bring along, if all do.

    Returns
    -------
    chosen : dict of str to courtside.events.tpose.TPose
        For each source its own spell of that T-pose.

    Raises
    ------
    InputError
        If no T-pose is shown by all.
    """
    reference = next(iter(happened))
    choices = []
    for spell in happened[reference].tposes:
        choice = {source: _same(spell, each, clocks[source]) for source, each in happened.items()}
        if all(choice.values()):
            choices.append(choice)
    if not choices and motions and not any(motion.performed.all() for motion in motions.values()):
        return {source: tposes.rest(motion) for source, motion in motions.items()}
    if not choices:
        times = "; ".join(
            f"{source} {', '.join(f'{clocks[source].to_reference(s.start_s):.2f}' for s in each.tposes)}"
            for source, each in happened.items()
        )
        raise InputError(
            f"expected a T-pose that all sources show, found T-poses at (s, reference clock): {times}; "
            "film all devices together, or leave one out"
        )
    return min(choices, key=lambda choice: sum(spell.cost for spell in choice.values()))


def _same(spell, happened, clock):
    """Return a source's spell that overlaps the reference's most, or None."""

    def overlap(other):
        return _overlap(spell, clock.to_reference([other.start_s, other.stop_s]))

    best = max(happened.tposes, key=overlap)
    return best if overlap(best) >= SAME_S else None


def claps_of(source, happened, clocks):
    """Return the times of the claps of a take by one source: its own, and those that only others show.

    Parameters
    ----------
    source : str
    happened : dict of str to courtside.events.detect.Events
    clocks : dict of str to courtside.records.devices.clocks.Clock
        Against the reference.

    Returns
    -------
    clap_s : (C,) float
        On the reference clock.
    """
    found = []
    for name in (source, *(name for name in happened if name != source)):
        own_s = np.array([float(clap.time_s) for clap in happened[name].claps])
        for clap_s in clocks[name].to_reference(own_s):
            if all(abs(clap_s - other) > SAME_S for other in found):
                found.append(float(clap_s))
    return np.array(sorted(found))


def aligned(motion, frame, clock, clap_s=()):
    """Return a source in its body frame, on the reference clock.

    Parameters
    ----------
    motion : courtside.records.devices.device_motion.DeviceMotion
    frame : courtside.body_frame.frame.BodyFrame
    clock : courtside.records.devices.clocks.Clock
        Of the source against the reference.
    clap_s : (C,) float
        Claps, on the reference clock.

    Returns
    -------
    body : courtside.records.keypoints.body_motion.BodyMotion
        Frames that nobody performed are left out.
    """
    kept = motion.performed
    return BodyMotion(
        source=motion.source,
        kind=motion.kind,
        joints=motion.joints,
        time_s=clock.to_reference(motion.time_s[kept]),
        fixed=bodyframe.fixed(motion, frame)[kept],
        following=bodyframe.following(motion, frame)[kept],
        reason=motion.reason[kept],
        unit_m=frame.residuals["unit_m"],
        tpose_s=clock.to_reference([frame.tpose.start_s, frame.tpose.stop_s]),
        clap_s=np.asarray(clap_s, dtype=float),
    )


def counterpart(motion, carried_by, tpose_s):
    """Return the body frame of the motion that counts as true, of a T-pose that another source has.

    Parameters
    ----------
    motion : courtside.records.devices.device_motion.DeviceMotion
        On the reference clock.
    carried_by : courtside.body_frame.frame.Anchors
        Of this motion's joints.
    tpose_s : (2,) float
        When the T-pose began and ended, on the reference clock.

    Returns
    -------
    frame : courtside.body_frame.frame.BodyFrame

    Raises
    ------
    InputError
        If it shows no T-pose then.
    """
    spells = tposes.find(motion)
    best = max(spells, key=lambda spell: _overlap(spell, tpose_s))
    if _overlap(best, tpose_s) < SAME_S:
        raise InputError(
            f"{motion.source}: expected a T-pose at {tpose_s[0]:.2f} to {tpose_s[1]:.2f} s, found T-poses at "
            f"{', '.join(f'{spell.start_s:.2f}' for spell in spells)} s; check the clocks"
        )
    return bodyframe.at_tpose(motion, carried_by, best)


def _overlap(spell, span_s):
    return min(span_s[1], spell.stop_s) - max(span_s[0], spell.start_s)
