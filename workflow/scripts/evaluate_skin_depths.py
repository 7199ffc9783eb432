"""Measure the depth of joints behind the skin of development bodies: joints, truth -> depths."""

from courtside.evaluation import skin_depths
from courtside.records import tables
from courtside.records.devices import device_motion
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(lifted_npz, truth_npz, depths_csv, *, device, about, step):
    pairs = []
    for found_npz, true_npz in zip(lifted_npz, truth_npz, strict=True):
        motion, truth = device_motion.read(found_npz), take_truth.read(true_npz)
        person = truth.devices[device].person
        true = skin_depths.in_camera(truth, device, person, motion.time_s)
        pairs.append((motion.xyz, true))
    skin_m, beyond_m = step.get("skin_m"), step.get("beyond_m")
    table = skin_depths.estimate(pairs, motion.joints, truth.joints, skin_m, beyond_m)
    tables.write(depths_csv, table, about=about)


if __name__ == "__main__":
    run(main, snakemake)
