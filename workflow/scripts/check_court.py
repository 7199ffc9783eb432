"""Check a calibration made elsewhere by the painted lines of the court in each camera's picture."""

import numpy as np
import pandas as pd

from courtside.calibration import file_formats
from courtside.calibration.court import court as court_files
from courtside.calibration.file_check import court_place
from courtside.geometry import camera
from courtside.records import tables
from courtside.records.cameras import click_proposals
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(paths, check_json, check_csv, *, names, override, unit=None):
    found = file_formats.read_session(paths.calibration_path, names, override, unit)
    court, shown = court_files.read(paths.court_yaml), camera.read_toml(paths.cameras_toml)
    proposed = click_proposals.read(paths.proposals_csv, [one.name for one in shown], court.points)
    # Everything in px of the calibrated picture, which is what the file's numbers are of.
    xy = [
        camera.in_other_picture(here, whole, views(proposed[whole.name], court))
        for here, whole in zip(shown, found, strict=True)
    ]
    either_end = any("either" in place for view in proposed.values() for place in view.values())
    judged = court_place.judge(found, np.stack(xy), court, either_end=either_end)
    for line in judged.warnings:
        log.tell(line, check_json)
    place = judged.place
    rows = court_place.by_camera(found, place) if place else pd.DataFrame(columns=court_place.ROWS)
    tables.write(check_csv, rows, float_format="%.3f")
    content = {
        "warnings": judged.warnings,
        "cameras": judged.of_camera,
        "shared": judged.shared,
        "faults": [{"what": one.what, "advice": one.advice} for one in judged.faults],
        "n_agreeing": place.n_agreeing() if place else 0,
    }
    write_json(check_json, content)


def views(proposed, court):
    """Return the proposed points of one picture (P, 2) px."""
    xy = np.full((len(court.points), 2), np.nan)
    for point, place in proposed.items():
        xy[court.points.index(point)] = place["x"], place["y"]
    return xy


if __name__ == "__main__":
    run(main, snakemake)
