"""Tabulate all ways to calibrate: evaluations of several sessions -> one CSV."""

from courtside.evaluation.tables import calibration
from courtside.records import tables
from courtside.study.execution.script import run


def main(errors_csv, table_csv):
    rows = calibration.read(errors_csv, click_strength=None)
    found = calibration.table(rows)
    tables.write(table_csv, found, float_format="%.4f")


if __name__ == "__main__":
    run(main, snakemake)
