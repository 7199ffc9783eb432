"""T-poses and claps of every source of a take, and the tables that list them."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from courtside.events import claps as clapping
from courtside.events import tpose
from courtside.records.devices.clocks import Clock
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.devices.events import Clap, Events, NoClap, TPose
from courtside.study.errors import InputError


def detect(motions: Sequence[DeviceMotion]) -> dict[str, Events]:
    """Return what each source shows by itself; one that shows nothing has a `fault`."""
    return {motion.source: _detect(motion) for motion in motions}


def _detect(motion: DeviceMotion) -> Events:
    spells, fault = [], ""
    try:
        spells = tpose.find(motion)
    except InputError as error:
        fault = str(error)
    claps, no_claps = clapping.find(motion, spells)
    if not (claps or fault):
        fault = clapping.none_counts(motion.source, no_claps)
    return Events(spells, claps, no_claps, _rest(motion), fault)


def _rest(motion: DeviceMotion) -> TPose | None:
    try:
        return tpose.rest(motion)
    except InputError:
        return None


def of_devices(
    found: Mapping[str, Events], devices: Mapping[str, str], stated: Collection[str] = ()
) -> dict[str, Events]:
    """Give the sources of a take the claps that their devices show; `devices` by source.

    One source of each device must show a clap, because they share a clock. A source with T-poses
    but without a clap gets the claps of its device's first source with claps. A device whose
    clock is `stated` needs no clap; nor does the first, the reference, where all others' are, or
    where it is alone. An `InputError` if a device that needs them shows no T-pose and clap in any
    of its sources; it has a line for each source of all such devices.
    """
    clapped = {devices[source] for source, each in found.items() if each.claps} | set(stated)
    reference = devices[next(iter(found))]
    sought = {*devices.values()} - {reference, *stated}
    faults = [
        each.fault
        for source, each in found.items()
        if each.fault and devices[source] not in clapped and sought
    ]
    if faults:
        raise InputError(*faults)
    return {source: _with_claps(source, found, devices) for source in found}


def _with_claps(source: str, found: Mapping[str, Events], devices: Mapping[str, str]) -> Events:
    """Return the events of a source; without claps, with those of its device's other sources.

    Hands that point to a depth camera hide what is behind them: it sees bent arms, its colour
    camera does not.
    """
    own = found[source]
    if own.claps or not own.tposes:
        return own
    of_device = [each for name, each in found.items() if devices[name] == devices[source]]
    shared = next((each for each in of_device if each.claps), own)
    claps = []
    for clap in shared.claps:
        theirs = shared.tposes[clap.tpose]
        same = [
            number
            for number, spell in enumerate(own.tposes)
            if spell.start_s <= theirs.stop_s and theirs.start_s <= spell.stop_s
        ]
        if same:  # the last, where theirs fell into several
            claps.append(replace(clap, tpose=same[-1]))
    return replace(own, claps=claps)


EVENT_COLUMNS = [
    "source", "event", "number", "time_s", "own_time_s", "uncertainty_s", "used", "why",
]  # fmt: skip


def wrists(
    motions: Sequence[DeviceMotion], clocks: Mapping[str, Clock] | None = None
) -> pd.DataFrame:
    """Return the distance of the wrists over time.

    Clocks are of each source against the reference; without one `time_s` is the source's own.
    Columns: source, time_s: on the reference clock, own_time_s, distance_m: in space, empty if
    missing.
    """
    clocks = clocks or {}
    parts = [
        pd.DataFrame(
            {
                "source": motion.source,
                "time_s": clocks.get(motion.source, Clock()).to_reference(motion.time_s),
                "own_time_s": motion.time_s,
                "distance_m": np.where(motion.performed, clapping.wrist_distance(motion), np.nan),
            }
        )
        for motion in motions
    ]
    return pd.concat(parts, ignore_index=True)


def events(found: Mapping[str, Events], clocks: Mapping[str, Clock] | None = None) -> pd.DataFrame:
    """Return T-poses, claps, and times at which hands come together without a clap.

    Columns: source; event: `tpose_start`, `tpose_stop`, `clap` or `none`; number: of the T-pose,
    from 1; time_s: on the reference clock, by the clocks of `wrists`; own_time_s; uncertainty_s: of
    claps; used: whether the clap counts or it belongs to a T-pose; why: if not used. A source
    without a T-pose has one row with the reason.
    """
    clocks = clocks or {}
    rows = [{"source": source, **row} for source, own in found.items() for row in _rows(own)]
    table = pd.DataFrame(rows, columns=EVENT_COLUMNS)
    table["time_s"] = [
        float(clocks.get(source, Clock()).to_reference(own_s))
        for source, own_s in zip(table["source"], table["own_time_s"], strict=True)
    ]
    return table


def _rows(own: Events) -> Iterator[dict[str, object]]:
    if not own.tposes:
        yield {"event": "none", "used": False, "why": own.fault}
    for number, spell in enumerate(own.tposes, 1):
        for name, at_s in (("tpose_start", spell.start_s), ("tpose_stop", spell.stop_s)):
            yield {"event": name, "number": number, "own_time_s": at_s, "used": True, "why": ""}
    together: list[Clap | NoClap] = [*own.claps, *own.no_claps]
    for one in sorted(together, key=lambda one: one.time_s):
        row = {"event": "none", "own_time_s": one.time_s, "used": False}
        if isinstance(one, NoClap):
            yield row | {"why": one.why}
        else:
            row |= {"event": "clap", "number": one.tpose + 1, "used": True, "why": ""}
            yield row | {"uncertainty_s": one.uncertainty_s}
