"""Find a court by its painted lines: pictures, court -> points to be confirmed, verdicts."""

from courtside.calibration.court import court as court_files
from courtside.calibration.court_lines import verdict
from courtside.records.cameras import click_proposals
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import images


def main(pictures, court_yaml, proposals_csv, found_json, *, names, **step):
    court, proposed, said = court_files.read(court_yaml), {}, {}
    given = zip(names, pictures, strict=True)
    for name, path in log.progress(given, len(names), "court lines: cameras"):
        judged, one = verdict.examine(images.read(path), court, name, **step)
        proposed[name], said[name] = one, verdict.report(judged, one)
        log.logger.info("%s: %s", name, verdict.in_words(judged, one))
    click_proposals.write(proposals_csv, proposed, court.points)
    write_json(found_json, said)


if __name__ == "__main__":
    run(main, snakemake)
