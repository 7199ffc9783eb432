"""Draw the coverage of stated joint errors: counts of takes -> figure, CSV."""

from courtside.evaluation.tables import players
from courtside.figures.comparison import reliability
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(counts_csv, pdf, png, csv):
    numbers = reliability.table(players.read(counts_csv))
    style.save(reliability.draw(numbers), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
