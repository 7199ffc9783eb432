"""Estimate the empty picture of one fixed camera: the take itself -> temporal median."""

import numpy as np

from courtside.study.execution.script import run
from courtside.video import reader, static_picture


def main(source, background_png, *, trim_s, n_frames):
    start_s, stop_s = trim_s or (None, None)
    times_s = reader.frame_times(source, stop_s=stop_s)
    count = (times_s >= (start_s or 0.0)).sum()
    chosen = set(np.unique(np.linspace(0, count - 1, n_frames).round().astype(int)).tolist())
    frames = reader.frames(source, start_s=start_s, stop_s=stop_s)
    images = [image for at, (_, image) in enumerate(frames) if at in chosen]
    reader.write_png(background_png, static_picture.temporal_median(images))


if __name__ == "__main__":
    run(main, snakemake)
