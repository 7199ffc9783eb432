"""Estimate the empty picture of one fixed camera: static frames or the take itself -> temporal median."""

from pathlib import Path

import cv2
import numpy as np

from courtside.devices import video
from courtside.pose import foreground
from courtside.study import log


def main(source, background_png, *, n_frames):
    if Path(source).is_dir():
        paths = sorted(Path(source).glob("*.png"))
        images = [cv2.imread(str(paths[at])) for at in spread(len(paths), n_frames)]
    else:
        chosen = set(spread(len(video.frame_times(source)), n_frames))
        images = [i for at, (_, i) in enumerate(video.frames(source)) if at in chosen]
    video.write_png(background_png, foreground.estimate_background(images))


def spread(n_available, n_wanted):
    return np.unique(np.linspace(0, n_available - 1, n_wanted).round().astype(int)).tolist()


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(snakemake.input.source, snakemake.output.png, **snakemake.params.step)
