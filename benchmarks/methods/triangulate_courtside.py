"""Courtside's triangulation, timed. Arguments: scene.npz result.npz repeats."""

import json
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "workflow" / "lib"))
from courtside.geometry import camera, triangulation


def main(scene_npz, result_npz, repeats):
    scene = np.load(scene_npz)
    size = tuple(int(side) for side in scene["size"])
    views = [
        camera.Camera(f"cam_{at:02d}", size, scene["K"], np.zeros(5), matrix)
        for at, matrix in enumerate(scene["cam_from_world"])
    ]
    limits = {"max_error_px": 15.0, "min_views": 2}
    xy, score = scene["xy"], scene["score"]
    triangulation.triangulate_robust(views, xy[:, :100], score[:, :100], **limits)  # warm-up
    seconds = []
    for _ in range(int(repeats)):
        start = time.process_time()
        found = triangulation.triangulate_robust(views, xy, score, **limits)
        seconds.append(time.process_time() - start)
    np.savez(result_npz, triangulate_robust=found.xyz)
    print(json.dumps({"triangulate_robust": {"seconds": seconds, "points": xy.shape[1]}}))


if __name__ == "__main__":
    main(*sys.argv[1:])
