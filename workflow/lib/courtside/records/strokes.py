"""Strokes and reactions to them, as rules hand them on."""

from collections.abc import Sequence

import pandas as pd

from courtside.records import tables
from courtside.study.errors import StrPath

STROKE_COLUMNS = [
    "person", "time_s", "sigma_s", "hand", "hand_from", "overhead", "height_m", "x_m", "y_m",
    "speed_m_s", "quality",
]  # fmt: skip
REACTION_COLUMNS = [
    "person", "opponent", "hit_s", "split_start_s", "split_stop_s", "first_step_s", "to_split_s",
    "to_split_sigma_s", "to_step_s", "to_step_sigma_s", "split_to_step_s", "split_to_step_sigma_s",
]  # fmt: skip


def read(path: StrPath) -> pd.DataFrame:
    """Read strokes; raise `InputError` if the file is no such table."""
    return _read(path, "a table of strokes", STROKE_COLUMNS)


def read_reactions(path: StrPath) -> pd.DataFrame:
    """Read reactions; raise `InputError` if the file is no such table."""
    return _read(path, "a table of reactions", REACTION_COLUMNS)


def _read(path: StrPath, what: str, columns: Sequence[str]) -> pd.DataFrame:
    numbers = [name for name in columns if name.endswith(("_s", "_m")) or name == "quality"]
    return tables.read(path, what, lambda rows: tables.column_fault(rows, columns, numbers))
