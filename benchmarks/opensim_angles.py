"""Angles of the real session `walk-4cams` beside those that OpenSim gave Pose2Sim.

    python benchmarks/opensim_angles.py RESULTS MOT

RESULTS are of a default run. MOT is what Pose2Sim published of OpenSim's inverse kinematics of the
same 100 frames, from OpenPose's keypoints: in its repository at commit dde50b4f,
`Pose2Sim/Demo/S00_Demo_Session/S00_P00_Participant/S00_P00_OpenSim/` and there
`S00_P00_T01_BalancingTrial_filt_butterworth_0-100_body25b.mot`; rows may be left out. The skeletal
model's angles have the same names and signs. Neither is truth: Pose2Sim's rest on the calibration
file as it is, whose principal points are mirrored.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import pandas as pd

import stated
from real_footage import LATER
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation.numbers.players import NETWORK

OURS = f"walk-4cams/takes/balancing/pose3d_ik/file/all-robust/{NETWORK}.p1.mot"
RATE_HZ = 60
FIRST = 1  # Pose2Sim's number of the first row, which shows the video's frame `LATER`
ANGLES = {"hip flexion": "hip_flexion", "knee flexion": "knee_angle", "elbow": "elbow_flex"}
COMMAND = "`python benchmarks/opensim_angles.py RESULTS MOT`"


def motion(path):
    """Return the table of a `.mot` file."""
    lines = Path(path).read_text(encoding="utf-8").splitlines()
    head = lines.index("endheader") + 1
    table = pd.DataFrame([line.split() for line in lines[head + 1 :]], columns=lines[head].split())
    return table.astype(float)


def differences(ours, theirs):
    """Yield (angle, differences) in degrees, ours less theirs, at the frames of theirs."""
    frames = (theirs["time"] * RATE_HZ).round().astype(int) - FIRST + LATER
    known = frames.between(0, len(ours) - 1)
    at = frames[known].to_numpy()
    for words, name in ANGLES.items():
        for side in ("left", "right"):
            column = f"{name}_{side[0]}"
            found = ours[column].to_numpy()[at] - theirs.loc[known, column].to_numpy()
            yield f"{side} {words}", found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("mot", type=Path)
    given = parser.parse_args()
    rows = []
    for angle, apart in differences(motion(given.results / OURS), motion(given.mot)):
        numbers = {
            "rmse": np.sqrt(np.mean(apart**2)),
            "mean": apart.mean(),
            "scatter": apart.std(),
        }
        print(angle, {key: round(float(value), 1) for key, value in numbers.items()}, len(apart))
        about = ("degrees", "walk-4cams", len(apart), 0, "benchmark", COMMAND)
        rows += [["opensim-angles", angle, k, f"{v:.1f}", *about] for k, v in numbers.items()]
    stated.write(ROOT / stated.FOLDER / "opensim_angles.csv", rows)


if __name__ == "__main__":
    main()
