"""Measure the wrists' arcs from T-pose to clap: body motions -> paths, distortion, smoothness."""

import pandas as pd

from courtside.kinematics import smoothness, wrist_arcs
from courtside.records import tables
from courtside.records.keypoints import body_motion
from courtside.study.execution.script import run


def main(body_npz, paths_csv, distortion_csv, *, sparc_rate_hz):
    points, rows = [], []
    for body in map(body_motion.read, body_npz):
        found = wrist_arcs.arcs_or_none(body)
        sparc = smoothness.of_arcs(body, found, sparc_rate_hz)
        row = wrist_arcs.distortion(found).assign(unit_m=body.unit_m, sparc=sparc)
        points += wrist_arcs.paths(found).assign(source=body.source).to_dict("records")
        rows += row.assign(source=body.source).to_dict("records")
    columns = ["source", *wrist_arcs.PATHS]
    tables.write(paths_csv, pd.DataFrame(points, columns=columns))
    columns = ["source", *wrist_arcs.DISTORTION, "unit_m", "sparc"]
    tables.write(distortion_csv, pd.DataFrame(rows, columns=columns))


if __name__ == "__main__":
    run(main, snakemake)
