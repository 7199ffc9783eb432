"""How often a spoilt calibration file is found, and named: faults planted in true cameras.

    python benchmarks/calibration_file_faults.py results SESSION TAKE ... [--seeds 6] [--csv FILE]

SESSION is a virtual session whose takes were detected. For each seed the true cameras are written
as a file would have them, one of them spoilt, and judged by clicked court points (8 of those that
two cameras see, 1 px of scatter), by the network's own keypoints, by both, and by the painted lines
of the static pictures. For each fault the table gives how many were warned of, in how many the
camera was named, and in how many the camera and what is wrong with it. A warning without a fault is
a false alarm. Without TAKE, painted lines alone.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.court import court as court_files
from courtside.calibration.court_lines import verdict as court_verdict
from courtside.calibration.file_check import court_place, faults, residuals, verdict
from courtside.geometry import camera as camera_models
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.truth import session_truth
from courtside.study.configuration import yaml_files

MODEL = "blazepose-heavy-flip"
LINES = yaml_files.read(ROOT / "config" / "config.yaml")["propose_court_points"]
CLICK_PX, N_POINTS, SEEN = 1.0, 8, 0.8
LEAST_SHIFT_PX = 6.0  # a principal point mirrored by less is not planted
KINDS = {  # what a warning must say
    "none": "",
    "mirrored": "is mirrored in",
    "focal length 2 %": "focal length",
    "focal length 5 %": "focal length",
    "turned by 0.3 degrees": "direction",
    "turned by 1 degree": "direction",
    "turned by 1 degree, focal length 3 %": "direction and focal length",
    "moved by 5 cm, 0.5 degrees": "place",
    "moved by 20 cm, 0.5 degrees": "place",
    "exchanged": "exchanged",
    "picture size": "picture size",
    "picture turned": "turned by 180",
}


def plant(cameras, kind, rng):
    """Return cameras with a fault, and the name of the spoilt one."""
    at = int(rng.integers(len(cameras)))
    spoilt, one, n = list(cameras), cameras[at], len(cameras)
    if kind == "mirrored":
        ways = [(k, axis) for k in range(n) for axis in (0, 1)]
        far = [way for way in ways if shift_px(cameras[way[0]], way[1]) >= LEAST_SHIFT_PX]
        at, axis = far[rng.integers(len(far))]
        spoilt[at] = faults.mirrored_point(cameras[at], axis)
    elif kind.startswith("focal"):
        spoilt[at] = zoomed(one, rng.choice([-1, 1]) * float(kind.split()[2]))
    elif kind.startswith("turned"):
        vector = direction(rng) * np.radians(float(kind.split()[2]))
        percent = rng.choice([-1, 1]) * float(kind.split()[-2]) if "%" in kind else 0.0
        spoilt[at] = camera_models.turned(zoomed(one, percent), vector)
    elif kind.startswith("moved"):
        pose = one.cam_from_world.copy()
        pose[:, :3] = (
            Rotation.from_rotvec(direction(rng) * np.radians(0.5)).as_matrix() @ pose[:, :3]
        )
        centre_m = one.centre_in_world + direction(rng) * float(kind.split()[2]) / 100
        pose[:, 3] = -pose[:, :3] @ centre_m
        spoilt[at] = replace(one, cam_from_world=pose)
    elif kind == "exchanged":
        other = (at + 1) % n
        spoilt[at] = replace(cameras[other], name=one.name)
        spoilt[other] = replace(one, name=cameras[other].name)
    elif kind == "picture size":
        spoilt[at] = faults.scaled_picture(one, rng.choice([1 / 2, 2 / 3, 3 / 2, 2]))
    elif kind == "picture turned":
        spoilt[at] = faults.turned_picture(one, 2)
    return spoilt, cameras[at].name


def zoomed(camera, percent):
    matrix = camera.K.copy()
    matrix[[0, 1], [0, 1]] *= 1 + percent / 100
    return replace(camera, K=matrix)


def shift_px(camera, axis):
    return abs(camera.size[axis] - 1 - 2 * camera.K[axis, 2])


def direction(rng):
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


def clicked(cameras, xyz, rng):
    """Return clicks (C, N, 2) px of some points that two cameras or more see."""
    xy = np.stack([camera_models.project(camera, xyz) for camera in cameras])
    seen = [camera_models.in_picture(c, points) for c, points in zip(cameras, xy, strict=True)]
    seen = np.stack(seen) & (rng.random(xy.shape[:2]) < SEEN)
    xy = np.where(seen[..., None], xy + rng.normal(0, CLICK_PX, xy.shape), np.nan)
    return xy[:, rng.permutation(np.flatnonzero(seen.sum(axis=0) >= 2))[:N_POINTS]]


def detected(folder, take, cameras):
    """Return the limb joints (T, J, 2) px of the first person, for each camera that filmed."""
    files = {c.name: folder / "takes" / take / "pose2d" / MODEL / f"{c.name}.npz" for c in cameras}
    views = [keypoints.read_2d(files[camera.name]) for camera in cameras]
    joints = [list(views[0].joints).index(name) for name in skeleton.JOINTS]
    n_frames = min(view.xy.shape[1] for view in views)
    return [view.xy[0][:n_frames, joints] for view in views]


def painted(folder, cameras, court):
    """Return the court's points (C, P, 2) px that painted lines of the static pictures show."""
    xy = np.full((len(cameras), len(court.points), 2), np.nan)
    for at, camera in enumerate(cameras):
        image = cv2.imread(str(folder / "static" / f"{camera.name}.png"))
        xy[at] = court_verdict.examine(image, court, camera.name, **LINES)[1].xy
    return xy


