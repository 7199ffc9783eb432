"""Clocks of a take's cameras against the first camera's, with what is known of each, as JSON."""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.study.errors import InputError, StrPath, reading, require_scalar, require_type
from courtside.study.execution.files import read_json, write_json

FORM = "courtside sync 1"
USABLE = ("reference", "found", "assumed")
STATUSES = (*USABLE, "ambiguous", "unknown")
NUMBERS = ("offset_s", "drift_ppm", "uncertainty_s", "drift_uncertainty_ppm")
# ASSUME: speed of the wrist in a fast stroke, to turn an error of a clock into one of position.
WRIST_M_S = 12.0
FEWEST_FRAMES = 30  # ASSUME: a second of motion; with fewer, a camera's clock is not found
LEAST_SHARED = 0.5  # ASSUME: of a part: cameras that share less of it were not meant to
ON_OWN_CLOCK = "`trim_s` cuts each video at the times of its own camera's clock"
NEEDED = {  # to find a clock, by what it is of
    "camera": "film a clap that all cameras see",
    "device": "record a T-pose and a clap of the suit's wearer in view of the cameras",
}


@dataclass(frozen=True)
class Clock:
    """A clock that shows `t_own = t_ref * (1 + drift_ppm * 1e-6) + offset_s`."""

    offset_s: float = 0.0  # its reading when the reference clock shows zero, seconds
    drift_ppm: float = 0.0  # how much faster it runs, millionths
    # Standard deviation of its time against the reference, where in the take this is largest,
    # seconds; NaN where nothing is known. 90 % of errors should lie within 1.645 of it
    uncertainty_s: float = 0.0
    drift_uncertainty_ppm: float = 0.0  # standard deviation of the drift, millionths
    # `reference`, `found`, `assumed` (the session states it), `ambiguous` (several offsets explain
    # the recording), `unknown` (none explains it well enough)
    status: str = "assumed"
    note: str = ""  # one line on how it was found, or why it was not
    # Other offsets that explain the recording about as well, best first
    candidates_s: tuple[float, ...] = ()
    doubt: str = ""  # what speaks against a clock that was found; in the file only where there is

    def __post_init__(self) -> None:
        if self.status not in STATUSES:
            raise ValueError(f"expected a status of {STATUSES}, found {self.status!r}")
        if not (math.isfinite(self.offset_s) and abs(self.drift_ppm) < 1e6):
            raise ValueError(f"expected a finite offset and drift, found {self}")

    @property
    def usable(self) -> bool:
        """Whether triangulation may use it."""
        return self.status in USABLE

    def from_reference(self, time_s: ArrayLike) -> NDArray:
        """Return the readings of this clock at times of the reference clock."""
        return np.asarray(time_s) * (1 + self.drift_ppm * 1e-6) + self.offset_s

    def to_reference(self, time_s: ArrayLike) -> NDArray:
        """Return the times of the reference clock at which this clock shows `time_s`."""
        return (np.asarray(time_s) - self.offset_s) / (1 + self.drift_ppm * 1e-6)


def one_clock(cameras: Iterable[str]) -> dict[str, Clock]:
    """Return the clocks of cameras known to share one; the first is the reference."""
    first, *others = cameras
    shared = Clock(note="the session says that the cameras share a clock")
    return {first: Clock(status="reference"), **dict.fromkeys(others, shared)}


def are_stated(cameras: Sequence[str], clocks: Collection[str]) -> bool:
    """Return whether the clocks of all cameras but the first, the reference, are stated."""
    return all(camera in clocks for camera in cameras[1:])


def stated(numbers: Mapping[str, Mapping[str, Any]]) -> dict[str, Clock]:
    """Return the clocks that a session states.

    `numbers` holds for each camera or device `offset_s`, perhaps `drift_ppm` and `uncertainty_s`.
    """
    return {name: Clock(**clock, note="stated by the session") for name, clock in numbers.items()}


