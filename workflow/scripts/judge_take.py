"""Judge a take: keypoints, cameras, clocks and skeletons -> a verdict on each camera and the take.

Reads them for each way in which the take was measured; writes one table.
"""

from dataclasses import replace

from courtside.quality import body_sizes, calibration_doubts, seen, verdict
from courtside.records import tables
from courtside.records.cameras import footage
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(quality_csv, *, ways):
    judged = tables.joined(map(judge, ways), [way["labels"] for way in ways])
    tables.write(quality_csv, judged)


def judge(way):
    points = keypoints.read_3d(way["pose3d"])
    names = points.cameras.tolist()
    cameras = footage.read(way["cameras"], way["pose2d"], way["people"], way["sync"], wanted=names)
    gathered = seen.gather(cameras, points, skeleton.read(way["skeleton"]))
    said = calibration_doubts.read(way["quality"], way["check"], way["court_check"])
    if size := body_sizes.doubt(points, way["heights_m"]):
        said = replace(said, shared=(*said.shared, size))
    rows = verdict.judge(gathered, said)
    for row in rows[rows["measure"] == verdict.WHOLE].itertuples():
        log.logger.info("%s: %s", row.verdict, row.sentence)
    return rows


if __name__ == "__main__":
    run(main, snakemake)
