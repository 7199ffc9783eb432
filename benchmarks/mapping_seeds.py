"""How much of a calibration's error is the mapper's seed: error over the playing volume, by seed.

    python benchmarks/mapping_seeds.py results SESSION [--images 40] [--seeds 10] [--draws 10]

SESSION is a virtual session that the study has matched. Rounding in another processor changes a
model as another seed does, so the spread over seeds is also what to expect between processors. Each
seed maps the same matches again; each model is calibrated from the same draws of clicks. For each
way, the table gives how many seeds gave a result, and the lowest, median and highest of their
median errors (root mean square over the volume, cm).
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
sys.path.insert(0, str(ROOT / "workflow" / "scripts"))
import adjust_network
import map_images

from courtside.calibration.court import court as court_files
from courtside.calibration.records import tie_points
from courtside.evaluation import calibration
from courtside.records.truth import session_truth
from courtside.study.configuration import yaml_files
from virtualgym.session import clicks

CLICKS = "click_sigma_px", "click_bias_px", "click_loss"
LINE = "{:<13}{:<8}{:>7}{:>9}{:>9}{:>9}"


def errors(results, name, mapper, seed, n_images, n_draws):
    """Return the errors of all draws, cm, by way; empty where a fixed camera is not placed."""
    config = yaml_files.read(ROOT / "config" / "config.yaml")
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{name}.yaml")
    court_yaml = ROOT / "config" / "courts" / f"{session['court']}.yaml"
    folder, film = results / name, results / "virtual" / name
    court, real = court_files.read(court_yaml), session_truth.read(film / "truth.npz")
    step = config["map_images"]
    with tempfile.TemporaryDirectory() as temporary:
        model = Path(temporary)
        files = folder / "sfm" / "matches.db", folder / "sfm" / "features.csv"
        walks = {walk: folder / "frames" / f"{walk}.csv" for walk in session["walks"]}
        map_images.main(
            *files,
            list(walks.values()),
            model / "summary.json",
            walks=list(walks),
            mapper=mapper,
            n_images=n_images,
            offset=0,
            rule=step["rule"],
            seed=seed,
            options=step["colmap"][mapper],
            attempts=step["attempts"][mapper],
        )
        adjust_network.main(
            model / "summary.json",
            folder / "sfm" / "matches.db",
            film / "court_points.csv",
            court_yaml,
            model / "ties.npz",
            cameras=list(session["cameras"]),
            **config["adjust_network"],
        )
        record = tie_points.read(model / "ties.npz")
    if record.outcome:
        return {}
    drawn = {"n_draws": n_draws, "seed": 0, "preset": session["virtual"]["preset"], "session": name}
    weights = {key: config["adjust_network"][key] for key in CLICKS}
    found = {}
    for marked in clicks.clicks_of_persons(real.cameras, court, real.court_xyz, **drawn):
        for row in calibration.of_ties(
            record, real.cameras, court, marked, sets=["all"], **weights
        ):
            if row["in_sample"] and not row["outcome"]:
                found.setdefault(row["method"], []).append(row["volume_rms_cm"])
    return found


def main(results, session, n_images, n_seeds, n_draws):
    print(LINE.format("mapper", "way", "placed", "lowest", "median", "highest"))
    for mapper in ("global", "incremental"):
        # Seeds far enough apart that the attempts of one do not meet those of the next.
        tried = [
            errors(results, session, mapper, 100 * at, n_images, n_draws) for at in range(n_seeds)
        ]
        for way in ("sfm", "sim3", "paper"):
            medians = [np.median(found[way]) for found in tried if way in found]
            spread = [f"{f(medians):.2f}" if medians else "-" for f in (np.min, np.median, np.max)]
            print(LINE.format(mapper, way, f"{len(medians)}/{n_seeds}", *spread), flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("--images", type=int, default=40)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--draws", type=int, default=10)
    given = parser.parse_args()
    main(given.results, given.session, given.images, given.seeds, given.draws)
