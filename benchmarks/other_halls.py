"""Halls of other sizes, looks and layouts, whose worlds are wrong as real ones are: calibrations.

    python benchmarks/other_halls.py [RESULTS]

RESULTS holds the sessions `hall-...` of config/full.yaml. These alone are made by
`snakemake --configfile config/full.yaml --config 'variations=[]' 'sessions=[hall-a-plain,
hall-b-plain, hall-corners-plain, hall-a-rich, hall-b-rich, hall-corners-rich]' --
results/figures/calibration.csv`, in about a quarter of an hour on two cores. Besides the trials of
the study, `PERSONS` others click each hall: with the ten of the study at twice and three times the
usual scatter, the coverage of one hall is known to 10 percentage points only. Writes
docs/numbers/other_halls.csv, a source of docs/make_tables.py.
"""

import argparse
from pathlib import Path

import numpy as np

import stated
import ways_to_calibrate
from courtside.calibration.court import joint_adjustment
from courtside.calibration.records import tie_points
from courtside.evaluation import calibration as trials
from courtside.evaluation.numbers import calibration, register
from repository import ROOT
from ways_to_calibrate import HALLS, WEIGHTS

COMMAND = "`python benchmarks/other_halls.py`"
TABLES = {"calibration": "halls", "calibration-strengths": "halls-strengths"}
PERSONS, SEED, STRENGTHS, SETS = 30, 5, (1, 2, 3), ("all", "eight", "three")


def rows(results):
    """Yield the rows of the tables: errors in each hall and over halls, and by click scatter."""
    source = register.Source(results)
    for number in calibration.calibrations(source) + calibration.strengths(source):
        about = [TABLES[number.table], number.row, number.part, number.printed, number.unit]
        yield [*about, number.sessions, number.n, number.n_failed, register.BENCHMARK, COMMAND]


def trial(one, ties, clicks, name):
    """Return the error over the volume, cm, and the share of it in the 90 % ellipsoids."""
    use = np.zeros(len(one.court.points), dtype=bool)
    use[one.court.indices(name)] = True
    solved = joint_adjustment.solve_with_factors(ties, clicks, one.court, points=use, **WEIGHTS)
    truth = one.real.cameras, one.court
    found = trials.score(solved.cameras, *truth, clicks, solved.point_covariance)
    return found["volume_rms_cm"], 100 * found["coverage90"]


def coverage_rows(results):
    """Yield the rows of the table `halls-coverage`: other persons in each hall, and all halls."""
    shares = {}
    for one in (ways_to_calibrate.hall(results, name) for name in HALLS):
        ties = tie_points.read(results / one.name / "sfm" / "global-n40-o0" / "ties.npz").ties
        for strength in STRENGTHS:
            persons = one.persons(PERSONS, seed=SEED, strength=strength)
            every = [[trial(one, ties, clicks, name) for name in SETS] for clicks in persons]
            for name, (error, held) in zip(SETS, np.array(every).transpose(1, 2, 0), strict=True):
                part = f"n{len(one.court.sets[name])}_x{strength}"
                shares.setdefault(part, []).append(held.mean())
                printed = f"{np.median(error):.2f} cm, {held.mean():.0f} %"
                row = ["halls-coverage", f"`{one.name}`", part, printed, "", one.name, PERSONS, 0]
                yield [*row, register.BENCHMARK, COMMAND]
    for part, each in shares.items():
        printed = f"{np.mean(each):.0f} %, {min(each):.0f} to {max(each):.0f}"
        row = ["halls-coverage", "mean, least and most hall", part, printed, "", ", ".join(HALLS)]
        yield [*row, PERSONS * len(HALLS), 0, register.BENCHMARK, COMMAND]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path, nargs="?", default=ROOT / "results")
    given = parser.parse_args()
    stated.write(
        ROOT / stated.FOLDER / "other_halls.csv",
        [*rows(given.results), *coverage_rows(given.results)],
    )
