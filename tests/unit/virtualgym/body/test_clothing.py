"""Clothes: on the right places, off the skin, in colours that differ."""

import dataclasses
import itertools

import numpy as np
import pytest

from fixtures.people import mannequin
from virtualgym.body import clothing, makehuman, mesh, shapes, skinned_body

NAMES = sorted(shapes.BODIES)


def worn(name):
    """Return colours of the bare triangles and where these are, (F, 3)."""
    figure, dressed = mannequin.figure(name), mannequin.dressed(name)
    return dressed.colours, figure.vertices[figure.triangles].mean(axis=1), dressed


def nearest(name, point):
    """Return the colour of the triangle nearest to a point of the rest pose."""
    colours, places, _ = worn(name)
    return tuple(int(part) for part in colours[np.linalg.norm(places - point, axis=1).argmin()])


@pytest.mark.parametrize("name", NAMES)
def test_each_garment_is_where_it_is_worn(name):
    palette = {
        key: tuple(int(part) for part in np.clip(value, 0, 255))
        for key, value in clothing._palette(shapes.BODIES[name]).items()
    }
    heads = mannequin.dressed(name).skeleton.heads

    def between(start, end, share):
        return heads[start] + share * (heads[end] - heads[start])

    assert nearest(name, between("upperarm01.L", "lowerarm01.L", 0.3)) == palette["shirt"]
    assert nearest(name, heads["spine04"] + [0, 0, 0.2]) == palette["shirt"]
    assert nearest(name, between("upperleg01.R", "lowerleg01.R", 0.3)) == palette["shorts"]
    assert nearest(name, between("lowerleg01.R", "foot.R", 0.85)) == palette["sock"]
    assert nearest(name, between("lowerarm01.L", "wrist.L", 0.5)) == palette["skin"]
    assert nearest(name, between("lowerleg01.L", "foot.L", 0.2)) == palette["skin"]
    assert nearest(name, mannequin.figure(name).tail("head")) == palette["hair"]
    assert nearest(name, heads["foot.L"] + [0, 0.01, 0.05]) == palette["shoe"]


@pytest.mark.parametrize("name", NAMES)
def test_cloth_stands_off_the_skin_and_soles_stay_on_the_floor(name):
    figure, dressed = mannequin.figure(name), mannequin.dressed(name)
    skin = dressed.rest[: makehuman.N_BODY, :3]
    assert skin[:, 1].min() == pytest.approx(0, abs=1e-6)
    extra = mesh.volume(dressed.rest[:, :3], figure.skin) - mesh.volume(
        figure.vertices, figure.skin
    )
    assert 0.002 < extra < 0.02, "m3: about a square metre of cloth, a centimetre off"
    hair = skin[:, 1].max() - figure.height_m
    assert 0 < hair < 0.02


@pytest.mark.parametrize("name", NAMES)
def test_shirt_shorts_and_skin_differ_plainly(name):
    palette = clothing._palette(shapes.BODIES[name])
    for first, second in itertools.combinations(("shirt", "shorts", "skin"), 2):
        apart = np.linalg.norm(np.subtract(palette[first], palette[second]))
        assert apart > 60, (first, second)


def test_eyes_are_white_with_an_iris_that_looks_forward():
    colours, places, dressed = worn("m1")
    eye = dressed.figure.is_eye
    iris = eye & (colours == clothing.IRIS).all(axis=1)
    white = eye & (colours == clothing.EYE_WHITE).all(axis=1)
    assert (iris | white)[eye].all() and 10 < iris.sum() < white.sum()
    assert places[iris, 2].min() > places[white, 2].mean()
    assert (places[iris, 0] > 0).sum() == (places[iris, 0] < 0).sum()


def test_colours_come_from_the_seed_alone():
    figure, shape = mannequin.figure("m1"), shapes.BODIES["m1"]
    again = skinned_body.Body.of(figure, shape, None)
    np.testing.assert_array_equal(again.colours, mannequin.dressed("m1").colours)
    other = skinned_body.Body.of(figure, dataclasses.replace(shape, seed=shape.seed + 1), None)
    assert (other.colours != again.colours).any(axis=1).mean() > 0.2
