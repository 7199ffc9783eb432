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
    ties_npz, summary_json, truth_npz, court_yaml, errors_csv, *, labels, clicks, sets, **options
):
    court, real, record = (
        court_files.read(court_yaml),
        session_truth.read(truth_npz),
        tie_points.read(ties_npz),
    )
    summary = json.loads(Path(summary_json).read_text(encoding="utf-8"))
    rows = []
    for draw, marked in enumerate(
        clicking.clicks_of_persons(real.cameras, real.court_xyz, **clicks)
    ):
        if record.outcome:
            rows.append({"draw": draw, "outcome": record.outcome})
            continue
        found = calibration.of_ties(record, real.cameras, court, marked, sets=sets, **options)
        rows += [{"draw": draw, **row} for row in found]
    angles = [np.nan]
    if record.ties:
        fixed, point = image_names.are_static(record.images), [*court.size_m / 2, CENTRE_HEIGHT_M]
        angles = cameras.path_angles_deg(fixed, record.centres, point)
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
    table = pd.DataFrame(rows).reindex(columns=["draw", *calibration.COLUMNS])
    tables.write(errors_csv, table, about)


if __name__ == "__main__":
    run(main, snakemake)
