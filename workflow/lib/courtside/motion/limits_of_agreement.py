"""Limits of agreement of two methods, and the smallest change of one that repeats do not explain."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2, norm

LEVEL = 0.95  # of the limits and of their confidence intervals


@dataclass(frozen=True)
class Limits:
    """Limits of agreement of two methods.

    Attributes
    ----------
    bias : float
        Mean difference, second minus first.
    sd_between, sd_within : float
        Of the differences: between subjects, and between the repeats of one.
    lower, upper : float
        95 % of differences of single measurements are expected between these.
    lower_interval, upper_interval : (float, float)
        95 % confidence intervals of the limits.
    n_subjects, n : int
        Subjects, and differences of all together.
    """

    bias: float
    sd_between: float
    sd_within: float
    lower: float
    upper: float
    lower_interval: tuple
    upper_interval: tuple
    n_subjects: int
    n: int


def limits(subject, difference):
    """Find limits of agreement from several differences of each subject, the true value varying.

    Parameters
    ----------
    subject : (N,) array_like
        Labels.
    difference : (N,) float
        Of the two methods, measured at the same time.

    Returns
    -------
    limits : Limits

    Raises
    ------
    ValueError
        If there are fewer than two subjects, or none has two differences.

    Notes
    -----
    Bland & Altman 2007, J Biopharm Stat 17:571-582, section 3: the variance of a single difference is the sum
    of its components between and within subjects, from a one-way analysis of variance. Intervals after Zou
    2013, Stat Methods Med Res 22:630-642 (method of variance estimates recovery), which hold their level for
    few subjects too: with three subjects they are very wide, and rightly so.
    """
    count, mean, within, difference = _by_subject(subject, difference)
    n_subjects, total = len(count), int(count.sum())
    bias = difference.mean()
    between = np.sum(count * (mean - bias) ** 2) / (n_subjects - 1)
    typical = (total - np.sum(count**2) / total) / (n_subjects - 1)
    component = max((between - within) / typical, 0.0)
    half = norm.ppf(0.5 + LEVEL / 2) * np.sqrt(component + within)
    inner, outer = _margins(count, mean, within)
    return Limits(
        bias=float(bias),
        sd_between=float(np.sqrt(component)),
        sd_within=float(np.sqrt(within)),
        lower=float(bias - half),
        upper=float(bias + half),
        lower_interval=(float(bias - half - outer), float(bias - half + inner)),
        upper_interval=(float(bias + half - inner), float(bias + half + outer)),
        n_subjects=n_subjects,
        n=total,
    )


def _by_subject(subject, value):
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


def _margins(count, mean, within):
    """Return how far the interval of a limit reaches towards the bias and away from it."""
    n_subjects, tail = len(count), (1 - LEVEL) / 2
    normal = norm.ppf(1 - tail)
    of_means = mean.var(ddof=1)
    rest = (1 - np.mean(1 / count)) * within
    variance = of_means + rest
    reach = {}
    for side, quantile in (("upper", tail), ("lower", 1 - tail)):
        of_one = of_means * ((n_subjects - 1) / chi2.ppf(quantile, n_subjects - 1) - 1)
        freedom = count.sum() - n_subjects
        of_other = rest * (freedom / chi2.ppf(quantile, freedom) - 1)
        reach[side] = np.hypot(of_one, of_other)
    most, least = np.sqrt(variance + reach["upper"]), np.sqrt(max(variance - reach["lower"], 0.0))
    of_bias = normal**2 * of_means / n_subjects
    inner = np.sqrt(of_bias + normal**2 * (np.sqrt(variance) - least) ** 2)
    outer = np.sqrt(of_bias + normal**2 * (most - np.sqrt(variance)) ** 2)
    return inner, outer


def smallest_detectable_change(subject, value):
    """Find the change of one subject that repeats alone do not explain.

    Parameters
    ----------
    subject : (N,) array_like
        Labels.
    value : (N,) float
        One method's.

    Returns
    -------
    change : float
        1.96 sqrt(2) times the standard error of measurement.
    interval : (float, float)
        Its 95 % confidence interval.
    freedom : int
        Degrees of freedom: repeats less subjects.

    Notes
    -----
    The standard error of measurement is the standard deviation between repeats of one subject, pooled
    (Bland & Altman 1996, BMJ 312:1654; de Vet et al. 2006, Health Qual Life Outcomes 4:54). What differs
    between repeats belongs to it: the athlete's own variation and the measurement's.
    """
    count, _, within, _ = _by_subject(subject, value)
    freedom = int(count.sum() - len(count))
    change = norm.ppf(0.5 + LEVEL / 2) * np.sqrt(2 * within)
    tail = (1 - LEVEL) / 2
    interval = [change * np.sqrt(freedom / chi2.ppf(at, freedom)) for at in (1 - tail, tail)]
    return float(change), (float(interval[0]), float(interval[1])), freedom
