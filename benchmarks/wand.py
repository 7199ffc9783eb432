"""Errors of cameras calibrated with a simulated wand in a virtual hall.

    python benchmarks/wand.py [--easywand FOLDER] [--seeds 6] [--seconds 40]

A wand of 0.8 m, measured to 0.5 mm, moves over the whole court of `players-b`, up to a height of
2.4 m. Its markers in the pictures are simulated without rendering: noise of 0.5 or 1 px, hidden for
15 % of the time, 2 % on another spot nearby. Lenses are known, or focal length and distortion are
estimated. Points of the volume are projected by the true cameras and triangulated by the estimated
ones, after the rigid motion that moves the wand's markers to their true positions. `volume`: root
mean square error of these points, median and 95 % quantile over the seeds, cm. `angles`: largest
error of a camera's direction, median and maximum over the seeds. `focal`: largest error of a focal
length, median. `hold`: share of the points inside their stated 90 % ellipsoids. The row of the ways
to calibrate has 18 clicked court points, which define the world frame.

FOLDER contains `wandpts.csv` of a real wand, clicked in 50 frames of three cameras, and the
cameras' nominal lenses in `RGBsetup_profile.txt` (github.com/PeppyHare/EasyWand). The length of
this wand is not stated; its variation measures the quality of the cameras. Writes
docs/numbers/wand.csv; without FOLDER its rows there stay.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

import numpy as np

import stated
from people_seen import WEIGHTS
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.court import court as court_files
from courtside.calibration.court import quality
from courtside.calibration.people.adjustment import court_clicks
from courtside.calibration.wand import calibration, points
from courtside.calibration.wand import quality as wand_quality
from courtside.calibration.wand.points import SIGMA_M, Seen, Wand
from courtside.geometry import camera as camera_models
from courtside.geometry import rotations, similarity
from courtside.geometry.similarity import Sim3
from courtside.geometry.triangulation import triangulate_all
from courtside.statistics import normal_errors
from courtside.study.configuration import yaml_files
from virtualgym import presets
from virtualgym.devices import wand as simulated
from virtualgym.session import clicks as clicking
from virtualgym.session import session as virtual

SESSION, COURT = "players-b", court_files.read(ROOT / "config" / "courts" / "badminton.yaml")
THREE = ("oblique", "mirror", "front")  # not on one line
LENGTH_M, RATE_HZ, HIDDEN, MISREAD = 0.8, 10.0, 0.15, 0.02
LOW, HIGH = (0.0, 0.0, 0.4), (*COURT.size_m, 2.4)  # of the wand's middle, m
MADE = "benchmark", "`python benchmarks/wand.py --easywand FOLDER`"


def hall():
    """Return the true cameras of the session and its preset, from its configuration."""
    given = yaml_files.read(ROOT / "config" / "sessions" / f"{SESSION}.yaml")["virtual"]
    settings = virtual.Settings(**given | {"size_px": tuple(given["size_px"])})
    return virtual.plan(settings, COURT)[0], presets.PRESETS[given["preset"]]


def swung(real, sigma_px, seconds, seed):
    """Return the stated wand, the true positions of its markers, and those in the pictures."""
    rng = np.random.default_rng(seed)
    wand = Wand((), np.array([0.0, LENGTH_M]), SIGMA_M)
    true_m = [0.0, LENGTH_M + SIGMA_M * rng.standard_normal()]
    common = {"rate_hz": RATE_HZ, "rng": rng}
    xyz = simulated.swing(true_m, LOW, HIGH, seconds=seconds, **common)
    xy = simulated.film(real, xyz, sigma_px=sigma_px, hidden=HIDDEN, misread=MISREAD, **common)
    return wand, xyz, Seen(tuple(one.name for one in real), np.arange(len(xyz), dtype=float), xy)


def placed(found, real, xyz):
    """Return points (N, 3) m, projected by true cameras and triangulated by the estimated ones."""
    exact = np.stack([camera_models.project(camera, xyz) for camera in real])
    return triangulate_all(found.cameras, exact)


def errors(found, real, markers):
    """Return rms and shape error, cm, angle, degrees, focal error, %, and coverage, %.

    They are errors after the rigid motion that fits the wand's markers (N, 3) m; with None, in the
    world frame.
    """
    grid = quality.volume(COURT)
    rigid = Sim3(1.0, np.eye(3), np.zeros(3))
    if markers is not None:
        rigid = similarity.rigid(placed(found, real, markers), markers)
    xyz = placed(found, real, grid)
    network = conversion.network_of(found.cameras)
    spread = point_covariance.point_covariance(network, found.covariance.of_columns(), xyz)
    off, spread = rigid.points(xyz) - grid, rigid.rotation @ spread @ rigid.rotation.T
    held = normal_errors.mahalanobis(off, spread) <= normal_errors.ellipsoid(0.9)
    shape = similarity.umeyama(xyz, grid).points(xyz) - grid
    turns = [
        rotations.angles(rigid.camera(one).cam_from_world[:, :3] @ true.cam_from_world[:, :3].T)
        for one, true in zip(found.cameras, real, strict=True)
    ]
    focal = [one.K[1, 1] / true.K[1, 1] - 1 for one, true in zip(found.cameras, real, strict=True)]
    rms, left = (100 * np.sqrt((d**2).sum(axis=1).mean()) for d in (off, shape))
    return rms, left, np.degrees(max(turns)), 100 * np.abs(focal).max(), 100 * held.mean()


def trial(real, sigma_px, known, seconds, seed, clicks=None):
    """Return the errors of one wand."""
    wand, xyz, seen = swung(real, sigma_px, seconds, seed)
    sizes = {camera.name: camera.size for camera in real}
    lenses = {camera.name: camera for camera in real} if known else {}
    found = calibration.calibrate(wand, seen, sizes, lenses=lenses, clicks=clicks)
    markers = None if clicks else xyz[:: len(xyz) // 100].reshape(-1, 3)
    return errors(found, real, markers)


def alone(real, seconds, seeds):
    """Yield the rows of a wand without clicked points."""
    for names in (tuple(camera.name for camera in real), THREE):
        chosen = [camera for camera in real if camera.name in names]
        for sigma_px in (0.5, 1.0):
            for known in (True, False):
                row = (
                    f"{len(chosen)} cameras, {sigma_px:g} px, lens {'known' if known else 'found'}"
                )
                found = np.array([trial(chosen, sigma_px, known, seconds, s) for s in range(seeds)])
                rms, _, angle, focal, held = found.T
                print(row, found.round(3).tolist(), flush=True)
                volume = f"{np.median(rms):.2f} / {np.quantile(rms, 0.95):.2f}"
                yield row, "volume", volume, "cm"
                yield row, "angles", f"{np.median(angle):.2f} / {angle.max():.2f}", "degrees"
                yield row, "focal", "" if known else f"{np.median(focal):.2f}", "%"
                yield row, "hold", f"{held.mean():.0f}", "%"


def clicked(real, preset, seconds, seeds):
    """Return the text of the row of the ways to calibrate: lenses estimated, with 18 clicks."""
    names, found = [camera.name for camera in real], []
    for seed in range(seeds):
        marked = clicking.click_points(
            real, COURT.xyz, rng=np.random.default_rng([seed, 1]),
            sigma_px_at_3840=preset.click_sigma_px_at_3840,
            bias_px_at_3840=preset.click_bias_px_at_3840,
        )  # fmt: skip
        weighted = partial(court_clicks, COURT, {name: marked[name] for name in names}, **WEIGHTS)
        found.append(trial(real, 0.5, False, seconds, seed, weighted))
    rms, shape, _, _, held = np.array(found).T
    print("clicked", np.round(found, 3).tolist(), flush=True)
    volume = f"{np.median(rms):.2f} / {np.quantile(rms, 0.95):.2f}"
    return f"{volume}; {np.median(shape):.2f}; hold {held.mean():.0f} %"


def easywand(folder):
    """Yield the rows of a real wand: with stated lenses without distortion, and estimated ones."""
    given = {"length_m": 1.0, "points": folder / "wandpts.csv", "program": "dltdv"}
    profile = np.loadtxt(folder / "RGBsetup_profile.txt")
    names = {f"cam{number:g}": f"cam{number:g}" for number in profile[:, 0]}
    sizes = {name: (int(w), int(h)) for name, (w, h) in zip(names, profile[:, 2:4], strict=True)}
    lenses = {
        name: camera_models.Camera(
            name, sizes[name], [[f, 0, cx], [0, f, cy], [0, 0, 1]], np.zeros(5), np.eye(3, 4)
        )
        for name, (f, cx, cy) in zip(names, profile[:, [1, 4, 5]], strict=True)
    }
    wand = Wand.of(given)
    seen = points.read(given, wand, names, sizes)
    for known, lens in ((lenses, "stated"), ({}, "found")):
        found = calibration.calibrate(wand, seen, sizes, lenses=known)
        summary = wand_quality.summary(found, wand, seen, set(known))
        varies = 100 * summary["length_mm"]["spread"] / (1000 * wand.length_m)
        px = "/".join(f"{value:.1f}" for value in summary["rms_px"].values())
        row = f"`easywand-3cams`: a wand clicked in {len(seen.frames)} frames, lenses {lens}"
        yield row, f"markers {px} px; its length varies by {varies:.2f} %", len(seen.frames)


def rows(seconds, seeds, folder):
    """Yield the rows of docs/numbers/wand.csv."""
    for row, printed, n in easywand(folder) if folder else ():
        print(row, printed, flush=True)
        yield ["ways", row, "alone", printed, "px", "easywand-3cams", n, 0]
    real, preset = hall()
    way = f"`{SESSION}`: wand of {LENGTH_M:g} m for {seconds:g} s and 18 clicks, lens found"
    yield ["ways", way, "alone", clicked(real, preset, seconds, seeds), "cm", SESSION, seeds, 0]
    for row, part, printed, unit in alone(real, seconds, seeds):
        yield ["wand", row, part, printed or "known", unit, SESSION, seeds, 0]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=40)
    parser.add_argument("--easywand", type=Path)
    parser.add_argument("--csv", type=Path, default=ROOT / stated.FOLDER / "wand.csv")
    given = parser.parse_args()
    made = [[*row, *MADE] for row in rows(given.seconds, given.seeds, given.easywand)]
    others = stated.of_other_sessions(given.csv, {row[5] for row in made})
    stated.write(given.csv, [*others, *made])
