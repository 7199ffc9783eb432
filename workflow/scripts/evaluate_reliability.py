"""Evaluate how far stated errors of joints hold: 3D keypoints of every stage, truth -> counts."""

import pandas as pd

from courtside.evaluation import joints, reliability
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(pose3d_npz, truth_npz, counts_csv, *, labels):
    truth, parts = take_truth.read(truth_npz), []
    for path, about in zip(pose3d_npz, labels, strict=True):
        points = keypoints.read_3d(path).between(truth.time_s[0], truth.time_s[-1])
        true = joints.true_places(points, truth)
        parts.append(reliability.counts(points, truth.joints.tolist(), true).assign(**about))
    rows = pd.concat(parts, ignore_index=True)
    tables.write(counts_csv, rows.set_index(list(labels[0])).reset_index())


if __name__ == "__main__":
    run(main, snakemake)
