"""Draw reprojection errors per joint and camera: 3D keypoints -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import reprojection
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(pose3d_npz, pdf, png, csv):
    rows = reprojection.table(keypoints.read_3d(pose3d_npz))
    style.save(reprojection.draw(rows), rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
