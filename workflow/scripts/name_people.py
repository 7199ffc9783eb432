"""Name the persons found in a take: people, the user's sightings -> subjects."""

from courtside.calibration.court import court
from courtside.reconstruction.association import naming
from courtside.records.cameras import footage
from courtside.records.keypoints import people, sightings
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, people_npz, *, persons, stated, take, page, file):
    seen = footage.read(paths.cameras, paths.pose2d, None, paths.sync)
    found, wording = people.read(paths.found), naming.Wording(take, " ".join(page), file)
    sighted = [
        sightings.stated(f"{wording.file}: subjects.{name}.seen", name, entry)
        for name, entry in stated
    ]
    if paths.people_csv:
        cameras = [one.camera.name for one in seen]
        sighted += sightings.read(paths.people_csv, take.split("/")[-1], persons, cameras)
    lines = court.read(paths.court) if paths.court else None
    named = naming.name(found, seen, sighted, persons, wording, lines)
    for line in naming.lines(found, named):
        log.logger.info("%s", line)
    if left := naming.others(found, named):
        log.logger.info("no subject: %s", ", ".join(left))
    people.write(people_npz, named)


if __name__ == "__main__":
    run(main, snakemake)
