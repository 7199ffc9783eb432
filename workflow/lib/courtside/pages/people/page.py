"""The page on which the persons found in a take are named, split and joined."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from courtside.calibration.court.court import Court
from courtside.pages import page
from courtside.pages.people.strips import Shot
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.people import People

SHOWN = 0.02  # share of the take from which somebody is worth a name
JPEG = "image/jpeg"


def shown(people: People) -> list[int]:
    """Return the persons that the page shows."""
    return [k for k, share in enumerate(people.placed) if share >= SHOWN or k == 0]


def build(
    words: Mapping[str, Any],
    people: People,
    seen: Sequence[Footage],
    columns: Mapping[int, Sequence[int]],
    shots: Sequence[Shot],
    *,
    court: Court | None = None,
    named: Sequence[Mapping[str, Any]] = (),
    rows: Sequence[Sequence[str]] = (),
) -> str:
    """Return the page, to be written by `page.write`.

    `words` are `session`, `take`, `subjects`; `takes`, all that people.csv may name; `target`,
    where the workflow reads this file; `meet_m`, how far apart two tracks of one person may be.
    `columns` are the instants at which each person is shown, `shots` the pictures. `named` are
    names given before: `person`, `subject`, `time_s`, `from_s` and `to_s` of the reference clock;
    `rows` are those of people.csv, of which those of other takes are saved again.
    """
    persons = [_person(people, k, columns[k], shots) for k in columns]
    about = [words["session"], words["take"], persons, list(named)]
    stamp = hashlib.sha256(json.dumps(about, sort_keys=True).encode()).hexdigest()[:16]
    data = {
        **words,
        "stamp": f"{words['session']} {words['take']} {stamp}",
        "start_s": float(people.time_s[0]),
        "stop_s": float(people.time_s[-1]),
        "clocks": {
            one.camera.name: [one.clock.offset_s, 1 + one.clock.drift_ppm * 1e-6] for one in seen
        },
        "court": court and {"size_m": court.size_m, "lines_m": court.lines_m},
        "persons": persons,
        "named": list(named),
        "rows": [list(row) for row in rows],
        "left_out": len(people.person_id) - len(persons),
    }
    title = f"Who is who: {words['session']}, {words['take']}"
    return page.build(
        title,
        page.render("people.html", session=words["session"], take=words["take"]),
        css=["people.css"],
        js=["keeping.js", "csv.js", "people_table.js", "people.js"],
        data={"people": data},
        images={_name(shot): (shot.picture, JPEG) for shot in shots},
    )


def _name(shot: Shot) -> str:
    return f"{shot.person}.{shot.column}.{shot.camera}"


def _person(
    people: People, person: int, columns: Sequence[int], shots: Sequence[Shot]
) -> dict[str, Any]:
    """Return what the page says of one person."""
    own = [shot for shot in shots if shot.person == person]
    known = np.isfinite(people.path[person, :, 0])
    path = np.column_stack([people.time_s, people.path[person, :, :2]])[known]
    return {
        "index": person,
        "name": str(people.person_id[person]),
        "placed": float(people.placed[person]),
        "confidence": float(people.confidence[person]),
        "doubts": people.to_check(person)[:, [1, 2, 4]].tolist(),
        "path": np.round(path, 2).tolist(),
        "columns": [
            {
                "time_s": float(people.time_s[at]),
                "views": [
                    {
                        "camera": shot.camera,
                        "time_s": round(shot.time_s, 3),
                        "at_px": list(shot.at_px),
                        "size_px": round(shot.size_px, 1),
                        "image": _name(shot),
                    }
                    for shot in own
                    if shot.column == column
                ],
            }
            for column, at in enumerate(columns)
        ],
    }
