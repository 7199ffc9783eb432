"""Courtside's pose detection on whole frames, timed.

Arguments: frames.npy result.npz detector.tflite landmarks.tflite. The networks are the very files
inside the peer's package, converted by this project. `network` is the landmark network alone, on
noise.
"""

import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "workflow" / "lib"))
from courtside.pose import blazepose
from courtside.pose.conversion import tflite_onnx

MIN_PRESENCE = 0.5
LANDMARK_OUTPUTS = ["Identity", "Identity_1", "Identity_3", "Identity_4"]


def networks(detector_tflite, landmarks_tflite):
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / "detector.onnx", Path(folder) / "landmarks.onnx"]
        tflite_onnx.convert(detector_tflite, paths[0])
        tflite_onnx.convert(landmarks_tflite, paths[1], outputs=LANDMARK_OUTPUTS)
        return blazepose.BlazePoseDetector(paths[0]), blazepose.BlazePoseLandmarks(paths[1])


def ours(frames, detector, landmarks, follow):
    """Yield each frame's joints (33, 2) px, NaN without anyone; `follow` starts from the last."""
    region = None
    for frame in frames:
        pose = landmarks.estimate(frame, region) if region is not None else None
        if pose is None or pose.presence < MIN_PRESENCE:
            found = detector.detect(frame)
            pose = landmarks.estimate(frame, found[0]) if found else None
        seen = pose is not None and pose.presence >= MIN_PRESENCE
        region = pose.region if seen and follow else None
        yield pose.xy if seen else np.full((33, 2), np.nan)


def timed(frames, detector, landmarks, follow):
    seconds, xy = [], []
    start = time.process_time()
    for joints in ours(frames, detector, landmarks, follow):
        seconds.append(time.process_time() - start)
        xy.append(joints)
        start = time.process_time()
    return seconds, np.array(xy)


def alone(landmarks, count):
    """Return the seconds of each of some runs of the landmark network."""
    tensor = np.random.default_rng(0).random((1, 256, 256, 3), np.float32)
    seconds = []
    for _ in range(count):
        start = time.process_time()
        landmarks.network.run(tensor)
        seconds.append(time.process_time() - start)
    return seconds


def main(frames_npy, result_npz, detector_tflite, landmarks_tflite):
    frames = np.load(frames_npy)
    pair = networks(detector_tflite, landmarks_tflite)
    timed(frames[:3], *pair, follow=True)  # warm-up
    static_s, static = timed(frames, *pair, follow=False)
    tracking_s, tracking = timed(frames, *pair, follow=True)
    np.savez(result_npz, static=static, tracking=tracking)
    network_s = alone(pair[1], len(frames))
    print(json.dumps({"static": static_s, "tracking": tracking_s, "network": network_s}))


if __name__ == "__main__":
    main(*sys.argv[1:])
