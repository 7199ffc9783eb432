"""Compare joint angles of a take's sources with the truth, before and after the skeletal model."""

import pandas as pd

from courtside.body_model import source
from courtside.evaluation import kinematics
from courtside.exports import device as device_export
from courtside.records import tables
from courtside.records.devices import clocks, device_motion
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(
    device_npz, fitted_npz, sync_json, truth_npz, errors_csv,
    *, person, devices, sigma_m_of, labels,
):  # fmt: skip
    truth, (_, found) = take_truth.read(truth_npz), clocks.read(sync_json)
    of_device = {devices[name]: clock for name, clock in found.items() if name in devices}
    rows = []
    for raw, fitted in zip(device_npz, fitted_npz, strict=True):
        motion = device_motion.read(raw)
        name = motion.source
        points = device_export.points(motion, person)
        if name in sigma_m_of:
            points = source.observed(points, sigma_m_of[name])
        for stage, one in (("source", points), ("model", keypoints.read_3d(fitted))):
            clock = of_device[devices[name]]
            if line := kinematics.no_common_time(f"{name}, {stage}", one, truth, clock):
                log.logger.warning("%s", line)
            errors = kinematics.angles_of(one, truth, person, clock)
            rows.append(errors.assign(source=name, stage=stage))
    table = pd.concat(rows, ignore_index=True).drop(columns="person")
    tables.write(errors_csv, tables.labels_first(table, ["source", "stage"]), labels)


if __name__ == "__main__":
    run(main, snakemake)
