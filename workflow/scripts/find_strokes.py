"""Find the strokes of a take and reactions to them: skeletons, hands, events of feet -> tables."""

from courtside.calibration.court import court as courts
from courtside.records import footwork, tables
from courtside.records.keypoints import keypoints
from courtside.strokes import detect, reaction
from courtside.study.execution.script import run


def main(pose3d_npz, events_csv, court, strokes_csv, reactions_csv, *, hand_of):
    points, net = keypoints.read_3d(pose3d_npz), courts.read(court).net
    strokes = detect.table(points, hand_of)
    tables.write(strokes_csv, strokes)
    events = footwork.read_events(events_csv)
    tables.write(reactions_csv, reaction.join(strokes, events, points, net and net["y_m"]))


if __name__ == "__main__":
    run(main, snakemake)
