"""Draw table 1: rows per joint of a take, published values -> figure, CSV."""

from courtside.figures.badminton import tab01
from courtside.figures.style import style
from courtside.records import tables
from courtside.study.execution.script import run


def main(rows_csv, published_csv, pdf, png, csv, *, title):
    rows = tables.read(rows_csv, "a table of errors")
    numbers = tab01.table(rows, tables.read(published_csv, "a table of published values"))
    style.save(tab01.draw(numbers, title), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
