"""Evaluate the joint angles of a take against its truth.

Reads 3D keypoints of every stage and fusion, and the truth; writes errors by person and angle.
"""

from courtside.evaluation import kinematics
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(pose3d_npz, truth_npz, errors_csv, *, labels):
    truth = take_truth.read(truth_npz)
    parts = [kinematics.angles(keypoints.read_3d(path), truth) for path in pose3d_npz]
    tables.write(errors_csv, tables.joined(parts, labels))


if __name__ == "__main__":
    run(main, snakemake)
