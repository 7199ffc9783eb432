"""Draw how the time of each step grows with the number of images: benchmarks -> figure, CSV."""

from courtside.figures.calibration import growth
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(benchmarks_tsv, pdf, png, csv, *, session):
    rows = growth.table(benchmarks_tsv)
    style.save(growth.draw(rows, session), rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
