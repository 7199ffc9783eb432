"""Draw networks on the same frames: table of their measures -> figure, CSV."""

from courtside.figures.comparison import networks
from courtside.figures.style import style
from courtside.records import tables
from courtside.study.execution.script import run


def main(table_csv, pdf, png, csv):
    numbers = networks.table(tables.read(table_csv, "a table of networks"))
    style.save(networks.draw(numbers), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
