"""Pose2Sim's `triangulation_from_best_cameras`, timed.

Arguments: scene.npz result.npz repeats points.

It takes one point a call, with its defaults of 15 px and two cameras. The lens has no distortion
here, so its faster way without undistortion is used.
"""

import json
import sys
import time
import warnings

import numpy as np
from Pose2Sim.triangulation import triangulation_from_best_cameras

CONFIG = {
    "triangulation": {
        "reproj_error_threshold_triangulation": 15,
        "min_cameras_for_triangulation": 2,
        "handle_LR_swap": False,
        "undistort_points": False,
    }
}


def triangulate(projections, columns):
    xyz = np.empty((len(columns), 3))
    for at, column in enumerate(columns):
        xyz[at] = triangulation_from_best_cameras(CONFIG, column, column, projections, None)[0]
    return xyz


def main(scene_npz, result_npz, repeats, points):
    warnings.simplefilter("ignore")
    scene = np.load(scene_npz)
    projections = list(scene["K"] @ scene["cam_from_world"])
    score = np.where(scene["score"] < 0.3, np.nan, scene["score"])  # its likelihood threshold
    columns = np.stack([*np.moveaxis(scene["xy"], -1, 0), score]).transpose(2, 0, 1)[: int(points)]
    triangulate(projections, columns[:20])  # warm-up
    seconds = []
    for _ in range(int(repeats)):
        start = time.process_time()
        xyz = triangulate(projections, columns)
        seconds.append(time.process_time() - start)
    np.savez(result_npz, triangulation_from_best_cameras=xyz)
    print(
        json.dumps(
            {"triangulation_from_best_cameras": {"seconds": seconds, "points": len(columns)}}
        )
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
