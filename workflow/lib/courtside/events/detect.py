"""T-poses and claps of every source of a take, and the tables that list them."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from courtside.events import claps as clapping
from courtside.events import tpose
from courtside.events.claps import Clap
from courtside.events.tpose import TPose
from courtside.records.devices.clocks import Clock
from courtside.records.devices.device_motion import DeviceMotion
from courtside.study.errors import InputError


@dataclass(frozen=True, eq=False)
class Events:
    """T-poses and claps of one source, on its own clock."""

    tposes: list[TPose]
    claps: list[Clap]


def shown(
    motions: Sequence[DeviceMotion], devices: Mapping[str, str], stated: Collection[str] = ()
) -> dict[str, Events]:
    """Find the events of all sources of a take.

    Parameters
    ----------
    devices : dict of str to str
        The device of each source.
    stated : collection of str
        Devices whose clock is known: they need no clap.

    Returns
    -------
    happened : dict of str to Events
        By source. One source of each device must show a clap, because they share a clock. A source
        with T-poses but without a clap gets the claps of its device's first source with claps. A
        device that is alone needs none.

    Raises
    ------
    InputError
        If a device among others shows no T-pose and clap in any of its sources.
    """
    happened, faults = {}, {}
    for motion in motions:
        spells: list[TPose] = []
        claps: list[Clap] = []
        try:
            spells = tpose.find(motion)
            claps = clapping.find(motion, spells)
        except InputError as error:
            faults[motion.source] = error
        happened[motion.source] = Events(spells, claps)
    clapped = {devices[source] for source, each in happened.items() if each.claps} | set(stated)
    for source, fault in faults.items():
        if devices[source] not in clapped and len(set(devices.values())) > 1:
            raise fault
    return {source: _with_claps(source, happened, devices) for source in happened}


def _with_claps(source: str, happened: dict[str, Events], devices: Mapping[str, str]) -> Events:
    """Return the events of a source; without claps, with those of its device's other sources.

    Hands that point to a depth camera hide what is behind them: it sees bent arms, its colour
    camera does not.
    """
    own = happened[source]
    if own.claps or not own.tposes:
        return own
    of_device = [each for name, each in happened.items() if devices[name] == devices[source]]
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
    return Events(own.tposes, claps)


EVENT_COLUMNS = [
    "source",
    "event",
    "number",
    "time_s",
    "own_time_s",
    "uncertainty_s",
    "used",
    "why",
]


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


def events(
    motions: Sequence[DeviceMotion], clocks: Mapping[str, Clock] | None = None
) -> pd.DataFrame:
    """Return T-poses, claps, and times at which hands come together without a clap.

    Columns: source; event: `tpose_start`, `tpose_stop`, `clap` or `none`; number: of the T-pose,
    from 1; time_s: on the reference clock, by the clocks of `wrists`; own_time_s; uncertainty_s: of
    claps; used: whether the clap counts or it belongs to a T-pose; why: if not used. A source
    without a T-pose has one row with the reason; no error is raised.
    """
    clocks = clocks or {}
    rows = [row for motion in motions for row in _events(motion)]
    table = pd.DataFrame(rows, columns=EVENT_COLUMNS)
    table["time_s"] = [
        float(clocks.get(source, Clock()).to_reference(own_s))
        for source, own_s in zip(table["source"], table["own_time_s"], strict=True)
    ]
    return table


def _events(motion: DeviceMotion) -> Iterator[dict[str, object]]:
    try:
        spells = tpose.find(motion)
    except InputError as error:
        spells, why = [], str(error)
        yield {"source": motion.source, "event": "none", "used": False, "why": why}
    for number, spell in enumerate(spells, 1):
        for name, at_s in (("tpose_start", spell.start_s), ("tpose_stop", spell.stop_s)):
            about = {"source": motion.source, "event": name, "number": number}
            yield about | {"own_time_s": at_s, "used": True, "why": ""}
    for candidate in clapping.candidates(motion, spells):
        row = {"source": motion.source, "event": "none", "used": False, "why": candidate.why}
        row["own_time_s"] = candidate.time_s
        if candidate.clap:
            row |= {"event": "clap", "number": candidate.clap.tpose + 1, "used": True}
            row["uncertainty_s"] = candidate.clap.uncertainty_s
        yield row


def checks(found: Mapping[str, Any]) -> pd.DataFrame:  # Any: the type is in a higher room
    """Return one row per source: the estimates of its `synchronisation.devices.Found`."""
    rows = []
    for source, one in found.items():
        clock = {key: getattr(one.clock, key) for key in ("offset_s", "drift_ppm", "uncertainty_s")}
        rest = {key: value for key, value in vars(one).items() if key not in ("clock", "claps")}
        about = {"source": source, "status": one.clock.status, **clock}
        about["drift_uncertainty_ppm"] = one.clock.drift_uncertainty_ppm
        rows.append(about | {"n_claps": len(one.claps)} | rest)
    return pd.DataFrame(rows)
