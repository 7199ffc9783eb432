"""Find the strokes of a take and reactions to them: skeletons, hands, events of feet -> tables."""

from courtside.records import footwork, tables
from courtside.records.keypoints import keypoints
from courtside.strokes import detect, reaction
from courtside.study.execution.script import run


def main(pose3d_npz, events_csv, strokes_csv, reactions_csv, *, hand_of):
    strokes = detect.table(keypoints.read_3d(pose3d_npz), hand_of)
    tables.write(strokes_csv, strokes)
    tables.write(reactions_csv, reaction.join(strokes, footwork.read_events(events_csv)))


if __name__ == "__main__":
    run(main, snakemake)
