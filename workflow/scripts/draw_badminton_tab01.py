"""Draw table 1: rows per joint of a take, published values -> figure, CSV."""

import pandas as pd

from courtside.figures.badminton import tab01
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(rows_csv, published_csv, pdf, png, csv, *, title):
    rows = pd.read_csv(rows_csv, dtype={"person": str}, keep_default_na=True)
    numbers = tab01.table(rows, pd.read_csv(published_csv))
    style.save(tab01.draw(numbers, title), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
