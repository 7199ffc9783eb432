"""Compare skeletons from fewer cameras with those from all.

Reads 3D keypoints of a take; writes distances per joint.
"""

from courtside.evaluation import camera_sets
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(pose3d_npz, distances_csv, *, fusions, labels):
    records = {
        name: keypoints.read_3d(path) for name, path in zip(fusions, pose3d_npz, strict=True)
    }
    rows = camera_sets.compare(records, fusions[-1])
    tables.write(distances_csv, rows, labels)


if __name__ == "__main__":
    run(main, snakemake)
