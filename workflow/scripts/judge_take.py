"""Judge a take: keypoints, cameras, clocks and skeletons -> a verdict on each camera and the take.

Reads them for each way in which the take was measured; writes one table.
"""

import pandas as pd

from courtside.quality import seen, verdict
from courtside.records import tables
from courtside.records.cameras import footage
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import files, log
from courtside.study.execution.script import run


def main(quality_csv, *, ways):
    judged = [judge(way).assign(**way["labels"]) for way in ways]
    rows = pd.concat(judged, ignore_index=True)
    tables.write(quality_csv, tables.labels_first(rows, ways[0]["labels"]))


def judge(way):
    points = keypoints.read_3d(way["pose3d"])
    names = points.cameras.tolist()
    cameras = footage.read(way["cameras"], way["pose2d"], way["people"], way["sync"], wanted=names)
    gathered = seen.gather(cameras, points, skeleton.read(way["skeleton"]))
    rows = verdict.judge(gathered, by_lines(way["court_check"]))
    for row in rows[rows["measure"] == verdict.WHOLE].itertuples():
        log.logger.info("%s: %s", row.verdict, row.sentence)
    return rows


def by_lines(check_json):
    """Return what painted lines say against cameras of a calibration file, {} where unchecked."""
    return files.read_json(check_json)["cameras"] if check_json else {}


if __name__ == "__main__":
    run(main, snakemake)
