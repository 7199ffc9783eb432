"""Triangulate the same keypoints with this project, Pose2Sim and aniposelib: cost and error.

    python benchmarks/triangulate_points.py [--environments DIR] [--repeats 5] [--json OUT]

4 cameras x 26 joints x 1000 frames, 2 px noise, 5 % outliers, 5 % missing, then 4 and 12 cameras
with one bad view of every point. One core and one thread each; the fastest of the repeats counts,
and this project runs before and after its peers so that a busier machine shows; ratios are to the
faster of the two. Errors of a method that took fewer points stand beside this project's on those
points.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

import numpy as np

import peers
import scene

POINTS_OF_POSE2SIM = {"spoiled": 26000, "bad": 260}
HEAD = "{:<44}{:>8}{:>9}{:>7}{:>8}{:>8}{:>8}{:>7}   {}"
LINE = "{:<44}{:>8}{:>9.2f}{:>7.1f}{:>8.1f}{:>8.1f}{:>8.1f}{:>7.2f}   {}"


def errors_mm(xyz, truth):
    """Return RMSE, median, p95 in mm and the share of missing points in %."""
    error = 1000 * np.linalg.norm(xyz - truth[: len(xyz)], axis=-1)
    found = error[np.isfinite(error)]
    spread = [np.sqrt(np.mean(found**2)), np.median(found), np.percentile(found, 95)]
    return [*map(float, spread), 100 * (1 - len(found) / len(error))]


def measure(folder, name, python, script, *arguments):
    """Run one script on the scene in `folder`; return {function: (us per point, points (N, 3))}."""
    result = folder / f"{name}.npz"
    timed = peers.run_method(python, script, folder / "scene.npz", result, *arguments)
    if "failed" in timed:
        print(f"{name}: {timed['failed']}", file=sys.stderr)
        return {}
    with np.load(result) as found:
        return {
            f"{name} {function}": (1e6 * min(times["seconds"]) / times["points"], found[function])
            for function, times in timed.items()
        }


def ours_us_per_point(measured):
    """Return the cost of this project's faster run."""
    return min(us for name, (us, _) in measured.items() if name.startswith("courtside"))


def report(measured, truth):
    """Print one line a method and return the lines as dictionaries."""
    ours_us, ours_xyz = ours_us_per_point(measured), measured["courtside triangulate_robust"][1]
    print(HEAD.format("method", "points", "us/point", "ratio", "RMSE", "median", "p95", "NaN %",
                      "ours on these points: RMSE / median / p95 mm"))  # fmt: skip
    lines = []
    for name, (us, xyz) in measured.items():
        numbers = errors_mm(xyz, truth)
        same = np.where(np.isfinite(xyz).all(axis=-1, keepdims=True), ours_xyz[: len(xyz)], np.nan)
        beside = errors_mm(same, truth)
        text = " / ".join(f"{number:.1f}" for number in beside[:3])
        print(LINE.format(name, len(xyz), us, us / ours_us, *numbers, text))
        keys = ("rmse_mm", "median_mm", "p95_mm", "missing_percent")
        lines.append({"method": name, "points": len(xyz), "us_per_point": us, "ratio": us / ours_us,
                      **dict(zip(keys, numbers, strict=True)),
                      "ours_mm_on_these": beside[:3]})  # fmt: skip
    return lines


def compare(made, environments, repeats, pose2sim_points, with_aniposelib=True):
    """Run every method on one scene and report."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        np.savez(folder / "scene.npz", **made)
        ours = (sys.executable, "triangulate_courtside.py", repeats)
        measured = measure(folder, "courtside", *ours)
        if not measured:
            raise SystemExit("this project's own triangulation did not run: see the line above")
        peer = peers.interpreter("pose2sim", environments)
        measured |= measure(folder, "pose2sim", peer, "triangulate_pose2sim.py", 2, pose2sim_points)
        if with_aniposelib:
            peer = peers.interpreter("aniposelib", environments)
            arguments = ("triangulate_aniposelib.py", repeats, str(scene.JOINTS))
            measured |= measure(folder, "aniposelib", peer, *arguments)
        again = measure(folder, "courtside", *ours)
        measured |= {f"{key} (again)": value for key, value in again.items()}
    return report(measured, made["xyz"])


def main():
    """Run both comparisons."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--environments", type=Path, default=peers.FOLDER)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--json", type=Path, help="also write the numbers to this file")
    given = parser.parse_args()
    common = (given.environments, str(given.repeats))
    print("4 cameras, 5 % outliers, 5 % missing, 2 px noise")
    tables = {"spoiled": compare(scene.spoiled(), *common, str(POINTS_OF_POSE2SIM["spoiled"]))}
    for count in (4, 12):
        print(f"\n{count} cameras, one bad view of every point, 2 px noise")
        key = f"bad_view_{count}_cameras"
        points = str(POINTS_OF_POSE2SIM["bad"])
        tables[key] = compare(scene.one_bad_view(count), *common, points, with_aniposelib=False)
    lines = {count: tables[f"bad_view_{count}_cameras"] for count in (4, 12)}
    cost = [min(line["us_per_point"] for line in (lines[n][0], lines[n][-1])) for n in lines]
    print(f"\ncourtside, 12 cameras against 4: {cost[1] / cost[0]:.2f} times the cost a point")
    if given.json:
        given.json.write_text(json.dumps(tables, indent=1) + "\n")


if __name__ == "__main__":
    main()
