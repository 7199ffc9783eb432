"""Which foot stands when: contact of each frame, stances and events, as rules hand them on."""

from dataclasses import dataclass
from typing import Annotated

import pandas as pd
from numpy.typing import NDArray

from courtside.records import npz, tables
from courtside.study.errors import StrPath

FORM = "courtside contacts 2"
FEET = ("left", "right")
# Of a stance: how the foot came to it; `stand`: it stood when the person was first seen.
KINDS = ("stand", "step", "lunge", "split_step", "jump")
EVENTS = KINDS[1:]

# One row per stance, in order of person and time. Times on the reference clock; a time is empty
# where the take or a gap cuts the stance: then the foot stands from `seen_from_s`, or until
# `seen_until_s`. Between these two it is seen without a gap. Sigma is a standard deviation: 90 % of
# errors should be within 1.645 of it.
STEP_COLUMNS = (
    "person", "foot", "kind", "onset_s", "onset_sigma_s", "end_s", "end_sigma_s", "seen_from_s",
    "seen_until_s", "x_m", "y_m", "sigma_m", "quality",
)  # fmt: skip
# One row per event: the flight that ends in it. A split step and a jump are of both feet (`both`):
# from when the last leaves the floor to when the first lands; the others from when the foot
# leaves to when it lands.
EVENT_COLUMNS = (
    "person", "event", "foot", "start_s", "start_sigma_s", "stop_s", "stop_sigma_s", "x_m", "y_m",
    "quality",
)  # fmt: skip
WORDS = {"person", "foot", "kind", "event"}


@dataclass(frozen=True)
class Contacts:
    """Contact of each foot with the floor in each frame of a take."""

    person_id: Annotated[NDArray, "str P"]
    foot: Annotated[NDArray, "str S"]  # `FEET`
    time_s: Annotated[NDArray, "float T"]  # of the skeletons, on the reference clock
    # That the foot is in contact with the floor, 0 to 1; NaN where the foot is not known
    probability: Annotated[NDArray, "float P T S"]
    held: Annotated[NDArray, "float P T S 2"]  # that its heel and its toe stand, likewise
    # How high heel and toe stand above z = 0 while the foot is flat, metres; NaN where unknown
    floor_m: Annotated[NDArray, "float P S 2"]


def write_contacts(path: StrPath, contacts: Contacts) -> None:
    """Write a `Contacts` to an npz file."""
    npz.write_record(path, FORM, contacts)


def read_contacts(path: StrPath) -> Contacts:
    """Read a `Contacts` from an npz file; raise `InputError` if it is not one."""
    return npz.read_record(path, FORM, Contacts)


def write_steps(path: StrPath, steps: pd.DataFrame) -> None:
    """Write stances, rows of `STEP_COLUMNS`."""
    tables.write(path, steps[list(STEP_COLUMNS)])


def read_steps(path: StrPath) -> pd.DataFrame:
    """Read stances, rows of `STEP_COLUMNS`; raise `InputError` if the file is no such table."""
    return tables.read(path, "a table of steps", lambda t: _fault(t, STEP_COLUMNS, "kind", KINDS))


def write_events(path: StrPath, events: pd.DataFrame) -> None:
    """Write events, rows of `EVENT_COLUMNS`."""
    tables.write(path, events[list(EVENT_COLUMNS)])


def read_events(path: StrPath) -> pd.DataFrame:
    """Read events, rows of `EVENT_COLUMNS`; raise `InputError` if the file is no such table."""
    what = "a table of footwork's events"
    return tables.read(path, what, lambda t: _fault(t, EVENT_COLUMNS, "event", EVENTS))


def _fault(
    table: pd.DataFrame, columns: tuple[str, ...], named: str, known: tuple[str, ...]
) -> str:
    numbers = [name for name in columns if name not in WORDS]
    if fault := tables.column_fault(table, columns, numbers):
        return fault
    strange = sorted(map(str, set(table[named]) - set(known)))
    return f"found {named} {', '.join(strange)}" if strange else ""
