"""What each source of a take shows: T-poses and claps, by its own clock."""

from dataclasses import dataclass, replace

from courtside.motion import claps as clapping
from courtside.motion import tpose as tposes
from courtside.study.errors import InputError


@dataclass(frozen=True, eq=False)
class Events:
    """T-poses and claps of one source, on its own clock."""

    tposes: list
    claps: list


def shown(motions, devices, stated=()):
    """Return the `Events` of all sources of a take.

    Parameters
    ----------
    motions : list of DeviceMotion
    devices : dict of str to str
        The device of each source.
    stated : collection of str
        Devices whose clock is known: they need no clap.

    Returns
    -------
    happened : dict of str to Events
        By source. Of the sources of one device one must show a clap: they have one clock, and a source with
        T-poses but without a clap has the claps of its device's first source that shows any. A device that
        is alone needs none.

    Raises
    ------
    InputError
        If a device among others shows no T-pose and clap in any of its sources.
    """
    happened, faults = {}, {}
    for motion in motions:
        spells, claps = [], []
        try:
            spells = tposes.find(motion)
            claps = clapping.find(motion, spells)
        except InputError as error:
            faults[motion.source] = error
        happened[motion.source] = Events(spells, claps)
    clapped = {devices[source] for source, each in happened.items() if each.claps} | set(stated)
    for source, error in faults.items():
        if devices[source] not in clapped and len(set(devices.values())) > 1:
            raise error
    return {source: _with_claps(source, happened, devices) for source in happened}


def _with_claps(source, happened, devices):
    """Return the events of a source; without a clap, with those that its device shows in another source.

    Hands that point to a depth camera hide what is behind them: it sees bent arms where its colour does not.
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
