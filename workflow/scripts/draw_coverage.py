"""Draw stated against true uncertainty: evaluations of several sessions -> figure, CSV."""

from courtside.evaluation.tables import calibration
from courtside.figures.calibration import coverage
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(errors_csv, pdf, png, csv):
    numbers = coverage.table(calibration.read(errors_csv))
    style.save(coverage.draw(numbers), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
