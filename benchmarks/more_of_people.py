"""What constant limbs, clocks and feet on the floor would add to cameras refined by people.

    python benchmarks/more_of_people.py results SESSION TAKE ... [--base known18] [--seeds 3]

SESSION is a virtual session whose takes share a clock. Cameras disturbed as `refine_cameras` states
are refined from people alone. Told are, with the true cameras, the base, the disturbed and the
refined ones: the error over the playing volume, as it is and after the best similarity; how much
eight limb lengths vary over frames (robust), and the medians of eight parts of time; the tilt of
the floor that low ankles show and their height above it; and the error over the volume after this
floor is made level and put below the ankles where the true cameras have it. The clocks that people
would correct are told last: a camera's offset that explains its residuals to joints that the others
place, where the truth is 0, and by how much the median residual falls with it.
"""

import argparse
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from people_seen import LIMITS, STATED, of_takes
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.court import court as court_files
from courtside.calibration.file_check import residuals
from courtside.calibration.people import adjustment, prior, views
from courtside.evaluation.numbers.players import NETWORK
from courtside.evaluation.tables import ways
from courtside.geometry import camera as camera_models
from courtside.records.keypoints import skeleton
from courtside.records.truth import session_truth
from courtside.study.configuration import yaml_files
from refined_by_people import disturbed

AT = {name: list(skeleton.JOINTS).index(name) for name in skeleton.JOINTS}
LIMBS = [
    (AT[f"{side}_{a}"], AT[f"{side}_{b}"])
    for side in ("left", "right")
    for chain in skeleton.CHAINS
    for a, b in pairwise(chain)
]
ANKLES = [AT["left_ankle"], AT["right_ankle"]]
LOW = 0.15  # share of the lowest ankles that the floor passes above: those in stance


def variation(xyz, track):
    """Return the variation of limb lengths (T, J, 3) over frames and over parts of time, %."""
    frames, parts = [], []
    for person in np.unique(track):
        for a, b in LIMBS:
            length = np.linalg.norm(xyz[track == person, a] - xyz[track == person, b], axis=1)
            length = length[np.isfinite(length)]
            middle = np.median(length)
            frames.append(adjustment.MEDIAN_TO_SIGMA * np.median(abs(length - middle)) / middle)
            medians = [np.median(part) for part in np.array_split(length, 8)]
            parts.append(np.std(medians, ddof=1) / np.mean(medians))
    return 100 * float(np.mean(frames)), 100 * float(np.mean(parts))


def floor(xyz):
    """Return slopes and height of the plane that a share of the lower ankles is below."""
    ankles = xyz[:, ANKLES]
    ankles = ankles[np.isfinite(ankles).all(axis=(1, 2))]
    low = ankles[np.arange(len(ankles)), ankles[..., 2].argmin(axis=1)]
    terms, weight = np.column_stack([low[:, :2], np.ones(len(low))]), np.ones(len(low))
    for _ in range(30):  # quantile regression by reweighting
        plane = np.linalg.lstsq(terms * weight[:, None], low[:, 2] * weight, rcond=None)[0]
        off = low[:, 2] - terms @ plane
        weight = np.sqrt(np.where(off > 0, LOW, 1 - LOW) / np.maximum(abs(off), 2e-3))
    return plane


def levelled(cameras, plane, height_m):
    """Return cameras of a world in which a plane is level, at a height."""
    up = np.array([-plane[0], -plane[1], 1.0])
    turn = Rotation.from_rotvec(np.cross(up / np.linalg.norm(up), [0, 0, 1])).as_matrix()
    found = []
    for camera in cameras:
        rotation = camera.cam_from_world[:, :3]
        shift = camera.cam_from_world[:, 3] + rotation @ [0, 0, plane[2] - height_m]
        pose = np.column_stack([rotation @ turn.T, shift])
        found.append(replace(camera, cam_from_world=pose))
    return found


def clocks_ms(cameras, seen):
    """Return each camera's offset, ms, and the change of its median residual by it, percent."""
    found, step_s = [], float(np.median(np.diff(np.unique(seen.time_s))))
    for at, camera in enumerate(cameras):
        xyz = residuals.placed_by_others(cameras, seen.xy, at)
        off = seen.xy[at] - camera_models.project(camera, xyz)
        speed = np.gradient(seen.xy[at], step_s, axis=0)
        size = np.linalg.norm(off, axis=-1)
        known = np.isfinite(size + speed.sum(axis=-1)) & (size < 5 * np.nanmedian(size))
        off, speed = off[known], speed[known]
        late_s = (off * speed).sum() / (speed**2).sum()
        sizes = [np.median(np.linalg.norm(one, axis=1)) for one in (off, off - late_s * speed)]
        found.append((1000 * late_s, 100 * (sizes[1] / sizes[0] - 1)))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("takes", nargs="+")
    parser.add_argument("--base", default="known18")
    parser.add_argument("--model", default=NETWORK)
    parser.add_argument("--seeds", type=int, default=3)
    given = parser.parse_args()
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{given.session}.yaml")
    court = court_files.read(ROOT / "config" / "courts" / f"{session['court']}.yaml")
    folder = given.results / given.session
    base = camera_models.read_toml(folder / "calibration" / given.base / "cameras.toml")
    names = [camera.name for camera in base]
    truth = session_truth.read(given.results / "virtual" / given.session / "truth.npz").cameras
    real = [{camera.name: camera for camera in truth}[name] for name in names]
    parts = of_takes(folder, given.takes, given.base, given.model, names, people="npz")
    seen, rows = views.joined(parts), []

    def errors_cm(cameras):
        return list(ways.against_truth(cameras, real, court).values())

    def measure(of, cameras, height_m):
        placed = views.placed(cameras, seen, LIMITS)
        xyz = placed.xyz.reshape(len(seen.track), -1, 3)
        plane = floor(xyz)
        numbers = [*errors_cm(cameras), *variation(xyz, seen.track)]
        height_m = plane[2] if height_m is None else height_m
        level = levelled(cameras, plane, height_m)
        numbers += [1000 * np.hypot(*plane[:2]), 1000 * plane[2], errors_cm(level)[0]]
        rows.append((of, *numbers))
        print(rows[-1], flush=True)
        return plane[2]

    height_m = measure("true", real, None)
    measure("base", base, height_m)
    for seed in range(given.seeds):
        cameras = disturbed(base, STATED, np.random.default_rng(seed))
        measure("disturbed", cameras, height_m)
        known = prior.knowledge(cameras, prior.stated(cameras, **STATED))
        measure("refined", adjustment.refine(cameras, seen, known, LIMITS).cameras, height_m)
    columns = ["of", "volume_cm", "shape_cm", "limbs_percent", "limbs_parts_percent"]
    columns += ["floor_mrad", "ankles_mm", "levelled_cm"]
    table = pd.DataFrame(rows, columns=columns).groupby("of", sort=False)
    print(table.median().round(2).to_string())
    for name, part in zip(given.takes, parts, strict=True):
        for camera, (late, change) in zip(names, clocks_ms(base, part), strict=True):
            print(f"{name} {camera}: clock {late:.1f} ms, residual {change:+.1f} %")


if __name__ == "__main__":
    main()
