"""Propose court points: cameras, static pictures, court -> where they are seen, to be confirmed."""

from courtside.calibration.click_proposals import proposals as court_proposals
from courtside.calibration.court import court as court_files
from courtside.geometry import camera as cameras
from courtside.records.cameras import click_proposals
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import images


def main(cameras_toml, pictures, court_yaml, proposals_csv, *, names, search_share, **options):
    known = {camera.name: camera for camera in cameras.read_toml(cameras_toml)}
    court, found = court_files.read(court_yaml), {}
    given = zip(names, pictures, strict=True)
    for name, path in log.progress(given, len(names), "court points: cameras"):
        if name not in known:
            raise InputError(
                f"{cameras_toml}: expected camera {name}, found {', '.join(known)}; "
                "calibrate it first"
            )
        image = images.read(path)
        cameras.check_size(known[name], image.shape[1::-1], path)
        reach = {"search_px": search_share * max(image.shape[:2])}
        found[name] = court_proposals.propose(known[name], image, court, **reach, **options)
        n = sum(not reason for reason in found[name].reason)
        log.logger.info("%s: %d of %d points proposed", name, n, len(court.points))
    click_proposals.write(proposals_csv, found, court.points)


if __name__ == "__main__":
    run(main, snakemake)
