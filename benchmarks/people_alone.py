"""Errors of cameras calibrated from the people that they film, and nothing else.

    python benchmarks/people_alone.py RESULTS [--session SESSION] [--takes TAKE ...]
        [--cameras NAME ...]

RESULTS are those of a run that detected poses in the takes of a virtual session. Lenses are
unknown. Three cameras film two players, whose heights are stated to the centimetre; in other rows a
length on the floor is known instead, clicked in every picture. True joints are projected by the
true cameras and triangulated by the estimated ones. `joints`: median error after the best rigid
motion. `shape`: the same after the best similarity. `scale`: error of all lengths. `hold`: share of
the joints inside the 90 % ellipsoids of the cameras' covariance. `accepted`: views of held-out limb
joints that agree with the others. Writes docs/numbers/people_alone.csv.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

import numpy as np

from people_seen import CONFIG, LIMITS, ROOT, WEIGHTS

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection
from courtside.calibration.court import joint_adjustment
from courtside.calibration.people import unit
from courtside.evaluation.numbers import stated
from courtside.evaluation.numbers.players import NETWORK as MODEL
from courtside.geometry import camera as camera_models
from courtside.geometry import similarity
from courtside.geometry.triangulation import triangulate_all
from courtside.reconstruction import self_calibration
from courtside.records.keypoints import keypoints
from courtside.records.truth import session_truth, take_truth
from courtside.study.configuration import yaml_files
from courtside.synchronisation import cameras as camera_sync

TAKES = "footwork", "crossing"
THREE = ("oblique", "mirror", "front")  # not on one line
MADE = "benchmark", "`python benchmarks/people_alone.py RESULTS`"
# Known lengths on the floor, m; heights are then not stated.
KNOWN = {
    "a court line of 6.1 m clicked": np.array([[0, 4.72, 0], [6.1, 4.72, 0]]),
    "a racket on the floor clicked": np.array([[3.0, 4.0, 0], [3.674, 4.0, 0]]),
}
CLICK = {key: WEIGHTS[key] for key in ("click_sigma_px", "click_bias_px")}
SEED = 0  # of the clicks
EVERY = 12  # of the true frames: neighbouring ones are nearly equal


def timed(results, session, takes, names, cameras):
    """Return the takes for `self_calibration`, with clocks by cameras if these are known."""
    found = []
    for name, take in takes.items():
        folder = results / session / "takes" / name / "pose2d" / MODEL
        views = [keypoints.read_2d(folder / f"{camera}.npz") for camera in names]
        known = {"synchronised": take.get("synchronised", False), "stated": {}}
        clocks = camera_sync.of_take(views, cameras, **known, **CONFIG["synchronise_cameras"])
        found.append((name, views, clocks))
    return found


def errors(found, real, xyz):
    """Return median joint error and shape error, mm, scale - 1, %, and coverage, %."""
    cameras, covariance = found.cameras, found.covariance.of_columns()
    exact = np.stack([camera_models.project(camera, xyz) for camera in real])
    placed = triangulate_all(cameras, exact)
    best, rigid = similarity.umeyama(placed, xyz), similarity.rigid(placed, xyz)
    off = rigid.points(placed) - xyz
    spread = point_covariance.point_covariance(selection.of_cameras(cameras), covariance, placed)
    spread = best.rotation @ spread @ best.rotation.T
    inside = point_covariance.mahalanobis(off, spread) <= point_covariance.ellipsoid(0.9)
    shape = np.linalg.norm(best.points(placed) - xyz, axis=1)
    return (
        1000 * np.median(np.linalg.norm(off, axis=1)),
        1000 * np.median(shape),
        100 * (1 / best.scale - 1),
        100 * inside.mean(),
    )


def clicked(real, ends, seed):
    """Return a known length with simulated clicks, of the errors in config.yaml."""
    rng, length_m = np.random.default_rng(seed), float(np.linalg.norm(ends[1] - ends[0]))
    xy = np.stack([camera_models.project(camera, ends) for camera in real])
    for camera, px in zip(real, xy, strict=True):
        scatter, bias = (joint_adjustment.click_sigma(one, camera.size) for one in CLICK.values())
        px += rng.normal(0, scatter, px.shape) + rng.normal(0, bias, 2)
        px[((px < 0) | (px >= camera.size)).any(axis=1)] = np.nan
    stated_ends = [{"points": ["one", "other"], "length_m": length_m, "on_floor": True}]
    (found,) = unit.of_clicks(stated_ends, ["one", "other"], xy, **CLICK)
    return found


def rows(results, name, takes, names):
    """Yield the parts of the rows of docs/numbers/people_alone.csv."""
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{name}.yaml")
    stated_takes = {take: session["takes"][take] for take in takes}
    everybody = list(session["subjects"])
    heights_m = [
        [session["subjects"][who]["height_m"] for who in take.get("subjects", everybody)]
        for take in stated_takes.values()
    ]
    folder = results / "virtual" / name
    real = session_truth.read(folder / "truth.npz").cameras
    real = [camera for camera in real if camera.name in names]
    names = [camera.name for camera in real]
    true = [take_truth.read(folder / "takes" / take / "truth.npz") for take in takes]
    xyz = np.concatenate([one.xyz[:, ::EVERY, :12].reshape(-1, 3) for one in true])
    seconds = sum(take["virtual"]["seconds"] for take in stated_takes.values())
    of_takes = partial(timed, results, name, stated_takes, names)
    for what, ends in (("heights stated", None), *KNOWN.items()):
        heights = heights_m if ends is None else [[None] * len(one) for one in heights_m]
        known = [] if ends is None else [clicked(real, ends, SEED)]
        found = self_calibration.calibrate(names, {}, of_takes, heights, LIMITS, known)
        joint, shape, scale, inside = errors(found, real, xyz)
        accepted = found.score.accepted_percent()
        print(names, what, joint, shape, scale, inside, accepted, found.scale, found.warnings)
        row = f"`{name}`: people alone, {len(names)} cameras, {seconds} s, {what}"
        text = f"joints after a rigid motion {joint:.0f} mm, scale {scale:+.1f} %"
        yield row, "alone", f"{text}, hold {inside:.0f} %", "mm", 1
        yield row, "alone_shape", f"{shape / 10:.2f}", "cm", 1
        yield row, "alone_accepted", f"{accepted.mean():.1f}", "%", 1


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--session", default="players-b")
    parser.add_argument("--takes", nargs="+", default=list(TAKES))
    parser.add_argument("--cameras", nargs="+", default=list(THREE))
    parser.add_argument("--model", default=MODEL)
    given = parser.parse_args()
    chosen = given.session, tuple(given.cameras), tuple(given.takes), given.model
    documented = chosen == ("players-b", THREE, TAKES, MODEL)
    MODEL = given.model
    made = [
        ["ways", row, part, printed, unit, given.session, n, 0, *MADE]
        for row, part, printed, unit, n in rows(
            given.results, given.session, given.takes, given.cameras
        )
    ]
    if documented:
        stated.write(ROOT / stated.FOLDER / "people_alone.csv", stated.joined(made))
