"""Verdicts on takes: read from their files, and summarised at the end of a run."""

import csv
from collections.abc import Iterable
from pathlib import Path

from courtside.study.errors import InputError, StrPath, reading

GOOD, DOUBTFUL, FAILED = ORDER = ("good", "doubtful", "failed")
ALL = "all"  # in place of a camera or a person
WHOLE = "whole"  # in place of a measure: the verdict on a camera, a person or the take
CALIBRATION, CLOCK, EXCHANGED = "calibration", "clock", "exchanged"
# Causes that a camera is wrong, and with it whatever the take measures; the others cost keypoints.
WRONG_CAMERA = (CALIBRATION, CLOCK, EXCHANGED)
WAY = ("calibration", "fusion", "model")  # how the take was measured: the first columns
COLUMNS = ["camera", "person", "measure", "value", "doubtful_from", "failed_from", "verdict"]
COLUMNS += ["cause", "sentence"]


def read(path: StrPath) -> list[dict[str, str]]:
    """Read the rows of a table of verdicts; an `InputError` if it is none."""
    with (
        reading(path, "a table of verdicts", "delete it and run the study again"),
        Path(path).open(encoding="utf-8", newline="") as file,
    ):
        table = csv.DictReader(file)
        rows, columns = list(table), table.fieldnames
    if columns != [*WAY, *COLUMNS] or any(row["verdict"] not in ORDER for row in rows):
        raise InputError(
            f"{path}: expected a table of verdicts, found other columns or verdicts; delete it "
            "and run the study again"
        )
    return rows


def of_takes(rows: Iterable[dict[str, str]]) -> list[dict[str, str]]:
    """Return the rows that are the verdict on a take, one for each way in which it was measured."""
    return [
        row
        for row in rows
        if row["measure"] == WHOLE and row["camera"] == ALL and row["person"] == ALL
    ]


def failed(path: StrPath) -> bool:
    """Return whether a take has been judged, and failed in one of its ways."""
    if not Path(path).is_file():
        return False
    try:
        return any(row["verdict"] == FAILED for row in of_takes(read(path)))
    except InputError:
        return True  # it must be made again


def summary(files: Iterable[str]) -> tuple[list[str], int]:
    """Return lines that summarise the verdicts on some takes, and the number of failed takes.

    A line counts them; one follows for each that is not good, those that failed last.
    """
    worst: dict[str, str] = {}
    lines: list[tuple[int, str]] = []
    for path in files:
        takes = of_takes(read(path))
        worst[path] = max((row["verdict"] for row in takes), key=ORDER.index, default=FAILED)
        name = "/".join(Path(path).parts[i] for i in (-4, -2))
        for row in takes:
            if row["verdict"] != GOOD:
                way = " ".join(row[key] for key in WAY)
                line = f"  {row['verdict']}: {name} ({way}): {row['sentence']} See {path}."
                lines.append((ORDER.index(row["verdict"]), line))
    if not worst:
        return [], 0
    verdicts = list(worst.values())
    counts = [f"{verdicts.count(word)} {word}" for word in ORDER if word in verdicts]
    sentences = [line for _, line in sorted(lines, key=lambda pair: pair[0])]
    return [f"Verdicts on takes: {', '.join(counts)}.", *sentences], verdicts.count(FAILED)
