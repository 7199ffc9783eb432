"""Numbers that no study makes: measured by hand or by a benchmark, or published by others."""

import csv
import math
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path

from courtside.evaluation.numbers.markers import View
from courtside.evaluation.numbers.register import ORIGINS, STUDY, Number, Source
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.files import atomic

FOLDER = "docs/numbers"  # of their tables, one for each command that writes one, and one by hand
COLUMNS = ("table", "row", "part", "printed", "unit", "sessions", "n", "n_failed", "origin")


def numbers(documents: Source) -> list[Number]:
    """Return the numbers of all tables, in the order of their files.

    `documents` is the repository. An `InputError` where a number says neither the command that
    measured it nor where it is published.
    """
    found = []
    for file in documents.names(f"{FOLDER}/*.csv"):
        rows = documents.texts(file)
        if missing := {*COLUMNS, "command"} - set(rows):
            raise InputError(f"{file}: expected columns {sorted(missing)}, found none; add them")
        found += [
            _number(documents, file, line, row)
            for line, row in enumerate(rows.to_dict("records"), start=2)
        ]
    return found


def joined(rows: Iterable[Sequence[object]]) -> list[list[object]]:
    """Join rows of one table, label and first word of the part: `alone`, `alone_shape` to one."""
    found: dict[tuple, list[object]] = {}
    for row in rows:
        key = (row[0], row[1], str(row[2]).partition("_")[0])
        if key in found:
            found[key][3] = f"{found[key][3]}; {row[3]}"
        else:
            found[key] = [*row[:2], key[2], *row[3:]]
    return list(found.values())


def write(path: StrPath, rows: Iterable[Sequence[object]]) -> None:
    """Write the table of one command; each row has the values of `COLUMNS`, then the command."""
    with atomic(path) as new, new.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow([*COLUMNS, "command"])
        table.writerows(rows)


def of_other_sessions(path: StrPath, sessions: Collection[str]) -> list[list[str]]:
    """Return the rows of a table whose sessions are not among these: a new run may keep them."""
    if not Path(path).is_file():
        return []
    with Path(path).open(newline="", encoding="utf-8") as stream:
        before = list(csv.DictReader(stream))
    return [list(row.values()) for row in before if row["sessions"] not in sessions]


def _number(documents: Source, file: str, line: int, row: dict[str, str]) -> Number:
    if row["origin"] not in set(ORIGINS) - {STUDY} or not row["command"]:
        raise InputError(
            f"{file}, line {line}: expected an origin of {ORIGINS[1:]}, and the command or place "
            f"that a number comes from, found {row['origin']!r}, {row['command']!r}; state them"
        )
    counts = {key: int(float(row[key])) if row[key] else None for key in ("n", "n_failed")}
    return Number(
        **{key: row[key] for key in ("table", "row", "part", "printed", "unit", "sessions")},
        **{key: row[key] for key in ("origin", "command")},
        value=_value(row["printed"]),
        source=Path(file).as_posix(),
        selector=f"line {line}",
        n=counts["n"],
        n_failed=counts["n_failed"],
        sha256=documents.sha256(file),
    )


def _value(printed: str) -> float:
    try:
        return float(printed)
    except ValueError:
        return math.nan


