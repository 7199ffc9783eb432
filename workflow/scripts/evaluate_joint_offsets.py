"""Estimate joint offsets on development bodies: filtered 3D keypoints, truths -> offsets."""

import numpy as np

from courtside.evaluation import joints
from courtside.reconstruction import joint_correction
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(pose3d_npz, truth_npz, offsets_csv, *, sex_of, about):
    clips = []
    for found_npz, true_npz in zip(pose3d_npz, truth_npz, strict=True):
        points, truth = keypoints.read_3d(found_npz), take_truth.read(true_npz)
        sexes = [sex_of[str(person)] for person in points.person_id]
        clips += zip(points.xyz, joints.true_places(points, truth), sexes, strict=True)
    table = joint_correction.estimate(clips, points.joints, truth.joints)
    log.logger.info("frames: %d", np.sum([len(found) for found, _, _ in clips]))
    tables.write(offsets_csv, table, about=about)


if __name__ == "__main__":
    run(main, snakemake)
