"""Correct a mocopi recording by vision.

Reads its motion, a camera's skeleton and clocks; writes corrected BVH and GLB, motion, events and
report.
"""

from dataclasses import replace
from math import hypot

from courtside.events import detect
from courtside.exports import bvh
from courtside.exports import device as device_export
from courtside.exports.trees import gltf
from courtside.inertial import correction
from courtside.inertial import report as reports
from courtside.records.devices import clocks as sync
from courtside.records.devices import device_motion, events
from courtside.records.devices.hierarchy import forward
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.script import run

ABSENT = sync.Clock(status="unknown", note="not in the file")


def main(
    device_npz,
    skeleton_yaml,
    vision_npz,
    sync_json,
    motion_npz,
    corrected_bvh,
    corrected_glb,
    events_json,
    report_json,
    *,
    device,
    vision_device,
    sigma_m,
):
    names = skeleton.read(skeleton_yaml)
    motion, vision = device_motion.read(device_npz), device_motion.read(vision_npz)
    own, theirs = usable(sync_json, device, vision_device)
    lag_s = hypot(own.uncertainty_s, theirs.uncertainty_s)
    corrected, report = correction.correct(
        replace(motion.posed, time_s=own.to_reference(motion.time_s)),
        replace(vision, time_s=theirs.to_reference(vision.time_s)),
        sigma_m=sigma_m,
        lag_s=lag_s,
        performed=motion.performed,
    )
    time_s = own.from_reference(corrected.time_s)
    corrected = replace(corrected, time_s=time_s)
    order = [corrected.hierarchy.joints.index(joint) for joint in motion.joints]
    xyz = forward(corrected)[0][:, order]
    motion = replace(motion, source=f"{device}-corrected", time_s=time_s, xyz=xyz, posed=corrected)
    device_motion.write(motion_npz, motion)
    events.write(events_json, detect.detect([motion]))
    bvh.write(corrected_bvh, device_export.named(corrected, names))
    shown = device_export.named(device_export.performed(motion), names)
    gltf.write(corrected_glb, shown, motion.source)
    report.write(report_json)
    tell(device, reports.doubts(report, lag_s), report_json)


def usable(sync_json, *names):
    _, clocks = sync.read(sync_json)
    used = {name: clocks.get(name, ABSENT) for name in names}
    if fault := sync.fault_line(sync_json, used, "device"):
        raise InputError(fault)
    return used.values()


def tell(device, doubts, path):
    for doubt in doubts:
        log.tell(f"{device}: {doubt}", path)


if __name__ == "__main__":
    run(main, snakemake)
