"""The skeletal model beside OpenSim's inverse kinematics, of virtual players with truth.

    python benchmarks/opensim_ik.py RESULTS [--sessions NAME ...] [--environments DIR]

RESULTS are of a finished default run. Each take is fitted by the rule's script and written as
`.osim`, `.mot` and `.trc`. OpenSim plays the motion on the model, and fits the same model with its
own tool to the corrected (filtered) joints, frame by frame, all markers alike. Pose2Sim's fits its
own model, of which the time alone is taken. Truth judges joints and angles as in body_model.py. It
writes docs/numbers/opensim.csv.
"""

import argparse
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

import body_model
import peers
import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.exports import markers, opensim, opensim_model, trc
from courtside.records.keypoints import keypoints, skeletal_motion
from courtside.records.truth import take_truth

SESSIONS = ("players-a", "players-b")
COMMAND = "`python benchmarks/opensim_ik.py results`"
STAGES = ("model", "opensim")


def run(python, script, *given):
    """Run one method; return what it said."""
    timed = peers.run_method(python, script, *given)
    if "failed" in timed:
        raise SystemExit(f"{script}: {timed['failed']}")
    return timed


def located(folder, points):
    """Return the markers (1, T, J, 3), world metres, of OpenSim's tool where a record has them."""
    file = next(Path(folder).glob("*model_marker_locations.sto"))
    names, *rows = file.read_text().split("endheader\n")[1].splitlines()
    table = np.array([row.split() for row in rows], dtype=float)
    column = {name: at for at, name in enumerate(names.split())}
    xyz = np.full(points.xyz.shape, np.nan)
    frames = [int(np.argmin(np.abs(points.time_s - row[0]))) for row in table]
    for at, joint in enumerate(points.joints.tolist()):
        own = table[:, [column[f"{joint}_t{axis}"] for axis in "xyz"]][:, trc.TRC_AXES]
        xyz[0, frames, at] = own
    return np.where(np.isfinite(points.xyz), xyz, np.nan)


def one(results, session, way, folder, python):
    """Return the rows of one take: this project's fit and OpenSim's; none of several persons."""
    file = f"{way[1]}/{body_model.FUSION}/{body_model.NETWORK}.npz"
    known = keypoints.read_3d(results / session / "takes" / way[0] / "pose3d_corrected" / file)
    if len(known.person_id) > 1:
        return []
    points, seconds = body_model.fitted(results, session, way, folder)
    motion = skeletal_motion.read(folder / "motion.npz")
    opensim_model.write(folder / "a.osim", motion, 0)
    opensim.write_motion(folder / "a.mot", motion, 0)
    trc.write(folder / "a.trc", points["model"], 0)
    seen_s = motion.posed(0)[0].time_s  # its tool fails on frames without markers
    corrected = points["corrected"].between(seen_s[0], seen_s[-1])
    trc.write(folder / "corrected.trc", corrected, 0)
    files = [folder / name for name in ("a.osim", "corrected.trc", "a.trc", "a.mot")]
    timed = run(python, "ik_opensim.py", *files, folder)
    other = replace(corrected, joints=np.array(markers.names(corrected.joints.tolist())))
    trc.write(folder / "named.trc", other, 0)
    theirs = run(python, "ik_pose2sim.py", folder / "named.trc", folder)
    truth = take_truth.read(results / "virtual" / session / "takes" / way[0] / "truth.npz")
    per_frame = 1000 / len(corrected.time_s)
    more = {
        "model": {"time a frame, ms": 1000 * seconds, "played, mm": timed["markers_mm"]},
        "opensim": {
            "time a frame, ms": per_frame * timed["seconds"],
            "of Pose2Sim's model": per_frame * theirs["seconds"],
        },
    }
    both = {"model": points["model"], "opensim": replace(corrected, xyz=located(folder, corrected))}
    return [
        {
            "take": f"{session}/{way[0]}",
            "stage": stage,
            **body_model.errors(both[stage], truth, folder),
        }
        | more[stage]
        for stage in STAGES
    ]


MEASURES = (
    "joints, median, mm", "joints, 95 %, mm", "time a frame, ms",
    *(f"{angle.replace('_', ' ')}, RMSE, degrees" for angle in body_model.ANGLES),
)  # fmt: skip


def rows(table, sessions):
    """Yield the rows of docs/numbers: medians over takes, and the worst take."""
    n = len(table) // len(STAGES)

    def row(label, part, value, digits=1):
        about = (label.rsplit(", ", 1)[-1], ", ".join(sessions), n, 0, "benchmark", COMMAND)
        return ["opensim", label, part, f"{value:.{digits}f}", *about]

    for stage, measure in ((stage, measure) for measure in MEASURES for stage in STAGES):
        of = table.loc[table["stage"] == stage, measure]
        yield row(measure, f"{stage}_median", of.median())
        yield row(measure, f"{stage}_worst", of.max())
    label = "time a frame, Pose2Sim's model, ms"
    yield row(label, "opensim_median", table["of Pose2Sim's model"].median())
    yield row(label, "opensim_worst", table["of Pose2Sim's model"].max())
    label = "markers, motion file played by OpenSim, mm"
    yield row(label, "model_median", table["played, mm"].median(), 4)
    yield row(label, "model_worst", table["played, mm"].max(), 4)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--sessions", nargs="+", default=SESSIONS)
    parser.add_argument("--environments", type=Path, default=peers.FOLDER)
    given = parser.parse_args()
    try:
        python = peers.interpreter("opensim", given.environments)
    except (subprocess.CalledProcessError, OSError) as error:
        print(f"opensim: not installable here, nothing compared: {error}")
        return
    found = []
    for session in given.sessions:
        for way in body_model.takes(given.results, session):
            with tempfile.TemporaryDirectory() as temporary:
                found += one(given.results, session, way, Path(temporary), python)
            print(session, *way, flush=True)
    table = pd.DataFrame(found)
    print(table.round(3).to_string(index=False))
    if tuple(given.sessions) == SESSIONS:
        path = ROOT / stated.FOLDER / "opensim.csv"
        stated.write(path, rows(table, given.sessions))


if __name__ == "__main__":
    peers.on_one_thread()
    main()
