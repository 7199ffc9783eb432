"""Errors of contacts against the truth of a virtual take."""

import numpy as np
import pytest

from courtside.evaluation.movement import contacts
from courtside.footwork import feet
from courtside.records.truth.take_truth import TakeTruth
from fixtures.people import walking_feet

SECONDS = 5.0


@pytest.fixture(scope="module")
def take():
    points, planted = walking_feet.record(walking_feet.gait(), SECONDS)
    joints, places = [], []
    for side, foot in planted.items():
        moved = [foot.at(t) for t in points.time_s]
        toes = [ankle + foot.length_m * ahead for ankle, ahead, _ in moved]
        joints += [f"{side}_ankle", f"rig_{side}_toe"]
        places += [[ankle for ankle, _, _ in moved], toes]
    xyz = np.array(places).swapaxes(0, 1)[None]
    racket = np.full((1, len(xyz[0]), 2, 3), np.nan)
    known = points.time_s, np.array(joints), points.person_id, xyz, racket
    return points, TakeTruth(*known, {}, {}), planted


def test_true_contacts_are_those_that_the_gym_planned(take):
    _, truth, planted = take
    for side, foot in planted.items():
        stands, true_s = contacts.true_contact(truth, str(truth.person_id[0]), side)
        onset, end = walking_feet.true_steps(foot, SECONDS)
        np.testing.assert_allclose(true_s["onset"], onset, atol=0.009)
        np.testing.assert_allclose(true_s["end"], end, atol=0.009)
        assert stands[0]


def test_errors_are_those_put_in(take):
    points, truth, _ = take
    found, steps, _ = feet.find(points, walking_feet.CUTOFFS)
    exact = contacts.table(points, found, steps, truth)
    late = contacts.table(points, found, steps.assign(onset_s=steps.onset_s + 0.05), truth)
    np.testing.assert_allclose(late.onset_bias_ms - exact.onset_bias_ms, 50, atol=1e-6)
    assert (late.onset_within_90 < exact.onset_within_90).all()
    assert exact.foot.tolist() == ["left", "right"]
    assert (exact.n_found_onset == exact.n_true_onset).all()
    assert (exact.right_percent > 93).all()
    assert (exact.moved_rms_mm < 15).all()
    fewer = contacts.table(points, found, steps[steps.onset_s < 3], truth)
    assert (fewer.n_matched_onset < exact.n_matched_onset).all()


def test_without_a_step_there_is_nothing_to_compare(take):
    points, truth, _ = take
    found, steps, _ = feet.find(points, walking_feet.CUTOFFS)
    none = contacts.table(points, found, steps[:0], truth)
    assert none.n_found_onset.tolist() == [0, 0]
    assert none.onset_median_ms.isna().all()
    assert none.moved_rms_mm.isna().all()
