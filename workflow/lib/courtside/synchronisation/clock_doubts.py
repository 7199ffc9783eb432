"""What speaks against the clock of a device that its claps gave: the motion of the whole take."""

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.study.errors import InputError
from courtside.synchronisation import smooth_tracks
from courtside.synchronisation.motion_signals import Signals

BETTER = 0.15  # ASSUME: correlation by which motion must prefer something else, as for two pairings
# ASSUME: least correlation at another offset. The true one has 0.85 with a network of one camera
# and 0.99 with good sources; wrong ones had 0.25 at most on takes of the virtual gym.
LEAST_ALIKE = 0.5
# ASSUME: share of the shorter recording that devices of one take have in common, and the shortest
# time in which chance does not make motions alike.
COMMON_SHARE, COMMON_S = 0.5, 10.0
SAME_S = 1.0  # ASSUME: offsets that differ by less are one: the motion's peak is that wide


def refuse_other_claps(signals: Signals, offset_s: float, where: str) -> None:
    """Raise `InputError` if the motions say that one clap of each device is not the same clap.

    Each device may have missed another clap. That is told by another offset with much common time,
    at which the motions are more alike than at `offset_s` of the claps; or about as alike, where
    the claps leave little in common. `where` begins the message.
    """
    offsets_s, alike, common_s, least_s = _scan(signals)
    here = int(np.argmin(np.abs(offsets_s - offset_s)))
    there = (np.abs(offsets_s - offset_s) > SAME_S) & (common_s >= max(least_s, COMMON_S))
    if not there.any():
        return
    best = int(np.argmax(np.where(there, alike, -np.inf)))
    least = alike[here] + (-BETTER if common_s[here] < least_s else BETTER)
    if alike[best] < max(LEAST_ALIKE, least):
        return
    raise InputError(
        f"{where}: expected motions that are most alike where the claps meet, at an offset of "
        f"{offset_s:.2f} s, found a correlation of {alike[here]:.2f} over {common_s[here]:.0f} s "
        f"there, and {alike[best]:.2f} over {common_s[best]:.0f} s at {offsets_s[best]:.2f} s: "
        "each device probably missed the other's clap; give the device's offset_s under clocks of "
        "the take"
    )


def _scan(signals: Signals) -> tuple[NDArray, NDArray, NDArray, float]:
    """Return offsets (L,), correlation and common time (L,) s, and the least common time, s."""
    step_s = max(track.step_s for track in signals.tracks)
    starts_s, values = [], []
    for track in signals.tracks:
        count = int((track.values.shape[1] - 1) * track.step_s / step_s) + 1
        time_s = track.start_s + step_s * np.arange(count)
        values.append(smooth_tracks.sample(track, time_s)[0][0, :, :, 0])
        starts_s.append(track.start_s)
    known = [np.isfinite(value).astype(float) for value in values]
    first, second = (np.nan_to_num(value) for value in values)

    def across(one: NDArray, other: NDArray) -> NDArray:
        return scipy.signal.fftconvolve(one, other[::-1], axes=0)

    size = across(second**2, known[0]) * across(known[1], first**2)
    size = np.sqrt(np.where(size > 1e-9 * size.max(), size, np.inf))
    alike = np.median(across(second, first) / size, axis=1)
    shown = [each.any(axis=1).astype(float)[:, None] for each in known]
    common_s = step_s * across(shown[1], shown[0])[:, 0]
    lags = np.arange(len(alike)) - (len(first) - 1)
    least_s = COMMON_SHARE * step_s * min(each.sum() for each in shown)
    return starts_s[1] - starts_s[0] + step_s * lags, alike, common_s, float(least_s)
