"""Choose the T-pose that all sources of a take show best: motions, clocks -> its spells, claps."""

from courtside.body_frame import common
from courtside.events import detect
from courtside.records.devices import clocks as sync
from courtside.records.devices import device_motion
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(device_npz, sync_json, chosen_json, *, devices, stated):
    motions = {motion.source: motion for motion in map(device_motion.read, device_npz)}
    reference, found = sync.read(sync_json)
    of_device = {devices[name]: clock for name, clock in found.items()}
    clocks = {name: of_device[devices[name]] for name in motions}
    order = sorted(motions, key=lambda name: name != reference)
    shown = detect.shown(list(motions.values()), devices, stated)
    happened = {name: shown[name] for name in order}
    chosen = common.common(happened, clocks, motions)
    content = {
        source: {
            "tpose": spell.as_dict(),
            "clap_s": common.claps_of(source, happened, clocks).tolist(),
        }
        for source, spell in chosen.items()
    }
    for source, spell in chosen.items():
        log.logger.info("%s: T-pose %.2f to %.2f s", source, spell.start_s, spell.stop_s)
    write_json(chosen_json, content)


if __name__ == "__main__":
    run(main, snakemake)
