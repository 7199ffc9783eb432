"""Evaluate the clocks of a take against its truth: clocks, truth -> errors per camera."""

import numpy as np
import pandas as pd

from courtside.records import tables
from courtside.records.devices import clocks as sync
from courtside.records.truth import take_truth
from courtside.statistics import normal_errors
from courtside.study.execution.script import run


def main(sync_json, truth_npz, errors_csv, *, labels):
    reference, clocks = sync.read(sync_json)
    truth = take_truth.read(truth_npz)
    ends_s = truth.time_s[[0, -1]]
    rows = []
    for camera, clock in clocks.items():
        if camera == reference:
            continue
        real = sync.Clock(truth.offset_s[camera], truth.drift_ppm[camera])
        error_s = clock.from_reference(ends_s) - real.from_reference(ends_s)
        worst_s = error_s[np.abs(error_s).argmax()]
        rows.append(
            {
                "camera": camera,
                "status": clock.status,
                "offset_s": clock.offset_s,
                "drift_ppm": clock.drift_ppm,
                "error_ms": 1000 * error_s.mean(),
                "worst_error_ms": 1000 * worst_s,
                "sigma_ms": 1000 * clock.uncertainty_s,
                "within_90_percent": bool(
                    abs(worst_s) <= normal_errors.WITHIN_90 * clock.uncertainty_s
                ),
                "drift_error_ppm": clock.drift_ppm - truth.drift_ppm[camera],
            }
        )
    tables.write(errors_csv, pd.DataFrame(rows), labels)


if __name__ == "__main__":
    run(main, snakemake)
