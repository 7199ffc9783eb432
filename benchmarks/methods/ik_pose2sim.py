"""Pose2Sim's inverse kinematics of one TRC file, timed: OpenSim's tool with Pose2Sim's own model.

Arguments: markers.trc folder. Markers have Pose2Sim's names of BlazePose's joints. Its model is
scaled first, which is not timed; of its models it is the one without muscles, which is the faster.
"""

import json
import sys
import time
from pathlib import Path

import opensim
from Pose2Sim import kinematics

MODEL = "BLAZEPOSE"


def main(markers_trc, folder):
    opensim.Logger.setLevelString("Off")
    trc, folder, setup = Path(markers_trc), Path(folder), kinematics.get_opensim_setup_dir()
    kinematics.perform_scaling(trc, MODEL, folder, setup, use_simple_model=True)
    start = time.process_time()
    kinematics.perform_IK(trc, folder, setup, MODEL)
    print(json.dumps({"seconds": time.process_time() - start}))


if __name__ == "__main__":
    main(*sys.argv[1:])