def little_shared(used: Mapping[str, Sequence[float]], clocks: Mapping[str, Clock]) -> str:
    """Return a line if `trim_s`, on the clock of each camera, leaves all of them few common times.

    `used` (start, stop) is what is used of each video, on its own clock, the reference first. The
    line is empty if enough is common.
    """
    spans = [clocks[name].to_reference(span).tolist() for name, span in used.items()]
    shared_s = min(stop for _, stop in spans) - max(start for start, _ in spans)
    shortest_s = min(stop - start for start, stop in spans)
    if shared_s >= LEAST_SHARED * shortest_s:
        return ""
    first, (start_s, stop_s) = next(iter(used.items()))
    begin_s, late = max((float(clocks[name].to_reference(0)), name) for name in used)
    shown_s = max(start_s, begin_s), stop_s
    own = [clocks[name].from_reference(shown_s) for name in used]
    part = min(one[0] for one in own), max(one[1] for one in own)
    starts, stops = zip(*used.values(), strict=True)
    if begin_s >= stop_s or np.allclose(part, (min(starts), max(stops)), atol=0.1):
        remedy = f"end later: camera {late} begins at {begin_s:.2f} s of camera {first}'s clock"
    else:
        shown = f"camera {first} shows from {shown_s[0]:.2f} to {stop_s:.2f} s"
        remedy = f"[{part[0]:.2f}, {part[1]:.2f}] lets all show what {shown}"
    return (
        f"trim_s: all cameras share {max(0.0, shared_s):.2f} of {shortest_s:.2f} s, because "
        f"{ON_OWN_CLOCK}; if that is too little, {remedy}"
    )


def fault_line(where: StrPath, clocks: Mapping[str, Clock], what: str = "camera") -> str:
    """Return a line on the first clock that may not be used; empty if none.

    It begins with `where`; `what` the clocks are of is a key of `NEEDED`.
    """
    for name, clock in clocks.items():
        if not clock.usable:
            # Of an unknown clock they are as good as any.
            told = clock.candidates_s if clock.status == "ambiguous" else ()
            others = ", ".join(f"{at:.3f}" for at in told)
            found = f"{clock.status} ({clock.note})" if clock.note else clock.status
            found += f", possible offsets {others} s" if others else ""
            return (
                f"{where}: {what} {name}: expected a clock that the recording determines, "
                f"found {found}; give its offset_s under clocks of the take, or {NEEDED[what]}"
            )
    return ""


def write(path: StrPath, reference: str, clocks: Mapping[str, Clock]) -> None:
    """Write the clocks of a take; `reference` is the camera whose clock is the take's."""
    if reference not in clocks:
        raise ValueError(f"expected the reference among {list(clocks)}, found {reference!r}")
    tables = {}
    for camera, clock in clocks.items():
        table = asdict(clock)
        # JSON has no NaN.
        table |= {k: float(table[k]) if math.isfinite(table[k]) else None for k in NUMBERS}
        if not clock.doubt:
            del table["doubt"]
        tables[camera] = table | {"candidates_s": [float(at) for at in clock.candidates_s]}
    write_json(path, {"form": FORM, "reference": reference, "cameras": tables})


def read(path: StrPath) -> tuple[str, dict[str, Clock]]:
    """Read the reference camera and the clocks of a take; an `InputError` if it is no such file."""
    content = read_json(path)
    if not isinstance(content, dict) or content.get("form") != FORM:
        found = content.get("form") if isinstance(content, dict) else type(content).__name__
        raise InputError(f"{path}: expected form {FORM!r}, found {found!r}; make it again")
    with reading(path, "a reference and its clock among cameras"):
        tables = require_type(content["cameras"], dict)
        clocks = {camera: _clock(require_type(table, dict)) for camera, table in tables.items()}
        if content["reference"] not in list(clocks):
            raise ValueError(f"the reference {content['reference']!r}, whose clock is missing")
    return content["reference"], clocks


def _clock(table: Mapping[str, Any]) -> Clock:
    numbers = {key: math.nan if table[key] is None else _number(table[key]) for key in NUMBERS}
    candidates = tuple(_number(at) for at in require_type(table["candidates_s"], list))
    return Clock(
        **numbers,
        status=table["status"],
        note=str(table["note"]),
        candidates_s=candidates,
        doubt=str(table.get("doubt", "")),
    )


def _number(value: object) -> float:
    return float(require_scalar(value))
