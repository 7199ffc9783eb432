"""Filter one take: raw 3D keypoints -> short gaps filled, noise removed without delay."""

from courtside.kinematics import filtering
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(raw_npz, skeleton_yaml, filtered_npz, *, max_gap_s, order, cutoff_hz):
    points = keypoints.read_3d(raw_npz)
    per_joint = skeleton.read(skeleton_yaml).by_group(cutoff_hz)
    filled = filtering.fill_gaps(points, max_gap_s)
    keypoints.write_3d(filtered_npz, filtering.smooth(filled, per_joint, order))


if __name__ == "__main__":
    run(main, snakemake)
