"""Stated errors of joints of bodies left out of their fit: docs/numbers/joint_errors.csv.

    python benchmarks/joint_errors.py results

RESULTS hold the development sessions as `evaluate_joint_errors` reads them (CONTRIBUTING.md, "A
network"). Each body is left out in turn: the mixture of good places and outliers is fitted on the
other bodies, and judged on filtered joints of this one by two, three and four true cameras. The
offsets are those of config/, fitted on all bodies. Shares of the errors inside the 50 % and the
90 % ellipsoids, and of errors above 100 mm inside the 90 % ellipsoids, by how a normal distribution
is stated for the mixture.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import joint_offsets
import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.evaluation import error_fit, joints
from courtside.evaluation.numbers.players import NETWORK
from courtside.reconstruction import joint_correction, joint_errors
from courtside.statistics.normal_errors import ellipsoid, mahalanobis
from courtside.study.configuration import yaml_files

VIEWS = {2: "two", 3: "three", 4: "four"}
SHARES = (0.9, 0.95, joint_errors.SHARE_HELD, 0.99)
COMMAND = "`python benchmarks/joint_errors.py results`"


def takes_of(results):
    """Return [(body, views, what `joint_errors.fit` needs)], for each set of cameras of a take."""
    content, found = yaml_files.read(ROOT / "config" / "config.yaml"), []
    steps = content["triangulate"], content["filter_motion"]
    table = joint_correction.read(ROOT / "config" / "joint_offsets" / f"{NETWORK}.csv")
    takes = [take for of in joint_offsets.takes_of(results).values() for take in of]
    for seen, sex_of, truth in error_fit.footage_with_truth(takes):
        (body,) = sex_of
        given = seen, joint_offsets.SHAPE, sex_of, table, truth, *steps
        sets = zip(error_fit.sets_of_cameras(seen), error_fit.joints_of_sets(*given), strict=True)
        found += [(body, len(used), joints) for used, joints in sets]
    return found


def variances(model, columns):
    """Return the stated variance (N,) m2 by each way to state one for the mixture."""
    good, share = model.of(columns)
    found = {"variance of the mixture": (1 - share) * good + share * model.sigma_m**2}
    for held in SHARES:
        name = f"holds {100 * held:g} % of the mixture"
        name += " (used)" if held == joint_errors.SHARE_HELD else ""
        found[name] = joint_errors.stated_variance(good, share, model.sigma_m**2, held)
    return found


def held_of(takes):
    """Return {(way, views): errors (N,) m, and their squared distances in sigmas} of all bodies."""
    found = {}
    for body in sorted({body for body, _, _ in takes}):
        others = [given for other, _, given in takes if other != body]
        model = joint_errors.fit(*map(np.concatenate, zip(*others, strict=True)))
        for own, views, (columns, error, covariance, _) in takes:
            for way, variance in variances(model, columns).items() if own == body else ():
                total = covariance + variance[:, None, None] * np.eye(3)
                sizes = np.linalg.norm(error, axis=1), mahalanobis(error, total)
                found.setdefault((way, views), []).append(np.stack(sizes))
    return {key: np.concatenate(each, axis=1) for key, each in found.items()}


def rows_of(results):
    """Yield the numbers of the table, and print them."""
    for (way, views), (size_m, distance) in sorted(held_of(takes_of(results)).items()):
        inside = distance <= ellipsoid(0.9)
        shares = (distance <= ellipsoid(0.5)).mean(), inside.mean()
        large = inside[size_m > joints.LARGE_M]
        printed = "{:.0f}, {:.0f}; {:.0f}".format(*(100 * one for one in (*shares, large.mean())))
        print(way, views, printed, len(large), flush=True)
        row = "stated-left-out", way, VIEWS[views], printed, "%", " ".join(joint_offsets.SESSIONS)
        yield *row, len(size_m), 0, "benchmark", COMMAND


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    given = parser.parse_args()
    stated.write(ROOT / "docs" / "numbers" / "joint_errors.csv", list(rows_of(given.results)))


if __name__ == "__main__":
    main()
