"""Put a take's source into the common body frame: motion, clocks, events -> body motion, frame."""

import numpy as np

from courtside.body_frame import common
from courtside.body_frame import frame as bodyframe
from courtside.events import detect
from courtside.records.devices import clocks as sync
from courtside.records.devices import device_motion, events
from courtside.records.keypoints import body_motion, derived_joints
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(
    device_npz,
    sync_json,
    events_json,
    derived_yaml,
    body_npz,
    frame_json,
    *,
    skeleton,
    devices,
    stated,
):
    motion, (reference, found) = device_motion.read(device_npz), sync.read(sync_json)
    of_device = {devices[name]: clock for name, clock in found.items()}
    clocks = {name: of_device[device] for name, device in devices.items()}
    events_of = detect.of_devices(events.read(events_json), devices, stated)
    events_of = {reference: events_of[reference], **events_of}
    spell = common.common(events_of, clocks)[motion.source]
    anchors = bodyframe.anchors(derived_joints.read(derived_yaml), skeleton, motion.joints)
    frame = bodyframe.at_tpose(motion, anchors, spell)
    if doubt := bodyframe.doubt(motion, frame):
        log.tell(doubt, frame_json)
    claps_s = common.claps_of(motion.source, events_of, clocks)
    body = common.aligned(motion, frame, clocks[motion.source], claps_s)
    if np.isfinite(body.tpose_s).all():
        log.logger.info("%s: T-pose %.2f to %.2f s", motion.source, spell.start_s, spell.stop_s)
    else:
        warning = "%s: no T-pose: unit and axes are those of its model's rest pose; film a T-pose"
        log.logger.warning(warning, motion.source)
    log.logger.info("%s: unit %.4f m, %s", motion.source, body.unit_m, frame.residuals)
    body_motion.write(body_npz, body)
    write_json(frame_json, frame.as_dict())


if __name__ == "__main__":
    run(main, snakemake)
