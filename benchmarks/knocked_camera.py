"""A camera knocked at mid-take, found and measured by people alone: a virtual session.

    python benchmarks/knocked_camera.py results SESSION TAKE [--base sfm-n40-lines] [--seeds 2]

Each camera in turn is knocked about a random axis: its keypoints from then on are where the turned
camera would have seen them; clocks and people are those without the knock. No video is used. Told
are the angles between the poses taken and the true ones, before and after the knock (of the optical
axis, and of the whole turn), and the median error of limb joints against the truth: without the
knock, with it, and with both poses. A knock that is taken of the take as it is, is false.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from people_seen import LIMITS, STATED, of_takes
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.people import prior, views
from courtside.calibration.people.knocks import knocks
from courtside.calibration.records import covariance
from courtside.evaluation.numbers.players import NETWORK
from courtside.geometry import camera as camera_models
from courtside.geometry import interpolation, rotations
from courtside.records.keypoints import skeleton
from courtside.records.truth import session_truth, take_truth


def apart(camera, other):
    """Return the angle between two optical axes and that of the whole turn, degrees."""
    turn = camera.cam_from_world[:, :3] @ other.cam_from_world[:, :3].T
    axis = np.degrees(np.arccos(np.clip(turn[2, 2], -1, 1)))
    return float(axis), float(np.degrees(rotations.angles(turn)))


def knocked(camera, seen, at, time_s, turn):
    """Return keypoints with one camera turned from a time on."""
    xy, after = seen.xy.copy(), seen.time_s >= time_s
    xy[at, after] = camera_models.turned_back(camera, xy[at, after], -turn)
    return replace(seen, xy=xy)


def error_mm(cameras, seen, truth):
    """Return the median error of limb joints placed by the cameras, mm."""
    xyz = views.placed(cameras, seen, LIMITS).xyz
    named = [list(truth.joints).index(name) for name in skeleton.JOINTS]
    true = interpolation.linear(truth.time_s, truth.xyz[0][:, named], seen.time_s)
    off = np.linalg.norm(xyz.reshape(true.shape) - true, axis=-1)
    return 1000 * float(np.nanmedian(off))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("take")
    parser.add_argument("--base", default="sfm-n40-lines")
    parser.add_argument("--model", default=NETWORK)
    parser.add_argument("--deg", type=float, default=0.4)
    parser.add_argument("--seeds", type=int, default=2)
    given = parser.parse_args()
    folder = given.results / given.session
    virtual, of_base = (
        given.results / "virtual" / given.session,
        folder / "calibration" / given.base,
    )
    cameras = camera_models.read_toml(of_base / "cameras.toml")
    names = [camera.name for camera in cameras]
    seen = of_takes(folder, [given.take], given.base, given.model, names)[0]
    real = {camera.name: camera for camera in session_truth.read(virtual / "truth.npz").cameras}
    truth = take_truth.read(virtual / "takes" / given.take / "truth.npz")
    known = prior.stated(cameras, **STATED)
    if (of_base / "covariance.npz").is_file():
        known = covariance.read(of_base / "covariance.npz").of(names)
    whole, rows = error_mm(cameras, seen, truth), []
    for seed in range(given.seeds):
        rng = np.random.default_rng(seed)
        middle = float(seen.time_s.mean())
        for at, camera in enumerate(cameras):
            turn = np.radians(given.deg) * rotations.unit(rng.normal(size=3))
            bumped = knocked(camera, seen, at, middle, turn)
            found = [one for one in knocks.find(cameras, known, bumped, LIMITS) if one.taken]
            right = next((one for one in found if one.camera == at), None)
            row = {"camera": camera.name, "seed": seed, "knocks": len(found)}
            row |= dict(
                zip(("before_axis", "before_deg"), apart(camera, real[camera.name]), strict=True)
            )
            if right is not None:
                after = camera_models.turned(camera, right.turn)
                true = camera_models.turned(real[camera.name], turn)
                row |= dict(zip(("after_axis", "after_deg"), apart(after, true), strict=True))
                off = np.degrees(right.turn - turn)
                row |= {"across_deg": np.hypot(*off[:2]), "roll_deg": abs(off[2])}
                row["turn_deg"] = float(np.linalg.norm(off))
                row |= {"late_s": right.time_s - middle}
            undone = knocks.undone(cameras, bumped, found)
            row |= {"mm": whole, "mm_knocked": error_mm(cameras, bumped, truth)}
            rows.append(row | {"mm_repaired": error_mm(cameras, undone, truth)})
            print(rows[-1], flush=True)
    false = [one for one in knocks.find(cameras, known, seen, LIMITS) if one.taken]
    table = pd.DataFrame(rows)
    print(table.drop(columns=["camera", "seed"]).median().round(3).to_string())
    found = int(table["late_s"].notna().sum())
    print(f"{found} of {len(table)} knocks found, {len(false)} where there was none")


if __name__ == "__main__":
    main()
