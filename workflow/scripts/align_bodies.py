"""Put a take's source into the common body frame: motion, clock, T-pose -> body motion, frame."""

import json
from pathlib import Path

from courtside.body_frame import common
from courtside.body_frame import frame as bodyframe
from courtside.events.tpose import TPose
from courtside.records.devices import clocks, device_motion
from courtside.records.keypoints import body_motion, derived_joints
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(device_npz, sync_json, chosen_json, derived_yaml, body_npz, frame_json, *, skeleton, like):
    motion, clock = device_motion.read(device_npz), clocks.read(sync_json)[1][like]
    chosen = json.loads(Path(chosen_json).read_text(encoding="utf-8"))[motion.source]
    anchors = bodyframe.anchors(derived_joints.read(derived_yaml), skeleton, motion.joints)
    frame = bodyframe.at_tpose(motion, anchors, TPose(**chosen["tpose"]))
    body = common.aligned(motion, frame, clock, chosen["clap_s"])
    log.logger.info("%s: unit %.4f m, %s", motion.source, body.unit_m, frame.residuals)
    body_motion.write(body_npz, body)
    write_json(frame_json, frame.as_dict())


if __name__ == "__main__":
    run(main, snakemake)
