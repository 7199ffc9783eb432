"""Calibrate from the same images with this project and with COLMAP's defaults: seconds and error.

    python benchmarks/structure_from_motion.py results SESSION
        [--images 75] [--map-minutes M] [--json OUT]

SESSION is a virtual session that the study has rendered and extracted (static pictures, frames of
the walk, clicks, truth). Both sides get the same pictures, lens model, one lens per physical
camera, and all cores; their processor time counts, which a busy machine changes little, and the
time by the clock stands beside it; this project matches the pairs of its list and maps globally,
COLMAP matches all pairs and maps incrementally, with its own default options. Errors are those of
the playing volume, from the session's own clicks, after the alignment that each side stops at (a
similarity to all court points) and after this project's adjustment of either model. `--map-minutes`
stops COLMAP's mapper after so long (it counts what it has by then); with hundreds of images it
takes hours otherwise.
"""

import argparse
import itertools
import json
import os
import sqlite3
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pycolmap

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.bundle import conversion, selection
from courtside.calibration.court import court as court_files
from courtside.calibration.court import joint_adjustment, sfm_alignment
from courtside.evaluation import calibration
from courtside.records.cameras import clicks, image_names
from courtside.records.truth import session_truth
from courtside.sfm import database, features, grid, mapping, matching, model, registration
from courtside.study.configuration import yaml_files

STEPS = "features", "matching", "mapping"
LINE = "{:<13}{:>10}{:>10}{:>10}{:>9}{:>9}{:>12}{:>10}{:>10}"


class Watch:
    """Processor seconds (all threads) and seconds by the clock of each step of one side."""

    def __init__(self):
        self.cpu, self.wall = {}, {}
        self._last = time.process_time(), time.perf_counter()

    def stop(self, step):
        """Note the seconds since the last stop as those of a step."""
        now = time.process_time(), time.perf_counter()
        self.cpu[step], self.wall[step] = (n - m for n, m in zip(now, self._last, strict=True))
        self._last = now


def ours(root, groups, walked, fixed, folder, parameters):
    watch = Watch()
    features.extract(
        folder / "f.db", root, groups, threads=os.cpu_count(), **parameters["extract_features"]
    )
    watch.stop("features")
    pairs = walked.pairs(fixed)
    matching.match(folder / "f.db", folder / "m.db", pairs, **parameters["match_images"])
    watch.stop("matching")
    images = [*fixed, *walked.names.tolist()]
    options = parameters["map_images"]["colmap"]["global"]
    mapping.map_images(folder / "m.db", images, folder, mapper="global", seed=0, options=options)
    watch.stop("mapping")
    return watch


def colmap(root, groups, folder, map_minutes):
    watch = Watch()
    defaults = pycolmap.SiftExtractionOptions()
    features.extract(
        folder / "f.db",
        root,
        groups,
        threads=os.cpu_count(),
        max_features=defaults.max_num_features,
        first_octave=defaults.first_octave,
        focal_factor=pycolmap.ImageReaderOptions().default_focal_length_factor,
    )
    watch.stop("features")
    with database.working_copy(folder / "f.db") as copy:
        pycolmap.match_exhaustive(copy, device=pycolmap.Device.cpu)
        watch.stop("matching")
        print(f"colmap: features and matches {watch.cpu} CPU s", file=sys.stderr, flush=True)
        options = pycolmap.IncrementalPipelineOptions()
        if map_minutes:
            options.max_runtime_seconds = round(60 * map_minutes)
        found = pycolmap.incremental_mapping(copy, root, folder, options)
    none = pycolmap.Reconstruction()  # where it was stopped too early
    largest = max(found.values(), key=lambda each: each.num_reg_images(), default=none)
    largest.write_binary(str(folder))
    watch.stop("mapping")
    return watch


