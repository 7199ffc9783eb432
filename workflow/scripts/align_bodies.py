"""Put one source of a take into the body frame of all: device motions, clocks -> body motion, its frame."""

from courtside.motion import bodyframe, common_frame, device_events
from courtside.records import body_motion, derived, device_motion, sync
from courtside.study import log
from courtside.study.files import write_json


def main(
    device_npz, sync_json, derived_yaml, body_npz, frame_json, *, source, skeleton, devices, stated
):
    motions = {motion.source: motion for motion in map(device_motion.read, device_npz)}
    reference, found = sync.read(sync_json)
    of_device = {devices[name]: clock for name, clock in found.items()}
    clocks = {name: of_device[devices[name]] for name in motions}
    order = sorted(motions, key=lambda name: name != reference)
    shown = device_events.shown(list(motions.values()), devices, stated)
    happened = {name: shown[name] for name in order}
    chosen = common_frame.common(happened, clocks, motions)[source]
    motion, clock = motions[source], clocks[source]
    anchors = bodyframe.anchors(derived.read(derived_yaml), skeleton, motion.joints)
    frame = bodyframe.at_tpose(motion, anchors, chosen)
    claps = common_frame.claps_of(source, happened, clocks)
    body = common_frame.aligned(motion, frame, clock, claps)
    log.logger.info("%s: unit %.4f m, %s", source, body.unit_m, frame.residuals)
    body_motion.write(body_npz, body)
    write_json(frame_json, frame.as_dict())


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.devices,
        snakemake.input.sync,
        snakemake.input.derived,
        snakemake.output.body,
        snakemake.output.frame,
        source=snakemake.wildcards.source,
        **snakemake.params.step,
    )
