"""Compare skeletons from fewer cameras with those from all: 3D keypoints of a take -> distances per joint."""

from courtside.motion import view_sets
from courtside.records import keypoints
from courtside.study import log
from courtside.study.files import atomic


def main(pose3d_npz, distances_csv, *, fusions, labels):
    records = {
        name: keypoints.read_3d(path) for name, path in zip(fusions, pose3d_npz, strict=True)
    }
    rows = view_sets.compare(records, fusions[-1])
    with atomic(distances_csv) as temporary:
        rows.assign(**labels)[[*labels, *rows.columns]].to_csv(
            temporary, index=False, float_format="%.6g", lineterminator="\n"
        )


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.pose3d,
        snakemake.output.distances,
        fusions=snakemake.params.fusions,
        labels=snakemake.params.labels,
    )
