"""Detect a person by another execution provider: time a frame, and distance of joints to `cpu`.

    python benchmarks/execution_providers.py RESULTS VIDEO [--provider cuda] [--frames 100]
        [--models blazepose-full blazepose-heavy blazepose-heavy-flip]

RESULTS is of a run that converted the networks. The frames are decoded before the clock starts. One
process follows the person of the video, as the study follows people; `frame` is the wall time of
the median frame, `pass` that of one run of the landmark network alone. `apart` is the distance of
joints from those by `cpu` of the same regions, in px of the picture: median and largest.
"""

import argparse
import itertools
import sys
import time
from pathlib import Path

import numpy as np
import yaml

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.pose import open_network, tracking
from courtside.pose.networks import session
from courtside.records.keypoints import skeleton
from courtside.video import reader

MIN_PRESENCE = 0.5  # as `detect_pose.min_presence` of the default study
PASSES = 50


def opened(results, name, provider):
    """Return the detector and the landmark network of one of BlazePose's models."""
    declared = yaml.safe_load((ROOT / "config" / "models.yaml").read_text())[name]
    folder, how = results / "networks" / name, {"decoder": "blazepose", "providers": [provider]}
    joints = skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml").joints
    landmarks = open_network.landmark_network(
        folder / "landmarks.onnx", joints, flip_test=declared.get("flip_test", False), **how
    )
    return open_network.person_detector(folder / "detector.onnx", **how), landmarks


def follow(frames, detector, landmarks):
    """Return the (frame, region, pose) of each frame with the person, and ms of the median one."""
    found, times, region = [], [], None
    for frame in frames:
        start = time.perf_counter()
        pose = landmarks.estimate(frame, region) if region else None
        if pose is None or pose.presence < MIN_PRESENCE:
            whole = (0, 0, frame.shape[1], frame.shape[0])
            region = tracking.regions_near(frame, whole, detector)[0]
            pose = landmarks.estimate(frame, region)
        times.append(time.perf_counter() - start)
        if pose.presence >= MIN_PRESENCE:
            found.append((frame, region, pose))
        region = pose.region if pose.presence >= MIN_PRESENCE else None
    return found, 1000 * float(np.median(times))


def pass_ms(landmarks):
    """Return the wall time of one run of a landmark network, ms."""
    tensor = np.random.default_rng(0).random((1, 256, 256, 3), np.float32)
    times = [time.perf_counter()]
    for _ in range(PASSES):
        landmarks.network.run(tensor)
        times.append(time.perf_counter())
    return 1000 * float(np.median(np.diff(times)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("video", type=Path)
    parser.add_argument("--provider", choices=session.PROVIDERS, default="cuda")
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument(
        "--models", nargs="+", default=["blazepose-full", "blazepose-heavy", "blazepose-heavy-flip"]
    )
    given = parser.parse_args()
    read = itertools.islice(reader.frames(given.video), given.frames)
    frames = [image for _, image in read]
    for name in given.models:
        by = {one: opened(given.results, name, one) for one in ("cpu", given.provider)}
        for provider, networks in by.items():
            follow(frames[:3], *networks)  # warm-up
            found, frame_ms = follow(frames, *networks)
            print(
                f"{name}, {provider}: frame {frame_ms:.1f} ms, pass {pass_ms(networks[1]):.2f} ms, "
                f"found in {len(found)} of {len(frames)} frames"
            )
        same, _ = follow(frames, *by["cpu"])
        again = by[given.provider][1]
        away = [
            np.linalg.norm(again.estimate(frame, region).xy - pose.xy, axis=-1)
            for frame, region, pose in same
        ]
        print(f"{name}: apart {np.median(away):.1e} px, at most {np.max(away):.1e} px")


if __name__ == "__main__":
    main()
