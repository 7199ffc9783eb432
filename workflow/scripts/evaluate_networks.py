"""Evaluate networks on the same frames.

Reads errors in the pictures, and of virtual takes raw 3D keypoints and truth; writes a table.
"""

from courtside.evaluation.tables import networks as compared
from courtside.records import tables
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(errors_csv, table_csv, *, labels, skeleton_labels, networks, pose3d_npz=(), truth_npz=()):
    takes, points, truths = {}, {}, {}
    for path, label in zip(errors_csv, labels, strict=True):
        key = label["session"], label["take"], label["against"]
        rows = tables.read(path, "a table of errors")
        takes.setdefault(key, {})[label["model"]] = rows
    for path, truth, label in zip(pose3d_npz, truth_npz, skeleton_labels, strict=True):
        key = label["session"], label["take"], label["against"]
        points.setdefault(key, {})[label["model"]] = keypoints.read_3d(path)
        truths[key] = truth
    found = []
    for key, pictures in takes.items():
        space = ()
        if key in points:
            space = compared.errors_3d(points[key], take_truth.read(truths[key]))
        found.append(compared.ComparedTake(key[0], key[2], pictures, *space))
    table = compared.table(found, networks)
    for row in table[table["measure"] == "pck"].itertuples():
        log.logger.info("%s, %s: PCK %.1f %%", row.session, row.network, row.value)
    tables.write(table_csv, table)


if __name__ == "__main__":
    run(main, snakemake)
