"""Associate the tracklets of all cameras of a take: 2D keypoints, cameras, clocks -> people."""

from courtside.calibration.court import court
from courtside.reconstruction.association import everybody
from courtside.records.cameras import footage
from courtside.records.keypoints import people, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, people_npz, *, several, calibration, unit=None):
    seen = footage.read(paths.cameras, paths.pose2d, None, paths.sync, sure_clocks=several)
    lines = court.read(paths.court) if paths.get("court") else None
    joints = skeleton.read(paths.skeleton)
    found, line = everybody.find(seen, joints, lines, calibration, unit)
    log.logger.info("%s", line)
    people.write(people_npz, found)


if __name__ == "__main__":
    run(main, snakemake)
