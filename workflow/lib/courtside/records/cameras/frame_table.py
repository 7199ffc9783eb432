"""The table of extracted frames: source, sharpness, and whether each may be used."""

import numpy as np
import pandas as pd

from courtside.records import tables
from courtside.study.errors import StrPath

COLUMNS = ("frame_idx", "time_s", "name", "sharpness", "kept", "reason", "photo")
NUMBERS = ("frame_idx", "time_s", "sharpness", "kept")
REASONS = ("", "dark", "blurred", "duplicate")  # why a frame is not kept; empty if it is
OF_PHOTOS = {  # what they mean of a photo, which has no film around it
    "dark": "dark",
    "blurred": "far less sharp than the photos around it (blurred, or of another place)",
    "duplicate": "as the one before it",
}


def write(path: StrPath, table: pd.DataFrame) -> None:
    """Write a frame table as CSV; a `ValueError` if it does not meet this description.

    One row per extracted frame: `frame_idx` (of the video; of photos, the place in name order),
    `time_s` (since the video's first frame; NaN for photos), `name` (of the PNG file), `sharpness`
    (variance of the Laplacian, squared grey levels), `kept` (bool), `reason` ("" where kept),
    `photo` (a photo's own file name; "" for frames of a video).
    """
    fault = _fault(table)
    if fault:
        raise ValueError(f"{path}: {fault}")
    table = table.loc[:, list(COLUMNS)].assign(
        time_s=table["time_s"].round(6),
        sharpness=table["sharpness"].round(3),
        kept=table["kept"].astype(int),
    )
    tables.write(path, table, float_format=None)


def read(path: StrPath) -> pd.DataFrame:
    """Read a table as `write` describes it; raise `InputError` if the file is no such table."""
    table = tables.read(
        path, "a frame table", _fault, keep_default_na=False, na_values={"time_s": [""]}
    )
    return table.loc[:, list(COLUMNS)].assign(kept=table["kept"].astype(bool))


def _fault(table: pd.DataFrame) -> str:
    """Return in a few words what is wrong with a table; empty if nothing is."""
    if fault := tables.column_fault(table, COLUMNS, NUMBERS):
        return fault
    if not len(table) or np.any(np.diff(table["frame_idx"]) <= 0) or not table["name"].is_unique:
        return "found no frames, or not each once in order"
    if not set(table["kept"]) <= {0, 1} or not set(table["reason"]) <= set(REASONS):
        return f"found kept other than 0 and 1, or a reason not of {', '.join(REASONS[1:])}"
    if np.any(table["kept"].astype(bool) != (table["reason"] == "")):
        return "found a reason beside a kept frame, or none beside another"
    if table["name"].astype(str).str.contains(r"[/\\]|^\.").any():
        return "found the name of a file elsewhere"
    return ""
