"""Evaluate one take's sources against its truth: body motions, truth -> errors and their parts."""

from dataclasses import replace

import numpy as np
import pandas as pd

from courtside.body_frame import common
from courtside.body_frame import frame as bodyframe
from courtside.evaluation import sources
from courtside.events import tpose
from courtside.kinematics import smoothness, wrist_arcs
from courtside.records import tables
from courtside.records.devices import device_motion
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import body_motion, derived_joints
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(
    body_npz,
    truth_npz,
    derived_yaml,
    errors_csv,
    parts_csv,
    paths_csv,
    distortion_csv,
    *,
    labels,
    person,
    sparc_rate_hz,
):
    true = device_motion.of_truth(take_truth.read(truth_npz), person)
    spells = tpose.find(true)
    table = derived_joints.read(derived_yaml)
    carried_by = bodyframe.anchors(table, derived_joints.RIG, true.joints)
    errors, parts, paths, distortion = [], [], [], []
    for body in map(body_motion.read, body_npz):
        frame = common.counterpart(true, spells, carried_by, body.tpose_s)
        reference = common.aligned(true, frame, Clock())
        names, found = sources.errors(body, reference)
        _, expected = sources.matched(body, reference)
        known = np.isfinite(expected).all(axis=-1)
        errors.append(sources.table(names, found, known).assign(source=body.source))
        for form in ("fixed", "following"):
            part = sources.split(body, reference, form=form)
            parts.append(part.assign(source=body.source, frame=form))
        own = replace(reference, source=body.source, clap_s=body.clap_s)
        swept = wrist_arcs.arcs_or_none(own, "true arcs")
        paths.append(wrist_arcs.paths(swept).assign(source=body.source))
        row = wrist_arcs.distortion(swept).assign(source=body.source, unit_m=reference.unit_m)
        distortion.append(row.assign(sparc=smoothness.of_arcs(reference, swept, sparc_rate_hz)))
    files = errors_csv, parts_csv, paths_csv, distortion_csv
    for path, rows in zip(files, (errors, parts, paths, distortion), strict=True):
        rows = pd.concat(rows, ignore_index=True)
        tables.write(path, tables.labels_first(rows, ["source"]), labels)


if __name__ == "__main__":
    run(main, snakemake)
