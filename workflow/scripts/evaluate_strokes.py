"""Evaluate strokes and reactions of a take: both, feet, skeletons, truth -> errors."""

from courtside.evaluation.movement import reactions, strokes
from courtside.records import footwork, tables
from courtside.records import strokes as stroke_tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(paths, errors_csv, reaction_errors_csv, *, labels):
    points, truth = keypoints.read_3d(paths.pose3d_npz), take_truth.read(paths.truth_npz)
    rows = strokes.table(stroke_tables.read(paths.strokes_csv), points, truth)
    tables.write(errors_csv, rows, labels)
    answered = stroke_tables.read_reactions(paths.reactions_csv)
    feet = footwork.read_events(paths.events_csv)
    rows = reactions.table(answered, feet, truth, (points.time_s[0], points.time_s[-1]))
    tables.write(reaction_errors_csv, rows, labels)


if __name__ == "__main__":
    run(main, snakemake)
