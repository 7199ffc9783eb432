"""Tabulate all ways to calibrate: evaluations of several sessions -> one CSV."""

from courtside.figures import calibration_table, trials
from courtside.study import log
from courtside.study.files import atomic


def main(errors_csv, table_csv, *, n_reference):
    found = calibration_table.table(trials.read(errors_csv), n_reference=n_reference)
    with atomic(table_csv) as temporary:
        found.to_csv(temporary, index=False, float_format="%.4f", lineterminator="\n")


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.errors,
        snakemake.output.table,
        n_reference=snakemake.params.n_reference,
    )
