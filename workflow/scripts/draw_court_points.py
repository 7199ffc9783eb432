"""Draw the named points of a court and the edges that they name: court -> figure, CSV."""

from courtside.calibration.court import court as court_files
from courtside.figures.calibration import court_points
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(court_yaml, pdf, png, csv):
    court = court_files.read(court_yaml)
    style.save(court_points.draw(court), court_points.table(court), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
