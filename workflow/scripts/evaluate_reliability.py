"""Evaluate the coverage of stated errors: joints of every stage, measures, truth -> counts."""

import pandas as pd

from courtside.evaluation import joints, kinematics, reliability
from courtside.records import tables
from courtside.records.keypoints import derived_joints, keypoints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(paths, counts_csv, *, labels, sex_of):
    truth, parts = take_truth.read(paths.truth), []
    derived = derived_joints.read(paths.derived)
    for path in paths.pose3d:
        points = keypoints.read_3d(path).between(truth.time_s[0], truth.time_s[-1])
        true = joints.true_places(points, truth)
        counts = reliability.counts(points, truth.joints.tolist(), true)
        measured = {"angle": kinematics.all_angles(points, truth)}
        if path == paths.pose3d[-1]:
            frames = tables.read(paths.frames, "a table of frames")
            summary = tables.read(paths.summary, "a table of measures")
            given = truth, derived, sex_of
            measured["speed"] = kinematics.speeds(frames, *given)
            measured["distance"] = kinematics.distances(kinematics.table(frames, summary, *given))
        parts.append(pd.concat([counts, reliability.of_measures(measured)]))
    tables.write(counts_csv, tables.joined(parts, labels))


if __name__ == "__main__":
    run(main, snakemake)
