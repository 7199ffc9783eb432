"""Draw the errors of the cameras' clocks: evaluations of takes -> figure, CSV."""

from courtside.evaluation.tables import players
from courtside.figures.style import style
from courtside.figures.take import clock_errors
from courtside.study.execution.script import run


def main(errors_csv, pdf, png, csv):
    numbers = clock_errors.table(players.read(errors_csv))
    style.save(clock_errors.draw(numbers), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
