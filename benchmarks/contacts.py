"""Contacts of the feet against the truth of virtual players: docs/numbers/contacts.csv.

    python benchmarks/contacts.py results

Reads the corrected skeletons (the last stage) of the takes named below (the first calibration and
network of each session, all cameras), finds contacts as `find_contacts` does, and compares them
with the true feet. A step is counted right where true and found landings of a foot in a take are
equally many.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import pandas as pd

import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.evaluation.movement import contacts
from courtside.footwork import feet
from courtside.kinematics import cutoffs
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.truth import take_truth
from courtside.statistics.normal_errors import WITHIN_90

TAKES = {
    "`players-b`, drill to six corners, 24 s": ("players-b/footwork",),
    "`players-a` and `players-b`, single strokes and a rally": (
        *("players-a/shot", "players-b/shot", "players-b/rally"),
    ),
    "`players-b`, walking (two persons), T-poses and claps": (
        *("players-b/crossing", "players-b/claps"),
    ),
}
ALL = "all of them"


def errors_of_times(known, steps, truth, what):
    """Return errors and stated standard deviations (N, 2) s of all paired onsets, or ends."""
    found = [np.zeros((0, 2))]
    for person in set(known.person_id.tolist()) & set(truth.person_id.tolist()):
        for foot in known.foot.tolist():
            own = steps[(steps.person == person) & (steps.foot == foot)]
            _, true_s = contacts.true_contact(truth, person, foot)
            found.append(contacts.paired(known.time_s, own, true_s[what], what)[0])
    return np.concatenate(found)


def of_take(results, name):
    """Return the errors of each foot of a take."""
    session, take = name.split("/")
    folder = results / session / "takes" / take
    path = min((folder / "pose3d_corrected").glob("*/all-robust/blazepose-*.npz"))
    way = "/".join(path.parts[-3:]).removesuffix(".npz")
    points = keypoints.read_3d(path)
    chosen, _ = cutoffs.read(folder / "kinematics" / f"{way}.cutoffs.csv")
    per_joint = skeleton.read(ROOT / "config/skeletons/blazepose33.yaml").by_group(chosen)
    truth = take_truth.read(results / "virtual" / session / "takes" / take / "truth.npz")
    known, steps, _ = feet.find(points, per_joint)
    errors = contacts.table(points, known, steps, truth)
    pairs = [errors_of_times(known, steps, truth, what) for what in contacts.BOUNDARIES]
    return errors.assign(take=name), pairs


def numbers(row, rows, pairs, command):
    """Return the numbers of one row of the table."""
    frames = rows.n_frames
    printed = {"frames": f"{np.average(rows.right_percent, weights=frames):.1f} %"}
    for at, what in enumerate(contacts.BOUNDARIES):
        error, sigma = np.concatenate([each[at] for each in pairs]).T
        median, p90 = 1000 * np.quantile(abs(error), [0.5, 0.9])
        printed[what] = f"{median:.0f} / {p90:.0f} ms"
        held = 100 * np.mean(abs(error) <= WITHIN_90 * sigma)
        printed[f"{what}_held"] = f"{held:.0f} % (n = {len(error)})"
    found, true = rows.n_found_onset.sum(), rows.n_true_onset.sum()
    exact = (rows.n_found_onset == rows.n_true_onset).sum()
    printed["steps"] = f"{found} of {true}; {exact} of {len(rows)} feet exact"
    printed["moved"] = f"{rows.moved_rms_mm.median():.0f} mm"
    sessions = ", ".join(sorted({name.split("/")[0] for name in rows["take"]}))
    return [
        ("contacts", row, part, words, "", sessions, len(rows), 0, "benchmark", command)
        for part, words in printed.items()
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    results, command = parser.parse_args().results, "`python benchmarks/contacts.py results`"
    kept, written = [], []
    for row, names in TAKES.items():
        parts = [of_take(results, name) for name in names]
        kept += parts
        rows = pd.concat([errors for errors, _ in parts])
        written += numbers(row, rows, [pairs for _, pairs in parts], command)
    rows = pd.concat([errors for errors, _ in kept])
    written += numbers(ALL, rows, [pairs for _, pairs in kept], command)
    stated.write(ROOT / "docs" / "numbers" / "contacts.csv", written)
    print(pd.DataFrame(written)[[1, 2, 3]].to_string())


if __name__ == "__main__":
    main()
