"""Tabulate how well virtual players are measured: evaluations of takes -> one CSV."""

from courtside.evaluation.tables import players
from courtside.records import tables
from courtside.study.execution import log


def main(paths, table_csv):
    parts = [
        players.read(part) for part in (paths.errors, paths.kinematics, paths.clocks, paths.gains)
    ]
    tables.write(table_csv, players.table(*parts), float_format="%.4f")


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(snakemake.input, snakemake.output.table)
