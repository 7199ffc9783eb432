"""Draw a take's strokes over time: strokes, skeletons -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import rally
from courtside.records.keypoints import keypoints
from courtside.strokes import detect
from courtside.study.execution.script import run


def main(strokes_csv, pose3d_npz, pdf, png, csv):
    strokes, points = detect.read(strokes_csv), keypoints.read_3d(pose3d_npz)
    style.save(rally.draw(strokes, points), rally.table(strokes), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
