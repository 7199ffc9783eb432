"""Errors of the joint angles of devices, before and after the fit of the skeletal model.

    python benchmarks/device_angles.py RESULTS [--sessions NAME ...] [--sigma]

RESULTS are those of a default run, or takes of these sessions with `devices/` and `sync/`. The
script of the rule fit_source fits the model to each source of each virtual take; the comparison is
that of evaluate_source_angles. Suits are also fitted together with the joints of the depth camera,
without their own correction, to test if this fit could replace the correction. For the default
sessions it writes docs/numbers/device_angles.csv, which docs/make_tables.py reads.

`--sigma` prints the errors of joints per axis, after a rotation about the vertical and a shift of
each frame. Those of session single-dev are the values of `fit_source.sigma_m`.
"""

import argparse
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import scipy

import stated
from repository import ROOT

sys.path[:0] = [str(ROOT / "workflow" / "lib"), str(ROOT / "workflow" / "scripts")]

import fit_source

from courtside.body_model import source, take
from courtside.evaluation import joints, kinematics
from courtside.evaluation.numbers import views
from courtside.evaluation.numbers.players import NETWORK as MODEL
from courtside.exports import device
from courtside.geometry import interpolation, rotations, similarity
from courtside.inertial import heading
from courtside.records.devices import clocks, device_motion
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.truth import take_truth
from courtside.study.configuration import yaml_files
from courtside.study.configuration.sessions import SKELETONS

SESSIONS, DEVELOPMENT = ("single-view",), "single-dev"
LIMBS = list(skeleton.JOINTS)
ANGLES = list(views.ANGLES.values())
STAGES = ("source", "model")
UP, SUIT_UP = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
SLOW_S = 0.5  # standard deviation of the filter of the shift between suit and depth camera
COMMAND = "`python benchmarks/device_angles.py results`"


def parameters():
    """Return the parameters of the study."""
    return yaml_files.read(ROOT / "config" / "config.yaml")


def read(results, session, name):
    """Return the truth and the person of a take, and the file, motion and clock of each source."""
    base = results / session / "takes" / name
    truth = take_truth.read(results / "virtual" / session / "takes" / name / "truth.npz")
    _, known = clocks.read(base / "sync" / f"devices.{MODEL}.json")
    found = {}
    for path in sorted((base / "devices").glob("*.npz")):
        motion = device_motion.read(path)
        clock = known[motion.source.removesuffix("-corrected")]
        found[motion.source] = (path, motion, clock)
    return truth, str(truth.person_id[0]), found


def heights(session):
    """Return {person: height in metres} of a session."""
    known = yaml_files.read(ROOT / "config" / "sessions" / f"{session}.yaml")["subjects"]
    return {name: one.get("height_m") for name, one in known.items()}


def kind(motion):
    """Return the key of `fit_source.sigma_m` for a source."""
    if motion.source.endswith("-corrected"):
        return "corrected"
    return {"rgbd": "depth"}.get(motion.kind, motion.kind)


def fitted(path, motion, subject, folder):
    """Fit the model with the rule's script; return both stages and the processor time, s.

    `subject` has the person's name and height.
    """
    known = parameters()
    sigma_m = known["fit_source"]["sigma_m"][kind(motion)]
    files = [folder / part for part in ("joints.npz", "motion.npz", "angles.csv")]
    before = time.process_time()
    fit_source.main(
        path,
        ROOT / "config" / "skeletons" / f"{SKELETONS.get(motion.kind, 'blazepose33')}.yaml",
        *files,
        person=subject[0],
        height_m=subject[1],
        sigma_m=sigma_m,
        max_gap_s=known["filter_motion"]["max_gap_s"],
        cutoff_hz=known["filter_motion"]["cutoff_hz"],
    )
    seconds = time.process_time() - before
    raw = source.observed(device.points(motion, subject[0]), sigma_m)
    return {"source": raw, "model": keypoints.read_3d(files[0])}, seconds


