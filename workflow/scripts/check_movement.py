"""Check that a fixed camera did not move or zoom before a take, nor during it.

Reads its static picture and its video; writes what it moved before.
"""

import pandas as pd

from courtside.records import tables
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import images, static_picture, walk_frames


def main(static_png, video_path, movement_csv, *, camera, frames, trim_s, **limits):
    pictures = walk_frames.spread(video_path, frames, trim_s=trim_s)
    now = static_picture.temporal_median(pictures)
    found = static_picture.check_still(camera, images.read(static_png), now, **limits)
    static_picture.check_kept_still(camera, video_path, pictures, **limits)
    row = {"camera": camera, **found.row()}
    log.logger.info("%s", row)
    tables.write(movement_csv, pd.DataFrame([row]))


if __name__ == "__main__":
    run(main, snakemake)
