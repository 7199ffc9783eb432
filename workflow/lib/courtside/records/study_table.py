"""One table of the study: a row for each take, person and measure, with quality and provenance."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from courtside.records import tables
from courtside.study.errors import StrPath
from courtside.study.execution import files, verdicts
from courtside.study.execution.verdicts import ALL, DOUBTFUL, GOOD, ORDER, WAY, WHOLE, WRONG_CAMERA

KEY = ("session", "take", *WAY)
MEASURED = ("person", "measure", "value", "sigma", "sigma_camera", "unit", "n", "definition")
# The data dictionary, docs/results.md, describes them.
COLUMNS = (*KEY, *MEASURED, "quality", "provenance", "sha256")
NUMBERS = ("value", "sigma", "sigma_camera", "n")
TEXTS = tuple(name for name in COLUMNS if name not in NUMBERS)
DIGITS = 12  # of a checksum: enough to tell files of one study apart


def of_take(
    measures_csv: StrPath,
    labels: Mapping[str, str],
    quality_csv: StrPath | None,
    provenance: str,
    *,
    camera_errors: bool = True,
) -> pd.DataFrame:
    """Return the measures of a take, measured in one way, in `COLUMNS`.

    `labels` are `KEY`; `quality_csv` has the verdicts on the take, None where nobody judged it;
    `provenance` is the record of what `measures_csv` rests on. Measures of the feet state no
    `sigma_camera`: without `camera_errors` it is empty. An `InputError` if a file is none.
    """
    stated = tuple(name for name in MEASURED if camera_errors or name != "sigma_camera")
    rows = _read(measures_csv, "a summary of measures", stated).reindex(columns=MEASURED)
    judged = _of_persons(quality_csv, labels) if quality_csv else {}
    digest = files.sha256(Path(measures_csv))[:DIGITS]
    more = {"quality": rows["person"].map(judged), "provenance": provenance, "sha256": digest}
    return rows.assign(**labels, **more)[list(COLUMNS)]


def _of_persons(quality_csv: StrPath, labels: Mapping[str, str]) -> dict[str, str]:
    """Return the verdict on each person, measured in one way: at best doubtful by wrong cameras."""
    whole = [
        row
        for row in verdicts.read(quality_csv)
        if row["measure"] == WHOLE
        and row["camera"] == ALL
        and all(row[key] == labels[key] for key in WAY)
    ]
    wrong = any(row["cause"] in WRONG_CAMERA for row in whole)
    least = DOUBTFUL if wrong else GOOD
    return {
        row["person"]: max(row["verdict"], least, key=ORDER.index)
        for row in whole
        if row["person"] != ALL
    }


def read(path: StrPath) -> pd.DataFrame:
    """Read the table of a study, texts empty where nothing is known; an `InputError` if none."""
    return _read(path, "a table of the study", COLUMNS)


def _read(path: StrPath, what: str, columns: tuple[str, ...]) -> pd.DataFrame:
    numbers = [name for name in columns if name in NUMBERS]
    found = tables.read(
        path,
        what,
        lambda table: tables.column_fault(table, columns, numbers),
        dtype=dict.fromkeys(TEXTS, str),
        keep_default_na=False,
        na_values={name: [""] for name in NUMBERS},
    )
    return found[list(columns)]
