"""Agreement of two methods: limits of agreement, and whether one may replace the other.

Networks are given as (first, second): the one in use, and the one that might replace it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.study.errors import InputError

LEVEL = 0.95  # of the limits and of their confidence intervals, as is usual
PAIRS = ["subject", "session", "take", "measure", "unit", "definition", "first", "second"]
REPEATS = ["subject", "session"]  # whose takes are repeats: of one subject on one day
SAME_PLACE = ["subject", "session", "take", "calibration", "measure", "unit"]
YES, UNSURE, NO, UNKNOWN = "yes", "unsure", "no", "unknown"


def pair(rows: pd.DataFrame, networks: tuple[str, str]) -> pd.DataFrame:
    """Put the values of two networks from the same takes side by side, as `PAIRS`.

    `rows` are of `longitudinal.read`. `definition` is empty where both networks define the measure
    alike, and else names both definitions. `InputError` if a network has no values, or none from
    the same takes and calibration as the other.
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
            f"networks {networks[0]} and {networks[1]}: expected values from the same takes and "
            "calibration, found none; measure the same takes with both"
        )
    first, second = both.pop("first_definition"), both.pop("second_definition")
    both["definition"] = np.where(first == second, "", first + " / " + second)
    return both[PAIRS]


def compare(
    pairs: pd.DataFrame, networks: tuple[str, str], *, min_subjects: int = 3, min_repeats: int = 5
) -> pd.DataFrame:
    """Compare two networks, one row per measure of the `pairs` of `pair`.

    Columns: `agreement.table.csv` of `docs/results.md`. A verdict is `unsure` if the 95 %
    intervals of the limits contain the smallest detectable change; `unknown` for too few values.
    Takes of one subject in one session are repeats; what differs between sessions is not counted as
    their spread. `InputError` if no measure has `min_subjects` subjects with `min_repeats` repeats
    each.
    """
    table = [
        _row(name, unit, part, networks, min_subjects, min_repeats)
        for (name, unit), part in pairs.groupby(["measure", "unit"], sort=False)
    ]
    if all(row["verdict"] == UNKNOWN for row in table):
        counts = pairs.groupby(REPEATS)["take"].nunique().groupby("subject").max()
        raise InputError(
            f"networks {networks[0]} and {networks[1]}: expected {min_repeats} takes or more of "
            f"{min_subjects} subjects or more, found in one session at most {counts.to_dict()}; "
            "film more repeats"
        )
    return pd.DataFrame(table)


def _row(
    name: str,
    unit: str,
    part: pd.DataFrame,
    networks: tuple[str, str],
    min_subjects: int,
    min_repeats: int,
) -> dict[str, Any]:
    part = part.dropna(subset=["first", "second"])
    part = part[part.groupby(REPEATS)["first"].transform("count") >= min_repeats]
    marked = ", ".join(sorted(set(part["definition"]) - {""}))
    row = {"measure": name, "unit": unit, "n_subjects": part["subject"].nunique(), "n": len(part)}
    row |= {"definitions_differ": marked}
    if row["n_subjects"] < min_subjects:
        return row | {"verdict": UNKNOWN, "sentence": f"unknown for {name}: too few repeats"}
    found = limits(part["subject"], part["second"] - part["first"])
    day = part.groupby(REPEATS).ngroup()
    change, interval = smallest_detectable_change(day, part["first"])
    second, _ = smallest_detectable_change(day, part["second"])
    row |= {"bias": found.bias}
    row |= _with_interval("lower", found.lower, found.lower_interval)
    row |= _with_interval("upper", found.upper, found.upper_interval)
    row |= {"sd_between": found.sd_between, "sd_within": found.sd_within}
    row |= _with_interval("detectable", change, interval) | {"detectable_second": second}
    row |= {"freedom": len(part) - day.nunique()}
    return row | verdict(row, networks)


def detectable_of(
    table: pd.DataFrame, networks: tuple[str, str], model: str
) -> pd.DataFrame | None:
    """Return the smallest detectable changes of one network from the `table` of `compare`.

    Columns measure, detectable and freedom; None of a network that is not compared.
    """
    own = dict(zip(networks, ("detectable", "detectable_second"), strict=True)).get(model)
    if own not in table:
        return None
    return table[["measure", "freedom"]].assign(detectable=table[own])


def _with_interval(name: str, value: float, ends: tuple[float, float]) -> dict[str, float]:
    return {name: value, f"{name}_from": ends[0], f"{name}_to": ends[1]}


def verdict(row: Mapping[str, Any], networks: tuple[str, str]) -> dict[str, str]:
    """Say whether two networks may be exchanged for one measure: verdict and sentence.

    `row` holds measure, unit, the limits and their intervals, detectable, n_subjects,
    definitions_differ.

    Two networks without bias, with independent errors as large as the repeats', have limits of
    exactly the smallest detectable change: beyond it, a change of network looks like a change of
    the athlete.
    """
    what, unit = row["measure"].replace("_", " "), row["unit"]
    span = f"limits of agreement {row['lower']:.3g} to {row['upper']:.3g} {unit}"
    change = f"the smallest detectable change {row['detectable']:.3g} {unit}"
    both = f"{networks[0]} and {networks[1]}"
    mark = (
        f"; defined differently: {row['definitions_differ']}" if row["definitions_differ"] else ""
    )
    exceed = max(-row["lower"], row["upper"]) > row["detectable"]
    limits = f"{span} {'exceed' if exceed else 'lie within'} {change}"
    if max(-row["lower_to"], row["upper_from"]) > row["detectable"]:
        return {"verdict": NO, "sentence": f"not for {what}: {limits}{mark}"}
    if max(-row["lower_from"], row["upper_to"]) > row["detectable"]:
        words = f"unsure for {what}, as far as {row['n_subjects']} subjects tell: {limits}, but"
        return {"verdict": UNSURE, "sentence": f"{words} their 95 % intervals contain it{mark}"}
    words = f"{both} may be exchanged for {what}: {limits}, with their 95 % intervals"
    return {"verdict": YES, "sentence": words + mark}


