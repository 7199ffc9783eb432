"""The skeletal model against truth: virtual players, and a real hall's marker system.

    python benchmarks/body_model.py RESULTS [--hall RESULTS DATA] [--sessions NAME ...]

RESULTS are of a finished default run. Each take of its virtual players is fitted again by the
script of the rule fit_skeleton, and compared with the truth beside the corrected joints, as
evaluate_take and evaluate_angles do. `--hall` takes the results of hall_markers.py and its DATA:
knee and elbow flexion against those of the marker system's joints, whose shoulders are joints of
the clavicle. It writes docs/numbers/body_model.csv, a source of docs/make_tables.py.
"""

import argparse
import sys
import tempfile
import time
from dataclasses import replace
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

import marker_system
import stated
from repository import ROOT

sys.path[:0] = [str(ROOT / "workflow" / "lib"), str(ROOT / "workflow" / "scripts")]

import find_contacts
import fit_skeleton

from courtside.body_model import take
from courtside.evaluation import joints, kinematics
from courtside.evaluation.movement import contacts
from courtside.evaluation.numbers.players import NETWORK
from courtside.footwork import feet
from courtside.kinematics import joint_angles, shared_errors
from courtside.records import footwork, npz
from courtside.records.keypoints import keypoints
from courtside.records.truth import take_truth
from courtside.statistics import moving_blocks
from courtside.study.configuration import yaml_files

SESSIONS = ("players-a", "players-b", "players-shaken", "repeats")
LONG = 1000  # frames
LONGEST = ("players-b", ("footwork", "sfm-n40-lines"))
FUSION = "all-robust"
STAGES = ("corrected", "model")
ANGLES = ("knee_flexion", "hip_flexion", "elbow_flexion", "shoulder_elevation", "trunk_lean")
HALL = ("RHip", "RKnee", "RAnkle", "RShoulder", "RElbow", "RHand")
CONTACTS = (footwork.read_contacts, "contacts.npz"), (footwork.read_steps, "steps.csv")
BLOCK_S = 0.5
COMMAND = "`python benchmarks/body_model.py results`"
HALL_COMMAND = "`python benchmarks/body_model.py results --hall RESULTS DATA`"


def fitted(results, session, way, folder):
    """Fit one take by the rule's script; return its stages, and processor seconds per frame."""
    name, calibration = way
    file = f"{calibration}/{FUSION}/{NETWORK}"
    base, config = results / session / "takes" / name, ROOT / "config"
    paths = SimpleNamespace(
        raw=base / f"pose3d/{file}.npz",
        cameras=results / session / "calibration" / calibration / "cameras.toml",
        corrected=base / f"pose3d_corrected/{file}.npz",
        cutoffs=base / f"kinematics/{file}.cutoffs.csv",
        skeleton=config / "skeletons/blazepose33.yaml",
        offsets=config / f"joint_offsets/{NETWORK}.csv",
    )
    session_yaml = config / "sessions" / f"{session}.yaml"
    known = yaml_files.read(session_yaml).get("subjects", {}) if session_yaml.is_file() else {}
    paths.contacts, paths.skeletons, paths.court = folder / "contacts.npz", paths.corrected, None
    tables = [folder / f"{part}.csv" for part in ("steps", "events", "summary")]
    find_contacts.main(paths, paths.contacts, *tables)
    before = time.process_time()
    fit_skeleton.main(
        paths,
        *(folder / name for name in ("ik.npz", "motion.npz", "angles.csv")),
        max_gap_s=yaml_files.read(config / "config.yaml")["filter_motion"]["max_gap_s"],
        sex_of={name: one.get("sex") for name, one in known.items()},
        height_m_of={name: one.get("height_m") for name, one in known.items()},
        recorded=False,
    )
    seconds = time.process_time() - before
    both = dict(zip(STAGES, (paths.corrected, folder / "ik.npz"), strict=True))
    points = {stage: keypoints.read_3d(path) for stage, path in both.items()}
    return points, seconds / points["model"].xyz[..., 0, 0].size


