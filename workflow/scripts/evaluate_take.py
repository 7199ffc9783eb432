"""Evaluate the skeletons of a take against its truth: 3D keypoints of every stage and fusion -> errors."""

import pandas as pd

from courtside.motion import pose_errors
from courtside.records import keypoints, take_truth
from courtside.study import log
from courtside.study.files import atomic


def main(pose3d_npz, truth_npz, errors_csv, *, labels):
    truth = take_truth.read(truth_npz)
    tables = [
        table(keypoints.read_3d(path), truth).assign(**about)
        for path, about in zip(pose3d_npz, labels, strict=True)
    ]
    rows = pd.concat(tables, ignore_index=True)
    with atomic(errors_csv) as temporary:
        columns = [*labels[0], *(name for name in rows.columns if name not in labels[0])]
        rows[columns].to_csv(temporary, index=False, float_format="%.6g")


def table(points, truth):
    points = points.between(truth.time_s[0], truth.time_s[-1])
    order = [truth.person_id.tolist().index(person) for person in points.person_id.tolist()]
    true = pose_errors.at_times(truth.time_s, truth.xyz[order], points.time_s)
    rows = pose_errors.table(points.person_id, *pose_errors.errors(points, truth.joints, true))
    right = pose_errors.identity_percent(points, truth.joints, true)
    who = dict(zip(points.person_id.tolist(), right, strict=True))
    return rows.assign(identity_percent=rows["person"].map(who))


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.pose3d,
        snakemake.input.truth,
        snakemake.output.errors,
        labels=snakemake.params.labels,
    )
