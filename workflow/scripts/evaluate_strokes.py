"""Evaluate strokes and reactions of a take: both, feet, skeletons, truth -> errors."""

from courtside.evaluation.movement import reactions, strokes
from courtside.records import footwork, tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.strokes import detect, reaction
from courtside.study.execution.script import run


def main(paths, errors_csv, reaction_errors_csv, *, labels):
    points, truth = keypoints.read_3d(paths.pose3d_npz), take_truth.read(paths.truth_npz)
    rows = strokes.table(detect.read(paths.strokes_csv), points, truth)
    tables.write(errors_csv, rows, labels)
    answered, feet = reaction.read(paths.reactions_csv), footwork.read_events(paths.events_csv)
    rows = reactions.table(answered, feet, truth, (points.time_s[0], points.time_s[-1]))
    tables.write(reaction_errors_csv, rows, labels)


if __name__ == "__main__":
    run(main, snakemake)
