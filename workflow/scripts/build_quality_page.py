"""Build a session's page for quality: verdicts, calibrations, videos of takes -> one HTML file."""

from courtside.pages import page
from courtside.pages import quality as quality_page
from courtside.records.keypoints import keypoints, people, skeleton
from courtside.study.execution import log, verdicts
from courtside.study.execution.script import run


def main(page_html, *, session, takes, cameras):
    shown = [with_pictures(take) for take in log.progress(takes, len(takes), "takes")]
    page.write(page_html, quality_page.build(session, shown, cameras))
    count = sum(len(take["pictures"]) for take in shown)
    log.logger.info("%s: %d takes, %d pictures", page_html, len(shown), count)


def with_pictures(take):
    joints, who = skeleton.read(take["skeleton"]), people.read(take["people"])
    pictures = {}
    for pose2d, video in zip(take["pose2d"], take["videos"], strict=True):
        view = keypoints.read_2d(pose2d)
        pictures[view.camera] = quality_page.thumbnail(view, who, video, joints)
    lines = quality_page.lines(verdicts.read(take["quality"]))
    return {**take, "lines": lines, "pictures": pictures}


if __name__ == "__main__":
    run(main, snakemake)