def together(depth, suit, person):
    """Return the model's joints fitted to the joints of a depth camera and a suit together.

    `depth` and `suit` have motion and clock. The suit's drift of heading is removed, and it is
    shifted slowly to the joints of the depth camera.
    """
    (seen, own), (worn, other) = depth, suit
    at_s = own.to_reference(seen.time_s)
    moved = worn.performed
    suit_s = other.to_reference(worn.time_s[moved])
    columns = [list(worn.joints).index(name) for name in LIMBS]
    xyz = interpolation.linear(suit_s, worn.xyz[moved][:, columns], at_s)
    vision = seen.xyz[:, [list(seen.joints).index(name) for name in LIMBS]]
    alike = heading.estimate(at_s, xyz, vision, SUIT_UP, window_s=1.5)
    turns = rotations.rotation_from_rodrigues(alike.heading_at(at_s)[:, None] * SUIT_UP)
    xyz = np.einsum("tij,tkj->tki", turns, xyz) @ alike.vision_from_device.T
    away = pd.DataFrame(np.nanmedian(vision - xyz, axis=1)).interpolate(limit_direction="both")
    slow = SLOW_S / np.median(np.diff(at_s))
    xyz = xyz + scipy.ndimage.gaussian_filter1d(away.to_numpy(), slow, axis=0)[:, None]
    sigmas = parameters()["fit_source"]["sigma_m"]
    worn = replace(seen, joints=np.array(LIMBS), xyz=xyz, reason=seen.reason[:, :12] * 0)
    one, two = (
        source.observed(device.points(motion, person), sigmas[name])
        for motion, name in ((seen, "depth"), (worn, "inertial"))
    )
    per_joint = ("xyz", "covariance_2d", "covariance_camera", "covariance_network", "offset")
    per_joint += ("outlier", "n_views", "reproj_error_px", "accepted", "swapped", "reason")
    joined = {
        key: np.concatenate([getattr(p, key) for p in (one, two)], axis=2) for key in per_joint
    }
    both = replace(one, joints=np.concatenate([one.joints, two.joints]), **joined)
    groups = parameters()["filter_motion"]["cutoff_hz"]
    shape = skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml")
    hz = dict(zip(shape.joints, shape.by_group(groups), strict=True))
    return take.joints(both, take.people(both, hz, {}))


def apart(points, clock, truth, turn_any=True):
    """Return the errors of limb joints (T, 12, 3) mm after a rotation and a shift of each frame.

    The rotation is free with `turn_any`, otherwise about the vertical.
    """
    names = points.joints.tolist()
    true = joints.at_times(truth.time_s, truth.xyz, clock.to_reference(points.time_s))[0]
    true = true[:, [truth.joints.tolist().index(name) for name in LIMBS]]
    own = points.xyz[0][:, [len(names) - 1 - names[::-1].index(name) for name in LIMBS]]
    known = (np.isfinite(own) & np.isfinite(true)).all(axis=2)[..., None]
    own, true = (np.where(known, one, np.nan) for one in (own, true))
    own, true = (one - np.nanmean(one, axis=1, keepdims=True) for one in (own, true))
    products = np.einsum("tji,tjk->tik", np.nan_to_num(true), np.nan_to_num(own))
    if turn_any:
        turned, _ = similarity.kabsch(products)
    else:
        sine = products[:, 1, 0] - products[:, 0, 1]
        angle = np.arctan2(sine, products[:, 0, 0] + products[:, 1, 1])
        turned = rotations.rotation_from_rodrigues(angle[:, None] * UP)
    return 1000 * (np.einsum("tij,tkj->tki", turned, own) - true)


def numbers(points, clock, truth, person):
    """Return the errors of joint angles and joints of one source and stage."""
    angles = kinematics.angles_of(points, truth, person, clock).set_index("angle")
    found = {}
    for angle in ANGLES:
        found[f"{angle}_deg"] = angles.loc[angle, "rmse_deg"]
        found[f"{angle}_within"] = angles.loc[angle, "within_90_percent"]
    off = np.linalg.norm(apart(points, clock, truth), axis=2)
    return found | {"median_mm": np.nanmedian(off), "p95_mm": np.nanpercentile(off, 95)}


