"""Draw the errors of all sources and what they are made of: errors, parts -> figure, CSV."""

import pandas as pd

from courtside.figures.devices import source_errors
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(errors_csv, parts_csv, pdf, png, csv, *, kinds):
    errors, parts = pd.read_csv(errors_csv), pd.read_csv(parts_csv)
    drawing = source_errors.draw(errors, parts, kinds=kinds)
    style.save(drawing, source_errors.table(errors, parts), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
