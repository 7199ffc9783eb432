"""How much of the error of virtual players is of their cameras: corrected by both, the same 2D.

    python benchmarks/true_cameras.py RESULTS

RESULTS is of a default run. Skeletons of its 3D keypoints, and of the same 2D keypoints
triangulated anew by the cameras as they truly are, are filtered, corrected, and compared with the
truth: median and 95 % over the limbs' joints, and the mean error along x, y and z, mm. The rows
become `docs/numbers/true_cameras.csv`.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation import error_fit, joints
from courtside.evaluation.numbers.players import NETWORK
from courtside.kinematics import cutoffs, skeleton_filter
from courtside.reconstruction import joint_correction
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.configuration import yaml_files

TAKES = (
    ("players-b/footwork", "all-robust"),
    ("players-b/footwork", "three-robust"),
    ("players-a/shot", "all-robust"),
    *((f"repeats/{take}", "all-robust") for take in ("m3-1", "f3-1", "f4-1")),
)
COMMAND = "`python benchmarks/true_cameras.py RESULTS`"
SHAPE = skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml")


class Take:
    """The files of one take of a default run, as `error_fit.footage_with_truth` needs them."""

    def __init__(self, results, name, model, fusion):
        session, take = name.split("/")
        folder, virtual = results / session / "takes" / take, results / "virtual"
        (raw,) = folder.glob(f"pose3d/*/{fusion}/{model}.npz")
        calibration = raw.parts[-3]
        self.raw = keypoints.read_3d(raw)
        owners = (session, "players-b")  # sessions without own cameras have those of players-b
        views = [folder / "pose2d" / model / f"{camera}.npz" for camera in self.raw.cameras]
        sexes = yaml_files.read(ROOT / "config" / "sessions" / f"{session}.yaml")["subjects"]
        self.sex_of = {str(who): sexes[str(who)]["sex"] for who in self.raw.person_id}
        self.take = {
            "cameras": results / session / "calibration" / calibration / "cameras.toml",
            "session_truth": next(p for o in owners if (p := virtual / o / "truth.npz").is_file()),
            "pose2d": views,
            "people": folder / "people" / calibration / f"{model}.npz",
            "sync": folder / "sync" / calibration / f"cameras.{model}.json",
            "truth": virtual / session / "takes" / take / "truth.npz",
            "sex_of": self.sex_of,
        }


def stages(raw, table, sex_of, step, cameras):
    """Return raw, filtered, and corrected and filtered skeletons."""
    how = step["filter_motion"]
    points = skeleton_filter.prepare(raw, how["max_gap_s"])
    choices = cutoffs.by_group(points, SHAPE, how["cutoff_hz"], how["order"], path="made again")
    per_joint = SHAPE.by_group({group: one.cutoff_hz for group, one in choices.items()})
    filtered = skeleton_filter.smooth(points, per_joint, how["order"])
    corrected = joint_correction.correct_then_filter(
        points, filtered, table, sex_of, per_joint, how["order"], cameras
    )
    return {"raw": raw, "filtered": filtered, "corrected": corrected}


def limb_errors(points, truth):
    """Return the errors (persons, frames, joints, 3) of the limbs' joints, mm."""
    points = points.between(truth.time_s[0], truth.time_s[-1])
    names, error, _ = joints.errors(points, truth.joints, joints.true_places(points, truth))
    return 1000 * error[:, :, [names.index(joint) for joint in skeleton.JOINTS]]


def printed(error):
    """Return median and 95 % of the lengths of these errors, as the tables print them."""
    return "{:.1f} / {:.1f}".format(*np.nanpercentile(np.linalg.norm(error, axis=-1), [50, 95]))


def rows_of(results):
    """Yield the numbers of the table, and print them."""
    offsets = ROOT / "config" / "joint_offsets" / f"{NETWORK}.csv"
    table, step = joint_correction.read(offsets), yaml_files.read(ROOT / "config" / "config.yaml")
    for name, fusion in TAKES:
        files = Take(results, name, NETWORK, fusion)
        ((seen, sex_of, truth),) = error_fit.footage_with_truth([files.take])
        true = error_fit.triangulated(seen, SHAPE, list(sex_of), step["triangulate"])
        cameras = [one.camera for one in seen]
        label = f"`{name}`, {len(cameras)} cameras"
        for part, raw in (("study", files.raw), ("true", true)):
            points = stages(raw, table, sex_of, step, cameras)["corrected"]
            error = limb_errors(points, truth)
            n, shift = int(np.isfinite(error[..., 0]).sum()), np.nanmean(error, axis=(0, 1, 2))
            for what, words in (
                (part, printed(error)),
                (f"{part}_shift", ", ".join(f"{one:.1f}" for one in shift)),
            ):
                print(label, what, words, flush=True)
                row = "true-cameras", label, what, words, "mm", name.split("/")[0]
                yield *row, n, 0, "benchmark", COMMAND


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    rows = list(rows_of(parser.parse_args().results))
    stated.write(ROOT / stated.FOLDER / "true_cameras.csv", rows)


if __name__ == "__main__":
    main()
