"""Read and solve a mocopi-like BVH file with this project and with bvhio: time, growth, agreement.

    python benchmarks/bvh.py [--file FILE.bvh] [--frames 3000] [--repeats 3] [--json OUT]

Both read the same file, with 27 joints of six channels each, and give the world place of every
joint in every frame: this project by `devices.bvh.read` and `records.hierarchy.forward`, bvhio by
`readAsHierarchy` and, for each frame, `loadPose` and `PositionWorld`. Then the same with twice and
four times the frames. Without --file a motion is made up. This project runs before and after its
peer, so that a busy moment of the machine shows.
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import bvhio
import numpy as np
from scipy.spatial.transform import Rotation

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.devices import bvh
from courtside.exports import bvh as writer
from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy, forward
from courtside.records.keypoints import skeleton

SKELETON = ROOT / "config" / "skeletons" / "mocopi27.yaml"
GROWTH = (1, 2, 4)
LINE = "{:<22}{:>8d}{:>11.3f}{:>16.1f}{:>9.3f}{:>10.2f}"


def made():
    """Return 500 frames of 27 joints that swing smoothly at rates of their own."""
    shape = skeleton.read(SKELETON)
    parent = {child: shape.index(start) for start, child in shape.bones}
    parents = np.array([parent.get(joint, NO_PARENT) for joint in shape.joints])
    rng = np.random.default_rng(0)
    offsets = rng.normal(0, 0.15, (27, 3))
    time_s = np.arange(500) / 50
    phase = rng.uniform(0, 2 * np.pi, (27, 3))
    angles = 40 * np.sin(rng.uniform(0.5, 4, (27, 3)) * time_s[:, None, None] + phase)
    turns = Rotation.from_euler("ZXY", angles.reshape(-1, 3), degrees=True).as_matrix()
    places = np.repeat(offsets[None], 500, axis=0)
    return PosedHierarchy(
        Hierarchy(shape.device_names(), parents, offsets),
        time_s,
        places,
        turns.reshape(500, 27, 3, 3),
    )


def repeat_rows(path, source, n_frames):
    """Write a file with the rows of another, over and over, until there are `n_frames`."""
    head, _, motion = source.read_text().partition("MOTION\n")
    _count, period, *rows = [line for line in motion.splitlines() if line.strip()]
    longer = (rows * (1 + n_frames // len(rows)))[:n_frames]
    path.write_text(f"{head}MOTION\nFrames: {n_frames}\n{period}\n" + "\n".join(longer) + "\n")


def courtside(path):
    return forward(bvh.read(path, unit_m=1.0))[0]


def by_bvhio(path):
    root = bvhio.readAsHierarchy(str(path))
    joints = [joint for joint, _, _ in root.layout()]
    places = []
    for frame in range(len(root.Keyframes)):
        root.loadPose(frame)
        places.append([tuple(joint.PositionWorld) for joint in joints])
    return np.array(places)


METHODS = {"courtside": courtside, "bvhio": by_bvhio, "courtside (again)": courtside}


def measure(path, repeats):
    """Return {method: (best seconds, places)}."""
    found = {}
    for method, solve in METHODS.items():
        best_s = np.inf
        for _ in range(repeats):
            start = time.process_time()
            places = solve(path)
            best_s = min(best_s, time.process_time() - start)
        found[method] = best_s, places
    return found


def main():
    """Run the comparison at three lengths."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--file", type=Path, help="a BVH file whose rows are repeated")
    parser.add_argument("--frames", type=int, default=3000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", type=Path, help="also write the numbers to this file")
    given = parser.parse_args()
    lines, first_s = [], {}
    head = ("frames", "seconds", "us/frame", "ratio", "growth")
    print("{:<22}{:>8}{:>11}{:>16}{:>9}{:>10}".format("method", *head))
    with tempfile.TemporaryDirectory() as folder:
        source, path = Path(folder) / "made.bvh", Path(folder) / "take.bvh"
        if given.file is None:
            writer.write(source, made())
        for times in GROWTH:
            n_frames = times * given.frames
            repeat_rows(path, given.file or source, n_frames)
            found = measure(path, given.repeats)
            peer_s, peer = found["bvhio"]
            for method, (took_s, _) in found.items():
                growth = took_s / first_s.setdefault(method, took_s)
                ratio = took_s / peer_s
                print(LINE.format(method, n_frames, took_s, 1e6 * took_s / n_frames, ratio, growth))
                numbers = {"frames": n_frames, "seconds": took_s, "ratio": ratio, "growth": growth}
                lines.append({"method": method, **numbers})
            apart = np.abs(found["courtside"][1] - peer).max()
            print(f"  farthest apart: {apart:.2g} of the file's unit", flush=True)
    print(
        "ratio: to bvhio's time on the same file; growth: to the same method's time on the shortest"
    )
    if given.json:
        given.json.write_text(json.dumps(lines, indent=1) + "\n")


if __name__ == "__main__":
    main()
