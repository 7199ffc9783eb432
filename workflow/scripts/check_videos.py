"""Check by the pictures of a hall whether each video is of its camera in a calibration file."""

import cv2
import pandas as pd

from courtside.calibration.file_check import exchanged_videos
from courtside.geometry import camera
from courtside.records import tables
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import images


def main(paths, check_json, check_csv, *, halls):
    cameras = {one.name: one for one in camera.read_toml(paths.cameras_toml)}
    warnings, remarks, rows = [], [], []
    for hall in halls:
        pictures = [images.read(path, cv2.IMREAD_GRAYSCALE) for path in hall["pictures"].values()]
        shown = [cameras[name] for name in hall["pictures"]]
        found = exchanged_videos.judge(shown, exchanged_videos.match(pictures))
        of_take = f"take {hall['take']}: " if hall["take"] else ""
        warnings += [of_take + line for line in found.warnings]
        remarks += [of_take + line for line in found.remarks]
        rows.append(found.table.assign(take=hall["take"]))
    for line in warnings:
        log.tell(line, check_json)
    tables.write(check_csv, pd.concat(rows)[["take", *exchanged_videos.ROWS]])
    write_json(check_json, {"warnings": warnings, "remarks": remarks})


if __name__ == "__main__":
    run(main, snakemake)
