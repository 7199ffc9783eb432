"""Find the strokes of a take: skeletons, stated playing hands -> table of strokes."""

from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.strokes import detect
from courtside.study.execution.script import run


def main(pose3d_npz, strokes_csv, *, hand_of):
    points = keypoints.read_3d(pose3d_npz)
    tables.write(strokes_csv, detect.table(points, hand_of))


if __name__ == "__main__":
    run(main, snakemake)
