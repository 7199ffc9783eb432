"""Limits of agreement: the published example, simulated variance components, coverage of the intervals."""

import numpy as np
import pytest

from courtside.statistics import agreement

# Cardiac output of 12 subjects by radionuclide ventriculography, and less that by impedance cardiography:
# Bland & Altman 2007, table 1.
OUTPUT = {
    1: [(7.83, 6.57), (7.42, 5.62), (7.89, 6.9), (7.12, 6.57), (7.88, 6.35)],
    2: [(6.16, 4.06), (7.26, 4.29), (6.71, 4.26), (6.54, 4.09)],
    3: [(4.75, 4.71), (5.24, 5.5), (4.86, 5.08), (4.78, 5.02), (6.05, 6.01), (5.42, 5.67)],
    4: [(4.21, 4.14), (3.61, 4.2), (3.72, 4.61), (3.87, 4.68), (3.92, 5.04)],
    5: [(3.13, 3.03), (2.98, 2.86), (2.85, 2.77), (3.17, 2.46), (3.09, 2.32), (3.12, 2.43)],
    6: [(5.92, 5.9), (6.42, 5.81), (5.92, 5.7), (6.27, 5.76)],
    7: [(7.13, 5.09), (6.62, 4.63), (6.58, 4.61), (6.93, 5.09)],
    8: [(4.54, 4.72), (4.81, 4.61), (5.11, 4.36), (5.29, 4.2), (5.39, 4.36), (5.57, 4.2)],
    9: [(4.48, 3.17), (4.92, 3.12), (3.97, 2.96)],
    10: [(4.22, 4.35), (4.65, 4.62), (4.74, 3.16), (4.44, 3.53), (4.5, 3.53)],
    11: [(6.78, 7.2), (6.07, 6.09), (6.52, 7.0), (6.42, 7.1), (6.41, 7.4), (5.76, 6.8)],
    12: [(5.06, 4.5), (4.72, 4.2), (4.9, 3.8), (4.8, 3.8), (4.9, 4.2), (5.1, 4.5)],
}


def simulated(rng, counts, sd_between, sd_within, bias=0.0):
    subject = np.repeat(np.arange(len(counts)), counts)
    own = rng.normal(0, sd_between, len(counts))
    return subject, bias + own[subject] + rng.normal(0, sd_within, len(subject))


def test_the_published_example():
    """The paper gives a mean difference of 0.60, a standard deviation of 0.99 of single differences."""
    pairs = [(subject, rv - ic) for subject, values in OUTPUT.items() for rv, ic in values]
    found = agreement.limits(*zip(*pairs, strict=True))
    assert (found.n_subjects, found.n) == (12, 60)
    assert found.bias == pytest.approx(0.60, abs=0.005)
    assert np.hypot(found.sd_between, found.sd_within) == pytest.approx(0.99, abs=0.005)
    assert found.upper - found.bias == pytest.approx(1.96 * 0.9906, abs=0.001)
    assert found.lower + found.upper == pytest.approx(2 * found.bias)


def test_known_components_are_found():
    subject, difference = simulated(np.random.default_rng(1), [8] * 4000, 2.0, 1.0, bias=0.7)
    found = agreement.limits(subject, difference)
    assert found.bias == pytest.approx(0.7, abs=0.1)
    assert found.sd_between == pytest.approx(2.0, rel=0.03)
    assert found.sd_within == pytest.approx(1.0, rel=0.02)
    assert found.upper == pytest.approx(0.7 + 1.96 * np.sqrt(5), rel=0.03)
    assert found.upper_interval[0] < found.upper < found.upper_interval[1]
    assert found.upper_interval[1] - found.upper_interval[0] < 0.3


@pytest.mark.parametrize(
    ("counts", "between", "within"),
    [
        ([5] * 3, 1.0, 0.5),
        ([5] * 3, 0.2, 1.0),
        ([5] * 10, 1.0, 1.0),
        ([3, 4, 8, 5, 6, 10], 0.7, 1.0),
    ],
)
def test_intervals_hold_the_true_limits_as_often_as_they_say(counts, between, within):
    rng = np.random.default_rng(2)
    true = 1.959964 * np.hypot(between, within)
    inside = []
    for _ in range(800):
        found = agreement.limits(*simulated(rng, counts, between, within))
        inside.append(found.upper_interval[0] <= true <= found.upper_interval[1])
        inside.append(found.lower_interval[0] <= -true <= found.lower_interval[1])
    assert 0.92 <= np.mean(inside) <= 0.985


def test_the_smallest_detectable_change_of_a_known_error():
    rng = np.random.default_rng(3)
    subject, value = simulated(rng, [20] * 500, 30.0, 1.5)
    change, interval, freedom = agreement.smallest_detectable_change(subject, value)
    assert change == pytest.approx(1.96 * np.sqrt(2) * 1.5, rel=0.02)
    assert freedom == 500 * 19
    assert interval[0] < change < interval[1]


def test_the_interval_of_the_smallest_detectable_change_covers():
    rng = np.random.default_rng(4)
    true = 1.96 * np.sqrt(2)
    inside = []
    for _ in range(1500):
        _, interval, _ = agreement.smallest_detectable_change(*simulated(rng, [5] * 3, 9.0, 1.0))
        inside.append(interval[0] <= true <= interval[1])
    assert 0.93 <= np.mean(inside) <= 0.97


def test_nothing_is_said_of_one_subject_or_without_repeats():
    for subject in ([1, 1, 1], [1, 2, 3]):
        with pytest.raises(ValueError, match="two subjects at least"):
            agreement.limits(subject, [0.1, 0.2, 0.3])
