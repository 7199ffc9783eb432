"""Evaluate the keypoints of a take in each picture.

Reads 2D keypoints, true joints and true cameras; writes errors in px.
"""

import pandas as pd

from courtside.evaluation import detection
from courtside.records import tables
from courtside.records.devices import clocks
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.truth import session_truth, take_truth
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(pose2d_npz, take_truth_npz, truth_npz, skeleton_yaml, errors_csv, *, labels):
    known = {camera.name: camera for camera in session_truth.read(truth_npz).cameras}
    real = take_truth.read(take_truth_npz)
    joints = skeleton.read(skeleton_yaml).groups["limbs"]
    parts = []
    for path in pose2d_npz:
        view = keypoints.read_2d(path)
        clock = clocks.Clock(real.offset_s[view.camera], real.drift_ppm[view.camera])
        rows = detection.evaluate(known[view.camera], view, clock, real, joints)
        whole = 100 * rows.groupby(["person", "frame_idx"]).placed.all().mean()
        log.logger.info("%s: all %d joints in %.0f %% of frames", view.camera, len(joints), whole)
        parts.append(rows)
    tables.write(errors_csv, pd.concat(parts, ignore_index=True), labels, "%.4f")


if __name__ == "__main__":
    run(main, snakemake)
