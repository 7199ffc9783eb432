"""Measure one take on the skeletons that are exported.

Reads them, the raw keypoints for their noise, the cut-offs that were used, and the covariance of
the cameras; writes speeds, distances, accelerations and angles with uncertainty.
"""

import numpy as np

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.records import covariance
from courtside.exports import measures
from courtside.geometry import camera
from courtside.kinematics import cutoffs, shared_errors, skeleton_filter
from courtside.kinematics import measures as kinematics
from courtside.records import tables
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, frames_csv, summary_csv, *, max_gap_s, stage, sex_of, recorded):
    unused = ("covariance_camera", "outlier")  # for the memory
    raw = keypoints.read_3d(paths.raw, left_out=(*unused, "offset"))
    raw = skeleton_filter.prepare(raw, max_gap_s)
    points = keypoints.read_3d(paths.skeletons, left_out=(*unused, "reproj_error_px"))
    shape, (chosen, order) = skeleton.read(paths.skeleton), cutoffs.read(paths.cutoffs)
    how = kinematics.Filter(shape.by_group(chosen), order)
    table = derived_joints.read(paths.derived)
    field = field_of_cameras(paths, points.cameras) if paths.covariance else None
    people = kinematics.measure(
        points, raw, table, shape.name, how, sex_of, field, recorded=recorded
    )
    tables.write(frames_csv, measures.frames(people))
    tables.write(summary_csv, measures.summary(people, stage))


def field_of_cameras(paths, names):
    seen = {one.name: one for one in camera.read_toml(paths.cameras)}
    used = [seen[name] for name in names]
    known = covariance.read(paths.covariance).of(names)
    columns = known.of_columns()
    if not np.isfinite(columns).all():
        return None
    field = point_covariance.field(conversion.network_of(used), columns, used)
    return shared_errors.with_frame(field, known.frame)


if __name__ == "__main__":
    run(main, snakemake)
