"""Compare the real take `walk-4cams` with the other program's result: raw, filtered, corrected.

    python benchmarks/correct_real_footage.py RECORDINGS [--results results]

RECORDINGS is a folder with OpenPose's keypoints of the same videos (`openpose_body25b/`), which are
triangulated by the study's mended cameras, and with `trc/Balancing_for_IK.trc`, which Pose2Sim's
demonstration made from them by the faulty file: another markerless result with other joint
definitions, not truth. How often the stated intervals of the corrected angles hold OpenPose's is
counted, too. Writes docs/numbers/real_footage.csv, a source of docs/make_tables.py.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import pandas as pd

import real_footage
import real_people
import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.geometry import camera, triangulation
from courtside.statistics.normal_errors import WITHIN_90
from courtside.study.methods import STAGE_WORDS

SESSION = "walk-4cams"
TAKE = f"{SESSION}/takes/balancing/{{stage}}/file/all-robust/{real_footage.NETWORK}.npz"
ANGLES = f"{SESSION}/takes/balancing/kinematics/file/all-robust/{real_footage.NETWORK}.frames.csv"
HINGES = ("knee_flexion", "hip_flexion", "elbow_flexion", "shoulder_elevation")
LABEL = (
    "real, `walk-4cams/balancing`, against OpenPose's joints in Pose2Sim's TRC, which rests on the "
    "original, faulty calibration file (no truth)"
)
BESIDE = "`walk-4cams`, against OpenPose's keypoints by the mended cameras"
COMMAND = "`python benchmarks/correct_real_footage.py RECORDINGS`"


def openpose(recordings, cameras):
    """Return (T, 12, 3) m of OpenPose's keypoints, triangulated by the cameras of the study."""
    seen = np.stack([real_footage.openpose(recordings, at + 1) for at in range(len(cameras))])
    flat = seen[..., :2].reshape(len(seen), -1, 2), seen[..., 2].reshape(len(seen), -1)
    found = triangulation.triangulate_robust(cameras, *flat, **real_footage.LIKE_POSE2SIM)
    return found.xyz.reshape(seen.shape[1], -1, 3)


def rows(stages, theirs):
    """Yield the rows of the table `footage`, stage by stage."""
    for word, xyz in stages.items():
        apart = real_footage.distances_mm(xyz, theirs)
        known = apart[np.isfinite(apart)]
        found = {"median": np.median(known), "p90": np.percentile(known, 90)}
        for part, value in {**found, "p95": np.percentile(known, 95)}.items():
            counts = [known.size, apart.size - known.size]
            about = ["footage", LABEL, f"{word}_{part}", f"{value:.1f}", "mm", SESSION]
            yield [*about, *counts, "benchmark", COMMAND]


def beside(stages, theirs):
    """Return the rows of the table `real-people`; OpenPose's frames are `LATER`."""
    later = {word: xyz[real_footage.LATER :] for word, xyz in stages.items()}
    theirs = theirs[: len(later["raw"])]
    return list(real_people.rows(BESIDE, SESSION, later, theirs, COMMAND))


def intervals(frames, theirs):
    """Yield the rows of the table `real-intervals`: angles with errors, of both sides, in turn."""
    frames, angles = frames[real_footage.LATER :], real_people.angles_deg(theirs)
    for hinge in HINGES:
        names = [f"{side}_{hinge}" for side in real_people.SIDES]
        ours, sigma = (
            np.stack([frames[f"{name}{part}"] for name in names]) for part in ("_deg", "_sd_deg")
        )
        apart = abs(ours - np.stack([angles[name][: ours.shape[1]] for name in names]))
        known = np.isfinite(apart) & np.isfinite(sigma)
        found = {"mean": f"{apart[known].mean():.1f}", "stated": f"{sigma[known].mean():.1f}"}
        inside = (apart <= WITHIN_90 * sigma)[known]
        found["held"] = f"{100 * inside.mean():.0f}"
        for part, value in found.items():
            about = ["real-intervals", hinge.replace("_", " "), part, value]
            yield [*about, "%" if part == "held" else "degrees", SESSION, known.sum()]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recordings", type=Path)
    parser.add_argument("--results", type=Path, default=ROOT / "results")
    given = parser.parse_args()
    made = {
        word: real_people.limbs(given.results / TAKE.format(stage=stage))
        for stage, word in STAGE_WORDS.items()
    }
    known = camera.read_toml(given.results / SESSION / "calibration" / "file" / "cameras.toml")
    theirs = openpose(given.recordings, known)
    held = intervals(pd.read_csv(given.results / ANGLES), theirs)
    stated.write(
        ROOT / stated.FOLDER / "real_footage.csv",
        [
            *rows(made, real_footage.reference(given.recordings)),
            *beside(made, theirs),
            *([*row, 0, "benchmark", COMMAND] for row in held),
        ],
    )
