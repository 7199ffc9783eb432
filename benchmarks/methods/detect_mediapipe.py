"""MediaPipe Pose's own Python solution on whole frames, timed.

Arguments: frames.npy result.npz model_complexity.

Its smoothing is off, so that joints can be compared. The conversion to RGB that it asks for is not
timed.
"""

import json
import sys
import time

import mediapipe
import numpy as np

OPTIONS = {"min_detection_confidence": 0.5, "smooth_landmarks": False}


def timed(frames, static, complexity):
    seconds, xy = [], []
    height, width = frames.shape[1:3]
    options = {"static_image_mode": static, "model_complexity": complexity, **OPTIONS}
    with mediapipe.solutions.pose.Pose(**options) as solution:
        solution.process(frames[0])  # warm-up: loads the networks
        for frame in frames:
            start = time.process_time()
            found = solution.process(frame).pose_landmarks
            seconds.append(time.process_time() - start)
            joints = [(j.x * width, j.y * height) for j in found.landmark] if found else None
            xy.append(joints or [(np.nan, np.nan)] * 33)
    return seconds, np.array(xy)


def main(frames_npy, result_npz, complexity):
    frames = np.ascontiguousarray(np.load(frames_npy)[..., ::-1])
    static_s, static = timed(frames, True, int(complexity))
    tracking_s, tracking = timed(frames, False, int(complexity))
    np.savez(result_npz, static=static, tracking=tracking)
    print(json.dumps({"static": static_s, "tracking": tracking_s}))


if __name__ == "__main__":
    main(*sys.argv[1:])
