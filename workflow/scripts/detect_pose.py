"""Detect the people in one camera during one take: video -> 2D keypoints."""

import cv2
import numpy as np

from courtside.pose import decoders, foreground, tracklets
from courtside.pose.blazepose import BlazePoseDetector
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import images, reader


def main(
    paths, pose2d_npz, *, camera, model, decoder, trim_s, max_people, min_difference, **options
):
    cv2.setNumThreads(1)
    joints = skeleton.read(paths.skeleton).joints
    start_s, stop_s = trim_s or (None, None)
    info = reader.probe(paths.video, stop_s=stop_s)
    frames = reader.frames(paths.video, start_s=start_s, stop_s=stop_s)
    changed = foreground.Whole()
    if paths.background:
        changed = foreground.Foreground(images.read(paths.background), min_difference)
    track = tracklets.track_people(
        log.progress(frames, info.n_frames if not trim_s else None, f"{camera}: frames"),
        BlazePoseDetector(paths.detector),
        decoders.landmark_network(paths.landmarks, joints, **decoder),
        changed,
        max_people=max_people,
        **options,
    )
    found = keypoints.Keypoints2D(
        camera=camera,
        model=model,
        joints=np.array(joints),
        size=np.array(info.size),
        time_s=track.time_s,
        xy=track.xy,
        score=track.score,
        reason=track.reason,
        xyz_in_body=track.xyz_in_body,
    )
    keypoints.write_2d(pose2d_npz, found)


if __name__ == "__main__":
    run(main, snakemake)
