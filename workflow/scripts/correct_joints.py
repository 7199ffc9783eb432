"""Correct joints, then filter: 3D keypoints, cameras, offsets, cut-offs -> corrected keypoints."""

from courtside.geometry import camera
from courtside.kinematics import cutoffs, skeleton_filter
from courtside.reconstruction import joint_correction
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run

UNUSED = ("covariance_network", "offset", "outlier")  # errors of raw keypoints, for the memory


def main(paths, corrected_npz, *, max_gap_s, sex_of):
    table, (chosen, order) = joint_correction.read(paths.offsets), cutoffs.read(paths.cutoffs)
    corrected = joint_correction.correct_then_filter(
        skeleton_filter.prepare(keypoints.read_3d(paths.raw, left_out=UNUSED), max_gap_s),
        keypoints.read_3d(paths.filtered),
        table,
        sex_of,
        skeleton.read(paths.skeleton).by_group(chosen),
        order,
        camera.read_toml(paths.cameras),
    )
    keypoints.write_3d(corrected_npz, corrected)


if __name__ == "__main__":
    run(main, snakemake)
