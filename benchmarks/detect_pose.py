"""Detect the pose in the same whole frames with this project and MediaPipe: time and agreement.

    python benchmarks/detect_pose.py VIDEO [--environments DIR] [--frames 40] [--json OUT]

One core and one thread each, on the same decoded frames, with the same networks (taken from
MediaPipe's package). Static: the person is searched in every frame. Tracking: each frame starts
from the one before. This project runs before and after its peer so that a busier machine shows;
ratios are to the faster of the two.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

import peers

LINE = "{:<20}{:<10}{:>11.1f}{:>9.1f}{:>9.2f}{:>10}{:>16.2f}{:>12.2f}"
NETWORKS = ("pose_detection/pose_detection.tflite", "pose_landmark/pose_landmark_full.tflite")


def decode(path, count):
    """Return the first `count` frames, (T, H, W, 3) BGR."""
    capture = cv2.VideoCapture(str(path))
    frames = [frame for found, frame in (capture.read() for _ in range(count)) if found]
    if not frames:
        raise SystemExit(f"{path}: expected a video, found no frame that can be decoded")
    return np.array(frames)


def networks(python):
    """Return the network files inside the peer's package."""
    package = next(python.parents[1].glob("lib/python3*/site-packages/mediapipe/modules"))
    return [package / name for name in NETWORKS]


def measure(frames, environments):
    """Return {method: (seconds per frame by mode, joints by mode)}."""
    peer = peers.interpreter("mediapipe", environments)
    ours = (sys.executable, "detect_courtside.py", networks(peer))
    runs = {
        "courtside": ours,
        "mediapipe": (peer, "detect_mediapipe.py", []),
        "courtside (again)": ours,
    }
    measured = {}
    with tempfile.TemporaryDirectory() as name:
        frames_npy, result = Path(name) / "frames.npy", Path(name) / "result.npz"
        np.save(frames_npy, frames)
        for method, (python, script, more) in runs.items():
            seconds = peers.run_method(python, script, frames_npy, result, *more)
            if "failed" in seconds:
                print(f"{method}: {seconds['failed']}", file=sys.stderr)
                continue
            with np.load(result) as joints:
                measured[method] = seconds, dict(joints)
    return measured


def report(measured):
    """Print one line a method and mode, and return the lines as dictionaries."""
    print(f"{'method':<20}{'mode':<10}{'ms/frame':>11}{'p95':>9}{'ratio':>9}{'found':>10}"
          f"{'from peer: px':>16}{'p95':>12}")  # fmt: skip
    lines = []
    for mode in ("static", "tracking"):
        ours = [run for method, run in measured.items() if method.startswith("courtside")]
        base_ms = min((1000 * np.median(run[0][mode]) for run in ours), default=np.nan)
        for method, (seconds, joints) in measured.items():
            times_ms = 1000 * np.array(seconds[mode])
            away = np.linalg.norm(joints[mode] - measured["mediapipe"][1][mode], axis=-1)
            found = int(np.isfinite(joints[mode][:, 0, 0]).sum())
            numbers = (
                np.median(times_ms),
                np.percentile(times_ms, 95),
                np.median(times_ms) / base_ms,
            )
            apart = (np.nanmedian(away), np.nanpercentile(away, 95))
            print(LINE.format(method, mode, *numbers, f"{found}/{len(times_ms)}", *apart))
            keys = ("median_ms", "p95_ms", "ratio", "from_peer_median_px", "from_peer_p95_px")
            values = map(float, (*numbers, *apart))
            lines.append(
                {
                    "method": method,
                    "mode": mode,
                    "found": found,
                    **dict(zip(keys, values, strict=True)),
                }
            )
    return lines


def main():
    """Run the comparison on one video."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("video", type=Path)
    parser.add_argument("--environments", type=Path, default=peers.FOLDER)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--json", type=Path, help="also write the numbers to this file")
    given = parser.parse_args()
    frames = decode(given.video, given.frames)
    print(f"{given.video.name}: {len(frames)} frames of {frames.shape[2]} x {frames.shape[1]} px")
    measured = measure(frames, given.environments)
    if "mediapipe" not in measured:
        raise SystemExit("mediapipe did not run: see the line above")
    lines = report(measured)
    if given.json:
        given.json.write_text(json.dumps(lines, indent=1) + "\n")


if __name__ == "__main__":
    main()
