"""Feet: still while they carry, off the floor between, toes on the floor while the heel rises."""

import numpy as np
import pytest

from fixtures.people.performers import BODY
from virtualgym.movement import footwork
from virtualgym.movement.footwork import Plant

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