def errors(folder, real, court, marked, parameters):
    """Return registered images, and the volume error (cm) after a similarity and after adjustment.

    The errors are NaN where the study would call a fixed camera not placed.
    """
    network, images, sizes = model.read(folder)
    options = dict(parameters["adjust_network"])
    fixed = {camera.name: image_names.static(camera.name) for camera in real.cameras}
    if registration.outcome(network, images, fixed, min_points=options.pop("min_points")):
        return len(images), np.nan, np.nan
    placed = {name: images.index(image) for name, image in fixed.items()}
    size_of = {name: sizes[network.lens_of_image[at]] for name, at in placed.items()}
    sfm = conversion.fixed_cameras(network, placed, size_of)
    world_from_sfm, _ = sfm_alignment.align(court, sfm_alignment.reconstruct(sfm, marked))
    bias_px = options.pop("click_bias_px")
    options["tie_sigma_px"] = options.pop("tie_sigma") * selection.residual_spread(network)
    ties, _ = joint_adjustment.condense(network, placed, size_of, marked, court, **options)
    solved = joint_adjustment.solve(
        ties,
        marked,
        court,
        click_bias_px=bias_px,
        click_sigma_px=options["click_sigma_px"],
        click_loss=options["click_loss"],
    )
    both = [world_from_sfm.camera(camera) for camera in sfm], solved.cameras
    scored = [calibration.score(each, real.cameras, court, marked) for each in both]
    return len(images), *(each["volume_rms_cm"] for each in scored)


def compared_features(path, pairs=None):
    """Return how many pairs of features are compared in some pairs of images (default all)."""
    with sqlite3.connect(path) as opened:
        query = "SELECT name, keypoints.rows FROM images JOIN keypoints USING (image_id)"
        counts = dict(opened.execute(query))
    return sum(counts[a] * counts[b] for a, b in pairs or itertools.combinations(counts, 2))


def compare(results, session, count, map_minutes=None):
    """Return {side: seconds of steps, images registered, errors in cm} for n bridging images."""
    root, virtual = results / session, results / "virtual" / session
    court = court_files.read(ROOT / "config" / "courts" / "badminton.yaml")
    real = session_truth.read(virtual / "truth.npz")
    names = [camera.name for camera in real.cameras]
    marked = clicks.read(virtual / "court_points.csv", names, list(court.points))
    parameters = yaml_files.read(ROOT / "config" / "config.yaml")
    whole = grid.read({"walk": root / "frames" / "walk.csv"})
    taken = np.array(whole.choose(count, 0, "even"))
    everything = np.ones(len(taken), dtype=bool)
    blank = np.full(len(taken), "")
    walk = np.full(len(taken), "walk")
    walked = grid.Grid(walk, taken, everything, everything * 1.0, blank, blank)
    fixed = [image_names.static(name) for name in names]
    groups = [features.Group(n, (f,)) for n, f in zip(names, fixed, strict=True)]
    groups.append(features.Group("walk", tuple(taken.tolist())))
    found = {}
    for side in ("courtside", "colmap"):
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            if side == "courtside":
                watch = ours(root, groups, walked, fixed, folder, parameters)
                pairs = walked.pairs(fixed)
            else:
                watch, pairs = colmap(root, groups, folder, map_minutes), None
            compared = compared_features(folder / "f.db", pairs)
            errors_cm = errors(folder, real, court, marked, parameters)
        named = ("registered", "similarity_cm", "adjusted_cm")
        wall = {f"{step}_wall": seconds for step, seconds in watch.wall.items()}
        found[side] = {**watch.cpu, **wall, "compared": compared}
        found[side] |= dict(zip(named, errors_cm, strict=True))
        print(f"{side}: {found[side]}", file=sys.stderr, flush=True)
    return found


def total(row, steps=STEPS):
    """Return the processor seconds of some steps together."""
    return sum(row[step] for step in steps)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("--images", type=int, default=75)
    parser.add_argument("--map-minutes", type=float, help="stop COLMAP's mapper then")
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    found = compare(chosen.results, chosen.session, chosen.images, chosen.map_minutes)
    print(LINE.format("CPU seconds", *STEPS, "total", "wall", "registered", "sim. cm", "adjusted"))
    for side, row in found.items():
        wall = total(row, [f"{step}_wall" for step in STEPS])
        cells = [f"{value:.1f}" for value in (*(row[step] for step in STEPS), total(row), wall)]
        cells += [
            f"{row['registered']}",
            f"{row['similarity_cm']:.2f}",
            f"{row['adjusted_cm']:.2f}",
        ]
        print(LINE.format(side, *cells))
    ratio = total(found["colmap"]) / total(found["courtside"])
    after = total(found["colmap"], STEPS[1:]) / total(found["courtside"], STEPS[1:])
    print(f"COLMAP's time over this project's: {ratio:.2f} in all, {after:.2f} after features")
    if chosen.json:
        chosen.json.write_text(json.dumps(found, indent=2) + "\n")


if __name__ == "__main__":
    main()
