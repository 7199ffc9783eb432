"""Fit the errors that residuals do not show, on development players, all and fewer cameras."""

import numpy as np

from courtside.evaluation import error_fit
from courtside.reconstruction import joint_correction, joint_errors
from courtside.records import tables
from courtside.records.keypoints import skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, errors_csv, *, takes, about, step, filtering):
    table = joint_correction.read(paths.offsets) if paths.offsets else None
    joints, parts = skeleton.read(paths.skeleton), []
    for seen, sex_of, truth in error_fit.footage_with_truth(takes):
        parts += error_fit.joints_of_sets(seen, joints, sex_of, table, truth, step, filtering)
    columns, error, covariance, weight = map(np.concatenate, zip(*parts, strict=True))
    log.logger.info("joints: %d", len(columns))
    model = joint_errors.fit(columns, error, covariance, weight)
    tables.write(errors_csv, joint_errors.table(model), about=about)


if __name__ == "__main__":
    run(main, snakemake)
