"""Draw the length of a racket by several calibrations: evaluations of sessions -> figure, CSV."""

from courtside.evaluation.tables import racket
from courtside.figures.badminton import fig12
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(lengths_csv, pdf, png, csv, *, length_m):
    numbers = racket.table(racket.read(lengths_csv))
    style.save(fig12.draw(numbers, length_m), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