def said(kind, by, name, judged):
    """Return what a verdict says of one planted fault."""
    line = " ".join(one.what for one in judged.faults) or " ".join(judged.warnings)
    named = name in line
    right = named and bool(judged.faults) and KINDS[kind] in line
    warned = bool(judged.warnings)
    return {"kind": kind, "by": by, "n": 1, "warned": warned, "camera": named, "fault": right}


def trial(kind, cameras, xyz, views, seed):
    """Yield what was said of one planted fault, by clicked points and people."""
    rng = np.random.default_rng([seed, list(KINDS).index(kind)])
    spoilt, name = plant(cameras, kind, rng)
    static, people = clicked(cameras, xyz, rng), residuals.of_people(views)
    by = {"static": (static, None), "people": (None, people), "both": (static, people)}
    unknown = np.full((len(views), len(views[0])), np.nan)  # somebody is seen whole
    person_px = residuals.height_px(views, unknown)
    for what, data in by.items():
        judged = verdict.judge(spoilt, verdict.Seen(*data), person_px)
        yield said(kind, what, name, judged)


def by_lines(kind, cameras, court, lines, seed):
    """Return what was said of the same fault by painted lines."""
    rng = np.random.default_rng([seed, list(KINDS).index(kind)])
    spoilt, name = plant(cameras, kind, rng)
    return said(kind, "lines", name, court_place.judge(spoilt, lines, court, either_end=True))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("takes", nargs="*")
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--cameras", nargs="*", help="only these")
    parser.add_argument("--kinds", nargs="*", choices=KINDS, default=list(KINDS))
    parser.add_argument("--csv", type=Path)
    given = parser.parse_args()
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{given.session}.yaml")
    court = court_files.read(ROOT / "config" / "courts" / f"{session['court']}.yaml")
    real = session_truth.read(given.results / "virtual" / given.session / "truth.npz")
    cameras = [c for c in real.cameras if c.name in (given.cameras or session["cameras"])]
    folder = given.results / given.session
    lines = painted(folder, cameras, court)
    print(
        f"court found in {np.isfinite(lines[..., 0]).any(axis=1).sum()} of {len(cameras)} pictures"
    )
    rows = [
        by_lines(kind, cameras, court, lines, seed)
        for kind in given.kinds
        for seed in range(given.seeds)
    ]
    for take in given.takes:
        views = detected(folder, take, cameras)
        for kind in given.kinds:
            for seed in range(given.seeds):
                rows += trial(kind, cameras, court.xyz, views, seed)
    table = pd.DataFrame(rows).groupby(["kind", "by"], sort=False).sum().reset_index()
    table.insert(0, "session", given.session)
    table.insert(1, "n_cameras", len(cameras))
    print(table.to_string(index=False))
    if given.csv:
        table.to_csv(given.csv, index=False)


if __name__ == "__main__":
    main()
