"""Evaluate calibration from known court points: truth, lenses -> errors of every draw."""

import pandas as pd

from courtside.calibration.court import court as court_files
from courtside.evaluation import calibration
from courtside.geometry import camera as camera_models
from courtside.records import tables
from courtside.records.truth import session_truth
from courtside.study.execution.script import run
from virtualgym.session import clicks as clicking


def main(
    truth_npz, court_yaml, lens_toml, errors_csv, *, cameras, labels, clicks, strengths, **options
):
    court, real = court_files.read(court_yaml), session_truth.read(truth_npz)
    lens_of = dict(zip(cameras, lens_toml, strict=False))
    lenses = {camera: camera_models.read_toml(path)[0] for camera, path in lens_of.items()}
    rows = []
    seen = real.cameras, court, real.court_xyz
    for drawn, marked in clicking.clicks_of_strengths(strengths, *seen, **clicks):
        found = calibration.of_known(real.cameras, court, marked, lenses, **options)
        rows += [{**drawn, **row} for row in found]
    table = pd.DataFrame(rows).reindex(columns=[*drawn, *calibration.COLUMNS])
    tables.write(errors_csv, table, labels)


if __name__ == "__main__":
    run(main, snakemake)
