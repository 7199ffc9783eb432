"""Measure how deep joints lie behind the skin of development bodies: lifted joints, truth -> depths."""

from courtside.evaluation import skin_depths
from courtside.records import tables
from courtside.records.devices import device_motion
from courtside.records.truth import take_truth
from courtside.study.execution import log


def main(lifted_npz, truth_npz, depths_csv, *, device, about, skin_m=None, beyond_m=None):
    pairs = []
    for found_npz, true_npz in zip(lifted_npz, truth_npz, strict=True):
        motion, truth = device_motion.read(found_npz), take_truth.read(true_npz)
        person = truth.devices[device].person
        true = skin_depths.in_camera(truth, device, person, motion.time_s)
        pairs.append((motion.xyz, true))
    table = skin_depths.estimate(pairs, motion.joints, truth.joints, skin_m, beyond_m)
    tables.write(depths_csv, table, about=about)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.lifted,
        snakemake.input.truth,
        snakemake.output.depths,
        device=snakemake.wildcards.device,
        about=snakemake.params.about,
        skin_m=snakemake.params.step.get("skin_m"),
        beyond_m=snakemake.params.step.get("beyond_m"),
    )
