"""Draw a take's strokes and steps over time: strokes, events, skeletons -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import rally
from courtside.records import footwork, strokes
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(strokes_csv, events_csv, pose3d_npz, pdf, png, csv):
    hits, events = strokes.read(strokes_csv), footwork.read_events(events_csv)
    drawing = rally.draw(hits, events, keypoints.read_3d(pose3d_npz))
    style.save(drawing, rally.table(hits, events), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
