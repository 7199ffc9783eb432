"""How near to the truth people bring disturbed cameras: a virtual session, with and without clicks.

    python benchmarks/refined_by_people.py results SESSION TAKE ... [--base CALIBRATION] [--seeds 6]

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

from people_seen import LIMITS, STATED, WEIGHTS, of_takes
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.court import court as court_files
from courtside.calibration.people import adjustment, prior, refinement
from courtside.calibration.people.held_out import Points
from courtside.calibration.people.views import joined
from courtside.calibration.records import covariance
from courtside.evaluation import calibration
from courtside.evaluation.numbers.players import NETWORK
from courtside.evaluation.tables import ways
from courtside.geometry import camera as camera_models
from courtside.records.cameras import clicks
from courtside.records.truth import session_truth
from courtside.study.configuration import yaml_files
from virtualgym.session import clicks as clicking


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
    columns, network = spread.of_columns(), conversion.network_of(cameras)

    def stated(xyz):
        return point_covariance.point_covariance(network, columns, xyz)

    found = calibration.score(cameras, real.cameras, court, marked, stated)
    left = ways.against_truth(cameras, real.cameras, court)
    return {"coverage90": found["coverage90"], **left}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("takes", nargs="+")
    parser.add_argument("--base", default="sfm-n40-lines")
    parser.add_argument("--model", default=NETWORK)
    parser.add_argument("--seeds", type=int, default=6)
    given = parser.parse_args()
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{given.session}.yaml")
    court_yaml = ROOT / "config" / "courts" / f"{session['court']}.yaml"
    court = court_files.read(court_yaml)
    virtual, folder = given.results / "virtual" / given.session, given.results / given.session
    real = session_truth.read(virtual / "truth.npz")
    names = [camera.name for camera in real.cameras]
    marked = clicks.read(virtual / "court_points.csv", names, list(court.points))
    of_base = folder / "calibration" / given.base
    seen, rows = joined(of_takes(folder, given.takes, given.base, given.model, names)), []

    def measure(way, seed, base, known, points):
        found = refinement.refine(base, known, seen, LIMITS, points)
        before = errors(base, known, real, court, marked)
        for what, one in (
            ("base", before),
            ("taken", errors(found.cameras, found.covariance, real, court, marked)),
        ):
            rows.append({"way": way, "seed": seed, "of": what, "taken": found.taken, **one})
        print(rows[-2:], found.line, flush=True)

    cameras = {camera.name: camera for camera in camera_models.read_toml(of_base / "cameras.toml")}
    cameras = [cameras[name] for name in names]
    known = covariance.read(of_base / "covariance.npz").of(names)
    measure(given.base, 0, cameras, known, Points())
    drawn = {"n_draws": given.seeds, "seed": 0, "session": given.session}
    drawn["preset"] = session["virtual"]["preset"]
    persons = clicking.clicks_of_persons(real.cameras, court, real.court_xyz, **drawn)
    for seed, by_camera in enumerate(persons):
        base = disturbed(real.cameras, STATED, np.random.default_rng(seed))
        clicked = adjustment.court_clicks(court, by_camera, base, **WEIGHTS)
        known = prior.stated(base, **STATED)
        measure("disturbed, clicks", seed, base, known, Points(court=clicked, fitted=True))
        measure("disturbed", seed, base, known, Points())
    table = pd.DataFrame(rows).groupby(["way", "of"], sort=False)
    measures = ["volume_rms_cm", "shape_cm", "coverage90"]
    print(table[measures].agg(["median", "mean"]).round(3).to_string())


if __name__ == "__main__":
    main()