def compare(results, sessions, folder):
    """Return a table of the errors of every take, source and stage."""
    found = []
    for session in sessions:
        for path in sorted((results / session / "takes").glob("*/sync/devices.*.json")):
            name = path.parts[-3]
            truth, person, sources = read(results, session, name)
            label = {"session": session, "take": name}
            for one, (file, motion, clock) in sources.items():
                subject = person, heights(session)[person]
                stages, seconds = fitted(file, motion, subject, folder)
                for stage, points in stages.items():
                    row = numbers(points, clock, truth, person)
                    more = {"n": len(points.time_s), "seconds": seconds}
                    found.append({**label, "source": one, "stage": stage, **more, **row})
                print(session, name, one, f"{seconds:.1f} s", flush=True)
            depth = next((s[1:] for n, s in sources.items() if n.endswith("-depth")), None)
            for one in (n for n in sources if f"{n}-corrected" in sources and depth):
                points = together(depth, sources[one][1:], person)
                row = numbers(points, depth[1], truth, person)
                more = {"source": f"{one} and depth", "stage": "model", "n": len(points.time_s)}
                found.append({**label, **more, **row})
    return pd.DataFrame(found)


def sigmas(results, session=DEVELOPMENT):
    """Return the root mean square errors of limb joints per axis, mm, by kind of source."""
    every = {}
    for path in sorted((results / session / "takes").glob("*/sync/devices.*.json")):
        truth, person, sources = read(results, session, path.parts[-3])
        for _, motion, clock in sources.values():
            error = apart(device.points(motion, person), clock, truth, turn_any=False)
            every.setdefault(kind(motion), []).append(error)
    columns = {part: [n.endswith(f"_{part}") for n in LIMBS] for part in skeleton.LIMBS}
    return pd.DataFrame(
        {
            name: {
                part: np.sqrt(np.nanmean(np.concatenate(parts)[:, at] ** 2))
                for part, at in columns.items()
            }
            for name, parts in every.items()
        }
    ).T


SOLVERS = {  # source and stage of each row, for a suit named {}
    "as it is": ("{}", "source"),
    "its own correction": ("{}-corrected", "source"),
    "its own correction, then the model": ("{}-corrected", "model"),
    "the model fitted to suit and depth camera at once": ("{} and depth", "model"),
}


def rows(table):
    """Yield the rows of docs/numbers: of reported sessions, then of suits by solver."""
    for (session, name), part in table.groupby(["session", "source"], sort=False):
        label, stages = f"`{session}`: `{name}`", dict(list(part.groupby("stage")))
        if session in SESSIONS and len(stages) == 2:
            for stage, one in stages.items():
                yield from _measured("device-angles", label, one, f"_{stage}")
    known = table.set_index(["session", "source", "stage"]).sort_index()
    for session, name in table.groupby(["session", "source"], sort=False).groups:
        if f"{name} and depth" in table["source"].to_numpy():
            for words, (pattern, stage) in SOLVERS.items():
                one = known.loc[[(session, pattern.format(name), stage)]].reset_index()
                yield from _measured("device-solvers", f"`{session}`, `{name}`: {words}", one, "")


def _measured(name, label, part, suffix):
    """Yield the numbers of one row, the median over takes."""
    measures = {f"{angle}_deg": "degrees" for angle in ANGLES}
    measures |= {f"{angle}_within": "%" for angle in ANGLES} | {"median_mm": "mm", "p95_mm": "mm"}
    for measure, unit in measures.items():
        digits = 1 if unit == "degrees" else 0
        about = (unit, part["session"].iloc[0], len(part), 0, "benchmark", COMMAND)
        yield [name, label, f"{measure}{suffix}", f"{part[measure].median():.{digits}f}", *about]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--sessions", nargs="+", default=(*SESSIONS, DEVELOPMENT))
    parser.add_argument("--sigma", action="store_true")
    given = parser.parse_args()
    pd.set_option("display.width", 250, "display.max_columns", 30)
    if given.sigma:
        print(sigmas(given.results, DEVELOPMENT).round(0).to_string())
        return
    with tempfile.TemporaryDirectory() as temporary:
        table = compare(given.results, given.sessions, Path(temporary))
    print(table.round(1).to_string(index=False))
    if tuple(given.sessions) == (*SESSIONS, DEVELOPMENT):
        stated.write(ROOT / stated.FOLDER / "device_angles.csv", rows(table))


if __name__ == "__main__":
    main()
