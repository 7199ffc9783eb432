"""Errors of cameras calibrated from the people that they film, and nothing else.

    python benchmarks/people_alone.py RESULTS [--session SESSION] [--takes TAKE ...]
        [--cameras NAME ...] [--development RESULTS]

RESULTS are those of a run that detected poses in the takes of a virtual session. Lenses are
unknown. Three cameras film two players, whose heights are stated to the centimetre; in other rows
known lengths define the scale, clicked in every picture in 20 draws: a line on the floor, a racket
at one place, or at five places where somebody holds it, alone or with the heights. True joints are
projected by the true cameras and triangulated by the estimated ones. `joints`: median error after
the best rigid motion. `shape`: the same after the best similarity. `scale`: error of all lengths,
its root mean square over draws. `hold`: share of the joints inside the 90 % ellipsoids of the
cameras' covariance, over all draws. `accepted`: views of held-out limb joints that agree with the
others. With the results of the development sessions (`--development`), heights alone give the scale
there, too: from joints as the network sees them, and without its joint offsets, as the study does.
Writes docs/numbers/people_alone.csv.
"""

import argparse
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import scipy

import stated
from people_seen import CONFIG, LIMITS, WEIGHTS, offsets_of
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.court import joint_adjustment
from courtside.calibration.people import metric_scale, world_frame
from courtside.calibration.records import covariance as camera_covariance
from courtside.evaluation.numbers.players import NETWORK as MODEL
from courtside.geometry import camera as camera_models
from courtside.geometry import similarity
from courtside.geometry.triangulation import triangulate_all
from courtside.reconstruction import self_calibration
from courtside.records.keypoints import keypoints
from courtside.records.truth import session_truth, take_truth
from courtside.statistics import normal_errors
from courtside.study.configuration import yaml_files
from courtside.synchronisation import cameras as camera_sync

TAKES = "footwork", "crossing"
THREE = ("oblique", "mirror", "front")  # not on one line
COMMAND = "python benchmarks/people_alone.py RESULTS"
MADE = "benchmark", f"`{COMMAND}`"
# Places of a racket (top, butt), m: on the floor, then held by somebody who stands still.
RACKETS = np.array([
    [[3.674, 4.0, 0.0], [3.0, 4.0, 0.0]],
    [[1.5, 2.5, 1.9], [1.5, 2.5, 1.226]],
    [[4.5, 2.9, 1.0], [4.5, 2.226, 1.0]],
    [[4.2, 5.6, 2.2], [4.2, 5.6, 1.526]],
    [[1.4, 5.5, 1.1], [2.074, 5.5, 1.1]],
])  # fmt: skip
LINE = np.array([[[0, 4.72, 0], [6.1, 4.72, 0]]])
# Known lengths, and whether heights are stated, too.
KNOWN = {
    "a court line of 6.1 m clicked": (LINE, False),
    "a racket on the floor clicked": (RACKETS[:1], False),
    "a racket clicked at five places": (RACKETS, False),
    "a racket clicked at five places, heights stated": (RACKETS, True),
}
CLICK = {key: WEIGHTS[key] for key in ("click_sigma_px", "click_bias_px")}
DEVELOPED = "benchmark", f"`{COMMAND} --development RESULTS`"
DRAWS = 20  # of the clicks
DEVELOPMENT = (  # sessions and persons
    ("players-dev", ("m1", "f1", "m2", "f2")),
    ("players-dev-stands", ("m1", "f1", "m6", "f6")),
    ("players-dev-stands", ("m2", "f2", "m7", "f7")),
    ("players-dev-near", ("m1", "f1", "m6", "f6")),
    ("players-dev-near", ("m7", "f7")),
)
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
    spread = point_covariance.point_covariance(conversion.network_of(cameras), covariance, placed)
    spread = best.rotation @ spread @ best.rotation.T
    inside = normal_errors.mahalanobis(off, spread) <= normal_errors.ellipsoid(0.9)
    shape = np.linalg.norm(best.points(placed) - xyz, axis=1)
    return (
        1000 * np.median(np.linalg.norm(off, axis=1)),
        1000 * np.median(shape),
        100 * (1 / best.scale - 1),
        100 * inside.mean(),
    )


def clicked(real, places, seed):
    """Return known lengths (L, 2, 3) with simulated clicks, of the errors in config.yaml."""
    rng, ends = np.random.default_rng(seed), places.reshape(-1, 3)
    xy = np.stack([camera_models.project(camera, ends) for camera in real])
    for camera, px in zip(real, xy, strict=True):
        scatter, bias = (joint_adjustment.click_sigma(one, camera.size) for one in CLICK.values())
        px += rng.normal(0, scatter, px.shape) + rng.normal(0, bias, 2)
        px[((px < 0) | (px >= camera.size)).any(axis=1)] = np.nan
    names = [f"{end} {k}" for k in range(len(places)) for end in ("one", "other")]
    length_m = float(np.linalg.norm(places[0, 1] - places[0, 0]))
    stated_ends = [
        {"points": names[2 * k : 2 * k + 2], "length_m": length_m} for k in range(len(places))
    ]
    return metric_scale.of_clicks(stated_ends, names, xy, **CLICK)


