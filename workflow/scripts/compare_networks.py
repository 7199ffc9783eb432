"""Compare two networks on the same takes.

Reads measures and 3D keypoints; writes pairs, limits of agreement and verdicts.
"""

import pandas as pd

from courtside.kinematics import joint_means
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.statistics import agreement, longitudinal
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(measures_csv, pose3d_npz, pairs_csv, table_csv, *, labels, joint_labels, networks, **step):
    parts = [longitudinal.read(measures_csv, labels)]
    parts += [
        joint_means.table(keypoints.read_3d(path), label)
        for path, label in zip(pose3d_npz, joint_labels, strict=True)
    ]
    left_out = step.pop("left_out")
    rows = longitudinal.check_single(pd.concat(parts, ignore_index=True))
    rows = longitudinal.of_movement(rows)
    for part in left_out:
        rows = rows[~rows["measure"].str.contains(part, regex=False)]
    pairs = agreement.pair(rows, networks)
    table = agreement.compare(pairs, networks, **step)
    for sentence in table["sentence"]:
        log.logger.info("%s", sentence)
    tables.write(pairs_csv, pairs)
    tables.write(table_csv, table)


if __name__ == "__main__":
    run(main, snakemake)
