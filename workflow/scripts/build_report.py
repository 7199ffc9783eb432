"""Put what the study has made into one HTML page: measures, warnings, figures, quality, methods."""

from courtside.pages import page
from courtside.pages.report import report
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(html, *, study):
    content = report.build(study)
    page.write(html, content)
    counts = f"{len(study['sessions'])} sessions, {len(study['figures'])} figures"
    log.logger.info("%s: %s, %.1f MB", html, counts, len(content) / 1e6)


if __name__ == "__main__":
    run(main, snakemake)
