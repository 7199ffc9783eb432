"""Tabulate the errors of virtual players: evaluations of takes -> one CSV."""

from courtside.evaluation.tables import players
from courtside.records import tables
from courtside.study.execution.script import run


def main(paths, table_csv):
    table = players.table(
        players.read(paths.errors),
        players.read(paths.kinematics),
        players.read(paths.clocks),
        players.read(paths.gains),
    )
    tables.write(table_csv, table, float_format="%.4f")


if __name__ == "__main__":
    run(main, snakemake)
