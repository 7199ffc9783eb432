"""Evaluate the skeletons of a take against its truth: 3D keypoints, truth -> errors per joint."""

from courtside.motion import pose_errors
from courtside.records import keypoints, take_truth
from courtside.study import log
from courtside.study.files import atomic


def main(pose3d_npz, truth_npz, errors_csv, *, labels):
    points, truth = keypoints.read_3d(pose3d_npz), take_truth.read(truth_npz)
    points = points.between(truth.time_s[0], truth.time_s[-1])
    order = [truth.person_id.tolist().index(person) for person in points.person_id.tolist()]
    true = pose_errors.at_times(truth.time_s, truth.xyz[order], points.time_s)
    found = pose_errors.errors(points, truth.joints, true)
    rows = pose_errors.table(points.person_id, *found)
    right = pose_errors.identity_percent(points, truth.joints, true)
    who = dict(zip(points.person_id.tolist(), right, strict=True))
    rows["identity_percent"] = rows["person"].map(who)
    with atomic(errors_csv) as temporary:
        rows.assign(**labels)[[*labels, *rows.columns]].to_csv(
            temporary, index=False, float_format="%.6g"
        )


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.pose3d,
        snakemake.input.truth,
        snakemake.output.errors,
        labels=snakemake.params.labels,
    )
