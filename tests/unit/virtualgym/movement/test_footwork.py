"""Footwork: the path of the pelvis, the footfalls under it, and the feet between them."""

from itertools import pairwise

import numpy as np
import pytest

from fixtures.people.performers import BODY
from virtualgym.movement import footwork, two_bone_ik
from virtualgym.movement.footwork import Lap, Plant, Route, Station

STATIONS = (
    Station(0.0, 1.0, np.array([0.0, 0.0]), 0.0),
    Station(2.5, 3.0, np.array([1.2, 1.6]), -0.6, feet=footwork.LUNGE, settle_s=0.2),
    Station(4.5, 5.5, np.array([0.0, 0.1]), 0.0, lead="left"),
)


def planned(seed=0):
    return footwork.plan(STATIONS, BODY, np.random.default_rng(seed))


def test_the_pelvis_rests_at_stations_and_moves_straight_between():
    route = Route(STATIONS)
    for time_s, station in ((0.5, 0), (2.9, 1), (5.4, 2)):
        place, heading = route.at(time_s)
        np.testing.assert_allclose(place, STATIONS[station].place, atol=1e-9)
        assert heading == pytest.approx(STATIONS[station].heading)
    places = np.array([route.at(t)[0] for t in np.linspace(1, 2.7, 50)])
    np.testing.assert_allclose(places[:, 0] * 1.6, places[:, 1] * 1.2, atol=1e-9)
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) / (1.7 / 49)
    assert 2.0 / 1.7 < speeds.max() <= 2.0 / 1.7 / 0.65 + 1e-6


def test_the_body_looks_along_its_way_as_long_as_it_can():
    route = Route(STATIONS)
    there, back = abs(route.at(1.85)[1]), abs(route.at(3.8)[1])
    assert there > 0.3  # turned early, towards where it goes
    assert back > 0.3  # and late on the way back, backwards


def test_steps_alternate_and_the_lead_foot_lands_last():
    _, feet = planned()
    lands = sorted(
        (plant.land_s, side) for side in feet for plant in feet[side].plants if plant.land_s > 0
    )
    for earlier, later in pairwise(lands):
        assert later[0] > earlier[0]
    assert [side for time_s, side in lands if time_s <= 2.5 + 1e-9][-1] == "right"
    assert lands[-1] == (pytest.approx(4.5), "left")
    sides = [side for time_s, side in lands if time_s < 2.6]
    assert all(a != b for a, b in pairwise(sides))


def test_feet_stand_at_a_station_as_it_says():
    _, feet = planned()
    axes = two_bone_ik.facing(-0.6)[:2]
    for side, (left, forward, yaw) in footwork.LUNGE.items():
        expected = STATIONS[1].place + left * axes[:, 0] + forward * axes[:, 2]
        plant = next(p for p in feet[side].plants if p.land_s <= 2.6 <= p.off_s)
        np.testing.assert_allclose(plant.place, expected)
        assert plant.yaw == pytest.approx(-0.6 + yaw)


def test_in_a_hop_both_feet_are_in_the_air_and_land_where_the_station_says():
    hop = Station(1.15, 2.0, np.array([0.0, 0.1]), 0.0, hop=True)
    for seed in range(3):
        _, feet = footwork.plan((STATIONS[0], hop), BODY, np.random.default_rng(seed))
        offs = [foot.plants[0].off_s for foot in feet.values()]
        lands = [foot.plants[1].land_s for foot in feet.values()]
        assert (max(offs), min(lands)) == (1.0, 1.15)
        assert max(offs) - min(offs) <= footwork.HOP_APART_S >= max(lands) - min(lands)
        for side, foot in feet.items():
            lifts = [foot.at(time_s)[2] for time_s in np.arange(1.01, 1.145, 0.01)]
            assert min(lifts) > 0
            assert 0.02 < max(lifts) < 0.06  # the floor's push is gone: g t^2 / 8
            left, forward, _ = footwork.WIDE[side]
            np.testing.assert_allclose(foot.plants[1].place, [-left, forward + 0.1])


def test_going_sideways_the_legs_stay_uncrossed():
    sideways = (STATIONS[0], Station(2.6, 3.5, np.array([1.6, 0.0]), 0.0, lead="left"))
    for seed in range(5):
        _, feet = footwork.plan(sideways, BODY, np.random.default_rng(seed))
        for time_s in np.arange(0, 3.5, 0.02):
            standing = [f.at(time_s) for f in (feet["left"], feet["right"])]
            if all(lift == 0 for _, _, lift in standing):
                assert standing[1][0][0] - standing[0][0][0] > 0.05


