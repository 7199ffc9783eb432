"""Draw how the fixed cameras shook in a take: shake, cameras, skeletons -> figure, CSV, lines."""

import numpy as np

from courtside.figures.style import style
from courtside.figures.take import camera_shake
from courtside.geometry import camera as cameras
from courtside.reconstruction import camera_shake as knocks
from courtside.records.cameras import shake_table
from courtside.records.keypoints import keypoints
from courtside.study.execution import log
from courtside.study.execution.files import atomic
from courtside.study.execution.script import run


def main(paths, pdf, png, csv, text_path):
    calibrated = {camera.name: camera for camera in cameras.read_toml(paths.cameras)}
    tables = shake_table.read_all(paths.shake)
    seen = keypoints.read_3d(paths.pose3d).xyz.reshape(-1, 3)
    seen = seen[np.isfinite(seen).all(axis=1)]
    player = np.median(seen, axis=0) if len(seen) else np.full(3, np.nan)
    lines = [line for name in tables for line in knocks.say(calibrated[name], tables[name], player)]
    for line in lines:
        log.logger.info("%s", line)
    rows = camera_shake.table(calibrated, tables, player)
    style.save(camera_shake.draw(rows), rows, pdf, png, csv)
    with atomic(text_path) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    run(main, snakemake)
