"""Whether a device's file is in the units that it is read in, by the size of a body and the rate.

Formats of devices name no unit, or programs write another one: each check ends in one line that
gives what was found, the unit that would fit, and the key or the line to correct.
"""

import itertools
from collections import deque
from collections.abc import Iterable, Iterator
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from courtside.geometry.camera_fields import METRES
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log

RATES_HZ = (5.0, 500.0)  # ASSUME: no device follows people slower or faster
# ASSUME: times that go wrong for one frame are left out; more of them than this share say that the
# clock was reset, and which part of the take is meant is not known.
MOST_LATE = 0.02
IN_A_ROW = 5  # ASSUME: so many frames one after the other have no stray times
Frame = TypeVar("Frame")


def check_length(
    path: StrPath, what: str, found_m: float, unit: str, limits_m: tuple[float, float]
) -> None:
    """Raise `InputError` unless a length of the body, read in `unit`, lies within limits.

    `what` says in words which length it is. The message names the units in which it would fit.
    """
    least_m, most_m = limits_m
    if least_m <= found_m <= most_m:
        return
    in_file = found_m / METRES[unit]
    fits = [name for name, metres in METRES.items() if least_m <= in_file * metres <= most_m]
    likely = " or ".join(f"{name} ({in_file * METRES[name]:.2f} m)" for name in fits)
    keys = " or ".join(f"`unit: {name}`" for name in fits)
    mend = f"it is likely in {likely}: write {keys} for this device in the session file"
    raise InputError(
        f"{path}: expected {what} of {least_m:g} to {most_m:g} m, found {found_m:.3g} m, read in "
        f"{unit}; {mend if fits else 'export the file again, in metres or centimetres'}"
    )


def check_rate(path: StrPath, time_s: NDArray, mend: str) -> None:
    """Raise `InputError` unless frames at times (T,) come 5 to 500 times a second.

    `mend` says what to do, such as where the file states its rate.
    """
    if len(time_s) < 2:
        return
    step_s = float(np.median(np.diff(time_s)))
    if not 1 / RATES_HZ[1] <= step_s <= 1 / RATES_HZ[0]:
        raise InputError(
            f"{path}: expected {RATES_HZ[0]:g} to {RATES_HZ[1]:g} frames a second, found a frame "
            f"every {step_s:.3g} s; {mend}"
        )


def in_order(path: StrPath, time_s: NDArray) -> NDArray:
    """Return which frames at times (T,) to keep, as indices: those that `following` yields."""
    stamped = ((at, time, None) for at, time in enumerate(time_s.tolist()))
    return np.array([at for at, _, _ in following(path, stamped)], dtype=int)


def following(
    where: StrPath, stamped: Iterable[tuple[int, float, Frame]]
) -> Iterator[tuple[int, float, Frame]]:
    """Yield the frames (number, time, content) in order of both; repeated times are left out.

    A frame whose time alone is ahead of those around it, or behind, is left out with a warning. An
    `InputError` at the end if more than stray frames are out of order: the clock was set or
    restarted. At most `IN_A_ROW + 1` frames are held in memory.
    """
    frames = iter(stamped)
    held = deque(itertools.islice(frames, IN_A_ROW))
    last, last_s, n = -1, -np.inf, 0
    late: list[float] = []
    while held:
        frame = held.popleft()
        number, time_s, _ = frame
        n += 1
        held.extend(itertools.islice(frames, 1))
        rest_s = np.array([other[1] for other in held])
        ahead = len(rest_s) and ((rest_s < time_s) & (rest_s > last_s)).all()
        if time_s > last_s and number > last and not ahead:
            last, last_s = number, time_s
            yield frame
        elif time_s != last_s:
            late.append(time_s)
    if not late:
        return
    found = f"{len(late)} of {n} frames out of order, the first at {late[0]:.3f} s"
    if len(late) > max(1, MOST_LATE * n):
        raise InputError(
            f"{where}: expected times that increase, found {found}; the device's clock was set or "
            "restarted, so that one part of the take has other times: record it again, or cut the "
            "file there and give the parts as takes"
        )
    log.logger.warning("%s: left out: %s", where, found)
