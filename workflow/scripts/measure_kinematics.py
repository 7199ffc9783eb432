"""Measure one take.

Reads raw 3D keypoints; writes speeds, distances, accelerations and angles with uncertainty.
"""

from courtside.exports import measures
from courtside.kinematics import cutoffs, filtering
from courtside.kinematics import measures as kinematics
from courtside.records import tables
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.study.execution.script import run


def main(raw_npz, skeleton_yaml, derived_yaml, frames_csv, summary_csv, cutoffs_csv, **step):
    points = filtering.leave_out_uncertain(keypoints.read_3d(raw_npz))
    points = filtering.fill_gaps(points, step["max_gap_s"])
    shape = skeleton.read(skeleton_yaml)
    choices = cutoffs.by_group(points, shape, step["cutoff_hz"], step["order"])
    chosen = {group: choice.cutoff_hz for group, choice in choices.items()}
    how = kinematics.Filter(shape.by_group(chosen), step["order"], step["distance_cutoff_hz"])
    table = derived_joints.read(derived_yaml)
    people = kinematics.measure(points, table, shape.name, how, step["sex_of"])
    tables.write(frames_csv, measures.frames(people))
    tables.write(summary_csv, measures.summary(people))
    tables.write(cutoffs_csv, measures.cutoffs(choices))


if __name__ == "__main__":
    run(main, snakemake)
