"""Extract the frames of one static recording on a fixed grid: video -> PNG files and their table."""

from pathlib import Path

import pandas as pd

from courtside.devices import video
from courtside.study import log
from courtside.study.files import atomic


def main(video_path, folder, table_csv, *, every_s):
    rows = []
    for frame_idx, time_s, image in video.extract_frames(video_path, every_s):
        name = f"{len(rows):06d}.png"
        video.write_png(Path(folder) / name, image)
        rows.append((frame_idx, round(time_s, 6), round(video.sharpness(image), 3), name))
    table = pd.DataFrame(rows, columns=["frame_idx", "time_s", "sharpness", "name"])
    with atomic(table_csv) as temporary:
        table.to_csv(temporary, index=False)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.video,
        snakemake.output.folder,
        snakemake.output.table,
        **snakemake.params.step,
    )
