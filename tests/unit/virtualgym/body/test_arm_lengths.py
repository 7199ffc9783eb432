"""Longer forearms: of a chain of bones made for it, and of all bodies of the gym."""

import numpy as np
import pytest
from scipy import sparse

from fixtures.people import mannequin
from virtualgym.body import arm_lengths, makehuman, mesh, shapes

BONES = ("upperarm01", "lowerarm01", "lowerarm02", "wrist", "finger3-3")
X_M = (0.2, 0.5, 0.6, 0.7, 0.75)  # where they begin on the left; each ends where the next begins
# Span of adults, as a share of their height, and the standard deviation between them: ANSUR II.
SPAN, SPAN_SD = {"m": 1.033, "f": 1.0195}, 0.025


@pytest.fixture(scope="module")
def arms():
    """Return two arms along x, whose points lie on the bones' beginnings and middles."""
    bones = tuple(bone + suffix for suffix in (".L", ".R") for bone in BONES)
    heads = np.array([[sign * x, 1.4, 0.02] for sign in (1, -1) for x in X_M])
    tails = np.array([[sign * x, 1.4, 0.02] for sign in (1, -1) for x in (*X_M[1:], 0.8)])
    held = np.concatenate([np.eye(10), np.eye(10)])
    return makehuman.Figure(
        vertices=np.concatenate([heads, (heads + tails) / 2]),
        triangles=np.zeros((1, 3), int),
        is_eye=np.zeros(1, bool),
        bones=bones,
        parents=np.array([-1, 0, 1, 2, 3, -1, 5, 6, 7, 8]),
        heads=heads,
        tails=tails,
        weights=sparse.csr_matrix(held),
    )


def test_womens_forearms_are_longer_and_their_hands_as_large(arms):
    found = arm_lengths.lengthened(arms, "f")
    more = 0.156 * 0.2
    expected = [0.2, 0.5, 0.5 + 1.156 * 0.1, 0.7 + more, 0.75 + more]
    for side in (0, 1):
        sign = 1 - 2 * side
        at = slice(5 * side, 5 * side + 5)
        np.testing.assert_allclose(sign * found.heads[at, 0], expected, atol=1e-12)
        np.testing.assert_allclose(sign * found.tails[at, 0], [*expected[1:], 0.8 + more])
        np.testing.assert_allclose(found.vertices[at], found.heads[at], atol=1e-12)
    np.testing.assert_allclose(found.vertices[10:], (found.heads + found.tails) / 2, atol=1e-12)


def test_mens_arms_stay(arms):
    assert arm_lengths.lengthened(arms, "m") is arms


@pytest.mark.parametrize("name", shapes.BODIES)
def test_bodies_have_forearms_and_a_span_as_people_have_them_and_their_mass(name):
    figure, shape = mannequin.figure(name), shapes.BODIES[name]
    joints = [figure.head(bone + ".L") for bone in ("upperarm01", "lowerarm01", "wrist")]
    arm = np.linalg.norm(np.diff([*joints, figure.tail("finger3-3.L")], axis=0), axis=1)
    of_people = {"m": 268.9 / 1741, "f": 264.3 / 1735}[shape.sex]  # de Leva 1996, table 4
    assert arm[1] / shape.height_m / of_people == pytest.approx(1, abs=0.06)
    span = 2 * (joints[0][0] + arm.sum()) / shape.height_m
    assert abs(span - SPAN[shape.sex]) < SPAN_SD
    assert figure.height_m == pytest.approx(shape.height_m, abs=1e-6)
    mass_kg = 1000 * mesh.volume(figure.vertices, figure.skin)
    assert mass_kg == pytest.approx(shape.mass_kg, abs=0.02)
