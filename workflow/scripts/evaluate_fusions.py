"""Evaluate what the robust rule gains over others.

Reads 3D keypoints of one take and the truth; writes paired differences.
"""

from courtside.evaluation import camera_sets, joints
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(pose3d_npz, truth_npz, gains_csv, *, fusions, pairs, labels):
    truth, distance_mm = take_truth.read(truth_npz), {}
    for name, path in zip(fusions, pose3d_npz, strict=True):
        points = keypoints.read_3d(path).between(truth.time_s[0], truth.time_s[-1])
        distance_mm[name] = joints.limb_distances(points, truth)
    rows = camera_sets.gains(distance_mm, pairs, points.rate_hz)
    tables.write(gains_csv, rows, labels)


if __name__ == "__main__":
    run(main, snakemake)
