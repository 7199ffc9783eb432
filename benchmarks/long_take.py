"""Cost of fusing, synchronising, filtering and measuring: ms per frame, and memory.

Both are told by the length of the take.

    python benchmarks/long_take.py results players-b footwork [--minutes 0.5 2 10] [--json OUT]

A take of a finished study is repeated until it is long; then the study's own scripts run on it,
each in a process of its own, on one core. Reading and writing their files counts, imports do not.
"""

import argparse
import importlib
import json
import multiprocessing
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import yaml

from many_sessions import mib
from repository import ROOT

try:
    import resource
except ImportError:  # Windows does not tell the memory
    resource = None

sys.path += [str(ROOT / "workflow" / "lib"), str(ROOT / "workflow" / "scripts")]

from courtside.evaluation.numbers.players import NETWORK
from courtside.records.keypoints import keypoints, people, skeleton

LINE = "{step:<22}{minutes:>8g} min{n_frames:>8}{ms_per_frame:>9.3f} ms{peak_mib:>8.0f} MiB"


class Paths(SimpleNamespace):
    """Input files by name, as Snakemake gives them."""

    def get(self, name):
        """Return a file, or None where the take has none."""
        return getattr(self, name, None)


def repeated(view, seconds):
    """Return keypoints of a camera over and over, until its clock has shown so many seconds."""
    period_s = view.time_s[-1] + np.median(np.diff(view.time_s))
    times = int(np.ceil(seconds / period_s))
    names = ("xy", "score", "reason", "xyz_in_body", "clothing")
    every = {name: np.concatenate([getattr(view, name)] * times, axis=1) for name in names}
    time_s = (np.arange(times)[:, None] * period_s + view.time_s).ravel()
    stop = int(np.searchsorted(time_s, seconds))
    every = {name: values[:, :stop] for name, values in every.items()}
    return replace(view, time_s=time_s[:stop], **every)


def work(script, arguments, options):
    """Run one script; return its seconds and its greatest memory, MiB."""
    module = importlib.import_module(script)
    started = time.process_time()
    module.main(*arguments, **options)
    seconds = time.process_time() - started
    if resource is None:
        return seconds, float("nan")
    return seconds, mib(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def alone(*job):
    """Run `work` in a fresh process."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(work, job)


def steps(folder, given):
    """Yield (script, arguments, options) of each step of a take whose keypoints lie in a folder."""
    parameters = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))
    shape = ROOT / "config" / "skeletons" / f"{given.skeleton}.yaml"
    table = ROOT / "config" / "derived_joints.yaml"
    pose2d = sorted(folder.glob("*.npz"))
    names = [path.stem for path in pose2d]
    made = {key: folder / "made" / f"{key}.npz" for key in ("people", "raw", "filtered", "last")}
    sync = folder / "made" / "sync.json"
    offsets, errors = (
        ROOT / "config" / name / f"{given.model}.csv" for name in ("joint_offsets", "joint_errors")
    )
    paths = Paths(
        cameras=given.cameras, covariance=given.covariance, pose2d=pose2d, sync=sync,
        skeleton=shape, people=made["people"], offsets=offsets, errors=errors,
    )  # fmt: skip
    yield (
        "synchronise_cameras",
        (given.cameras, pose2d, sync),
        {"synchronised": False, "stated": {}, "trim_s": None} | parameters["synchronise_cameras"],
    )
    who = {"several": False, "calibration": given.cameras.parent.name}
    yield "associate_people", (paths, made["people"]), who
    persons = people.read(made["people"]).person_id.tolist()  # the path jumps at each repetition
    fusion = {"sex_of": dict.fromkeys(persons), "fusion": {"used": names, "rule": "robust"}}
    fusion |= {"recorded": True, **parameters["triangulate"]}
    yield "triangulate", (paths, made["raw"]), fusion
    tables = {key: folder / "made" / f"{key}.csv" for key in ("cutoffs", "frames", "summary")}
    filtering = parameters["filter_motion"]
    yield "filter_motion", (made["raw"], shape, made["filtered"], tables["cutoffs"]), filtering
    paths = Paths(
        raw=made["raw"], filtered=made["filtered"], cameras=given.cameras,
        cutoffs=tables["cutoffs"], skeleton=shape, offsets=offsets,
    )  # fmt: skip
    about = {"max_gap_s": filtering["max_gap_s"], "sex_of": {}}
    yield "correct_joints", (paths, made["last"]), about
    paths = Paths(
        skeletons=made["last"], raw=made["raw"], cutoffs=tables["cutoffs"],
        skeleton=shape, derived=table, cameras=given.cameras, covariance=given.covariance,
    )  # fmt: skip
    about = {"max_gap_s": filtering["max_gap_s"], "sex_of": dict.fromkeys(persons, "m")}
    measured = {"stage": "corrected", "recorded": True, **about}
    yield "measure_kinematics", (paths, tables["frames"], tables["summary"]), measured


def measure(given, views, minutes):
    """Return one row per step of a take of so many minutes."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "made").mkdir()
        for view in views:
            keypoints.write_2d(folder / f"{view.camera}.npz", repeated(view, 60 * minutes))
        n_frames = min(len(keypoints.read_2d(path).time_s) for path in folder.glob("*.npz"))
        for script, arguments, options in steps(folder, given):
            seconds, mib = alone(script, arguments, options)
            about = {"step": script, "minutes": minutes, "n_frames": n_frames}
            rows.append(about | {"ms_per_frame": 1e3 * seconds / n_frames, "peak_mib": mib})
            print(LINE.format(**rows[-1]))
    total = sum(row["ms_per_frame"] for row in rows)
    print(f"together, {minutes:g} min: {total:.2f} ms per frame of {len(views)} cameras\n")
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("session")
    parser.add_argument("take")
    parser.add_argument("--minutes", type=float, nargs="+", default=[0.5, 2.0, 10.0])
    parser.add_argument("--calibration", default="sfm-n40-lines")
    parser.add_argument("--model", default=NETWORK)
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args()
    folder = asked.results / asked.session
    paths = (folder / "takes" / asked.take / "pose2d" / asked.model).glob("*.npz")
    views = [keypoints.read_2d(path) for path in sorted(paths)]
    if not views:
        parser.error(
            f"expected keypoints of {asked.session}/{asked.take}, found none; run the study first"
        )
    calibration = folder / "calibration" / asked.calibration
    covariance = calibration / "covariance.npz"
    given = SimpleNamespace(
        cameras=calibration / "cameras.toml",
        covariance=covariance if covariance.is_file() else None,
        model=asked.model,
        skeleton=skeleton_of(views[0]),
    )
    rows = [row for minutes in asked.minutes for row in measure(given, views, minutes)]
    if asked.json:
        asked.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")


def skeleton_of(view):
    """Return the name of the skeleton that a network's keypoints have."""
    for path in sorted((ROOT / "config" / "skeletons").glob("*.yaml")):
        if tuple(skeleton.read(path).joints) == tuple(view.joints):
            return path.stem
    raise SystemExit(f"{view.camera}: expected the joints of a skeleton in config, found others")


if __name__ == "__main__":
    main()
