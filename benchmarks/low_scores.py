"""Joints that views of low scores determine, too: docs/numbers/low_scores.csv.

    python benchmarks/low_scores.py RESULTS ...

The folders hold the results of a default run and of the development sessions, as
`evaluate_joint_offsets` reads them (CONTRIBUTING.md, "A network"). The 2D keypoints of the default
network are triangulated by the true cameras, all four and each three of them: without views below
`triangulate: min_score`, and with these views where the others leave a direction open. Errors are
those of limb joints less the network's offsets, mm: median / 95 % / 99 %.
"""

import argparse
import sys
from itertools import combinations
from pathlib import Path

import numpy as np

import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.evaluation import error_fit, joints
from courtside.evaluation.numbers.players import NETWORK
from courtside.reconstruction import fusion, joint_correction
from courtside.study.configuration import yaml_files
from joint_offsets import SHAPE, errors_m, takes_of

SESSIONS = {  # the calibration that people were found with
    "players-dev": "known18",
    "players-dev-stands": "known18",
    "players-dev-near": "known18",
    "players-b": "sfm-n40-lines",
}
CONFIG = ROOT / "config"
COMMAND = "`python benchmarks/low_scores.py RESULTS ...`"


def rows_of(folders):
    """Yield the numbers of the table, and print them."""
    step = yaml_files.read(CONFIG / "config.yaml")["triangulate"]
    table = joint_correction.read(CONFIG / "joint_offsets" / f"{NETWORK}.csv")
    for session, calibration in SESSIONS.items():
        (results,) = (folder for folder in folders if (folder / session / "takes").is_dir())
        takes = takes_of(results, [session], calibration)[session]
        footage = list(error_fit.footage_with_truth(takes))
        for count in (4, 3):
            for part, weak_m in (("without", np.inf), ("used", fusion.WEAK_M)):
                apart_mm = 1000 * np.concatenate(
                    list(errors_of(footage, count, table, step, weak_m))
                )
                quantiles = np.quantile(apart_mm, [0.5, 0.95, 0.99])
                printed = "{:.1f} / {:.1f} / {:.0f}".format(*quantiles)
                label = f"`{session}`, " + ("four cameras" if count == 4 else "each three of them")
                print(label, part, printed, flush=True)
                row = "low-scores", label, part, printed, "mm", session
                yield *row, len(apart_mm), 0, "benchmark", COMMAND


def errors_of(footage, count, table, step, weak_m):
    """Yield the errors (N,) m of each take, person and set of cameras."""
    fusion.WEAK_M = weak_m
    for seen, sex_of, truth in footage:
        for own in combinations(seen, count):
            raw = error_fit.triangulated(own, SHAPE, list(sex_of), step)
            raw = raw.frames(error_fit.thin(raw))
            true, cameras = joints.true_places(raw, truth), [one.camera for one in own]
            yield errors_m(raw, true, truth.joints.tolist(), table, sex_of, cameras)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path, nargs="+")
    given = parser.parse_args()
    rows = list(rows_of(given.results))
    stated.write(ROOT / "docs" / "numbers" / "low_scores.csv", rows)


if __name__ == "__main__":
    main()
