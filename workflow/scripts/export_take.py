"""Export one person of one take: 3D keypoints -> TRC, C3D and CSV."""

from courtside.exports import c3d, tidy, trc
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(pose3d_npz, trc_path, c3d_path, csv_path, *, person):
    points = keypoints.read_3d(pose3d_npz)
    column = points.person_id.tolist().index(person)
    trc.write(trc_path, points, column)
    c3d.write(c3d_path, points, column)
    tidy.write(csv_path, points, column)


if __name__ == "__main__":
    run(main, snakemake)
