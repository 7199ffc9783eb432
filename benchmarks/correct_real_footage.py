"""Compare the real take `walk-4cams` with the other program's result: raw, filtered, corrected.

    python benchmarks/correct_real_footage.py RECORDINGS [--results results]

RECORDINGS is a folder with `trc/Balancing_for_IK.trc` of the same videos, as Pose2Sim's
demonstration made it from OpenPose's keypoints: another markerless result with other joint
definitions, not truth. Writes docs/numbers/real_footage.csv, a source of docs/make_tables.py.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import real_footage
import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.records.keypoints import keypoints, skeleton

TAKE = f"walk-4cams/takes/balancing/{{stage}}/file/all-robust/{real_footage.NETWORK}.npz"
STAGES = {"pose3d": "raw", "pose3d_filtered": "filtered", "pose3d_corrected": "corrected"}
LABEL = (
    "real, `walk-4cams/balancing`, against OpenPose's joints in Pose2Sim's TRC, which rests on the "
    "original, faulty calibration file (no truth)"
)
COMMAND = "`python benchmarks/correct_real_footage.py RECORDINGS`"


def rows(results, theirs):
    """Yield the rows of the table, stage by stage."""
    for stage, word in STAGES.items():
        points = keypoints.read_3d(results / TAKE.format(stage=stage))
        own = [points.joints.tolist().index(joint) for joint in skeleton.JOINTS]
        apart = real_footage.distances_mm(points.xyz[0][:, own], theirs)
        known = apart[np.isfinite(apart)]
        found = {"median": np.median(known), "p90": np.percentile(known, 90)}
        for part, value in {**found, "p95": np.percentile(known, 95)}.items():
            counts = [known.size, apart.size - known.size]
            about = ["footage", LABEL, f"{word}_{part}", f"{value:.1f}", "mm", "walk-4cams"]
            yield [*about, *counts, "benchmark", COMMAND]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recordings", type=Path)
    parser.add_argument("--results", type=Path, default=ROOT / "results")
    given = parser.parse_args()
    table = rows(given.results, real_footage.reference(given.recordings))
    stated.write(ROOT / stated.FOLDER / "real_footage.csv", table)
