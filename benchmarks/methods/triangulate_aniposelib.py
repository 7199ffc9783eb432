"""Three ways of aniposelib's `CameraGroup`, timed.

Arguments: scene.npz result.npz repeats joints [ransac optim].

`triangulate` is warm: its first call compiles. `triangulate_ransac` (a Python loop) and
`optim_points` (a non-linear fit over time, which may smooth) run once on fewer points, the latter
on whole frames: `ransac` points and `optim` frames, 0 for not at all.
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
        start = time.process_time()
        found = function()
        seconds.append(time.process_time() - start)
    return found, seconds


def group(scene):
    size, views = tuple(scene["size"]), []
    for at, matrix in enumerate(scene["cam_from_world"]):
        rotation = cv2.Rodrigues(matrix[:, :3])[0].ravel()
        views.append(Camera(scene["K"], np.zeros(5), size, rotation, matrix[:, 3], str(at)))
    return CameraGroup(views)


def optimised(cameras, xy, start, frames, joints):
    count = frames * joints
    clip = xy[:, :count].reshape(len(xy), frames, joints, 2)
    guess = start[:count].reshape(frames, joints, 3)
    options = {"constraints": [], "scale_smooth": 4, "n_deriv_smooth": 1}
    found, seconds = timed(
        lambda: cameras.optim_points(
            clip, guess, reproj_error_threshold=15, verbose=False, **options
        )
    )
    return found.reshape(-1, 3), seconds


def main(scene_npz, result_npz, repeats, joints, ransac=RANSAC_POINTS, optim=OPTIM_FRAMES):
    warnings.simplefilter("ignore")
    scene = np.load(scene_npz)
    cameras, xy = group(scene), scene["xy"]
    start, _ = timed(lambda: cameras.triangulate(xy))
    whole, whole_s = timed(lambda: cameras.triangulate(xy), int(repeats))
    found = {"triangulate": (whole, whole_s)}
    if int(ransac):
        cameras.triangulate_ransac(xy[:, :2])
        chosen = xy[:, : int(ransac)]
        found["triangulate_ransac"] = timed(lambda: cameras.triangulate_ransac(chosen)[0])
    if int(optim):
        found["optim_points"] = optimised(cameras, xy, start, int(optim), int(joints))
    np.savez(result_npz, **{name: xyz for name, (xyz, _) in found.items()})
    print(json.dumps({n: {"seconds": s, "points": len(xyz)} for n, (xyz, s) in found.items()}))


if __name__ == "__main__":
    main(*sys.argv[1:])
