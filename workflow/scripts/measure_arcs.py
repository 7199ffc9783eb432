"""Measure the wrists' arcs from T-pose to clap: body motions -> paths, distortion, smoothness."""

import pandas as pd

from courtside.kinematics import smoothness, wrist_arcs
from courtside.records import tables
from courtside.records.keypoints import body_motion
from courtside.study.execution.script import run


def main(body_npz, paths_csv, distortion_csv, *, sparc_rate_hz):
    paths, rows = [], []
    for body in map(body_motion.read, body_npz):
        found = wrist_arcs.arcs(body)
        paths.append(wrist_arcs.paths(found).assign(source=body.source))
        row = wrist_arcs.distortion(found).assign(source=body.source, unit_m=body.unit_m)
        rows.append(row.assign(sparc=smoothness.of_arcs(body, found, sparc_rate_hz)))
    for path, parts in ((paths_csv, paths), (distortion_csv, rows)):
        table = pd.concat(parts, ignore_index=True)
        tables.write(path, table.set_index("source").reset_index())


if __name__ == "__main__":
    run(main, snakemake)
