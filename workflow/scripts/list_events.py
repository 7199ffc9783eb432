"""List what each device shows, by its own clock: motions -> wrist distance, T-poses, claps."""

from courtside.events import detect
from courtside.records import tables
from courtside.records.devices import device_motion
from courtside.study.execution.script import run


def main(device_npz, wrists_csv, events_csv):
    motions = [device_motion.read(path) for path in device_npz]
    tables.write(wrists_csv, detect.wrists(motions))
    tables.write(events_csv, detect.events(motions))


if __name__ == "__main__":
    run(main, snakemake)