def long_ms(results, session, way):
    """Return the number of frames, and processor milliseconds per frame of the fit of one person.

    The take's corrected joints follow one another until there are over `LONG` frames.
    """
    file = f"{way[1]}/{FUSION}/{NETWORK}"
    points = keypoints.read_3d(results / f"{session}/takes/{way[0]}/pose3d_corrected/{file}.npz")
    n_frames = len(points.time_s) * (LONG // len(points.time_s) + 1)
    spec = npz.spec_of(type(points))
    more = {
        key: np.concatenate([getattr(points, key)] * (n_frames // len(points.time_s)), axis=1)
        for key, (_, shape) in spec.items()
        if shape[:2] == ("P", "T")
    }
    points = replace(points, time_s=np.arange(n_frames) / points.rate_hz, **more)
    hz = dict.fromkeys(points.joints.tolist(), 8.0)
    known, _, _ = feet.find(points, list(hz.values()))
    before = time.process_time()
    take.person(points, 0, hz, contacts=known)
    return n_frames, 1000 * (time.process_time() - before) / n_frames


def takes(results, session):
    """Yield (take, calibration) of a session with corrected joints."""
    for path in sorted((results / session / "takes").glob(f"*/pose3d_corrected/*/{FUSION}")):
        yield path.parts[-4], path.parts[-2]


def errors(points, truth, folder):
    """Return the numbers of one take and stage; the folder holds its contacts."""
    known, steps = (read(folder / file) for read, file in CONTACTS)
    stood = contacts.table(points, known, steps, truth)["moved_rms_mm"].median()
    points = points.between(truth.time_s[0], truth.time_s[-1])
    apart = joints.errors(points, truth.joints, joints.true_places(points, truth))
    rows = joints.table(points.person_id, *apart).set_index("joint").loc[["limbs"]].iloc[-1]
    found = {"joints, median, mm": rows["median_mm"], "joints, 95 %, mm": rows["p95_mm"]}
    found["joints, in 90 % ellipsoids, %"] = rows["coverage_90_percent"]
    found["a standing foot moves, mm"] = stood
    angles = kinematics.angles(points, truth).set_index("angle")
    for angle in ANGLES:
        of, words = angles.loc[[angle]], angle.replace("_", " ")
        found[f"{words}, RMSE, degrees"] = np.sqrt(np.mean(of["rmse_deg"] ** 2))
        found[f"{words}, in 90 % intervals, %"] = of["within_90_percent"].mean()
    return found


def players(results, sessions, folder):
    """Return a table of the numbers of every take and stage."""
    found = []
    for session in sessions:
        for way in takes(results, session):
            points, seconds = fitted(results, session, way, folder)
            truth = take_truth.read(results / "virtual" / session / "takes" / way[0] / "truth.npz")
            for stage, one in points.items():
                row = errors(one, truth, folder) | {"time a frame and person, ms": 1000 * seconds}
                found.append({"session": session, "take": way[0], "stage": stage, **row})
            print(session, way[0], f"{len(one.time_s)} frames", flush=True)
    return pd.DataFrame(found)


def hall(results, data, folder):
    """Return a table of errors of angles (RMSE and interval, degrees) with each calibration."""
    table, found = pd.read_csv(data / "mocap.csv"), []
    true_s, names = table["time_s"].to_numpy(), list(marker_system.JOINTS)
    true = {
        name: table[[f"{name}_{axis}_m" for axis in "xyz"]].to_numpy()
        for right in HALL
        for name in (right, f"L{right[1:]}")
    }
    both = np.stack([true[name] for name in marker_system.JOINTS.values()], axis=1)
    for calibration in ("file", "known"):
        way = ("play", calibration)
        points, _ = fitted(results, "hall-markers", way, folder)
        for stage, one in points.items():
            at = [one.joints.tolist().index(name) for name in names]
            fit = marker_system.fit(one.time_s, one.xyz[0][:, at], true_s, both)
            measured = joint_angles.measure(
                one.xyz[0],
                shared_errors.independent(one.covariance_2d[0]),
                one.joints.tolist(),
            )
            for angle, three in (("knee_flexion", HALL[:3]), ("elbow_flexion", HALL[3:])):
                error = [
                    measured[f"{side}_{angle}"].degrees
                    - flexion(
                        [true[side[0].upper() + name[1:]] for name in three], true_s, fit, one
                    )
                    for side in ("left", "right")
                ]
                found.append((calibration, stage, angle, *interval(np.array(error), one.rate_hz)))
    return pd.DataFrame(
        found, columns=["calibration", "stage", "angle", "n", "rmse", "least", "most"]
    )


def flexion(three, true_s, fit, points):
    """Return the marker system's flexion (T,) degrees at the times of a record."""
    xyz = np.stack(three)
    first, middle, last = joints.at_times(true_s, xyz, points.time_s + fit.shift_s)
    none = shared_errors.independent(np.zeros((len(first), 3, 3, 3)))
    return (
        180
        - joint_angles.between(
            first, middle, last, lambda slopes: none.variance([0, 1, 2], slopes)
        ).degrees
    )


def interval(error, rate_hz):
    """Return n, RMSE and its 95 % interval of errors (2, T) by blocks of frames drawn again."""
    known = np.isfinite(error)
    counts = moving_blocks.counts([error.shape[1]], [round(BLOCK_S * rate_hz)])
    again = np.sqrt((np.nan_to_num(error) ** 2 @ counts.T).sum(axis=0) / (known @ counts.T).sum(0))
    ends = np.percentile(again, [2.5, 97.5])
    return int(known.sum()), float(np.sqrt(np.nanmean(error**2))), *ends.tolist()


GROUPS = {"players-a, players-b": ["players-a", "players-b"], "all sessions": SESSIONS}


def rows(table, marked, long):
    """Yield the rows of docs/numbers: medians over takes, and 95 % of them or the least share."""
    measures = [name for name in table if name not in ("session", "take", "stage")]
    for (group, sessions), key in product(GROUPS.items(), measures):
        own = table[table["session"].isin(sessions)]
        unit = key.rsplit(", ", 1)[1]
        stages = STAGES if unit != "ms" else STAGES[1:]
        for stage in stages:
            of = own[own["stage"] == stage]
            end = of[key].min() if unit == "%" else of[key].quantile(0.95)
            about = (unit, ", ".join(sessions), len(of), 0, "benchmark", COMMAND)
            for part, value in (("median", of[key].median()), ("worst", end)):
                yield ["body-model", f"{key}; {group}", f"{stage}_{part}", f"{value:.1f}", *about]
    row, about = f"time a frame, {long[0]} frames, ms", ("ms", LONGEST[0])
    counts = (long[0], 0, "benchmark", COMMAND)
    yield ["body-model", row, "model_median", f"{long[1]:.1f}", *about, *counts]
    for one in marked.itertuples():
        label = f"{one.angle.replace('_', ' ')}; cameras: {one.calibration}"
        about = ("degrees", "hall-markers", one.n, 0, "benchmark", HALL_COMMAND)
        for part, value in (("rmse", one.rmse), ("least", one.least), ("most", one.most)):
            yield ["body-model-hall", label, f"{one.stage}_{part}", f"{value:.1f}", *about]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--hall", type=Path, nargs=2, metavar=("RESULTS", "DATA"))
    parser.add_argument("--sessions", nargs="+", default=SESSIONS)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        table = players(given.results, given.sessions, Path(temporary))
        marked = hall(*given.hall, Path(temporary)) if given.hall else None
    pd.set_option("display.width", 200)
    print(table.round(1).to_string(index=False))
    long = long_ms(given.results, *LONGEST)
    print(f"{long[0]} frames: {long[1]:.2f} ms a frame")
    if marked is not None:
        print(marked.round(1).to_string(index=False))
    if tuple(given.sessions) == SESSIONS and marked is not None:
        stated.write(ROOT / stated.FOLDER / "body_model.csv", rows(table, marked, long))


if __name__ == "__main__":
    main()
