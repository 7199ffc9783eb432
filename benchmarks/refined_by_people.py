"""How near to the truth people bring disturbed cameras: a virtual session, with and without clicks.

    python benchmarks/refined_by_people.py results SESSION TAKE ... [--base sfm-n40] [--seeds 6]

SESSION is a virtual session whose takes were detected and associated with the calibration BASE. For
each seed the true cameras are disturbed as `refine_cameras` of config.yaml states (0.3 degrees, 3
cm, 0.5 % of the focal length, standard deviations) and refined as files are: from people alone, and
with court points clicked by a drawn person. BASE itself is refined with its own covariance. Errors
are over the playing volume; `shape_cm` is what is left after the best similarity.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parents[1] / "workflow" / "lib"))
from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection
from courtside.calibration.court import court as court_files
from courtside.calibration.court import quality
from courtside.calibration.people import adjustment, prior, refinement
from courtside.calibration.people.adjustment import Limits
from courtside.calibration.people.held_out import Points
from courtside.calibration.records import covariance
from courtside.evaluation import calibration
from courtside.geometry import camera as camera_models
from courtside.geometry.similarity import umeyama
from courtside.geometry.triangulation import triangulate_all
from courtside.reconstruction import common_views
from courtside.records.cameras import clicks
from courtside.records.truth import session_truth
from courtside.study.configuration import yaml_files
from virtualgym.session import clicks as clicking

ROOT = Path(__file__).parents[1]


def disturbed(cameras, sigma, rng):
    """Return cameras turned, moved and with other focal lengths, as stated."""
    found = []
    for camera in cameras:
        turn = np.radians(sigma["rotation_deg"]) * rng.normal(size=3)
        pose = Rotation.from_rotvec(turn).as_matrix() @ camera.cam_from_world
        pose[:, 3] += sigma["position_m"] * rng.normal(size=3)
        matrix = camera.K.copy()
        matrix[[0, 1], [0, 1]] *= 1 + sigma["focal_percent"] / 100 * rng.normal()
        found.append(replace(camera, K=matrix, dist=camera.dist[:5], cam_from_world=pose))
    return found


def errors(cameras, spread, real, court, marked):
    """Return the errors of cameras over the volume, cm, and their coverage by 90 % ellipsoids."""
    columns, network = spread.of_columns(), selection.of_cameras(cameras)

    def stated(xyz):
        return point_covariance.point_covariance(network, columns, xyz)

    found = calibration.score(cameras, real.cameras, court, marked, stated)
    grid = quality.volume(court)
    xyz = triangulate_all(cameras, np.stack([camera_models.project(c, grid) for c in real.cameras]))
    left = umeyama(xyz, grid).points(xyz) - grid
    shape_cm = 100 * np.sqrt((left**2).sum(axis=1).mean())
    return {**{k: found[k] for k in ("volume_rms_cm", "coverage90")}, "shape_cm": shape_cm}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("takes", nargs="+")
    parser.add_argument("--base", default="sfm-n40")
    parser.add_argument("--model", default="blazepose-heavy")
    parser.add_argument("--seeds", type=int, default=6)
    given = parser.parse_args()
    config = yaml_files.read(ROOT / "config" / "config.yaml")
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{given.session}.yaml")
    court_yaml = ROOT / "config" / "courts" / f"{session['court']}.yaml"
    court, step, views = (
        court_files.read(court_yaml),
        config["refine_cameras"],
        config["triangulate"],
    )
    sigma = {key: value for key, value in step.items() if key != "takes"}
    virtual, folder = given.results / "virtual" / given.session, given.results / given.session
    real = session_truth.read(virtual / "truth.npz")
    names = [camera.name for camera in real.cameras]
    marked = clicks.read(virtual / "court_points.csv", names, list(court.points))
    of_base = folder / "calibration" / given.base
    seen = common_views.of_takes(
        of_base / "cameras.toml",
        names,
        [
            {
                "pose2d": [take / "pose2d" / given.model / f"{name}.npz" for name in names],
                "people": take / "people" / given.base / f"{given.model}.found.npz",
                "sync": take / "sync" / given.base / f"cameras.{given.model}.json",
            }
            for take in (folder / "takes" / name for name in given.takes)
        ],
    )
    limits = Limits(views["min_score"], views["max_error_share"], views["fade_share"])
    rows = []

    def measure(way, seed, base, known, points):
        found = refinement.refine(base, known, seen, limits, points)
        before = errors(base, known, real, court, marked)
        for what, one in (
            ("base", before),
            ("taken", errors(found.cameras, found.covariance, real, court, marked)),
        ):
            rows.append({"way": way, "seed": seed, "of": what, "taken": found.taken, **one})
        print(rows[-2:], found.line, flush=True)

    keys = ("click_sigma_px", "click_bias_px", "click_loss")
    weights = {key: config["adjust_network"][key] for key in keys}
    cameras = {camera.name: camera for camera in camera_models.read_toml(of_base / "cameras.toml")}
    cameras = [cameras[name] for name in names]
    known = covariance.read(of_base / "covariance.npz").of(names)
    clicked = adjustment.court_clicks(court, marked, cameras, **weights)
    measure(given.base, 0, cameras, known, Points(court=clicked))
    drawn = {"n_draws": given.seeds, "seed": 0, "session": given.session}
    drawn["preset"] = session["virtual"]["preset"]
    persons = clicking.clicks_of_persons(real.cameras, court, real.court_xyz, **drawn)
    for seed, by_camera in enumerate(persons):
        base = disturbed(real.cameras, sigma, np.random.default_rng(seed))
        clicked = adjustment.court_clicks(court, by_camera, base, **weights)
        known = prior.stated(base, **sigma)
        measure("disturbed, clicks", seed, base, known, Points(court=clicked, fitted=True))
        measure("disturbed", seed, base, known, Points())
    table = pd.DataFrame(rows).groupby(["way", "of"], sort=False)
    measures = ["volume_rms_cm", "shape_cm", "coverage90"]
    print(table[measures].agg(["median", "mean"]).round(3).to_string())


if __name__ == "__main__":
    main()
