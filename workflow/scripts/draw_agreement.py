"""Draw the agreement of two networks: pairs, limits of agreement -> figure, CSV."""

from courtside.figures.comparison import agreement
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(pairs_csv, table_csv, pdf, png, csv, *, networks):
    pairs, table = agreement.read(pairs_csv, table_csv)
    style.save(agreement.draw(pairs, table, networks), table, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
