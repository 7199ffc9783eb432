"""Measure a racket by cameras calibrated in several ways.

Reads ties and truth; writes lengths and errors of every run.
"""

from itertools import product

import pandas as pd

from courtside.calibration.court import court as court_files
from courtside.calibration.records import tie_points
from courtside.evaluation import racket
from courtside.records import tables
from courtside.records.truth import session_truth
from courtside.study.execution.script import run
from virtualgym.session import clicks as clicking
from virtualgym.session import rackets

VIEWS = 2  # the paper's: the first two fixed cameras of a layout


def main(
    ties_npz, truth_npz, court_yaml, lengths_csv, *, labels, clicks, length_m, tips_px, **options
):
    court, real = court_files.read(court_yaml), session_truth.read(truth_npz)
    views, records = real.cameras[:VIEWS], [tie_points.read(path) for path in ties_npz]
    rows = []
    for repeat, marked in enumerate(
        clicking.clicks_of_persons(real.cameras, court, real.court_xyz, **clicks)
    ):
        offset = repeat % len(records)
        ways = racket.calibrate(records[offset], views, court, marked, **options)
        of_run = {"seed": clicks["seed"], "run": repeat}
        ends = rackets.swing_of_run(court, length_m, **of_run)
        below = ends[..., 2].mean(axis=1) < court.net["mid_height_m"]
        for sigma_px, again in product(tips_px, (False, True)):
            tip = {"sigma_px_at_3840": sigma_px, "again": again}
            seen = rackets.click_racket(views, ends, **tip, **of_run)
            about = {"offset": offset, "draw": repeat, "tip_sigma_px": sigma_px, "again": again}
            found = racket.rows(ways, seen, length_m, below)
            rows += [{**about, **row} for row in found]
    lengths = racket.length_columns(rackets.FRAMES)
    table = pd.DataFrame(rows).reindex(columns=[*about, *racket.COLUMNS, *lengths])
    tables.write(lengths_csv, table, labels)


if __name__ == "__main__":
    run(main, snakemake)
