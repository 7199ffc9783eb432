"""Draw a take's strokes and steps over time: strokes, events, skeletons -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import rally
from courtside.records import footwork
from courtside.records.keypoints import keypoints
from courtside.strokes import detect
from courtside.study.execution.script import run


def main(strokes_csv, events_csv, pose3d_npz, pdf, png, csv):
    strokes, events = detect.read(strokes_csv), footwork.read_events(events_csv)
    drawing = rally.draw(strokes, events, keypoints.read_3d(pose3d_npz))
    style.save(drawing, rally.table(strokes, events), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