FOUND = {"by": "{found.origin}", "with": "{found.command}"}
VIEWS = {  # the columns that the documents show of their tables
    "offset-layouts": View(
        "offset-layouts",
        {
            "cameras and movements": "{row}",
            "raw": "{raw}",
            "fitted on `players-dev`, by posture": "{far}",
            "on all three, by posture": "{posture}",
            "on all three, by posture and view (used)": "{view}",
            "joints": "{view.n}",
            "with": "{view.command}",
        },
    ),
    "low-scores": View(
        "low-scores",
        {
            "limb joints, median / 95 % / 99 %, mm": "{row}",
            "without views of low scores": "{without}",
            "with them where they are needed (used)": "{used}",
            "joints": "{used.n}",
            "with": "{used.command}",
        },
    ),
    "true-cameras": View(
        "true-cameras",
        {
            "corrected, median / 95 %, mm": "{row}",
            "cameras of the study": "{study}",
            "true cameras": "{true}",
            "mean error along x, y, z: cameras of the study": "{study_shift}",
            "true cameras: mean error": "{true_shift}",
            "joints": "{true.n}",
            "with": "{true.command}",
        },
    ),
    "looks": View(
        "looks",
        {
            "`blazepose-heavy`: median / 90 %, mm; above 100 mm, %": "{row}",
            "two bodies, 4 cameras": "{four}",
            "one body, 3 cameras": "{three}",
            "another body, 4 cameras": "{other}",
            "by": "{four.origin}",
            "with": "{four.command}",
        },
    ),
    "persons-found": View(
        "persons-found",
        {
            "persons of 80 px or more; detector": "{row}",
            "found in the whole picture, %": "{whole}",
            "in tiles, as the study looks, %": "{tiles}",
            "persons": "{tiles.n}",
            "by": "{tiles.origin}",
            "with": "{tiles.command}",
        },
    ),
    "stated-errors": View(
        "stated-errors",
        {
            "90 % ellipsoids hold, %": "{row}",
            "target": "{target}",
            **{stage: f"{{{stage}}}" for stage in ("raw", "filtered", "corrected")},
            "by": "{raw.origin}",
            "with": "{raw.command}",
        },
    ),
    "flags": View(
        "flags",
        {
            "flag of errors above 100 mm": "{row}",
            "four views: right / found, %": "{four}",
            "three views: right / found, %": "{three}",
            "by": "{four.origin}",
            "with": "{four.command}",
        },
    ),
    "file-mended": View(
        "file-mended",
        {
            "`walk-4cams`, cameras": "{row}",
            "file as it is": "{found}",
            "mended": "{mended}",
            "by": "{found.origin}",
            "with": "{found.command}",
        },
    ),
    "file-faults": View(
        "file-faults",
        {
            "fault of one camera of four (`players-b/shot`, 6 seeds each)": "{row}",
            "static points: warned, camera and fault named": "{static}",
            "joints": "{joints}",
            "both": "{both}",
            "painted lines": "{lines}",
            "by": "{static.origin}",
            "with": "{static.command}",
        },
    ),
    "exchanged-videos": View(
        "exchanged-videos",
        {
            "pictures": "{row}",
            "sessions": "{sessions}",
            "false alarms with right cameras": "{right}",
            "two exchanged: named rightly": "{exchanged}",
            "all off by one: named rightly": "{shifted}",
            "one wrong in another way: called exchanged": "{otherwise}",
            "by": "{right.origin}",
            "with": "{right.command}",
        },
    ),
    "contacts": View(
        "contacts",
        {
            "takes": "{row}",
            "frames right": "{frames}",
            "landing: error, median / 90 %": "{onset}",
            "in its 90 % interval": "{onset_held}",
            "leaving: error, median / 90 %": "{end}",
            "in that of leaving": "{end_held}",
            "landings found": "{steps}",
            "a standing foot moves": "{moved}",
            "by": "{frames.origin}",
            "with": "{frames.command}",
        },
    ),
    "strokes": View(
        "strokes",
        {
            "takes": "{row}",
            "hits": "{hits}",
            "found (>= 95 %)": "{found}",
            "false (<= 5 %)": "{false}",
            "error of the time in frames, median (<= 1) / 95 %": "{median} / {p95}",
            "in 90 % intervals (80 to 97 %)": "{held}",
            "by": "{hits.origin}",
            "with": "{hits.command}",
        },
    ),
    "rally-hits": View(
        "rally-hits",
        {
            "rallies of two": "{row}",
            "hits": "{hits}",
            "found (>= 95 %)": "{found}",
            "false (<= 5 %)": "{false}",
            "error of the time in frames, median (<= 1) / 95 %": "{median}",
            "in 90 % intervals (80 to 97 %)": "{held}",
            "frames with contact right (>= 97 %)": "{contact}",
            "by": "{hits.origin}",
            "with": "{hits.command}",
        },
    ),
    "reactions": View(
        "reactions",
        {
            "rallies of two: what": "{row}",
            "true": "{true}",
            "found": "{found}",
            "false": "{false}",
            "median error, signed, ms": "{bias}",
            "size of the error, median / 95 %": "{median}",
            "within 40 ms": "{within}",
            "in 90 % intervals (80 to 97 %)": "{held}",
            "by": "{true.origin}",
            "with": "{true.command}",
        },
    ),
    "stroke-cues": View(
        "stroke-cues",
        {
            "extremum nearest to the stroke, less the true hit, in frames": "{row}",
            "overhead: median, sd (within one frame)": "{overhead}",
            "low: median, sd (within one frame)": "{low}",
            "by": "{low.origin}",
            "with": "{low.command}",
        },
    ),
    "ways": View(
        "ways",
        {
            "way": "{row}",
            "alone: volume error, median / 95 %, cm (people alone: joints, mm); shape, cm; "
            "accepted, %": "{alone}",
            "refined by people; refined cameras taken": "{refined}",
        },
        "^`players-b`",
    ),
    "ways-real": View(
        "ways",
        {
            "recording: way": "{row}",
            "alone; accepted views by camera, %": "{alone}",
            "refined by people; which cameras were taken": "{refined}",
        },
        "^`(walk|charuco|hall|easywand)",
    ),
    "wand": View(
        "wand",
        {
            "cameras, noise, lens": "{row}",
            "volume error, median / 95 %, cm": "{volume}",
            "largest angle of a camera, median / largest, degrees": "{angles}",
            "largest error of a focal length, median, %": "{focal}",
            "in 90 % ellipsoids, %": "{hold}",
        },
    ),
    "lines-clicks": View(
        "lines-clicks",
        {
            "hall": "{row}",
            "court found; 18 clicks, median / 95 %, cm; court lines, cm; lines / clicks": "{found}",
        },
    ),
    "walk-lines": View(
        "walk-lines",
        {
            "hall: volume error, median / 95 %, cm; in 90 % ellipsoids": "{row}",
            "cameras with lines": "{seen}",
            "walk, 18 clicks": "{clicks}",
            "walk, 18 clicks, lines": "{both}",
            "walk, lines": "{lines}",
        },
    ),
    "walk-lines-player": View(
        "walk-lines-player",
        {
            "joints, median / 95 %, mm": "{row}",
            "walk, 18 clicks": "{clicks}",
            "walk, 18 clicks, lines": "{both}",
            "true cameras": "{true}",
        },
    ),
    "refined-people": View(
        "refined-people",
        {
            "cameras": "{row}",
            "before": "{before}",
            "taken": "{taken}",
            "shape before": "{shape_before}",
            "shape taken": "{shape}",
            "in 90 % ellipsoids": "{coverage}",
            "by": "{taken.origin}",
            "with": "{taken.command}",
        },
    ),
    "knocked-cameras": View(
        "knocked-cameras",
        {
            "take": "{row}",
            "found": "{found}",
            "turn off, across the view": "{across}",
            "about the optical axis": "{roll}",
            "joints without the knock": "{whole}",
            "with it": "{knocked}",
            "with two poses": "{repaired}",
            "by": "{repaired.origin}",
            "with": "{repaired.command}",
        },
    ),
    "more-of-people": View(
        "more-of-people",
        {
            "cameras": "{row}",
            "volume": "{volume}",
            "limb lengths": "{limbs}",
            "tilt of the floor": "{tilt}",
            "volume, floor level": "{levelled}",
            "with": "{volume.command}",
        },
    ),
    **{
        name: View(
            name,
            {
                first: "{row}",
                **{strength: f"{{{strength}}}" for strength in ("x1", "x2", "x3")},
                "by": "{x1.origin}",
                "with": "{x1.command}",
            },
        )
        for name, first in {"click-model": "halls: clicks", "click-alarms": "clicks"}.items()
    },
    "halls-coverage": View(
        "halls-coverage",
        {
            "hall": "{row}",
            **{
                f"{n} clicks, x1; x2; x3": f"{{n{n}_x1}}; {{n{n}_x2}}; {{n{n}_x3}}"
                for n in (18, 8, 3)
            },
            "with": "{n18_x1.command}",
        },
    ),
    "worlds": View(
        "worlds",
        {
            "effect, strength 1": "{row}",
            "18 clicks, cm": "{walk18}",
            "held, 18": "{held18}",
            "3 clicks, cm": "{walk3}",
            "held, 3": "{held3}",
            "warnings": "{warnings}",
            "by": "{walk18.origin}",
            "with": "{walk18.command}",
        },
    ),
    "speed": View(
        "speed",
        {
            "comparison, largest work": "{row}",
            "here": "{found}",
            "other": "{other}",
            "other / here": "{ratio}",
            **FOUND,
        },
    ),
    "stages": View(
        "stages",
        {
            "stage": "{row}",
            "before": "{before}",
            "after": "{found}",
            "ratio": "{ratio}",
            "profile before": "{profile_before}",
            "profile after": "{profile_after}",
            **FOUND,
        },
    ),
    "faults": View(
        "faults",
        {"fault": "{row}", "times": "{times}", "survived": "{found}", **FOUND},
    ),
    "trust": View(
        "trust",
        {"what was done": "{row}", "times": "{times}", "what happened": "{found}", **FOUND},
    ),
}
