"""Evaluate the contacts of a take against its truth: contacts, steps, truth -> errors per foot."""

from courtside.evaluation.movement import contacts
from courtside.records import footwork, tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(paths, errors_csv, *, labels):
    points, found = keypoints.read_3d(paths.skeletons), footwork.read_contacts(paths.contacts)
    steps, truth = footwork.read_steps(paths.steps), take_truth.read(paths.truth)
    tables.write(errors_csv, contacts.table(points, found, steps, truth), labels)


if __name__ == "__main__":
    run(main, snakemake)
