"""The probability that a foot stands."""

import itertools
from dataclasses import replace

import numpy as np

from courtside.footwork import contact, tracks
from fixtures.people import walking_feet


def test_feet_of_the_virtual_gym_stand_when_they_are_planted():
    points, feet = walking_feet.record(walking_feet.gait(), 5.0)
    for side, foot in feet.items():
        (track,), _ = tracks.tracks(points, 0, side, walking_feet.CUTOFFS)
        stands = contact.probability(track)[:, 0] > 0.5
        true = np.any(
            [(track.time_s >= p.land_s) & (track.time_s < p.off_s) for p in foot.plants], 0
        )
        assert (stands == true).mean() > 0.94


def test_a_foot_that_nothing_is_known_of_has_no_sharp_contact():
    sure, _ = walking_feet.record(walking_feet.gait(), 4.0)
    vague, _ = walking_feet.record(walking_feet.gait(), 4.0, sigma_m=0.1)
    spread = []
    for points in (sure, vague):
        (track,), _ = tracks.tracks(points, 0, "left", walking_feet.CUTOFFS)
        p = contact.probability(track)[:, 0]
        spread.append((p * (1 - p)).mean())
    assert spread[1] > 1.5 * spread[0]


def test_posteriors_are_those_of_all_paths_of_states():
    rng = np.random.default_rng(0)
    log_densities = rng.normal(0, 1, (5, 4))
    moves = contact.RATES * 0.05
    moves += np.diag(1 - moves.sum(axis=1))
    total = np.zeros((5, 4))
    for path in itertools.product(range(4), repeat=5):
        steps = np.prod([moves[a, b] for a, b in itertools.pairwise(path)])
        weight = contact.START[path[0]] * steps * np.exp(log_densities[range(5), path].sum())
        total[range(5), path] += weight
    found = contact._smoothed(log_densities, moves)
    np.testing.assert_allclose(found, total / total.sum(axis=1, keepdims=True), rtol=1e-9)


def test_a_toe_that_is_seen_too_high_while_the_heel_is_up_still_stands(monkeypatch):
    points, feet = walking_feet.record(walking_feet.gait(stance_s=0.5), 5.0)
    xyz, toe = points.xyz.copy(), points.joints.tolist().index("left_foot_index")
    ends = [plant.off_s for plant in feet["left"].plants[:-1]]
    for end_s in ends:
        xyz[0, :, toe, 2] += 0.05 * np.clip(1 - abs(points.time_s - end_s) / 0.13, 0, 1)
    (track,), _ = tracks.tracks(replace(points, xyz=xyz), 0, "left", walking_feet.CUTOFFS)
    rolls = np.any([(track.time_s > end - 0.1) & (track.time_s < end - 0.02) for end in ends], 0)
    assert (contact.probability(track)[rolls, 0] > 0.5).mean() > 0.95
    monkeypatch.setattr(contact, "TIPTOE", contact.STRICT)
    assert (contact.probability(track)[rolls, 0] > 0.5).mean() < 0.9


def test_a_hop_that_looks_like_standing_on_the_toes_is_a_flight():
    points, _ = walking_feet.record(walking_feet.hop(), 3.0)
    (track,), _ = tracks.tracks(points, 0, "left", walking_feet.CUTOFFS)
    flies = abs(track.time_s - 0.9) < 0.04
    assert (contact._posterior(track, contact.TIPTOE)[flies, 0] > 0.5).all()
    assert (contact.probability(track)[flies, 0] < 0.5).all()
