"""Tabulate how well virtual players are measured: evaluations of takes -> one CSV."""

from courtside.figures import players_table
from courtside.study import log
from courtside.study.files import atomic


def main(paths, table_csv):
    parts = [
        players_table.read(part)
        for part in (paths.errors, paths.kinematics, paths.clocks, paths.gains)
    ]
    with atomic(table_csv) as temporary:
        players_table.table(*parts).to_csv(
            temporary, index=False, float_format="%.4f", lineterminator="\n"
        )


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(snakemake.input, snakemake.output.table)
