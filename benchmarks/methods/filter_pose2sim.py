"""Pose2Sim's filters on columns of coordinates, timed. Arguments: noisy.npz result.npz repeats.

`butterworth` is its usual filter; `default` is what its settings ask for: outliers taken out by a
Hampel filter first. Both go through `DataFrame.apply`, as its own stage does.
"""

import json
import sys
import time
import warnings

import numpy as np
import pandas as pd
from Pose2Sim.filtering import filter1d, hampel_filter

WITHOUT_HAMPEL, WITH_HAMPEL = "butterworth", "default"


def main(noisy_npz, result_npz, repeats):
    warnings.simplefilter("ignore")
    given = np.load(noisy_npz)
    settings = {"order": int(given["order"]), "cut_off_frequency": float(given["cutoff_hz"])}
    config = {"filtering": {"butterworth": settings}}
    columns = pd.DataFrame(given["xyz"].reshape(len(given["xyz"]), -1))

    def filtered(table):
        return table.apply(filter1d, axis=0, args=[config, "butterworth", float(given["rate_hz"])])

    ways = {
        WITHOUT_HAMPEL: lambda: filtered(columns),
        WITH_HAMPEL: lambda: filtered(columns.apply(hampel_filter, axis=0)),
    }
    report, results = {}, {}
    for name, way in ways.items():
        seconds = []
        for _ in range(int(repeats) if name == WITHOUT_HAMPEL else 1):
            start = time.process_time()
            found = way()
            seconds.append(time.process_time() - start)
        report[name] = {"seconds": seconds}
        results[name] = found.to_numpy().reshape(given["xyz"].shape)
    np.savez(result_npz, **results)
    print(json.dumps(report))


if __name__ == "__main__":
    main(*sys.argv[1:])
