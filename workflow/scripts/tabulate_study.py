"""Put the measures of all takes into one table: summaries, verdicts -> the table of the study."""

import pandas as pd

from courtside.records import study_table, tables
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(table_csv, *, takes):
    rows = pd.concat([study_table.of_take(**take) for take in takes], ignore_index=True)
    tables.write(table_csv, rows)
    log.logger.info("%s: %d rows of %d tables", table_csv, len(rows), len(takes))


if __name__ == "__main__":
    run(main, snakemake)
