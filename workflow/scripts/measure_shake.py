"""Measure the shake of a fixed camera during a take: static picture, video -> table per frame."""

import cv2
import numpy as np

from courtside.records.cameras import shake_table
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import images, reader, shake_tracking


def main(static_png, video_path, shake_csv, *, camera, trim_s):
    cv2.setNumThreads(1)
    start_s, stop_s = trim_s or (None, None)
    times_s = reader.frame_times(video_path, stop_s=stop_s)
    first = 0 if start_s is None else int(np.count_nonzero(times_s < start_s))
    frames = reader.frames(video_path, start_s=start_s, stop_s=stop_s)
    frames = log.progress(frames, len(times_s) - first, f"{camera}: frames")
    table = shake_tracking.measure_take(images.read(static_png), frames, first)
    shake_table.write(shake_csv, table)


if __name__ == "__main__":
    run(main, snakemake)
