"""Left and right exchanged where views disagree: docs/numbers/sides.csv.

    python benchmarks/sides.py RESULTS ...

The folders hold the results of a default run and of the development sessions, as
`evaluate_joint_offsets` reads them (CONTRIBUTING.md, "A network"). The 2D keypoints of the default
network are triangulated by the true cameras: all four, each three and each two of them. Errors of
raw limb joints, mm: median / 95 %, and the share above 150 mm. Plain DLT: with the keypoints as
detected, and with the sides that the robust rule finds.
"""

import argparse
import sys
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np

import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.evaluation import error_fit, joints
from courtside.geometry import triangulation
from courtside.reconstruction import left_right, resampling
from courtside.study.configuration import yaml_files
from joint_offsets import SHAPE, errors_m, takes_of
from low_scores import SESSIONS

COMMAND = "`python benchmarks/sides.py RESULTS ...`"
COUNTS = {4: "four cameras", 3: "each three of them", 2: "each two of them"}
LARGE_M = 0.15
PARTS = ("detected", "robust", "plain", "plain_exchanged")


def rows_of(folders):
    """Yield the numbers of the table, and print them."""
    step = yaml_files.read(ROOT / "config" / "config.yaml")["triangulate"]
    for session, calibration in SESSIONS.items():
        (results,) = (folder for folder in folders if (folder / session / "takes").is_dir())
        takes = takes_of(results, [session], calibration)[session]
        footage = list(error_fit.footage_with_truth(takes))
        for count, words in COUNTS.items():
            parts = [
                list(of_take) for of_take in zip(*errors_of(footage, count, step), strict=True)
            ]
            for part, errors in zip(PARTS, parts, strict=True):
                apart_m = np.concatenate(errors)
                middle, most = 1000 * np.quantile(apart_m, [0.5, 0.95])
                large = 100 * np.mean(apart_m > LARGE_M)
                printed = f"{middle:.1f} / {most:.1f}; {large:.2f} %"
                print(f"`{session}`, {words}", part, printed, flush=True)
                row = "sides", f"`{session}`, {words}", part, printed, "mm", session
                yield *row, len(apart_m), 0, "benchmark", COMMAND


def errors_of(footage, count, step):
    """Yield the errors (N,) m of each take and set of cameras, for each of `PARTS`.

    Of the joints that all of them place.
    """
    for seen, sex_of, truth in footage:
        for own in combinations(seen, count):
            detected, robust, plain = (
                error_fit.triangulated(own, SHAPE, list(sex_of), step | other)
                for other in ({"fix_sides": False}, {}, {"rule": "dlt"})
            )
            found = detected, robust, plain, with_sides(own, plain, robust, step)
            placed = np.logical_and.reduce([np.isfinite(points.xyz) for points in found])
            found = [replace(one, xyz=np.where(placed, one.xyz, np.nan)) for one in found]
            found = [points.frames(error_fit.thin(robust)) for points in found]
            true = joints.true_places(found[0], truth)
            yield tuple(errors_m(points, true, truth.joints.tolist()) for points in found)


def with_sides(own, plain, robust, step):
    """Return the skeletons of plain DLT with left and right as the robust rule exchanged them."""
    cameras = [one.camera for one in own]
    views, clocks = [one.view for one in own], [one.clock for one in own]
    xy, score = resampling.resample_all(views, clocks, robust.time_s)
    for values in (xy, score):
        left_right.exchange(values, np.moveaxis(robust.swapped, -1, 0), SHAPE.mirror())
    flat = xy.reshape(len(own), -1, 2), score.reshape(len(own), -1)
    options = {key: step[key] for key in ("min_views", "min_score")}
    found = triangulation.triangulate_plain(cameras, *flat, **options)
    return replace(plain, xyz=found.xyz.reshape(plain.xyz.shape))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path, nargs="+")
    given = parser.parse_args()
    stated.write(ROOT / "docs" / "numbers" / "sides.csv", list(rows_of(given.results)))


if __name__ == "__main__":
    main()
