"""Find the devices' clocks of one take: motions, events -> clocks, wrist distance, events."""

from courtside.events import detect
from courtside.records import tables
from courtside.records.devices import clocks as sync
from courtside.records.devices import device_motion, events
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.synchronisation import devices as device_sync


def main(
    device_npz,
    events_json,
    sync_json,
    wrists_csv,
    events_csv,
    checks_csv,
    *,
    devices,
    stated,
    latency_s,
):
    motions, own = [device_motion.read(path) for path in device_npz], events.read([events_json])
    events_of = detect.of_devices(own, devices, stated)
    # The reference must clap: the first source of the first device that does.
    first = devices[motions[0].source]
    motions.sort(key=lambda m: (devices[m.source] != first, not events_of[m.source].claps))
    by_device = sync.stated(stated)
    known = {name: by_device[owner] for name, owner in devices.items() if owner in by_device}
    found = device_sync.synchronise(
        motions, events_of, devices=devices, known=known, latency=latency_s
    )
    clocks = {source: one.clock for source, one in found.items()}
    report(clocks)
    for source, clock in clocks.items():
        if clock.doubt:
            log.tell(f"{source} against {motions[0].source}: {clock.doubt}", sync_json)
    sync.write(sync_json, motions[0].source, clocks)
    tables.write(wrists_csv, detect.wrists(motions, clocks))
    own = {motion.source: own[motion.source] for motion in motions}
    tables.write(events_csv, detect.events(own, clocks))
    checks = device_sync.checks(found)
    checks["n_tposes"] = [len(events_of[source].tposes) for source in checks["source"]]
    tables.write(checks_csv, checks)


def report(clocks):
    for source, clock in clocks.items():
        log.logger.info(
            "%s: %s, offset %.1f ms, drift %.0f +- %.0f ppm, uncertain by %.1f ms; %s",
            source,
            clock.status,
            1e3 * clock.offset_s,
            clock.drift_ppm,
            clock.drift_uncertainty_ppm,
            1e3 * clock.uncertainty_s,
            clock.note,
        )


if __name__ == "__main__":
    run(main, snakemake)