def rescaled(found, scale):
    """Return the result with another unit, which replaces its scale and the error of its scale."""
    factor, names = scale.metres, [camera.name for camera in found.cameras]
    larger = similarity.Sim3(factor, np.eye(3), np.zeros(3))
    cameras = [larger.camera(camera) for camera in found.cameras]
    grown = np.ones((len(names), len(camera_covariance.PARAMETERS)))
    grown[:, 3:6] = factor  # the translations
    own = found.covariance.of(names).covariance * np.outer(grown, grown)
    shape = camera_covariance.CameraCovariance(names, own).of_columns()
    places = factor * found.places
    covariance = world_frame.of_shape(cameras, shape, places, scale.sigma)
    named = camera_covariance.of_network(names, covariance, found.covariance.frame)
    return replace(found, cameras=cameras, covariance=named, scale=scale, places=places)


def with_lengths(found, known, heights):
    """Return cameras by heights with the unit of known lengths, or of both.

    This is what `from_nothing.adjust` does with its last cameras.
    """
    columns = found.covariance.of_columns()
    shape = world_frame.of_shape(found.cameras, columns, found.places, 0.0)
    each, covariance = metric_scale.by_lengths(found.cameras, known, shape)
    if heights:
        each.append(metric_scale.Scale(1.0, found.scale.sigma, metric_scale.HEIGHTS))
        covariance = scipy.linalg.block_diag(covariance, found.scale.sigma**2)
    return rescaled(found, metric_scale.combined(each, covariance))


def calibrated(results, name, takes, names, offsets):
    """Return the cameras by people alone, the true ones, some true joints (N, 3), the takes."""
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{name}.yaml")
    stated_takes = {take: session["takes"][take] for take in takes}
    everybody = list(session["subjects"])
    heights_m = {
        name: {who: session["subjects"][who]["height_m"] for who in take.get("subjects", everybody)}
        for name, take in stated_takes.items()
    }
    folder = results / "virtual" / name
    real = session_truth.read(folder / "truth.npz").cameras
    real = [camera for camera in real if not names or camera.name in names]
    true = [take_truth.read(folder / "takes" / take / "truth.npz") for take in takes]
    xyz = np.concatenate([one.xyz[:, ::EVERY, :12].reshape(-1, 3) for one in true])
    of_takes = partial(timed, results, name, stated_takes, [camera.name for camera in real])
    found = self_calibration.calibrate(
        [camera.name for camera in real], {}, of_takes, heights_m, LIMITS, offsets=offsets
    )
    return found, real, xyz[np.isfinite(xyz).all(axis=1)], stated_takes


def rows(results, name, takes, names):
    """Yield the parts of the rows of the table `ways`."""
    found, real, xyz, stated_takes = calibrated(results, name, takes, names, offsets_of(MODEL))
    names = [camera.name for camera in real]
    seconds = sum(take["virtual"]["seconds"] for take in stated_takes.values())
    print(found.warnings)
    for what, (places, heights) in (("heights stated", (None, True)), *KNOWN.items()):
        if places is None:
            each = [found]
        else:
            draws = (clicked(real, places, seed) for seed in range(DRAWS))
            each = [with_lengths(found, known, heights) for known in draws]
        joint, shape, scale, inside = np.array([errors(one, real, xyz) for one in each]).T
        accepted = found.score.accepted_percent()
        sigma = 100 * np.mean([one.scale.sigma for one in each])
        print(names, what, joint.mean(), shape.mean(), scale, inside.mean(), accepted, sigma)
        row = f"`{name}`: people alone, {len(names)} cameras, {seconds} s, {what}"
        off = f"{scale[0]:+.1f} %" if len(each) == 1 else f"{np.sqrt(np.mean(scale**2)):.1f} %"
        text = f"joints after a rigid motion {np.median(joint):.0f} mm, scale {off}"
        n = len(each)
        yield row, "alone", f"{text} (stated {sigma:.1f}), hold {inside.mean():.0f} %", "mm", n
        yield row, "alone_shape", f"{shape[0] / 10:.2f}", "cm", n
        yield row, "alone_accepted", f"{accepted.mean():.1f}", "%", n


def layouts(results):
    """Yield the rows of the table `heights-alone`, of development sessions."""
    for session, persons in DEVELOPMENT:
        known = yaml_files.read(ROOT / "config" / "sessions" / f"{session}.yaml")["takes"]
        takes = [take for take, said in known.items() if set(said["subjects"]) <= set(persons)]
        for part, offsets in (("seen", None), ("corrected", offsets_of(MODEL))):
            found, real, xyz, _ = calibrated(results, session, takes, (), offsets)
            joint_mm, _, scale, inside = errors(found, real, xyz)
            printed = (
                f"joints {joint_mm:.0f} mm, scale {scale:+.1f} % (stated "
                f"{100 * found.scale.sigma:.1f}), hold {inside:.0f} %"
            )
            row = f"`{session}`, {len(real)} cameras, persons {', '.join(persons)}"
            print(row, part, printed, flush=True)
            yield ["heights-alone", row, part, printed, "mm", session, len(xyz), 0, *DEVELOPED]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--session", default="players-b")
    parser.add_argument("--takes", nargs="+", default=list(TAKES))
    parser.add_argument("--cameras", nargs="+", default=list(THREE))
    parser.add_argument("--model", default=MODEL)
    parser.add_argument("--development", type=Path)
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
        path = ROOT / stated.FOLDER / "people_alone.csv"
        others = stated.of_other_sessions(path, [given.session])
        if given.development:
            others = list(layouts(given.development))
        stated.write(path, [*stated.joined(made), *others])
