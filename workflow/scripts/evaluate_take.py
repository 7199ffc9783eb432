"""Evaluate the skeletons of a take against its truth.

Reads 3D keypoints of every stage and fusion; writes errors.
"""

from courtside.evaluation import joints
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(pose3d_npz, truth_npz, errors_csv, *, labels):
    truth = take_truth.read(truth_npz)
    parts = [table(keypoints.read_3d(path), truth) for path in pose3d_npz]
    tables.write(errors_csv, tables.joined(parts, labels))


def table(points, truth):
    points = points.between(truth.time_s[0], truth.time_s[-1])
    true = joints.true_places(points, truth)
    rows = joints.table(points.person_id, *joints.errors(points, truth.joints, true))
    right = joints.identity_percent(points, truth.joints, true)
    who = dict(zip(points.person_id.tolist(), right, strict=True))
    return rows.assign(identity_percent=rows["person"].map(who))


if __name__ == "__main__":
    run(main, snakemake)
