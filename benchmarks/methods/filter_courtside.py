"""Courtside's zero-lag filter on points, timed. Arguments: noisy.npz result.npz repeats."""

import json
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "workflow" / "lib"))
from courtside.kinematics import filtering


def main(noisy_npz, result_npz, repeats):
    given = np.load(noisy_npz)
    settings = float(given["rate_hz"]), float(given["cutoff_hz"]), int(given["order"])
    xyz = given["xyz"]
    filtering.zero_lag_points(xyz[:100], *settings)  # warm-up
    seconds = []
    for _ in range(int(repeats)):
        start = time.process_time()
        found = filtering.zero_lag_points(xyz, *settings)
        seconds.append(time.process_time() - start)
    np.savez(result_npz, zero_lag_points=found)
    print(json.dumps({"zero_lag_points": {"seconds": seconds}}))


if __name__ == "__main__":
    main(*sys.argv[1:])
