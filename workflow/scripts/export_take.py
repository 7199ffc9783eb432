"""Export one person of one take: 3D keypoints -> TRC, C3D and CSV."""

from courtside.exports import c3d, tidy, trc
from courtside.records.keypoints import keypoints
from courtside.study.execution import log


def main(pose3d_npz, person_id, trc_path, c3d_path, csv_path):
    points = keypoints.read_3d(pose3d_npz)
    person = points.person_id.tolist().index(person_id)
    trc.write(trc_path, points, person)
    c3d.write(c3d_path, points, person)
    tidy.write(csv_path, points, person)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.pose3d,
        snakemake.wildcards.person,
        snakemake.output.trc,
        snakemake.output.c3d,
        snakemake.output.csv,
    )
