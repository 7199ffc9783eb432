"""Evaluate the strokes of a take against the true hits: strokes, skeletons, truth -> errors."""

from courtside.evaluation.movement import strokes
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.strokes import detect
from courtside.study.execution.script import run


def main(strokes_csv, pose3d_npz, truth_npz, errors_csv, *, labels):
    found, points = detect.read(strokes_csv), keypoints.read_3d(pose3d_npz)
    rows = strokes.table(found, points, take_truth.read(truth_npz))
    tables.write(errors_csv, rows, labels)


if __name__ == "__main__":
    run(main, snakemake)
