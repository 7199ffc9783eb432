"""Compare the body frames of one take's sources with the true ones.

Reads body motions, frames and truth; writes errors.
"""

import numpy as np
import pandas as pd

from courtside.body_frame import common, frame
from courtside.evaluation import sources
from courtside.events import tpose
from courtside.records import tables
from courtside.records.devices import device_motion
from courtside.records.keypoints import body_motion, derived_joints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(body_npz, frame_json, truth_npz, derived_yaml, errors_csv, *, labels, person, owners):
    truth = take_truth.read(truth_npz)
    true = device_motion.of_truth(truth, person)
    spells = tpose.find(true)
    carried_by = frame.anchors(derived_joints.read(derived_yaml), derived_joints.RIG, true.joints)
    rows = []
    for body, own in zip(map(body_motion.read, body_npz), frame_json, strict=True):
        expected = common.counterpart(true, spells, carried_by, body.tpose_s).body_from_device
        device = truth.devices.get(owners[body.source])
        pose = np.eye(3, 4) if device is None else device.from_world  # fixed cameras: the world
        found = sources.body_frame_errors(frame.read_transform(own), pose, expected)
        rows.append({"source": body.source, **found})
    tables.write(errors_csv, pd.DataFrame(rows), labels)


if __name__ == "__main__":
    run(main, snakemake)
