"""The real session `walk-4cams` with its calibration file as it is and mended.

    python benchmarks/real_footage.py results/walk-4cams DEMO [--csv FILE]

DEMO is Pose2Sim's demonstration of one person with what its wheel lacks beside
`calibration/Calib.qca.txt`: `trc/Balancing_for_IK.trc`, and OpenPose's keypoints in
`openpose_body25b/cam1_json` to `cam4_json`. For both calibrations and all stages (raw, filtered,
corrected) the table gives, of the study's own keypoints: static points against their views (root
mean square per axis), accepted views by camera, variation of limb lengths, and 12 limb joints
against OpenPose's keypoints triangulated by the same cameras, in the study's way and in a way close
to Pose2Sim's, and against Pose2Sim's TRC, which rests on the file as it is. OpenPose's keypoints
show the video's frames one later (`LATER`).
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
sys.path.insert(0, str(ROOT / "workflow" / "scripts"))
import correct_joints
import filter_motion

from courtside.calibration import file_formats
from courtside.calibration.file_check import residuals
from courtside.evaluation.numbers.players import NETWORK
from courtside.exports import trc
from courtside.geometry import camera as camera_models
from courtside.geometry import triangulation
from courtside.reconstruction import fusion
from courtside.records.cameras import clicks
from courtside.records.keypoints import keypoints, people, skeleton
from courtside.study.configuration import yaml_files

CONFIG = ROOT / "config"
# Frames: OpenPose's number 0, and Pose2Sim's first row, show the video's frame 1. By number, its
# keypoints are nearest to those of this study so, in each of the four cameras, and lie on the limbs
# of the picture (tests/test_real_footage.py).
LATER = 1
SKELETON = CONFIG / "skeletons" / "blazepose33.yaml"
# Of BODY_25B: left and right shoulder, elbow, wrist, hip, knee, ankle.
OPENPOSE = {name: 5 + 2 * at for at, name in enumerate(("shoulder", "elbow", "wrist"))}
OPENPOSE |= {name: 11 + 2 * at for at, name in enumerate(("hip", "knee", "ankle"))}
# Pose2Sim keeps all views until their mean error exceeds its limit; a wide fade comes closest.
OPENPOSE_PX = {"max_error_px": 15, "fade_px": 20}  # of a person 700 px tall
LIKE_POSE2SIM = {"max_error_px": 18, "fade_px": 36, "min_score": 0.1}


def openpose(folder, number):
    """Return (T, 12, 3): x, y, score of the limb joints of the person with the highest scores."""
    at = [
        OPENPOSE[joint.partition("_")[2]] + joint.startswith("right") for joint in skeleton.JOINTS
    ]
    rows = []
    for file in sorted((folder / "openpose_body25b" / f"cam{number}_json").glob("*.json")):
        people = [
            np.reshape(one["pose_keypoints_2d"], (-1, 3))
            for one in json.loads(file.read_text())["people"]
        ]
        best = max(people, key=lambda one: one[:, 2].sum(), default=np.zeros((25, 3)))
        rows.append(np.where(best[at, 2:] > 0, best[at], np.nan))
    return np.stack(rows)


def reference(folder):
    """Return (T, 12, 3) m of the limb joints of Pose2Sim's TRC."""
    joints, _, _, xyz = trc.read(folder / "trc" / "Balancing_for_IK.trc")
    words = [name.split("_") for name in skeleton.JOINTS]
    return xyz[:, [joints.index(f"{side[0].upper()}{part.capitalize()}") for side, part in words]]


def stages(points, cameras, step, sex_of):
    """Return raw skeletons, and filtered and corrected ones as the study makes them."""
    with tempfile.TemporaryDirectory() as folder:
        names = ("raw", "filtered", "corrected")
        paths = SimpleNamespace(**{name: Path(folder) / f"{name}.npz" for name in names})
        paths.cutoffs, paths.cameras = Path(folder) / "cutoffs.csv", Path(folder) / "cameras.toml"
        paths.skeleton, paths.offsets = SKELETON, CONFIG / "joint_offsets" / f"{NETWORK}.csv"
        keypoints.write_3d(paths.raw, points)
        camera_models.write_toml(paths.cameras, cameras, source="given")
        filter_motion.main(paths.raw, SKELETON, paths.filtered, paths.cutoffs, **step)
        correct_joints.main(paths, paths.corrected, max_gap_s=step["max_gap_s"], sex_of=sex_of)
        return {name: keypoints.read_3d(getattr(paths, name)) for name in names}


