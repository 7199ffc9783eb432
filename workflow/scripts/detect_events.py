"""Detect T-poses and claps of each source: motions -> T-poses, claps, wrist distance."""

from courtside.events import detect
from courtside.records import tables
from courtside.records.devices import device_motion, events
from courtside.study.execution.script import run


def main(device_npz, events_json, wrists_csv, events_csv):
    motions = [device_motion.read(path) for path in device_npz]
    found = detect.detect(motions)
    events.write(events_json, found)
    tables.write(wrists_csv, detect.wrists(motions))
    tables.write(events_csv, detect.events(found))


if __name__ == "__main__":
    run(main, snakemake)
