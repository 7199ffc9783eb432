"""Which claps of one device are which claps of another."""

from itertools import product

import numpy as np

from courtside.study.errors import InputError

SAME_S = 0.12  # claps that differ by less, after the offset, may be one
SAME_PPM = 500.0  # of the time between two claps
BETTER = 0.15  # correlation by which the motion must prefer one pairing


def pair(first, second, likeness, where):
    """Pair the claps of two devices.

    Parameters
    ----------
    first, second : list of courtside.events.claps.Clap
    likeness : callable
        Of an offset in seconds: how alike the motions of both are with it, a correlation.
    where : str
        To begin the line of an error.

    Returns
    -------
    pairs : list of (Clap, Clap)
        As many as one offset explains; of several such offsets, the one with the motions more alike.

    Raises
    ------
    InputError
        If several offsets explain equally many claps and the motion does not tell them apart.
    """
    choices = {}
    for one, other in product(first, second):
        offset = other.time_s - one.time_s
        pairs = _matched(first, second, one, offset)
        choices[tuple((first.index(a), second.index(b)) for a, b in pairs)] = pairs
    most = max(map(len, choices.values()))
    best = sorted(
        ((likeness(offset_s(pairs)), pairs) for pairs in choices.values() if len(pairs) == most),
        key=lambda choice: -choice[0],
    )
    if len(best) > 1 and best[0][0] < best[1][0] + BETTER:
        times = [", ".join(f"{clap.time_s:.2f}" for clap in claps) for claps in (first, second)]
        offsets = ", ".join(f"{offset_s(pairs):.2f}" for _, pairs in best)
        raise InputError(
            f"{where}: expected claps that pair in one way, found {len(best)} ways (offsets {offsets} s): "
            f"claps at {times[1]} s against {times[0]} s; give the device's offset_s under clocks of the take"
        )
    return best[0][1]


def offset_s(pairs):
    """Return the mean offset of the second device of pairs of claps, surer ones counting more."""
    weight = [1 / (a.uncertainty_s**2 + b.uncertainty_s**2) for a, b in pairs]
    return float(np.average([b.time_s - a.time_s for a, b in pairs], weights=weight))


def _matched(first, second, anchor, offset):
    """Return the pairs of claps that an offset explains, given at one clap of the first device."""
    pairs = []
    for one in first:
        apart = [abs(other.time_s - one.time_s - offset) for other in second]
        nearest = int(np.argmin(apart))
        if apart[nearest] <= SAME_S + 1e-6 * SAME_PPM * abs(one.time_s - anchor.time_s):
            pairs.append((one, second[nearest]))
    return pairs
