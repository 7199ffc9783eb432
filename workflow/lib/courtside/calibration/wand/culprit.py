"""Which camera is wrong where cameras do not agree on a wand: each is left out in turn.

Two cameras alone agree with each other also if one is late or mirrored, only the length of the wand
varies then. Three or more agree only if all are right.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.misfits import COPIES
from courtside.calibration.wand import start
from courtside.calibration.wand.points import Seen, Wand
from courtside.calibration.wand.start import Disagreement, Placed
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

# ASSUME: how far others agree less if a wrong camera is among them. Right cameras of unknown lenses
# may agree on a third of the markers only, with the focal lengths that are tried.
WORSE = 0.5
LOWER = 0.7  # ASSUME: share of a wrong one, relative to that of the others, at most
CLEARER = 0.5  # ASSUME: spread of the wand's length by two right cameras, relative to other pairs
STARTS = 2  # ASSUME: right cameras agree from one of so many starts
MOST = 0.98  # quantile of markers that must be in the picture of a smaller copy


def named(
    fault: Disagreement,
    wand: Wand,
    seen: Seen,
    sizes: Mapping[str, tuple[int, int]],
    lenses: Mapping[str, Camera],
) -> InputError:
    """Return a `fault` that names the camera without which all others agree, and what it lacks.

    If no camera is such, or several are, it names those that do not agree. If all markers are of
    smaller copies of the pictures, it says so.
    """
    cameras = [start.candidates(name, sizes[name], lenses) for name in seen.cameras]
    if copies := _copies(wand, seen, cameras):
        return InputError(copies)
    odd = _odd(fault.accused, wand, seen, cameras) if len(cameras) > 2 else None
    if odd is not None:
        return InputError(_of_one(odd[0], odd[1], seen, cameras))
    if not fault.accused or len(cameras) < 3:
        return fault
    others = ", ".join(name for name in seen.cameras if name != fault.accused)
    found = str(fault).partition(": ")[2]
    return InputError(
        f"camera {fault.accused} or others of {others}, which one is not clear: {found}"
    )


def _copies(wand: Wand, seen: Seen, cameras: Sequence[Sequence[Camera]]) -> str:
    """Return a line if all cameras agree once all markers are multiplied; empty if they do not."""
    fits = {}
    for times in COPIES:
        if all(_inside(xy * times, one[0]) for xy, one in zip(seen.xy, cameras, strict=True)):
            whole = _placed(wand, replace(seen, xy=seen.xy * times), cameras)
            if whole is not None and not whole.fault:
                fits[times] = whole.agreeing
    if not fits:
        return ""
    return (
        "wand: expected markers in px of the cameras' pictures, found some of smaller copies: the "
        f"cameras agree once all are multiplied; multiply x_px and y_px by "
        f"{max(fits, key=lambda times: fits[times]):g}"
    )


def _inside(xy: NDArray, camera: Camera) -> bool:
    most = np.nanquantile(xy.reshape(-1, 2), MOST, axis=0)
    return bool((most < camera.size).all())


def _placed(wand: Wand, seen: Seen, cameras: Sequence[Sequence[Camera]]) -> Placed | None:
    """Return the cameras, with a fault if they do not agree; None if all pairs are too close."""
    try:
        return start.placed(wand, seen, cameras, STARTS)
    except InputError:
        return None


def _odd(
    accused: str, wand: Wand, seen: Seen, cameras: Sequence[Sequence[Camera]]
) -> tuple[int, Placed] | None:
    """Return the camera without which the others agree, and the others; None if it is not clear."""
    rests: dict[int, Placed] = {}
    for c in sorted(range(len(cameras)), key=lambda c: seen.cameras[c] != accused):
        keep = [k for k in range(len(cameras)) if k != c]
        others = replace(seen, cameras=tuple(seen.cameras[k] for k in keep), xy=seen.xy[keep])
        rest = _placed(wand, others, [cameras[k] for k in keep])
        if rest is None:
            continue
        rests[c] = rest
        if len(keep) > 2 and rest.agreeing >= start.ENOUGH:
            return c, rest  # three cameras agree so well only if all are right
    if len(cameras) > 3:
        share = {c: rest.agreeing + bool(rest.fault) for c, rest in rests.items()}
        order = sorted(rests, key=lambda c: -rests[c].agreeing)
        best, second = ([share[c] for c in order] + [0.0, 0.0])[:2]
        clear = bool(order) and not rests[order[0]].fault and second < WORSE * best
    else:
        order = sorted((c for c in rests if not rests[c].fault), key=lambda c: rests[c].spread)
        best, second = ([rests[c].spread for c in order] + [np.inf, np.inf])[:2]
        clear = best < CLEARER * second
    return (order[0], rests[order[0]]) if clear else None


def _of_one(c: int, rest: Placed, seen: Seen, cameras: Sequence[Sequence[Camera]]) -> str:
    """Return what is found of a camera that does not agree with the others, and what to do."""
    xyz = start.positions(list(rest.cameras.values()), seen)
    count, shown, camera = start.resected(cameras[c], seen.xy[c], xyz)
    line = (
        f"camera {camera.name}: expected most of its markers to agree with the other cameras, "
        f"which agree with each other, found {count} of {shown}"
    )
    for xy, mend in _changes(seen.xy[c], camera):
        agreeing, tried, _ = start.resected(cameras[c], xy, xyz)
        if agreeing >= start.LEAST_AGREEING * tried and count < LOWER * agreeing:
            return f"{line}, and {agreeing} {mend}"
    return f"{line}; {start.mend(count, shown)}"


def _changes(xy: NDArray, camera: Camera) -> Iterator[tuple[NDArray, str]]:
    """Yield markers (F, M, 2) after a usual mistake is undone, and what it is."""
    width, height = camera.size
    yield (
        xy * [1, -1] + [0, height - 1],
        "once mirrored; undo the flip of its video, or, if its y_px are counted from the bottom, "
        "subtract them from the picture's height minus 1",
    )
    for times in COPIES:
        if _inside(xy * times, camera):
            yield (
                xy * times,
                f"times {times:g}: they are of a smaller copy of its picture, which has {width} x "
                f"{height} px; multiply x_px and y_px by {times:g}",
            )
