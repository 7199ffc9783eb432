"""Measure one take on the skeletons that are exported.

Reads them, the raw keypoints for their noise, and the cut-offs that were used; writes speeds,
distances, accelerations and angles with uncertainty.
"""

from courtside.exports import measures
from courtside.kinematics import cutoffs, skeleton_filter
from courtside.kinematics import measures as kinematics
from courtside.records import tables
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, frames_csv, summary_csv, *, max_gap_s, stage, sex_of):
    points = keypoints.read_3d(paths.skeletons)
    raw = skeleton_filter.prepare(keypoints.read_3d(paths.raw), max_gap_s)
    shape, (chosen, order) = skeleton.read(paths.skeleton), cutoffs.read(paths.cutoffs)
    how = kinematics.Filter(shape.by_group(chosen), order)
    table = derived_joints.read(paths.derived)
    people = kinematics.measure(points, raw, table, shape.name, how, sex_of)
    tables.write(frames_csv, measures.frames(people))
    tables.write(summary_csv, measures.summary(people, stage))


if __name__ == "__main__":
    run(main, snakemake)
