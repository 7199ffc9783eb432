"""Take joint offsets off, keep limb lengths: filtered 3D keypoints, offsets -> corrected ones."""

from courtside.reconstruction import joint_correction
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(filtered_npz, offsets_csv, corrected_npz, *, sex_of):
    table = joint_correction.read(offsets_csv)
    corrected = joint_correction.correct(keypoints.read_3d(filtered_npz), table, sex_of)
    keypoints.write_3d(corrected_npz, joint_correction.keep(corrected))


if __name__ == "__main__":
    run(main, snakemake)
