"""Draw the named points of a court and the edges that they name: court -> figure, CSV."""

from courtside.calibration.court import court as courts
from courtside.figures.calibration import court_points
from courtside.figures.style import style
from courtside.study.execution import log


def main(court_yaml, pdf, png, csv):
    court = courts.read(court_yaml)
    style.save(court_points.draw(court), court_points.table(court), pdf, png, csv)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.court,
        snakemake.output.pdf,
        snakemake.output.png,
        snakemake.output.csv,
    )
