"""Tabulate all ways to calibrate: evaluations of several sessions -> one CSV."""

from courtside.evaluation.tables import calibration
from courtside.records import tables
from courtside.study.execution import log


def main(errors_csv, table_csv, *, n_reference):
    found = calibration.table(calibration.read(errors_csv), n_reference=n_reference)
    tables.write(table_csv, found, float_format="%.4f")


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.errors,
        snakemake.output.table,
        n_reference=snakemake.params.n_reference,
    )
