"""People in the hall: where they walk, how they are put together, what a picture shows of them."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from virtualgym.hall import bystanders

FOLDER = Path(__file__).parents[4] / "config" / "courts"
COURT = court_files.read(FOLDER / "badminton.yaml")


def crowd(count=4, seed=0, court=COURT):
    return bystanders.plan(count, court, np.random.default_rng(seed))


def corners(quads):
    """Return all corners (n, 3) of surfaces."""
    return np.concatenate([[q.origin, q.origin + q.u, q.origin + q.v] for q in quads])


@pytest.mark.parametrize("court", ["badminton", "tennis"])
def test_people_stay_near_the_court_and_out_of_the_net(court):
    known = court_files.read(FOLDER / f"{court}.yaml")
    short, long = known.size_m
    crossed = []
    for seed in range(5):
        for person in crowd(4, seed, known):
            way = np.array([person.place(time_s) for time_s in np.arange(0, 200, 0.5)])
            assert (way > [-4.5, -0.5]).all() and (way < [short + 4.5, long + 0.5]).all()
            on_court = (way[:, 0] > -0.5) & (way[:, 0] < short + 0.5)
            crossed.append(np.ptp(np.sign(way[on_court, 1] - long / 2)) if on_court.any() else 0)
            assert np.ptp(way, axis=0).max() > 2, "walks about"
    assert max(crossed) == 0


def test_people_walk_at_a_constant_speed_and_without_jumps():
    for person in crowd():
        way = np.array([person.place(time_s) for time_s in np.arange(0, 120, 0.02)])
        speeds = np.linalg.norm(np.diff(way, axis=0), axis=1) / 0.02
        np.testing.assert_allclose(speeds, person.speed_m_s, rtol=0.05)
        assert 0.5 <= person.speed_m_s <= 1.3


@pytest.mark.parametrize("time_s", [0.0, 0.37, 11.0])
def test_a_body_is_as_tall_as_its_person_and_stands_on_the_floor(time_s):
    for person in crowd(8):
        found = corners(person.quads(time_s))
        assert found[:, 2].max() == pytest.approx(person.height_m)
        assert -0.12 < found[:, 2].min() < 0.1
        away = np.linalg.norm(found[:, :2] - person.place(time_s), axis=1)
        assert 0.15 < away.max() < 0.75


def test_a_body_faces_where_it_walks():
    for person in crowd():
        nose = person.quads(5.0)[6 + 1]  # the front of the head, the second box
        outward = np.cross(nose.v, nose.u)[:2]
        moved = person.place(5.01) - person.place(4.99)
        cosine = outward @ moved / np.linalg.norm(outward) / np.linalg.norm(moved)
        assert cosine == pytest.approx(1, abs=1e-3)


def test_limbs_are_boxes_that_hang_together_and_swing():
    person = crowd()[0]
    quads = person.quads(3.0)
    assert len(quads) == 72, "torso, head, and twice thigh, shank, foot, upper arm, forearm"
    for box in np.array([[q.origin + (q.u + q.v) / 2 for q in quads]]).reshape(12, 6, 3):
        # Opposite faces have one middle.
        middle = (box[[0, 1, 4]] + box[[2, 3, 5]]) / 2
        np.testing.assert_allclose(middle, middle[[0, 0, 0]], atol=1e-9)
    foot_m = [
        corners(person.quads(time_s)[24:30])[:, :2].mean(axis=0) - person.place(time_s)
        for time_s in np.arange(0, 4, 0.1)
    ]
    assert np.ptp(np.linalg.norm(foot_m, axis=1)) > 0.1


def test_the_same_generator_gives_the_same_people():
    one, same, other = crowd(seed=1), crowd(seed=1), crowd(seed=2)
    a, b, c = (corners(bystanders.quads(group, 7.5)) for group in (one, same, other))
    np.testing.assert_array_equal(a, b)
    assert np.abs(a - c).max() > 0.1
    shirts = [person.clothes["shirt"] for person in (one[0], same[0], other[0])]
    assert (shirts[0] == shirts[1]).all() and (shirts[0] != shirts[2]).any()


def test_more_bystanders_leave_the_first_as_they_are():
    few, many = crowd(2), crowd(7)
    np.testing.assert_array_equal(few[1].place(9.0), many[1].place(9.0))
    assert len(many) == 7 and bystanders.quads([], 0.0) == []
    assert len(bystanders.quads(many, 1.0)) == 7 * 72
