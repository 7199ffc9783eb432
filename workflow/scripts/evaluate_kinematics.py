"""Evaluate the kinematics of a take against its truth: measures, truth -> errors per point."""

import pandas as pd

from courtside.evaluation import kinematics
from courtside.records import tables
from courtside.records.keypoints import derived_joints
from courtside.records.truth import take_truth
from courtside.study.execution import log


def main(paths, errors_csv, *, labels, sex_of):
    frames, summary = pd.read_csv(paths.frames), pd.read_csv(paths.summary)
    known = take_truth.read(paths.truth), derived_joints.read(paths.derived), sex_of
    rows = kinematics.table(frames, *known)
    rows = kinematics.distances(rows, frames, summary, *known)
    tables.write(errors_csv, rows, labels)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input,
        snakemake.output.errors,
        labels=snakemake.params.labels,
        sex_of=snakemake.params.sex_of,
    )
