"""Estimate joint offsets on development bodies: 2D keypoints, true cameras, truths -> offsets."""

import numpy as np

from courtside.evaluation import error_fit
from courtside.reconstruction import joint_correction
from courtside.records import tables
from courtside.records.keypoints import skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, offsets_csv, *, takes, about, step):
    shape, clips = skeleton.read(paths.skeleton), []
    for seen, sex_of, truth in error_fit.footage_with_truth(takes):
        raw = error_fit.triangulated(seen, shape, list(sex_of), step)
        clips += error_fit.clips(raw, seen, sex_of, truth)
    table = joint_correction.estimate(clips, raw.joints, truth.joints)
    log.logger.info("frames: %d", np.sum([len(clip.xyz) for clip in clips]))
    tables.write(offsets_csv, table, about=about)


if __name__ == "__main__":
    run(main, snakemake)
