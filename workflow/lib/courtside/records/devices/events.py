"""T-poses and claps that sources show, each on its source's own clock, as JSON."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any, TypeVar

from courtside.study.errors import DAMAGED, InputError, StrPath, reading, require_type
from courtside.study.execution.files import read_json, write_json

FORM = "courtside events 1"
CLAP_WITHIN_S = 3.0  # ASSUME: from a T-pose to its clap; no source but the development takes
Row = TypeVar("Row")


@dataclass(frozen=True)
class TPose:
    """One spell of T-pose. Its measures are medians over the spell, of the worse arm."""

    start_s: float  # first and last frame, on the device's own clock
    stop_s: float
    first: int  # its frames are `first <= frame < stop`
    stop: int
    bend_deg: float  # of the elbow: 0 with shoulder, elbow and wrist in line
    level_deg: float  # of the arm, from square to the trunk
    sideways_deg: float  # of the arm, seen along the trunk, from the line of the shoulders
    speed_per_s: float  # of the wrist against the trunk, half wrist spans per second
    cost: float  # mean square of these four over their limits: the best spell has the least

    @property
    def frames(self) -> slice:
        """The spell as a slice of the device's frames."""
        return slice(self.first, self.stop)


@dataclass(frozen=True)
class Clap:
    """One clap."""

    time_s: float  # first touch of the palms, on the device's own clock
    # Standard deviation; 90 % of errors should be within 1.645 of it. It excludes a constant delay
    # of the device.
    uncertainty_s: float
    tpose: int  # number of the T-pose before it, from 0
    distance_m: float  # of the wrists held together, along their line in the T-pose
    speed_m_s: float  # closing speed of that distance on contact
    smoothing_s: float  # standard deviation of the smoothing by the device
    rebounds: bool  # whether the hands part again at once


@dataclass(frozen=True)
class NoClap:
    """A time at which the hands come together, and why it is no clap to go by."""

    time_s: float
    why: str


@dataclass(frozen=True)
class Events:
    """What one source shows, in order of time.

    `rest` is the rest pose of the device's own model, which nobody performed, if it has one with
    level arms. `fault` tells why there is no T-pose, or else no clap; it is empty if there is one.
    """

    tposes: list[TPose]
    claps: list[Clap]
    no_claps: list[NoClap] = field(default_factory=list)
    rest: TPose | None = None
    fault: str = ""


def write(path: StrPath, found: Mapping[str, Events]) -> None:
    """Write the events of sources by name."""
    tables = {source: asdict(events) for source, events in found.items()}
    write_json(path, {"form": FORM, "sources": tables})


def read(paths: Iterable[StrPath]) -> dict[str, Events]:
    """Read the events of sources, by name, from the files that hold them, in their order.

    Raises
    ------
    InputError
        If a file is not one of `write`.
    """
    found: dict[str, Events] = {}
    for path in paths:
        content = read_json(path)
        if not isinstance(content, dict) or content.get("form") != FORM:
            raise InputError(
                f"{path}: expected a file of form {FORM!r}, found another; make it again"
            )
        with reading(path, "T-poses and claps by source", kinds=DAMAGED):
            found |= {source: _events(table) for source, table in content["sources"].items()}
    return found


def _events(table: Mapping[str, Any]) -> Events:
    return Events(
        tposes=[_row(TPose, row) for row in table["tposes"]],
        claps=[_row(Clap, row) for row in table["claps"]],
        no_claps=[_row(NoClap, row) for row in table["no_claps"]],
        rest=None if table["rest"] is None else _row(TPose, table["rest"]),
        fault=require_type(table["fault"], str),
    )


def _row(kind: type[Row], row: Mapping[str, Any]) -> Row:
    for each in fields(kind):  # type: ignore[arg-type]  # the three classes above
        require_type(row[each.name], each.type)  # type: ignore[arg-type]
    return kind(**row)
