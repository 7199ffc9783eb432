"""One camera clicked on the neighbouring court: what the calibration with a walk says of it.

    python benchmarks/neighbouring_court.py results

RESULTS hold the sessions `SESSIONS`. Of each map and camera, the clicks are those of a court that
lies `SPACING_M` beside the right one, to either side; the other cameras keep their own clicks.
Counts how many of these calibrations are refused, warned of by how much worse the tie points fit
with the clicks (`joint_adjustment.strain`), by points of the map below the floor, by any other
line, and by nothing; and the strain with right clicks. Writes docs/numbers/neighbouring_court.csv.
"""

import argparse
import sys
from itertools import product
from pathlib import Path

import numpy as np

import stated
from repository import ROOT
from ways_to_calibrate import CONFIG, WEIGHTS, hall

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.bundle import selection, walk_parts
from courtside.calibration.court import joint_adjustment, quality
from courtside.geometry import camera as camera_models
from courtside.records.cameras import clicks, image_names
from courtside.sfm import model
from courtside.study.errors import InputError

SESSIONS = "plain-a", "plain-b", "rich-a", "players-b"
MAPS = "global-n20-o0", "global-n40-o0"
SPACING_M = 8.1  # of courts side by side: 6.1 m wide, 2 m apart
CLICK_PX, SEED = 1.2, 0
WAYS = "refused", "strain", "floor", "others", "nothing"
COMMAND = "`python benchmarks/neighbouring_court.py results`"


def with_neighbour(one, marked, name, shift_m, rng):
    """Return clicks of which those of one camera are of a court `shift_m` along x."""
    camera = one.real.cameras[one.names.index(name)]
    xy = camera_models.project(camera, np.add(one.real.court_xyz, (shift_m, 0, 0)))
    xy += rng.normal(0, CLICK_PX, xy.shape)
    inside = ((xy > 0) & (xy < camera.size)).all(axis=1)
    return {**marked, name: np.where(inside[:, None], xy, np.nan)}


def said(one, folder, marked):
    """Return the strain of the ties, NaN if refused, and which of the checks say something."""
    network, images, sizes = model.read(folder)
    fixed = {name: images.index(image_names.static(name)) for name in one.names}
    size_of = {name: sizes[network.lens_of_image[at]] for name, at in fixed.items()}
    options = {k: v for k, v in CONFIG["adjust_network"].items() if k != "min_points"}
    options["tie_sigma_px"] = options.pop("tie_sigma") * selection.residual_spread(network)
    options["click_sigma_px"] = np.hypot(options["click_sigma_px"], options.pop("click_bias_px"))
    try:
        ties, parts = joint_adjustment.condense(
            network, fixed, size_of, marked, one.court, **options
        )
        _, checked = quality.adjust_and_check(one.court, ties, marked, **WEIGHTS)
    except InputError:
        return np.nan, ["refused"]
    strain = joint_adjustment.strain(parts)
    found = {
        "strain": quality.strained(strain),
        "floor": quality.sunken(one.court, walk_parts.points(parts)),
        "others": checked["warnings"],
    }
    return strain, [way for way, line in found.items() if line] or ["nothing"]


def cases(one, folders, marked):
    """Yield the strain, and what is said, of each map, camera and side; and print them."""
    rng = np.random.default_rng(SEED)
    for folder, name, shift_m in product(folders, one.names, (-SPACING_M, SPACING_M)):
        strain, ways = said(one, folder, with_neighbour(one, marked, name, shift_m, rng))
        print(one.name, folder.name, name, shift_m, f"{strain:.1f}", *ways, flush=True)
        yield ways


def rows_of(results):
    """Yield the numbers of the table."""
    for session in SESSIONS:
        one = hall(results, session)
        clicks_csv = results / "virtual" / session / "court_points.csv"
        marked = clicks.read(clicks_csv, one.names, list(one.court.points))
        folders = [results / session / "sfm" / name for name in MAPS]
        folders = [folder for folder in folders if folder.is_dir()]
        right = max(said(one, folder, marked)[0] for folder in folders)
        told = list(cases(one, folders, marked))
        about = "neighbouring-court", f"`{session}`, {len(one.names)} cameras"
        made = session, len(told), 0, "benchmark", COMMAND
        yield *about, "right", f"{right:.1f}", "", *made
        for way in WAYS:
            yield *about, way, str(sum(way in ways for ways in told)), "", *made


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    given = parser.parse_args()
    stated.write(ROOT / "docs" / "numbers" / "neighbouring_court.csv", list(rows_of(given.results)))


if __name__ == "__main__":
    main()
