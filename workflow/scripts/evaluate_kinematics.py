"""Evaluate the kinematics of a take against its truth: measures, truth -> errors per point."""

from courtside.evaluation import kinematics
from courtside.records import tables
from courtside.records.keypoints import derived_joints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(paths, errors_csv, *, labels, sex_of):
    frames = tables.read(paths.frames, "a table of frames")
    summary = tables.read(paths.summary, "a table of measures")
    truth, derived = take_truth.read(paths.truth), derived_joints.read(paths.derived)
    rows = kinematics.table(frames, summary, truth, derived, sex_of)
    tables.write(errors_csv, rows, labels)


if __name__ == "__main__":
    run(main, snakemake)