def test_a_lap_goes_through_its_corners_and_looks_along():
    corners = np.array([(0.0, 0), (0.5, 1.5), (2, 2), (3, 0.5)])
    lap = Lap(corners, 1.0, 6.0)
    times = np.linspace(0.5, 6.5, 1201)
    states = [lap.at(t) for t in times]
    places = np.array([place for place, _ in states])
    np.testing.assert_allclose([places[0], places[-1]], corners[[0, -1]], atol=1e-6)
    for corner in corners[1:-1]:
        assert np.linalg.norm(places - corner, axis=1).min() < 0.02
    moves = np.diff(places, axis=0)
    moving = np.linalg.norm(moves, axis=1) > 1e-3
    forward = np.array([(-np.sin(h), np.cos(h)) for _, h in states])[:-1][moving]
    cosines = np.sum(moves[moving] * forward, axis=1) / np.linalg.norm(moves[moving], axis=1)
    assert cosines.min() > 0.999
    first, last = lap.ends(0.0, 7.0)
    assert (first.arrive_s, first.leave_s, last.arrive_s, last.leave_s) == (0, 1, 6, 7)


def test_feet_never_pull_the_pelvis_out_of_reach():
    route, feet = planned()
    leg = BODY.thigh + BODY.shank
    for time_s in np.arange(0, 5.5, 0.01):
        place, _ = route.at(time_s)
        for foot in feet.values():
            assert np.linalg.norm(foot.at(time_s)[0][:2] - place) < 0.95 * leg


# Feet: still while they carry, off the floor between, toes on the floor while the heel rises.

STEPS = {  # the right foot steps 0.7 m along y, while the left stands; then the left
    "left": [
        Plant(0.0, 1.4, np.array([-0.1, 0.3]), 0.0),
        Plant(1.8, 3.0, np.array([-0.1, 1.1]), 0.2),
    ],
    "right": [
        Plant(0.0, 0.8, np.array([0.1, 0.0]), 0.0),
        Plant(1.2, 3.0, np.array([0.1, 0.7]), 0.0),
    ],
}
TIMES = np.arange(0, 3, 0.005)


def feet(steps=STEPS):
    return footwork.walk(steps, BODY, rolls={side: [0.2] for side in steps})


def path(foot):
    """Return ankles and toes (T, 3) m."""
    states = [foot.at(time_s) for time_s in TIMES]
    ankles = np.array([ankle for ankle, _, _ in states])
    return ankles, ankles + foot.length_m * np.array([way for _, way, _ in states])


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_flat_foot_stands_still_at_its_plant(side):
    foot = feet()[side]
    ankles, toes = path(foot)
    for plant, (start, stop) in zip(foot.plants, foot.standing(), strict=True):
        still = (start <= TIMES) & (stop >= TIMES)
        assert np.ptp(ankles[still], axis=0).max() < 1e-12
        np.testing.assert_allclose(ankles[still][-1], [*plant.place, BODY.ankle_height], atol=1e-12)
        assert toes[still][-1, 2] == pytest.approx(BODY.toe_height)


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_heel_rises_about_the_toes(side):
    foot = feet()[side]
    ankles, toes = path(foot)
    rolling = (foot.standing()[0, 1] <= TIMES) & (foot.plants[0].off_s >= TIMES)
    assert np.ptp(toes[rolling], axis=0).max() < 1e-12
    assert ankles[rolling][-1, 2] > BODY.ankle_height + 0.02


def test_feet_clear_the_floor_and_one_another():
    both = feet()
    paths = {side: path(foot) for side, foot in both.items()}
    for side, (ankles, toes) in paths.items():
        off, land = both[side].plants[0].off_s, both[side].plants[1].land_s
        swing = abs(TIMES - (off + land) / 2) < 0.1
        assert ankles[swing, 2].min() > BODY.ankle_height + 0.02
        assert toes[:, 2].min() > BODY.toe_height - 1e-9
    apart = paths["left"][0][:, :2] - paths["right"][0][:, :2]
    assert np.linalg.norm(apart, axis=1).min() > 0.14


def test_a_heel_lands_before_its_toes():
    foot = feet()["right"]
    _, toes = path(foot)
    landed = np.searchsorted(TIMES, foot.plants[1].land_s)
    assert toes[landed, 2] > BODY.toe_height + 0.002
    assert toes[landed + 20, 2] == pytest.approx(BODY.toe_height)


def test_paths_have_no_kink():
    for foot in feet().values():
        for points in path(foot):
            assert np.linalg.norm(np.diff(points, 2, axis=0), axis=1).max() / 0.005**2 < 100


def test_a_foot_that_never_steps_stays():
    still = {side: plants[:1] for side, plants in STEPS.items()}
    foot = footwork.walk(still, BODY, rolls={"left": [], "right": []})["left"]
    np.testing.assert_allclose(foot.at(2.0)[0], foot.at(0.0)[0])
