"""Tabulate the errors of joint angles: evaluations of takes -> one CSV."""

from courtside.evaluation.tables import angles
from courtside.records import tables
from courtside.study.execution.script import run


def main(errors_csv, table_csv):
    tables.write(table_csv, angles.table(angles.read(errors_csv)), float_format="%.4f")


if __name__ == "__main__":
    run(main, snakemake)
