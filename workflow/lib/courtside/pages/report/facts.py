"""The facts on a take and a session for the report, read from the files of the study."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.kinematics import cutoffs
from courtside.records import tables
from courtside.records.devices import clocks
from courtside.records.keypoints import keypoints, missing_reason, skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics.normal_errors import WITHIN_90
from courtside.study.errors import StrPath
from courtside.study.execution import verdicts
from courtside.study.execution.files import read_json

SUMMARY = ("person", "measure", "value", "sigma", "sigma_camera", "unit", "n")
OBSERVED = {"static": "points at rest", "people": "people"}  # by a check of a calibration file
FRAMES = ("person", "time_s", "neck_reason")
KNOWN = [missing_reason.WORDS[code] for code in (missing_reason.OK, missing_reason.INTERPOLATED)]
# ASSUME: who is there for less of a take may be a substitute, or a player whose track was lost.
LEAST_THERE = 0.5
FOOTWORK = ("person", "measure", "value", "sigma", "unit", "n")


def of_take(files: dict) -> dict:
    """Read the facts of a take.

    `persons`: {person: {measure: (value, half of the 90 % interval, unit)}}; `footwork` likewise;
    `cutoffs`: {group of joints: Hz}; `strokes`: {person: rows}; `left_out`: {person: (frames
    without a neck, frames, {reason: frames}, when)}, while the person is there, and when that is;
    `part`: {person: when}, of those who are there for less than half of the take; `seconds`:
    {person: (of the path, when)}; `joints` and `cameras` as `of_skeleton` returns them;
    `clocks`: {camera: Clock}; `shake`: lines; `movement`, `devices`, `truth`,
    `true_paths` and `quality`: rows. Empty without a file. `InputError` if a file is missing or has
    another content.

    `files` are paths by `summary`, `frames` and `cutoffs` (kinematics), `footwork`, `strokes`,
    `pose3d`, `sync`, `movement` (a list), `shake` (text), `checks` (clocks of devices), `errors`
    and `kinematics` (against the truth), and by `quality` the `file` of verdicts and the `way` in
    which the take was measured; each may be left out.
    """
    facts: dict = {"persons": {}, "left_out": {}, "part": {}, "seconds": {}}
    facts |= {"joints": {}, "cameras": {}}
    if files.get("summary"):
        facts["persons"] = _measures(_table(files["summary"], SUMMARY))
        frames = _table(files["frames"], FRAMES)
        by_person = list(frames.groupby("person"))
        facts["left_out"] = {p: _left_out(rows) for p, rows in by_person}
        short = [(p, rows) for p, rows in by_person if _there(rows).mean() < LEAST_THERE]
        facts["part"] = {p: _when(rows, rows[_there(rows)]) for p, rows in short}
        facts["seconds"] = {p: _seconds(rows) for p, rows in by_person}
    steps = _table(files["footwork"], FOOTWORK) if files.get("footwork") else None
    facts["footwork"] = {} if steps is None else _measures(steps.assign(sigma_camera=np.nan))
    facts["cutoffs"] = cutoffs.read(files["cutoffs"])[0] if files.get("cutoffs") else {}
    hits = _rows(files, "strokes", ("person", "hand", "overhead"))
    facts["strokes"] = {str(row["person"]): [] for row in hits}
    for row in hits:
        facts["strokes"][str(row["person"])].append(row)
    if files.get("pose3d"):
        facts |= of_skeleton(keypoints.read_3d(files["pose3d"]))
    facts["clocks"] = clocks.read(files["sync"])[1] if files.get("sync") else {}
    facts["movement"] = [_row(path) for path in files.get("movement", ())]
    text = Path(files["shake"]).read_text(encoding="utf-8") if files.get("shake") else ""
    facts["shake"] = [line.strip() for line in text.splitlines() if line.strip()]
    facts["devices"] = _rows(files, "checks", ("source", "status"))
    errors = _rows(files, "errors", ("stage", "fusion", "person", "joint", "median_mm"))
    # Of one person alone there are no rows of all.
    facts["truth"] = [row for row in errors if row["person"] == "all"] or errors
    facts["quality"] = _verdicts(**files["quality"]) if files.get("quality") else []
    facts["true_paths"] = _rows(files, "kinematics", ("person", "point", "distance_error_percent"))
    return facts


def _verdicts(file: StrPath, way: dict[str, str]) -> list[dict]:
    """Return the verdicts on a take that was measured in one way; a value is a number or NaN."""
    rows = [row for row in verdicts.read(file) if all(row[key] == way[key] for key in way)]
    numbers = ("value", "doubtful_from", "failed_from")
    return [{**row, **{key: float(row[key] or "nan") for key in numbers}} for row in rows]


def of_session(files: dict) -> dict:
    """Read the facts of a session's cameras.

    `quality`: {calibration: content}; `model`: content, empty without a file; `static`: rows.
    `files` are paths by `quality`: {calibration: file}, `checks` (a list; what they warn of and
    remark, and what agrees, is of the calibration `file`), `model` (summary of the structure from
    motion), `static` (a list); each may be left out.
    """
    quality = {name: read_json(path) for name, path in files.get("quality", {}).items()}
    checks = [read_json(path) for path in files.get("checks", ())]
    if checks:
        keys = ("warnings", "remarks")
        told = {key: [line for check in checks for line in check.get(key, ())] for key in keys}
        told["remarks"] += filter(None, map(_agreement, checks))
        quality["file"] = {**quality["file"], **told}
    return {
        "quality": quality,
        "model": read_json(files["model"]) if files.get("model") else {},
        "static": [_row(path) for path in files.get("static", ())],
    }


def _agreement(check: dict) -> str:
    """Return in words what agrees with a calibration file, by a check that found no fault."""
    if check.get("warnings"):
        return ""
    told = [
        f"views of {OBSERVED[what]} disagree by {px:.1f} px per axis"
        for what, px in check.get("disagree_px", {}).items()
    ]
    if check.get("n_agreeing", 0) > 1:
        told.append(f"{check['n_agreeing']} cameras see the court's lines at the same place")
    return f"the check found no fault: {', '.join(told)}" if told else ""


def of_skeleton(found: Keypoints3D) -> dict:
    """Return statistics of the 12 limb joints; missing ones are counted while a person is there.

    `joints`: {joint: {`missing`: share, `reasons`: {word: share of all}, `few`: share of the
    reconstructed ones that rest on two views}}; `cameras`: {camera: {`accepted`: share of its
    keypoints that were used, `median_px`: their median reprojection error}}; `views`: {number of
    views: share}.
    """
    names = [str(name) for name in found.joints]
    at = [names.index(joint) for joint in skeleton.JOINTS if joint in names]
    reason, views = found.reason[:, :, at], found.n_views[:, :, at]
    seen = ~np.isin(reason, missing_reason.FEW_VIEWS)
    there = keypoints.while_there(np.any(seen, axis=2))
    joints = {}
    for number, index in enumerate(at):
        codes, lost = reason[there][:, number], np.isnan(found.xyz[there][:, index, 0])
        placed = views[there][:, number][~lost]
        words = {
            missing_reason.WORDS[code]: float(np.mean(lost & (codes == code)))
            for code in set(codes[lost])
        }
        few = float(np.mean(placed <= 2)) if placed.size else None
        joints[names[index]] = {"missing": float(lost.mean()), "reasons": words, "few": few}
    return {
        "joints": joints,
        "cameras": {str(c): _of_camera(found, at, v) for v, c in enumerate(found.cameras)},
        "views": {int(n): float(np.mean(views == n)) for n in np.unique(views)},
    }


def _of_camera(found: Keypoints3D, at: list[int], view: int) -> dict:
    error = found.reproj_error_px[:, :, at, view]
    accepted, seen = found.accepted[:, :, at, view], np.isfinite(error)
    good = error[accepted & seen]
    return {
        "accepted": float(accepted[seen].mean()) if seen.any() else None,
        "median_px": float(np.median(good)) if good.size else None,
    }


def _measures(table: pd.DataFrame) -> dict:
    found: dict = {}
    for row in table.itertuples():
        whole = np.hypot(row.sigma, 0 if np.isnan(row.sigma_camera) else row.sigma_camera)
        unit = row.unit if isinstance(row.unit, str) else ""
        value = (float(row.value), WITHIN_90 * float(whole), unit)
        found.setdefault(str(row.person), {})[row.measure] = value
    return found


def _left_out(rows: pd.DataFrame) -> tuple[int, int, dict[str, int], str]:
    """Return (frames without a neck, frames, why, when); an interpolated neck counts as present.

    Frames are counted from the first to the last in which two cameras see the neck.
    """
    there = rows[_there(rows)]
    lost = there["neck_reason"][~there["neck_reason"].isin(KNOWN)]
    why = {str(word): int(n) for word, n in lost.value_counts().items()}
    return len(lost), len(there), why, _when(rows, there)


def _there(rows: pd.DataFrame) -> NDArray:
    few = [missing_reason.WORDS[code] for code in missing_reason.FEW_VIEWS]
    return keypoints.while_there(~rows["neck_reason"].isin(few).to_numpy())


def _seconds(rows: pd.DataFrame) -> tuple[float, str]:
    """Return how long a person's path lasts, from the first to the last known neck, and when."""
    path = rows[keypoints.while_there(rows["neck_reason"].isin(KNOWN).to_numpy())]
    part = "" if _there(rows).all() else _when(rows, path)
    return float(np.ptp(path["time_s"])), part


def _when(rows: pd.DataFrame, part: pd.DataFrame) -> str:
    """Return between which times a part of a take's frames is; empty: the whole take."""
    first_s, last_s = part["time_s"].iloc[[0, -1]]
    return "" if len(part) == len(rows) else f"from {first_s:.1f} to {last_s:.1f} s of the take"


def _table(path: StrPath, columns: Sequence[str]) -> pd.DataFrame:
    def fault(table: pd.DataFrame) -> str:
        missing = [name for name in columns if name not in table.columns]
        return f"found no column {', '.join(missing)}" if missing else ""

    return tables.read(path, "a table of the study", fault)


def _rows(files: dict, key: str, columns: Sequence[str]) -> list[dict]:
    if not files.get(key):
        return []
    return _table(files[key], columns).to_dict("records")


def _row(path: StrPath) -> dict:
    rows = _table(path, ("camera", "shift_x_px", "shift_y_px", "zoom_percent", "n_matches"))
    return rows.to_dict("records")[0]
