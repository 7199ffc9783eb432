"""Draw how the time of each step grows with the number of images: benchmarks -> figure, CSV."""

from courtside.figures.calibration import growth
from courtside.figures.style import style
from courtside.study.execution import log


def main(benchmarks_tsv, pdf, png, csv, *, title):
    rows = growth.table(benchmarks_tsv)
    style.save(growth.draw(rows, title), rows, pdf, png, csv)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.benchmarks,
        snakemake.output.pdf,
        snakemake.output.png,
        snakemake.output.csv,
        title=snakemake.wildcards.session,
    )
