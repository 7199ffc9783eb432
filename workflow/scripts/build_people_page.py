"""Build the page to name people on: people found, videos, earlier names -> one HTML file."""

from courtside.calibration.court import court
from courtside.pages import page
from courtside.pages.people import page as people_page
from courtside.pages.people import strips
from courtside.reconstruction.association import identity, marks
from courtside.records.cameras import footage
from courtside.records.keypoints import people, sightings, skeleton
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, page_html, *, session, take, takes, subjects, stated, target):
    seen = footage.read(paths.cameras, paths.pose2d, None, paths.sync, paths.videos)
    found, joints = people.read(paths.found), skeleton.read(paths.skeleton)
    columns = {k: strips.times(found, seen, k) for k in people_page.shown(found)}
    shots = []
    for one in log.progress(seen, len(seen), "cameras"):
        shots += strips.pictures(one, one.video, found, columns, joints)
    rows, sighted = [], [sightings.stated("seen", name, entry) for name, entry in stated]
    if paths.people_csv:
        rows = sightings.every_row(paths.people_csv, takes)
        cameras = [one.camera.name for one in seen]
        sighted += sightings.read(paths.people_csv, take, subjects, cameras)
    named = earlier(sighted, found, seen, subjects)
    words = {"session": session, "take": take, "takes": takes, "subjects": subjects}
    words |= {"target": target, "meet_m": identity.MEET_M}
    lines = court.read(paths.court) if paths.court else None
    built = people_page.build(
        words, found, seen, columns, shots, court=lines, named=named, rows=rows
    )
    page.write(page_html, built)
    log.logger.info("%s: %d persons, %d pictures", page_html, len(columns), len(shots))


def earlier(sighted, found, seen, subjects):
    """Return the earlier names that still fit; the log names the others."""
    named = []
    for one in sighted:
        try:
            mark = marks.locate(one, found, seen, subjects)
        except InputError as error:
            log.logger.warning("%s", error)
            continue
        times = {key: getattr(mark, key) for key in ("time_s", "from_s", "to_s")}
        named.append({"person": mark.person, "subject": one.subject, **times})
    return named


if __name__ == "__main__":
    run(main, snakemake)