def distances_mm(xyz, other):
    """Return the distances (T - 1, 12) mm of the study's joints to OpenPose's, frame by frame."""
    return 1e3 * np.linalg.norm(xyz[LATER:] - other[: len(xyz) - LATER], axis=-1)


def apart_mm(xyz, other):
    """Return the median and the 90 % quantile of `distances_mm`."""
    away = distances_mm(xyz, other)
    return np.nanmedian(away), np.nanpercentile(away, 90)


def limb_variation(points):
    """Return the median and the largest coefficient of variation of eight segments, %."""
    found = []
    for ends in skeleton.read(SKELETON).segments.values():
        a, b = (list(points.joints).index(joint) for joint in ends)
        length = np.linalg.norm(points.xyz[0, :, a] - points.xyz[0, :, b], axis=-1)
        found.append(100 * np.nanstd(length) / np.nanmean(length))
    return np.median(found), np.max(found)


def measured(cameras, seen, others, demo, step, sex_of):
    """Yield rows (stage, measure, value, unit) of one calibration."""
    shape = skeleton.read(SKELETON)
    raw = fusion.triangulate_take(cameras, seen, shape, list(sex_of), **step["triangulate"])
    limbs = [list(raw.joints).index(name) for name in skeleton.JOINTS]
    for at, camera in enumerate(cameras):
        accepted = raw.accepted[0][:, limbs, at].mean()
        yield "raw", f"accepted {camera.name}", 100 * accepted, "%"
        yield (
            "raw",
            f"reprojection {camera.name}",
            np.nanmedian(raw.reproj_error_px[0][:, limbs, at]),
            "px",
        )
    own = {key: step["triangulate"][key] for key in ("min_score", "min_views")} | OPENPOSE_PX
    flat = others[..., :2].reshape(len(cameras), -1, 2), others[..., 2].reshape(len(cameras), -1)
    compared = {"TRC": reference(demo)}
    for name, options in (("triangulated alike", own), ("as Pose2Sim", LIKE_POSE2SIM)):
        xyz = triangulation.triangulate_robust(cameras, *flat, **options).xyz
        compared[f"OpenPose, same cameras, {name}"] = xyz.reshape(-1, len(limbs), 3)
    for stage, points in stages(raw, cameras, step["filter_motion"], sex_of).items():
        for name, other in compared.items():
            median, high = apart_mm(points.xyz[0][:, limbs], other)
            yield stage, f"{name}, median", median, "mm"
            yield stage, f"{name}, 90 %", high, "mm"
        median, largest = limb_variation(points)
        yield stage, "limb lengths vary, median", median, "%"
        yield stage, "limb lengths vary, largest", largest, "%"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("demo", type=Path)
    parser.add_argument("--csv", type=Path)
    given = parser.parse_args()
    session = yaml_files.read(CONFIG / "sessions" / "walk-4cams.yaml")
    step = yaml_files.read(CONFIG / "config.yaml")
    sex_of = {name: one["sex"] for name, one in session["subjects"].items()}
    names = list(session["cameras"])
    take = given.results / "takes" / "balancing"
    named = people.read(take / "people" / "file" / f"{NETWORK}.npz")
    folder = take / "pose2d" / NETWORK
    seen = [named.assigned(keypoints.read_2d(folder / f"{name}.npz")) for name in names]
    others = np.stack([openpose(given.demo, at + 1) for at in range(len(names))])
    _, static = clicks.read_static(CONFIG / "static_points" / "walk-4cams.csv", names)
    as_is = file_formats.read(given.demo / "calibration" / "Calib.qca.txt")
    mended = file_formats.with_principal_points(as_is, session["calibration"]["principal_point_px"])
    rows = []
    for label, found in (("file as it is", as_is), ("mended", mended)):
        off_px = residuals.rms_px(residuals.Rays(static).residuals(found))
        rows.append((label, "", "static points", off_px, "px"))
        crops = {name: (one or {}).get("crop_px") for name, one in session["cameras"].items()}
        shown = [camera_models.crop(c, crops[c.name]) if crops[c.name] else c for c in found]
        rows += [(label, *row) for row in measured(shown, seen, others, given.demo, step, sex_of)]
    table = pd.DataFrame(rows, columns=["calibration", "stage", "measure", "value", "unit"])
    print(table.to_string(index=False))
    if given.csv:
        table.to_csv(given.csv, index=False, float_format="%.2f")


if __name__ == "__main__":
    main()