@dataclass(frozen=True)
class Limits:
    """Limits of agreement of two methods."""

    bias: float  # mean difference, second minus first
    sd_between: float  # of the differences, between subjects
    sd_within: float  # of the differences, between the repeats of one subject
    # 95 % of the differences of single measurements are expected between `lower` and `upper`.
    lower: float
    upper: float
    lower_interval: tuple[float, float]  # 95 % confidence interval of `lower`
    upper_interval: tuple[float, float]  # 95 % confidence interval of `upper`


def limits(subject: ArrayLike, difference: ArrayLike) -> Limits:
    """Find limits of agreement from several differences of each subject, the true value varying.

    `subject` (N,) are labels; `difference` (N,) is of the two methods, measured at the same time.
    `ValueError` if there are fewer than two subjects, or none has two differences.

    Bland & Altman 2007, J Biopharm Stat 17:571-582, section 3: the variance of a single difference
    is the sum of its components between and within subjects, from a one-way analysis of variance.
    Intervals after Zou 2013, Stat Methods Med Res 22:630-642 (method of variance estimates
    recovery), which hold their level for few subjects too: with three subjects they are very wide,
    and rightly so.
    """
    count, mean, within, difference = _by_subject(subject, difference)
    n_subjects, total = len(count), int(count.sum())
    bias = difference.mean()
    between = np.sum(count * (mean - bias) ** 2) / (n_subjects - 1)
    typical = (total - np.sum(count**2) / total) / (n_subjects - 1)
    component = max((between - within) / typical, 0.0)
    half = scipy.stats.norm.ppf(0.5 + LEVEL / 2) * np.sqrt(component + within)
    # The bias counts each difference alike, so its variance is not that of the mean of means.
    of_bias = component * np.sum(count**2) / total**2 + within / total
    inner, outer = _margins(count, mean, within, of_bias)
    return Limits(
        bias=float(bias),
        sd_between=float(np.sqrt(component)),
        sd_within=float(np.sqrt(within)),
        lower=float(bias - half),
        upper=float(bias + half),
        lower_interval=(float(bias - half - outer), float(bias - half + inner)),
        upper_interval=(float(bias + half - inner), float(bias + half + outer)),
    )


def _by_subject(subject: ArrayLike, value: ArrayLike) -> tuple[NDArray, NDArray, float, NDArray]:
    """Return repeats, mean of each subject, pooled variance within, and the values, as arrays."""
    value = np.asarray(value, dtype=float)
    names, at = np.unique(np.asarray(subject), return_inverse=True)
    count = np.bincount(at, minlength=len(names))
    if len(count) < 2 or count.max() < 2:
        raise ValueError(
            f"expected two subjects at least and repeats, found repeats {count.tolist()}"
        )
    mean = np.bincount(at, weights=value) / count
    within = np.sum((value - mean[at]) ** 2) / (count.sum() - len(count))
    return count, mean, within, value


def _margins(count: NDArray, mean: NDArray, within: float, of_bias: float) -> tuple[float, float]:
    """Return how far the interval of a limit reaches towards the bias and away from it.

    `of_bias` is the variance of the bias.
    """
    n_subjects, tail = len(count), (1 - LEVEL) / 2
    normal = scipy.stats.norm.ppf(1 - tail)
    of_means = mean.var(ddof=1)
    rest = (1 - np.mean(1 / count)) * within
    variance = of_means + rest
    reach = {}
    for side, quantile in (("upper", tail), ("lower", 1 - tail)):
        of_one = of_means * ((n_subjects - 1) / scipy.stats.chi2.ppf(quantile, n_subjects - 1) - 1)
        freedom = count.sum() - n_subjects
        of_other = rest * (freedom / scipy.stats.chi2.ppf(quantile, freedom) - 1)
        reach[side] = np.hypot(of_one, of_other)
    most, least = np.sqrt(variance + reach["upper"]), np.sqrt(max(variance - reach["lower"], 0.0))
    inner = normal * np.sqrt(of_bias + (np.sqrt(variance) - least) ** 2)
    outer = normal * np.sqrt(of_bias + (most - np.sqrt(variance)) ** 2)
    return inner, outer


def smallest_detectable_change(
    subject: ArrayLike, value: ArrayLike
) -> tuple[float, tuple[float, float]]:
    """Find the smallest change of one subject that repeats alone do not explain.

    `subject` (N,) are labels, one for each subject and session; `value` (N,) are those of one
    method. Return the change, 1.96 sqrt(2) times the standard error of measurement, and its 95 %
    confidence interval.

    The standard error of measurement is the standard deviation between repeats of one subject,
    pooled (Bland & Altman 1996, BMJ 312:1654; de Vet et al. 2006, Health Qual Life Outcomes 4:54).
    It includes all that differs between repeats: the athlete's own variation and the measurement's.
    """
    count, _, within, _ = _by_subject(subject, value)
    freedom = int(count.sum() - len(count))
    change = scipy.stats.norm.ppf(0.5 + LEVEL / 2) * np.sqrt(2 * within)
    tail = (1 - LEVEL) / 2
    interval = [
        change * np.sqrt(freedom / scipy.stats.chi2.ppf(at, freedom)) for at in (1 - tail, tail)
    ]
    return float(change), (float(interval[0]), float(interval[1]))
