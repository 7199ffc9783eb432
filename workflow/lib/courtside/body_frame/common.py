"""All sources of a take in one body frame: the same T-pose for all, on the reference clock."""

from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.body_frame.frame import Anchors, BodyFrame, at_tpose, fixed, following
from courtside.records.devices.clocks import Clock
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.events import Events, TPose
from courtside.records.keypoints.body_motion import BodyMotion
from courtside.study.errors import InputError

SAME_S = 0.3  # ASSUME: spells of two devices that overlap this long are one T-pose


def common(events_of: Mapping[str, Events], clocks: Mapping[str, Clock]) -> dict[str, TPose]:
    """Choose the T-pose that all sources show best: for each source its own spell of it.

    One that a clap follows comes before all others. The first source of `events_of` is the
    reference, which `clocks` are against. Where no T-pose is common, the rest poses are used, if
    all sources bring one along. An `InputError` if no T-pose is shown by all.
    """
    reference = next(iter(events_of.values()))
    choices = []
    for spell in reference.tposes:
        same = {source: _same(spell, own, clocks[source]) for source, own in events_of.items()}
        shown = {source: own for source, own in same.items() if own}
        if len(shown) == len(same):
            choices.append(shown)
    if choices:
        clapped = {own.tposes[clap.tpose] for own in events_of.values() for clap in own.claps}

        def cost(choice: dict[str, TPose]) -> tuple[bool, float]:
            return clapped.isdisjoint(choice.values()), sum(one.cost for one in choice.values())

        return min(choices, key=cost)
    rests = {source: own.rest for source, own in events_of.items() if own.rest}
    if len(rests) == len(events_of):
        return rests
    at_s = {
        source: ", ".join(f"{clocks[source].to_reference(s.start_s):.2f}" for s in own.tposes)
        for source, own in events_of.items()
    }
    times = "; ".join(f"{source} {at or 'none'}" for source, at in at_s.items())
    advice = "film all devices together, or leave one out"
    if not any(at_s.values()):
        advice = "begin and end the take with a T-pose in view of all devices, held for a second"
    raise InputError(
        "expected a T-pose that all sources show, found T-poses at (s, reference clock): "
        f"{times}; {advice}"
    )


def _same(spell: TPose, own: Events, clock: Clock) -> TPose | None:
    """Return a source's spell that overlaps the reference's most, or None."""

    def overlap(other: TPose) -> float:
        return _overlap(spell, clock.to_reference([other.start_s, other.stop_s]))

    best = max(own.tposes, key=overlap, default=None)
    return best if best and overlap(best) >= SAME_S else None


def claps_of(source: str, events_of: Mapping[str, Events], clocks: Mapping[str, Clock]) -> NDArray:
    """Return the times (C,) of a take's claps on the reference clock.

    Those that the source itself shows, and those that only other sources show. `clocks` are against
    the reference.
    """
    found: list[float] = []
    for name in (source, *(name for name in events_of if name != source)):
        own_s = np.array([float(clap.time_s) for clap in events_of[name].claps])
        for clap_s in clocks[name].to_reference(own_s):
            if all(abs(clap_s - other) > SAME_S for other in found):
                found.append(float(clap_s))
    return np.array(sorted(found))


def aligned(
    motion: DeviceMotion, frame: BodyFrame, clock: Clock, clap_s: ArrayLike = ()
) -> BodyMotion:
    """Return a source in its body frame, on the reference clock, without unperformed frames.

    `clock` is the source's against the reference; `clap_s` (C,) are on the reference clock. The
    T-pose's times are NaN if nobody performed it: it is the rest pose of the device's own model.
    """
    kept = motion.performed
    span_s = [frame.tpose.start_s, frame.tpose.stop_s]
    tpose_s = span_s if kept[frame.tpose.frames].any() else [np.nan, np.nan]
    return BodyMotion(
        source=motion.source,
        kind=motion.kind,
        joints=motion.joints,
        time_s=clock.to_reference(motion.time_s[kept]),
        fixed=fixed(motion, frame)[kept],
        following=following(motion, frame)[kept],
        reason=motion.reason[kept],
        unit_m=cast(float, frame.residuals["unit_m"]),
        tpose_s=clock.to_reference(tpose_s),
        clap_s=np.asarray(clap_s, dtype=float),
    )


def counterpart(
    motion: DeviceMotion, spells: Sequence[TPose], carried_by: Anchors, tpose_s: NDArray
) -> BodyFrame:
    """Return the body frame of the true motion at the T-pose of another source.

    The motion, whose T-poses are `spells` and whose joints `carried_by` weighs, and the other
    T-pose's start and end (2,) are on the reference clock, NaN if nobody performed it. An
    `InputError` then, or if the motion shows no T-pose at that time.
    """
    if not np.isfinite(tpose_s).all():
        raise InputError(
            f"{motion.source}: expected a T-pose that the sources perform, found only rest poses "
            "of their own models; film one"
        )
    best = max(spells, key=lambda spell: _overlap(spell, tpose_s))
    if _overlap(best, tpose_s) < SAME_S:
        raise InputError(
            f"{motion.source}: expected a T-pose at {tpose_s[0]:.2f} to {tpose_s[1]:.2f} s, found "
            f"T-poses at {', '.join(f'{spell.start_s:.2f}' for spell in spells)} s; check the "
            "clocks"
        )
    return at_tpose(motion, carried_by, best)


def _overlap(spell: TPose, span_s: NDArray) -> float:
    return min(span_s[1], spell.stop_s) - max(span_s[0], spell.start_s)
