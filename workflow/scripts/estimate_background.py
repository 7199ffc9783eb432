"""Estimate the empty picture of one fixed camera: the take itself -> temporal median."""

import numpy as np

from courtside.devices import still, video
from courtside.study import log


def main(source, background_png, *, trim_s, n_frames):
    start_s, stop_s = trim_s or (None, None)
    times_s = video.frame_times(source, stop_s=stop_s)
    count = (times_s >= (start_s or 0.0)).sum()
    chosen = set(np.unique(np.linspace(0, count - 1, n_frames).round().astype(int)).tolist())
    frames = video.frames(source, start_s=start_s, stop_s=stop_s)
    images = [image for at, (_, image) in enumerate(frames) if at in chosen]
    video.write_png(background_png, still.temporal_median(images))


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.source,
        snakemake.output.png,
        trim_s=snakemake.params.trim_s,
        **snakemake.params.step,
    )
