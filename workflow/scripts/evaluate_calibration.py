"""Evaluate one structure from motion against the truth: ties, truth -> errors of every draw."""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from courtside.calibration.court import court as court_files
from courtside.calibration.planning import cameras
from courtside.calibration.records import tie_points
from courtside.evaluation import calibration
from courtside.records import tables
from courtside.records.cameras import image_names
from courtside.records.truth import session_truth
from courtside.study.execution.script import run
from virtualgym.session import clicks as clicking

CENTRE_HEIGHT_M = 1.0  # the angle between neighbouring views is measured there


def main(
    ties_npz,
    summary_json,
    truth_npz,
    court_yaml,
    errors_csv,
    *,
    labels,
    clicks,
    strengths,
    sets,
    **options,
):
    court, real = court_files.read(court_yaml), session_truth.read(truth_npz)
    record = tie_points.read(ties_npz)
    summary = json.loads(Path(summary_json).read_text(encoding="utf-8"))
    rows = []
    seen = real.cameras, court, real.court_xyz
    for drawn, marked in clicking.clicks_of_strengths(strengths, *seen, **clicks):
        if record.outcome:
            rows.append({**drawn, "outcome": record.outcome})
            continue
        found = calibration.of_ties(record, real.cameras, court, marked, sets=sets, **options)
        rows += [{**drawn, **row} for row in found]
    angles = neighbour_angles_deg(record, court)
    about = {
        **labels,
        "n_registered": summary["n_registered"],
        "n_images": summary["n_images"],
        "n_fixed_registered": len(record.sfm_cameras),
        "n_points3d": summary["n_points3d"],
        "reprojection_px": summary["reprojection_px"],
        "tie_residual_px": record.residual_px,
        "neighbour_deg_median": np.median(angles),
        "neighbour_deg_max": np.max(angles),
    }
    table = pd.DataFrame(rows).reindex(columns=[*drawn, *calibration.COLUMNS])
    tables.write(errors_csv, table, about)


def neighbour_angles_deg(record, court):
    if not record.ties:
        return [np.nan]
    fixed, point = image_names.are_static(record.images), [*court.size_m / 2, CENTRE_HEIGHT_M]
    return cameras.path_angles_deg(fixed, record.centres, point)


if __name__ == "__main__":
    run(main, snakemake)
