"""Correct joints, then filter: 3D keypoints, cameras, offsets, cut-offs -> corrected keypoints."""

from courtside.geometry import camera
from courtside.kinematics import cutoffs, skeleton_filter
from courtside.reconstruction import joint_correction
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, corrected_npz, *, max_gap_s, sex_of):
    raw = skeleton_filter.prepare(keypoints.read_3d(paths.raw), max_gap_s)
    filtered, table = keypoints.read_3d(paths.filtered), joint_correction.read(paths.offsets)
    chosen, order = cutoffs.read(paths.cutoffs)
    per_joint = skeleton.read(paths.skeleton).by_group(chosen)
    corrected = joint_correction.correct_then_filter(
        raw, filtered, table, sex_of, per_joint, order, camera.read_toml(paths.cameras)
    )
    keypoints.write_3d(corrected_npz, corrected)


if __name__ == "__main__":
    run(main, snakemake)
