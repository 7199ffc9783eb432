"""Put all calibrations of all sessions side by side: cameras, quality, skeletons, truth -> CSV."""

import pandas as pd

from courtside.calibration.court import court as court_files
from courtside.evaluation.tables import ways as compared
from courtside.geometry import camera as camera_models
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import session_truth
from courtside.study.execution.files import read_json
from courtside.study.execution.script import run


def main(table_csv, *, ways):
    rows = []
    for way in ways:
        row = {key: way[key] for key in ("session", "calibration", "base")}
        row |= compared.from_quality(read_json(way["quality"]))
        if way["truth"]:
            real, court = session_truth.read(way["truth"]), court_files.read(way["court"])
            cameras = camera_models.read_toml(way["cameras"])
            row |= compared.against_truth(cameras, real.cameras, court)
        row |= compared.accepted([keypoints.read_3d(path) for path in way["skeletons"]])
        rows.append(row)
    table = pd.DataFrame(rows, columns=list(compared.COLUMNS))
    tables.write(table_csv, table, float_format="%.4f")


if __name__ == "__main__":
    run(main, snakemake)
