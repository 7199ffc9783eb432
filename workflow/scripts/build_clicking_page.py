"""Build the clicking page: static pictures, court, earlier clicks, proposals -> one HTML file."""

from courtside.calibration.court import court as court_files
from courtside.pages import page
from courtside.pages.clicking import page as clicking_page
from courtside.records.cameras import click_proposals, clicks
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(
    pictures, court_yaml, page_html, *, session, names, targets, clicks_csv=None, proposals_csv=None
):  # fmt: skip
    court = court_files.read(court_yaml)
    clicked = clicks.read(clicks_csv, names, court.points) if clicks_csv else {}
    proposed = click_proposals.read(proposals_csv, names, court.points) if proposals_csv else {}
    frames = [
        clicking_page.frame(
            name,
            path,
            clicks=clicking_page.by_point(clicked.get(name), court.points),
            proposals=proposed.get(name, {}),
        )
        for name, path in zip(names, pictures, strict=True)
    ]
    page.write(page_html, clicking_page.build(session, court, frames, targets=targets))
    log.logger.info("%s: %d pictures", page_html, len(frames))


if __name__ == "__main__":
    run(main, snakemake)
