"""Calibrate a fixed camera's lens from pictures of a chessboard: images -> K and distortion."""

import cv2
import numpy as np

from courtside.calibration.boards import chessboard
from courtside.geometry import camera as cameras
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(images, lens_toml, *, camera, inner_corners):
    cv2.setNumThreads(1)  # of several, sums depend on which ends first
    boards = chessboard.find(images, inner_corners)
    lens = chessboard.calibrate(boards, name=camera)
    log.logger.info("%s: %d boards, %.2f px", camera, lens.n_used, lens.rms_px)
    for path, why in lens.dropped.items():
        log.logger.info("%s: left out, %s", path, why)
    for warning in chessboard.warnings(lens, name=camera):
        log.logger.warning("%s", warning)
    nowhere = np.eye(3, 4)  # a lens has no place
    found = cameras.Camera(camera, lens.size, lens.K, lens.dist, nowhere)
    cameras.write_toml(lens_toml, [found], source=f"chessboard, {lens.n_used} pictures")


if __name__ == "__main__":
    run(main, snakemake)
