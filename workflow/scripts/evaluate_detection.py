"""Evaluate the keypoints of a take in each picture.

Reads 2D keypoints, and true joints and true cameras of a virtual take, else imported keypoints to
compare with; writes errors in px.
"""

import pandas as pd

from courtside.evaluation import detection
from courtside.records import tables
from courtside.records.devices import clocks
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.truth import session_truth, take_truth
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(
    pose2d_npz,
    skeleton_yaml,
    errors_csv,
    *,
    n_persons,
    labels,
    take_truth_npz=None,
    truth_npz=None,
    reference_npz=(),
):
    joints = skeleton.read(skeleton_yaml).groups["limbs"]
    views = [keypoints.read_2d(path) for path in pose2d_npz]
    if truth_npz:
        found = against_truth(views, take_truth.read(take_truth_npz), truth_npz, joints)
    else:
        others = [keypoints.read_2d(path) for path in reference_npz]
        pairs = zip(views, others, strict=True)
        found = [detection.against(view, other, joints, n_persons) for view, other in pairs]
    parts = []
    for view, rows in zip(views, found, strict=True):
        whole = 100 * rows.groupby(["person", "frame_idx"]).placed.all().mean()
        log.logger.info("%s: all %d joints in %.0f %% of frames", view.camera, len(joints), whole)
        parts.append(rows)
    tables.write(errors_csv, pd.concat(parts, ignore_index=True), labels, "%.4f")


def against_truth(views, real, truth_npz, joints):
    known = {camera.name: camera for camera in session_truth.read(truth_npz).cameras}
    for view in views:
        clock = clocks.Clock(real.offset_s[view.camera], real.drift_ppm[view.camera])
        yield detection.evaluate(known[view.camera], view, clock, real, joints)


if __name__ == "__main__":
    run(main, snakemake)
