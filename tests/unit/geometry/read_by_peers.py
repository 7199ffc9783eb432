"""Load a camera file with aniposelib and with Pose2Sim, and print where they project points.

Run by hand, never by pytest, in the environments that `python benchmarks/peers.py aniposelib
pose2sim` makes and prints; each run uses the peer that its interpreter has:

    PYTHON tests/unit/geometry/read_by_peers.py cameras.toml [x,y,z x,y,z ...]

Prints a line of JSON per peer: cameras in the order in which the peer holds them, with their
projections in px of the points (metres, world). Pose2Sim has two ways: plain (its default; the lens
is ignored) and with the file's lens (`undistort_points`, through cv2.projectPoints, as its
triangulation does).
"""

import json
import sys
from pathlib import Path

import numpy as np

POINTS = ("0,0,0", "3.05,6.7,1.0", "1.0,2.0,1.5")


def by_aniposelib(path, xyz):
    """Project with `CameraGroup.load`."""
    from aniposelib.cameras import CameraGroup

    group = CameraGroup.load(path)
    projected = group.project(xyz)
    return {
        camera.get_name(): {
            "size": camera.get_size(),
            "dist": camera.get_distortions().tolist(),
            "xy": xy.tolist(),
        }
        for camera, xy in zip(group.cameras, projected, strict=True)
    } | {"metadata": group.metadata}


def by_pose2sim(path, xyz):
    """Project with `computeP` and with the parameters of `retrieve_calib_params`."""
    import cv2
    from Pose2Sim.common import computeP, reprojection, retrieve_calib_params

    read = retrieve_calib_params(path)
    plain = [np.transpose(reprojection(computeP(path), np.append(point, 1))) for point in xyz]
    cameras = {}
    for at, (size, dist) in enumerate(zip(read["S"], read["dist"], strict=True)):
        lens = cv2.projectPoints(xyz, read["R"][at], read["T"][at], read["K"][at], dist)[0][:, 0]
        cameras[f"camera {at}"] = {
            "size": size.tolist(),
            "dist": dist.tolist(),
            "xy": [points[at].tolist() for points in plain],
            "xy_with_lens": lens.tolist(),
        }
    return cameras


def main():
    """Print what each peer that can be imported here makes of the file."""
    path = Path(sys.argv[1])  # rtoml, and so Pose2Sim, takes a str for the text itself
    points = [[float(number) for number in point.split(",")] for point in sys.argv[2:] or POINTS]
    for peer, read in (("aniposelib", by_aniposelib), ("pose2sim", by_pose2sim)):
        try:
            result = read(path, np.array(points))
        except ModuleNotFoundError as missing:
            print(f"{peer}: not here ({missing.name})", file=sys.stderr)
            continue
        print(json.dumps({peer: result}))


if __name__ == "__main__":
    main()
