"""Caliscope's `triangulate_image_points`, timed. Arguments: scene.npz result.npz repeats joints.

It takes points on the undistorted, normalised picture, each camera's own; what is missing is left
out.
"""

import json
import sys
import time
import warnings

import numpy as np
from caliscope.core.point_data import triangulate_image_points


def main(scene_npz, result_npz, repeats, joints):
    warnings.simplefilter("ignore")
    scene = np.load(scene_npz)
    focal, centre = np.diag(scene["K"])[:2], scene["K"][:2, 2]
    camera, point = np.nonzero(np.isfinite(scene["xy"]).all(axis=-1))
    xy = (scene["xy"][camera, point] - centre) / focal
    matrices = dict(enumerate(scene["cam_from_world"]))
    frame, joint = np.divmod(point, int(joints))
    nobody = np.zeros_like(point)
    seconds = []
    for _ in range(int(repeats)):
        start = time.process_time()
        found = triangulate_image_points(matrices, frame, camera, nobody, joint, xy)
        seconds.append(time.process_time() - start)
    frames, _, keypoints, places = found
    xyz = np.full((scene["xy"].shape[1], 3), np.nan)
    xyz[np.asarray(frames) * int(joints) + keypoints] = places
    np.savez(result_npz, triangulate_image_points=xyz)
    print(json.dumps({"triangulate_image_points": {"seconds": seconds, "points": len(xyz)}}))


if __name__ == "__main__":
    main(*sys.argv[1:])
