"""Three ways of aniposelib's `CameraGroup`, timed. Arguments: scene.npz result.npz repeats joints.

`triangulate` is warm: its first call compiles. `triangulate_ransac` (a Python loop) and `optim_points` (a
non-linear fit over time, which may smooth) run once on fewer points, the latter on whole frames.
"""

import json
import sys
import time
import warnings

import cv2
import numpy as np
from aniposelib.cameras import Camera, CameraGroup

RANSAC_POINTS, OPTIM_FRAMES = 260, 200


def timed(function, repeats=1):
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        found = function()
        seconds.append(time.perf_counter() - start)
    return found, seconds


def group(scene):
    size, views = tuple(scene["size"]), []
    for at, matrix in enumerate(scene["cam_from_world"]):
        rotation = cv2.Rodrigues(matrix[:, :3])[0].ravel()
        views.append(Camera(scene["K"], np.zeros(5), size, rotation, matrix[:, 3], str(at)))
    return CameraGroup(views)


def main(scene_npz, result_npz, repeats, joints):
    warnings.simplefilter("ignore")
    scene = np.load(scene_npz)
    cameras, xy = group(scene), scene["xy"]
    start, _ = timed(lambda: cameras.triangulate(xy))
    whole, whole_s = timed(lambda: cameras.triangulate(xy), int(repeats))
    cameras.triangulate_ransac(xy[:, :2])
    ransac, ransac_s = timed(lambda: cameras.triangulate_ransac(xy[:, :RANSAC_POINTS])[0])
    count = OPTIM_FRAMES * int(joints)
    clip = xy[:, :count].reshape(len(xy), OPTIM_FRAMES, int(joints), 2)
    guess = start[:count].reshape(OPTIM_FRAMES, int(joints), 3)
    optim, optim_s = timed(
        lambda: cameras.optim_points(
            clip,
            guess,
            constraints=[],
            scale_smooth=4,
            n_deriv_smooth=1,
            reproj_error_threshold=15,
            verbose=False,
        )
    )
    found = {
        "triangulate": (whole, whole_s),
        "triangulate_ransac": (ransac, ransac_s),
        "optim_points": (optim.reshape(-1, 3), optim_s),
    }
    np.savez(result_npz, **{name: xyz for name, (xyz, _) in found.items()})
    print(json.dumps({n: {"seconds": s, "points": len(xyz)} for n, (xyz, s) in found.items()}))


if __name__ == "__main__":
    main(*sys.argv[1:])
