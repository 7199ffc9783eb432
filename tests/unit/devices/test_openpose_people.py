"""Persons keep their tracks through frames that list them in any order."""

import numpy as np

from courtside.devices import openpose


def person(x, y=100.0, seen=6):
    """Return six points of a person 200 px tall, the first `seen` of them seen."""
    found = np.column_stack([x + 20.0 * np.arange(6), y + 40.0 * np.arange(6), np.full(6, 0.9)])
    found[seen:] = np.nan
    return found


def stack(*persons):
    return np.array(persons).reshape(-1, 6, 3)


def test_persons_are_followed_whatever_their_order():
    rng = np.random.default_rng(0)
    left, right = 100 + 3.0 * np.arange(40), 900 - 4.0 * np.arange(40)
    people = []
    for a, b in zip(left, right, strict=True):
        both = [person(a), person(b, 120)]
        people.append(stack(*(both if rng.random() < 0.5 else both[::-1])))
    first = people[0][0, 0, 0]
    tracks = openpose.link(people)
    assert tracks.shape == (2, 40, 6, 3)
    order = (left, right) if first == left[0] else (right, left)
    for track, x in zip(tracks, order, strict=True):
        assert np.array_equal(track[:, 0, 0], x)


def test_a_gap_is_bridged_but_not_for_ever():
    people = [stack(person(100.0 + at)) for at in range(20)]
    people[5:9] = [stack()] * 4
    tracks = openpose.link(people)
    assert len(tracks) == 1
    assert np.isnan(tracks[0, 5:9]).all()
    assert np.isfinite(tracks[0, 9:, 0, 0]).all()
    people[5:18] = [stack()] * 13
    assert len(openpose.link(people)) == 2


def test_somebody_elsewhere_is_somebody_else():
    people = [stack(person(100.0)), stack(person(170.0 + 200))]
    tracks = openpose.link(people)
    assert len(tracks) == 2
    assert np.isfinite(tracks[:, :, 0, 0]).tolist() == [[True, False], [False, True]]


def test_the_nearest_pairing_wins_over_the_first():
    """Taken one after the other, the first person would take the track that the second needs."""
    people = [stack(person(100.0), person(150.0)), stack(person(140.0), person(95.0))]
    tracks = openpose.link(people)
    assert tracks[:, 1, 0, 0].tolist() == [95.0, 140.0]


def test_points_that_only_one_frame_has_do_not_count():
    other = person(100.0)
    other[:3] = np.nan
    tracks = openpose.link([stack(person(100.0, seen=4)), stack(other)])
    assert len(tracks) == 1  # the fourth point tells
    other[3] = np.nan
    assert len(openpose.link([stack(person(100.0, seen=4)), stack(other)])) == 2


def test_nobody():
    assert openpose.link([stack(), stack()]).shape == (0, 2, 6, 3)
    assert len(openpose.link([])) == 0
