"""Bodies: as tall and heavy as they say, of human proportions, and all different."""

import dataclasses
import itertools

import numpy as np
import pytest

from courtside.study.errors import InputError
from fixtures.people import mannequin
from virtualgym.body import makehuman, shapes

NAMES = sorted(shapes.BODIES)
# Shares of the stature. Thigh, shank, forearm, hand and height of the ankle: Drillis & Contini
# 1966, as drawn by Winter 2009, fig. 4.1. Upper arm: from joint centre to joint centre, de Leva
# 1996, table 4 (275.1 mm of 1.735 m, 281.7 mm of 1.741 m); Winter's 0.186 starts at the acromion.
SHARES = {"thigh": 0.245, "shank": 0.246, "forearm": 0.146, "hand": 0.108, "ankle_height": 0.039}
UPPER_ARM = {"f": 0.1586, "m": 0.1618}
TOLERANCE = 0.13


@pytest.mark.parametrize("name", NAMES)
def test_height_and_mass_are_as_stated(name):
    figure, shape = mannequin.figure(name), shapes.BODIES[name]
    assert figure.height_m == pytest.approx(shape.height_m, abs=1e-3)
    # A second way to the volume: slices of the skin, each the area that its outline encloses.
    assert 1000 * sliced_m3(figure) == pytest.approx(shape.mass_kg, rel=0.01)
    assert 18.5 < shape.mass_kg / shape.height_m**2 < 25


def sliced_m3(figure, n=100):
    """Integrate the areas of horizontal cuts, by Green's theorem on the cuts of triangles."""
    corners = figure.vertices[figure.skin]
    levels = (np.arange(n) + 0.5) / n * figure.height_m
    total = 0.0
    for level in levels:
        above = corners[:, :, 1] > level
        cut = corners[above.any(axis=1) & ~above.all(axis=1)]
        ends = [[], []]
        for first, second in ((0, 1), (1, 2), (2, 0)):
            start, stop = cut[:, first], cut[:, second]
            rise = stop[:, 1] - start[:, 1]
            share = (level - start[:, 1]) / np.where(rise == 0, 1, rise)
            point = start + share[:, None] * (stop - start)
            rises = (start[:, 1] <= level) & (stop[:, 1] > level)
            falls = (start[:, 1] > level) & (stop[:, 1] <= level)
            ends[0].append(np.where(rises[:, None], point, 0))
            ends[1].append(np.where(falls[:, None], point, 0))
        start, stop = np.sum(ends[0], axis=0), np.sum(ends[1], axis=0)
        total += (start[:, 0] * stop[:, 2] - stop[:, 0] * start[:, 2]).sum() / 2
    return abs(total) * figure.height_m / n


@pytest.mark.parametrize("name", NAMES)
def test_proportions_are_human(name):
    found, shape = mannequin.dressed(name).proportions, shapes.BODIES[name]
    for part, share in (SHARES | {"upper_arm": UPPER_ARM[shape.sex]}).items():
        assert getattr(found, part) / shape.height_m == pytest.approx(share, rel=TOLERANCE), part
    # 0.093 in the model of a man of 1.80 m (Delp et al. 1990); women have broader hips.
    assert 0.09 < found.hip_width / shape.height_m < 0.125
    assert 0.17 < found.shoulder_width / shape.height_m < 0.24
    assert 0.25 < found.trunk / shape.height_m < 0.31
    assert 0.015 < found.palm < 0.04 and 0.01 < found.toe_height < 0.04


def test_bodies_are_all_different_also_in_build():
    shares = {
        name: np.array(list(dataclasses.astuple(mannequin.dressed(name).proportions)))
        / shapes.BODIES[name].height_m
        for name in NAMES
    }
    for first, second in itertools.combinations(NAMES, 2):
        assert np.abs(shares[first] - shares[second]).max() > 0.002, (first, second)


def test_there_are_enough_bodies_of_each_sex_to_develop_and_to_report():
    assert set(shapes.DEVELOPMENT) < set(NAMES)
    others = set(NAMES) - set(shapes.DEVELOPMENT)
    for group in (shapes.DEVELOPMENT, others):
        assert {shapes.BODIES[name].sex for name in group} == {"m", "f"}
    assert len(NAMES) >= 8 and len(others) >= 4


def test_more_muscle_and_mass_make_the_thighs_thicker_and_leave_the_joints():
    shape = shapes.BODIES["m1"]
    lean, heavy = (
        shapes.figure(mannequin.folder(), dataclasses.replace(shape, mass_kg=mass))
        for mass in (64.0, 80.0)
    )
    np.testing.assert_allclose(lean.head("lowerleg01.L"), heavy.head("lowerleg01.L"), atol=0.006)
    girth = [np.ptp(_thigh(figure)[:, 2]) for figure in (lean, heavy)]
    assert girth[1] > girth[0] + 0.005


def _thigh(figure):
    hip, knee = figure.head("upperleg01.L"), figure.head("lowerleg01.L")
    vertices = figure.vertices[: makehuman.N_BODY]
    level = np.abs(vertices[:, 1] - (hip[1] + knee[1]) / 2) < 0.02
    return vertices[level & (np.abs(vertices[:, 0] - (hip[0] + knee[0]) / 2) < 0.1)]


@pytest.mark.parametrize("mass_kg", [40.0, 130.0])
def test_a_mass_that_the_build_cannot_have_is_refused(mass_kg):
    shape = dataclasses.replace(shapes.BODIES["m1"], mass_kg=mass_kg)
    with pytest.raises(InputError, match=r"expected .* kg, found mass_kg"):
        shapes.figure(mannequin.folder(), shape)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"sex": "x"}, "expected sex m or f .* found x, "),
        ({"origin": "martian"}, "an origin of .* found m, martian"),
        ({"muscle": 0.2}, r"expected muscle .* found 0\.2, "),
        ({"build": 1.5}, r"build -1\.\.1, found .*, 1\.5"),
    ],
)
def test_shapes_that_do_not_exist_are_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        dataclasses.replace(shapes.BODIES["m1"], **wrong)
