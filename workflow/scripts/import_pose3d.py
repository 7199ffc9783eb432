"""Import 3D keypoints of another program: a TRC file for each person -> 3D keypoints."""

from courtside.exports import pose2sim
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(trc_files, persons, skeleton_yaml, pose3d_npz, model):
    files = dict(zip(persons, trc_files, strict=True))
    points = pose2sim.read_takes(files, skeleton.read(skeleton_yaml), model=model)
    missing = (points.n_views == 0).all(axis=(0, 1))
    if missing.any():
        log.logger.info("joints without a marker: %s", ", ".join(points.joints[missing]))
    keypoints.write_3d(pose3d_npz, points)


if __name__ == "__main__":
    run(main, snakemake)
