"""Draw scores and views over time: 2D and 3D keypoints -> figure, CSV."""

from courtside.figures import style, visibility
from courtside.records import keypoints, skeleton
from courtside.study import log


def main(pose3d_npz, pose2d_npz, skeleton_yaml, pdf, png, csv):
    views = [keypoints.read_2d(path) for path in pose2d_npz]
    rows = visibility.table(keypoints.read_3d(pose3d_npz), views)
    style.save(visibility.draw(rows, skeleton.read(skeleton_yaml)), rows, pdf, png, csv)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.pose3d,
        snakemake.input.pose2d,
        snakemake.input.skeleton,
        snakemake.output.pdf,
        snakemake.output.png,
        snakemake.output.csv,
    )
