"""Extract the static picture of one fixed camera: its static recording -> PNG without people."""

import pandas as pd

from courtside.records import tables
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import reader, static_picture, walk_frames


def main(
    video_path, out_png, out_csv=None, *, frames, max_shift_px, max_zoom_percent, camera="camera"
):
    image, moved = static_picture.static_picture(
        camera,
        video_path,
        walk_frames.spread(video_path, frames),
        max_shift_px=max_shift_px,
        max_zoom_percent=max_zoom_percent,
    )
    reader.write_png(out_png, image)
    row = {"camera": camera, **moved.row()}
    log.logger.info("%s", row)
    if out_csv:
        tables.write(out_csv, pd.DataFrame([row]))


if __name__ == "__main__":
    run(main, snakemake)
