"""Import one camera's 2D keypoints of another program.

Reads a folder of OpenPose's JSON and the video; writes 2D keypoints.
"""

from courtside.devices import openpose
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import reader


def main(paths, pose2d_npz, *, camera, model, trim_s):
    # The whole video, whatever is used of it: the files count its frames.
    info = reader.probe(paths.video)
    found = openpose.read(
        paths.folder,
        skeleton.read(paths.skeleton),
        camera=camera,
        model=model,
        size=info.size,
        time_s=reader.frame_times(paths.video),
        trim_s=trim_s,
    )
    log.logger.info("%s: %d tracklets, %d frames", camera, len(found.xy), len(found.time_s))
    keypoints.write_2d(pose2d_npz, found)


if __name__ == "__main__":
    run(main, snakemake)
