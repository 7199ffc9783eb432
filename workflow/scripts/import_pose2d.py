"""Import one camera's 2D keypoints of another program.

Reads a folder of OpenPose's JSON and the video, or without one the folders of all cameras and the
calibrated cameras; writes 2D keypoints.
"""

import numpy as np

from courtside.devices import frame_numbers, openpose
from courtside.geometry import camera as camera_models
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import packets, reader


def main(paths, pose2d_npz, *, camera, model, trim_s, folders=None, rate_hz=None):
    if paths.video:
        stop_s = trim_s[1] if trim_s else None
        # All frames of the video, whatever is used of them: the files count them.
        times_s = packets.list_packets(paths.video, stop_s=stop_s).times_s
        frames = {"size": reader.probe(paths.video, stop_s=stop_s).size, "time_s": times_s}
        frames["video"] = paths.video
    else:
        numbers = frame_numbers.common(folders)
        known = {one.name: one for one in camera_models.read_toml(paths.cameras)}
        frames = {"size": known[camera].size, "time_s": np.arange(len(numbers)) / rate_hz}
        frames["first"] = numbers[0]
    found = openpose.read(
        paths.folder,
        skeleton.read(paths.skeleton),
        camera=camera,
        model=model,
        trim_s=trim_s,
        **frames,
    )
    log.logger.info("%s: %d tracklets, %d frames", camera, len(found.xy), len(found.time_s))
    keypoints.write_2d(pose2d_npz, found)


if __name__ == "__main__":
    run(main, snakemake)
