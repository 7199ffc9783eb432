"""Check a calibration made elsewhere by painted lines, static points and people in the takes."""

import numpy as np
import pandas as pd

from courtside.calibration import file_formats
from courtside.calibration.court import court as court_files
from courtside.calibration.file_check import court_place, residuals, verdict
from courtside.geometry import camera
from courtside.reconstruction import common_views
from courtside.records import tables
from courtside.records.cameras import click_proposals, clicks
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(paths, check_json, check_csv, *, names, override, takes, unit=None):
    found = file_formats.rename(file_formats.read(paths.calibration_path, unit), names)
    found = file_formats.with_principal_points(found, override.get("principal_point_px", {}))
    # Everything in px of the calibrated picture, which is what the file's numbers are of.
    shown, static = camera.read_toml(paths.cameras_toml), None
    if paths.static_csv:
        _, static = clicks.read_static(paths.static_csv, list(names))
        static = np.stack(in_calibrated(found, shown, static))
    lines = court_verdict(found, shown, paths) if paths.proposals_csv else None
    people = common_views.of_takes(paths.cameras_toml, list(names), takes)
    views = in_calibrated(found, shown, people.xy) if people else []
    joints = residuals.of_people(views) if views else None
    seen = verdict.Seen(static, joints)
    # Points at rest and people show what is wrong beside what the court's lines show.
    judged = verdict.judge(lines.cameras if lines else found, seen, residuals.height_px(views))
    warnings = [*(lines.warnings if lines else []), *judged.warnings]
    for line in warnings:
        log.logger.warning("%s", line)
    rows = [verdict.by_camera(found, seen)]
    if lines and lines.place:
        rows.append(court_place.by_camera(found, lines.place))
    rows = [table for table in rows if len(table)] or rows[:1]
    tables.write(check_csv, pd.concat(rows), float_format="%.3f")
    content = {
        "warnings": warnings,
        "faults": [
            {"what": one.what, "advice": one.advice}
            for one in [*(lines.faults if lines else []), *judged.faults]
        ],
        "disagree_px": seen.px(found),
        "without_faults_px": judged.mended_px,
    }
    write_json(check_json, content)


def court_verdict(calibrated, shown, paths):
    """Judge cameras by the points of painted lines that their pictures show."""
    court, names = court_files.read(paths.court_yaml), [camera.name for camera in shown]
    proposed = click_proposals.read(paths.proposals_csv, names, court.points)
    xy = np.full((len(names), len(court.points), 2), np.nan)
    for at, name in enumerate(names):
        for point, place in proposed[name].items():
            xy[at, court.points.index(point)] = place["x"], place["y"]
    either_end = any("either" in place for view in proposed.values() for place in view.values())
    xy = np.stack(in_calibrated(calibrated, shown, xy))
    return court_place.judge(calibrated, xy, court, either_end=either_end)


def in_calibrated(calibrated, shown, xy):
    """Return px (..., 2) of each camera's video as px of the calibrated picture."""
    each = zip(calibrated, shown, xy, strict=True) if len(xy) else ()
    return [camera.in_other_picture(here, whole, px) for whole, here, px in each]


if __name__ == "__main__":
    run(main, snakemake)
