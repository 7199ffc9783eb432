"""Estimate the empty picture of one fixed camera: static frames or the take itself -> temporal median."""

from pathlib import Path

import cv2
import numpy as np

from courtside.devices import video
from courtside.pose import foreground
from courtside.study import log


def main(source, background_png, *, trim_s, n_frames):
    if Path(source).is_dir():
        paths = sorted(Path(source).glob("*.png"))
        images = [cv2.imread(str(paths[at])) for at in spread(len(paths), n_frames)]
    else:
        start_s, stop_s = trim_s or (None, None)
        times_s = video.frame_times(source, stop_s=stop_s)
        count = (times_s >= (start_s or 0.0)).sum()
        chosen = set(spread(count, n_frames))
        frames = video.frames(source, start_s=start_s, stop_s=stop_s)
        images = [image for at, (_, image) in enumerate(frames) if at in chosen]
    video.write_png(background_png, foreground.estimate_background(images))


def spread(n_available, n_wanted):
    return np.unique(np.linspace(0, n_available - 1, n_wanted).round().astype(int)).tolist()


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.source,
        snakemake.output.png,
        trim_s=snakemake.params.trim_s,
        **snakemake.params.step,
    )
