"""Filter one take: raw 3D keypoints -> uncertain ones out, gaps filled, noise removed; cut-offs."""

from courtside.kinematics import cutoffs, skeleton_filter
from courtside.records import tables
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(raw_npz, skeleton_yaml, filtered_npz, cutoffs_csv, *, max_gap_s, order, cutoff_hz):
    points = skeleton_filter.prepare(keypoints.read_3d(raw_npz), max_gap_s)
    shape = skeleton.read(skeleton_yaml)
    choices = cutoffs.by_group(points, shape, cutoff_hz, order, path=raw_npz)
    per_joint = shape.by_group({group: choice.cutoff_hz for group, choice in choices.items()})
    keypoints.write_3d(filtered_npz, skeleton_filter.smooth(points, per_joint, order))
    tables.write(cutoffs_csv, cutoffs.table(choices, order))


if __name__ == "__main__":
    run(main, snakemake)
