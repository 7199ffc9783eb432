"""Walk, clicks and painted lines together: errors of cameras and of a player seen by them.

    python benchmarks/walk_and_lines.py RESULTS [--halls RESULTS] [--seeds 8] [--only SESSION ...]

RESULTS are those of a default run, as those of the halls of `other_halls.py`. Drawn persons click
each hall; its cameras are found from the walk and 18 clicks, the same with the court's lines, and
the walk with lines alone. Lines are measured once, near where the first person's cameras have them.
The 2D keypoints of `players-b/footwork` are triangulated anew with cameras from the session's own
clicks, with and without lines, and as they truly are. Writes docs/numbers/walk_and_lines.csv, in
which rows of halls that are not measured stay.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

import stated
import true_cameras
import ways_to_calibrate
from courtside.calibration.court import joint_adjustment
from courtside.calibration.court_lines import edges, walk_and_lines
from courtside.calibration.records import tie_points
from courtside.evaluation import calibration, error_fit
from courtside.evaluation.numbers.players import NETWORK
from courtside.reconstruction import joint_correction
from courtside.records.cameras import clicks
from repository import ROOT

CONFIG = ways_to_calibrate.CONFIG
WEIGHTS = {**ways_to_calibrate.WEIGHTS, "max_iterations": 30}
SESSIONS = ("players-b",)
WAYS = ("clicks", "both", "lines")
MADE = "benchmark", "`python benchmarks/walk_and_lines.py`"
THREE = ("oblique", "back", "mirror")


class Walk:
    """A virtual session with its ties and its measured lines."""

    def __init__(self, results, name):
        self.one = ways_to_calibrate.hall(results, name)
        folder = results / name
        self.ties = tie_points.read(folder / "sfm" / "global-n40-o0" / "ties.npz").ties
        near, step, self.seen = (
            self.solve(self.one.persons(1)[0]),
            CONFIG["propose_court_points"],
            {},
        )
        for camera in near.cameras:
            image = cv2.imread(str(folder / "static" / f"{camera.name}.png"))
            search = {"search_px": step["search_share"] * max(camera.size), "lines": step["lines"]}
            found, reason = edges.measure(camera, image, self.one.court, **search)
            print(name, camera.name, reason or f"{len(found.line)} stretches", flush=True)
            if found is not None:
                self.seen[camera.name] = found

    def solve(self, clicked):
        """Return the solution of ties and clicks."""
        court = self.one.court
        return joint_adjustment.solve_with_factors(self.ties, clicked, court, **WEIGHTS)

    def ways(self, clicked):
        """Yield the cameras of each way."""
        base, court = self.solve(clicked), self.one.court
        yield base
        adjusted = walk_and_lines.from_edges(base, self.ties, clicked, court, self.seen, **WEIGHTS)
        yield adjusted.solution
        nothing = {name: np.full_like(xy, np.nan) for name, xy in clicked.items()}
        adjusted = walk_and_lines.from_edges(base, self.ties, nothing, court, self.seen, **WEIGHTS)
        yield adjusted.solution

    def errors(self, n_draws):
        """Return volume error, cm, and coverage of the 90 % ellipsoids, (draws, ways, 2)."""
        real, court, found = self.one.real.cameras, self.one.court, []
        for clicked in self.one.persons(n_draws):
            scored = [
                calibration.score(way.cameras, real, court, clicked, way.point_covariance)
                for way in self.ways(clicked)
            ]
            found.append([(one["volume_rms_cm"], one["coverage90"]) for one in scored])
        return np.array(found)


def hall_rows(results, halls, n_draws, only):
    """Yield the rows of each hall and of the halls together."""
    where = dict.fromkeys(SESSIONS, results)
    where |= dict.fromkeys(ways_to_calibrate.HALLS, halls) if halls else {}
    every = {}
    for name, folder in where.items():
        if only and name not in only:
            continue
        walk = Walk(folder, name)
        every[name] = walk.errors(n_draws)
        seen = f"{len(walk.seen)} of {len(walk.one.names)}"
        yield f"`{name}`", "seen", seen, "cameras", name, n_draws
        for part, (cm, held) in zip(
            WAYS, np.moveaxis(every[name], 1, 0).swapaxes(1, 2), strict=True
        ):
            printed = (
                f"{np.median(cm):.2f} / {np.quantile(cm, 0.95):.2f}; {100 * held.mean():.0f} %"
            )
            yield f"`{name}`", part, printed, "cm", name, n_draws
            print(name, part, printed, flush=True)
    six = [every[name] for name in ways_to_calibrate.HALLS if name in every]
    if len(six) == len(ways_to_calibrate.HALLS):
        row, each = "the six halls `hall-...`: median, worst", np.median(six, axis=1)[:, :, 0]
        for at, part in enumerate(WAYS):
            held = np.mean(six, axis=(0, 1))[at, 1]
            printed = f"{np.median(each[:, at]):.2f}, {each[:, at].max():.2f}; {100 * held:.0f} %"
            yield row, part, printed, "cm", " ".join(ways_to_calibrate.HALLS), n_draws
            print(row, part, printed, flush=True)


def player_rows(results):
    """Yield the errors of a player by cameras of the walk, with lines, and by the true ones."""
    session = "players-b"
    name = f"{session}/footwork"
    files, walk = true_cameras.Take(results, name, NETWORK, "all-robust"), Walk(results, session)
    table = joint_correction.read(ROOT / "config" / "joint_offsets" / f"{NETWORK}.csv")
    ((seen, sex_of, truth),) = error_fit.footage_with_truth([files.take])
    path = results / "virtual" / session / "court_points.csv"
    clicked = clicks.read(path, walk.one.names, list(walk.one.court.points))
    base, both, _ = walk.ways(clicked)
    for words, found in (("clicks", base.cameras), ("both", both.cameras), ("true", None)):
        by_name = {camera.name: camera for camera in found or walk.one.real.cameras}
        for n, chosen in ((4, walk.one.names), (3, THREE)):
            used = [
                replace(one, camera=by_name[one.camera.name])
                for one in seen
                if one.camera.name in chosen
            ]
            raw = error_fit.triangulated(
                used, true_cameras.SHAPE, list(sex_of), CONFIG["triangulate"]
            )
            cameras = [one.camera for one in used]
            stages = true_cameras.stages(raw, table, sex_of, CONFIG, cameras)
            for stage, points in stages.items():
                printed = true_cameras.printed(true_cameras.limb_errors(points, truth))
                print(words, n, stage, printed, flush=True)
                yield f"`{name}`, {n} cameras, {stage}", words, printed, "mm", session, 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--halls", type=Path)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--only", nargs="+", default=[])
    given = parser.parse_args()
    rows = hall_rows(given.results, given.halls, given.seeds, given.only)
    made = [["walk-lines", *row, 0, *MADE] for row in rows]
    if not given.only:
        made += [["walk-lines-player", *row, 0, *MADE] for row in player_rows(given.results)]
        path = ROOT / stated.FOLDER / "walk_and_lines.csv"
        others = stated.of_other_sessions(path, {row[5] for row in made})
        stated.write(path, [*made, *others])


if __name__ == "__main__":
    main()
