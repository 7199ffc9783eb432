"""Draw the agreement of two networks: pairs, limits of agreement -> figure, CSV."""

from courtside.figures.comparison import agreement
from courtside.figures.style import style
from courtside.study.execution import log


def main(pairs_csv, table_csv, pdf, png, csv, *, networks):
    pairs, table = agreement.read(pairs_csv, table_csv)
    style.save(agreement.draw(pairs, table, networks), table, pdf, png, csv)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.pairs,
        snakemake.input.table,
        snakemake.output.pdf,
        snakemake.output.png,
        snakemake.output.csv,
        networks=snakemake.params.networks,
    )
