"""Whether one network may take another's place, measure by measure."""

import numpy as np
import pandas as pd

from courtside.motion import limits_of_agreement
from courtside.study.errors import InputError

PAIRS = ["subject", "session", "take", "measure", "unit", "definition", "first", "second"]
SAME_PLACE = ["subject", "session", "take", "calibration", "measure", "unit"]
YES, UNSURE, NO, UNKNOWN = "yes", "unsure", "no", "unknown"


def pair(rows, networks):
    """Put the values of two networks from the same takes side by side.

    Parameters
    ----------
    rows : pandas.DataFrame
        Of `measure_tables.read`.
    networks : (str, str)
        The network in use, and the one that might take its place.

    Returns
    -------
    pairs : pandas.DataFrame
        `PAIRS`; `definition` is empty where both networks define the measure alike, and else says both.

    Raises
    ------
    InputError
        If a network has no values, or none from the same takes and calibration as the other.
    """
    known = sorted(rows["model"].unique())
    sides = []
    for name, network in zip(("first", "second"), networks, strict=True):
        part = rows[rows["model"] == network]
        if part.empty:
            raise InputError(
                f"networks: expected values of {network}, found those of {known}; name two of these"
            )
        part = part[[*SAME_PLACE, "value", "definition"]]
        sides.append(part.rename(columns={"value": name, "definition": f"{name}_definition"}))
    both = sides[0].merge(sides[1], on=SAME_PLACE, validate="one_to_one")
    if both.empty:
        raise InputError(
            f"networks {networks[0]} and {networks[1]}: expected values from the same takes and calibration, "
            "found none; measure the same takes with both"
        )
    first, second = both.pop("first_definition"), both.pop("second_definition")
    both["definition"] = np.where(first == second, "", first + " / " + second)
    return both[PAIRS]


def compare(pairs, networks, *, min_subjects=3, min_repeats=5):
    """Compare two networks, measure by measure.

    Parameters
    ----------
    pairs : pandas.DataFrame
        Of `pair`.
    networks : (str, str)
    min_subjects, min_repeats : int
        Fewest subjects with so many repeats each.

    Returns
    -------
    table : pandas.DataFrame
        One row per measure: bias, limits and their intervals (second minus first), standard deviations, the
        smallest detectable change of the first network with its interval and that of the second, the number
        of subjects and differences, and a verdict: `yes`, `unsure` (the limits lie within the change, their
        intervals do not), `no`, `unknown` (too few values), with a sentence.

    Raises
    ------
    InputError
        If no measure has enough subjects with enough repeats.
    """
    table = [
        _row(name, unit, part, networks, min_subjects, min_repeats)
        for (name, unit), part in pairs.groupby(["measure", "unit"], sort=False)
    ]
    if all(row["verdict"] == UNKNOWN for row in table):
        counts = pairs.groupby("subject")["take"].nunique()
        raise InputError(
            f"networks {networks[0]} and {networks[1]}: expected {min_repeats} takes or more of "
            f"{min_subjects} subjects or more, found {counts.to_dict()}; film more repeats"
        )
    return pd.DataFrame(table)


def _row(name, unit, part, networks, min_subjects, min_repeats):
    part = part.dropna(subset=["first", "second"])
    repeats = part.groupby("subject")["first"].transform("count")
    part = part[repeats >= min_repeats]
    marked = ", ".join(sorted(set(part["definition"]) - {""}))
    row = {"measure": name, "unit": unit, "n_subjects": part["subject"].nunique(), "n": len(part)}
    row |= {"definitions_differ": marked}
    if row["n_subjects"] < min_subjects:
        return row | {"verdict": UNKNOWN, "sentence": f"unknown for {name}: too few repeats"}
    found = limits_of_agreement.limits(part["subject"], part["second"] - part["first"])
    change, interval, _ = limits_of_agreement.smallest_detectable_change(
        part["subject"], part["first"]
    )
    second, _, _ = limits_of_agreement.smallest_detectable_change(part["subject"], part["second"])
    row |= {
        "bias": found.bias,
        "lower": found.lower,
        "lower_from": found.lower_interval[0],
        "lower_to": found.lower_interval[1],
        "upper": found.upper,
        "upper_from": found.upper_interval[0],
        "upper_to": found.upper_interval[1],
        "sd_between": found.sd_between,
        "sd_within": found.sd_within,
        "detectable": change,
        "detectable_from": interval[0],
        "detectable_to": interval[1],
        "detectable_second": second,
    }
    return row | verdict(row, networks)


def verdict(row, networks):
    """Say whether two networks may be exchanged for one measure.

    Parameters
    ----------
    row : dict
        measure, unit, lower, upper, lower_from, upper_to, detectable, n_subjects, definitions_differ.
    networks : (str, str)

    Returns
    -------
    verdict : dict
        verdict, sentence.

    Notes
    -----
    Two networks with independent errors as large as the repeats' and no bias have limits of exactly the
    smallest detectable change: beyond it, a change of network looks like a change of the athlete.
    """
    what, unit = row["measure"].replace("_", " "), row["unit"]
    span = f"limits of agreement {row['lower']:.3g} to {row['upper']:.3g} {unit}"
    change = f"the smallest detectable change {row['detectable']:.3g} {unit}"
    both = f"{networks[0]} and {networks[1]}"
    mark = (
        f"; defined differently: {row['definitions_differ']}" if row["definitions_differ"] else ""
    )
    if max(-row["lower"], row["upper"]) > row["detectable"]:
        return {"verdict": NO, "sentence": f"not for {what}: {span} exceed {change}{mark}"}
    reach = max(-row["lower_from"], row["upper_to"])
    if reach > row["detectable"]:
        words = f"{both} may be exchanged for {what} as far as {row['n_subjects']} subjects tell: {span} lie"
        words += f" within {change}, but their 95 % intervals reach {reach:.3g} {unit}{mark}"
        return {"verdict": UNSURE, "sentence": words}
    words = f"{both} may be exchanged for {what}: {span} lie within {change}, with their 95 % intervals{mark}"
    return {"verdict": YES, "sentence": words}
