"""Halls of other sizes, looks and layouts, whose worlds are wrong as real ones are: calibrations.

    python benchmarks/other_halls.py [RESULTS]

RESULTS holds the sessions `hall-...` of config/full.yaml. These alone are made by
`snakemake --configfile config/full.yaml --config 'variations=[]' 'sessions=[hall-a-plain,
hall-b-plain, hall-corners-plain, hall-a-rich, hall-b-rich, hall-corners-rich]' -- all`, in about an
hour and a half on two cores. Writes docs/numbers/other_halls.csv, a source of docs/make_tables.py.
"""

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation.numbers import calibration, register, stated

COMMAND = "`python benchmarks/other_halls.py`"
TABLES = {"calibration": "halls", "calibration-strengths": "halls-strengths"}


def rows(results):
    """Yield the rows of the tables: errors in each hall and over halls, and by click scatter."""
    source = register.Source(results)
    for number in calibration.calibrations(source) + calibration.strengths(source):
        about = [TABLES[number.table], number.row, number.part, number.printed, number.unit]
        yield [*about, number.sessions, number.n, number.n_failed, register.BENCHMARK, COMMAND]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path, nargs="?", default=ROOT / "results")
    given = parser.parse_args()
    stated.write(ROOT / stated.FOLDER / "other_halls.csv", rows(given.results))
