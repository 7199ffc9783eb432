"""Draw a take's strokes over one another in phase: strokes, skeletons -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import strokes as phases
from courtside.records import strokes
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(strokes_csv, pose3d_npz, pdf, png, csv):
    hits, points = strokes.read(strokes_csv), keypoints.read_3d(pose3d_npz)
    rows = phases.table(hits, points)
    style.save(phases.draw(rows), rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
