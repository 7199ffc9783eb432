"""The racket: its size by the laws of badminton, closed tubes, its place in the world."""

import numpy as np
import pytest

from virtualgym.body import mesh, racket


@pytest.fixture(scope="module")
def built():
    return racket.build()


def test_size_is_within_the_laws_of_badminton(built):
    low, high = built.vertices.min(axis=0), built.vertices.max(axis=0)
    assert low[1] == pytest.approx(0, abs=1e-6) and high[1] == pytest.approx(0.674, abs=1e-4)
    assert high[0] - low[0] <= 0.230 and racket.HEAD_LENGTH_M <= 0.290
    assert high[2] - low[2] < 0.04
    np.testing.assert_allclose(low[[0, 2]], -high[[0, 2]], atol=1e-4)


def test_tubes_are_closed_and_face_outwards():
    angle = np.linspace(0, 2 * np.pi, 96, endpoint=False)
    line = np.stack([np.cos(angle), np.sin(angle), np.zeros(96)], axis=1)
    ring = racket._tube(line, np.full(96, 0.1), np.zeros((96, 3)), closed=True)
    share = racket.AROUND / (2 * np.pi) * np.sin(2 * np.pi / racket.AROUND)  # octagon of the circle
    torus = 2 * np.pi**2 * 0.1**2 * share
    assert mesh.volume(ring.vertices, ring.triangles) == pytest.approx(torus, rel=0.01)
    rod = racket._tube(
        np.array([[0, 0, 0], [0, 2.0, 0]]), np.array([0.1, 0.1]), np.zeros((1, 3)), closed=False
    )
    assert mesh.volume(rod.vertices, rod.triangles) == pytest.approx(2 * np.pi * 0.01 * share)


def test_both_ends_are_marked_and_nothing_else(built):
    marked = (built.colours == racket.END_BGR).all(axis=1)
    height = built.vertices[built.triangles[marked]].mean(axis=1)[:, 1]
    assert (height < 0.03).any() and (height > 0.66).any()
    assert ((height < 0.03) | (height > 0.62)).all()


def test_a_racket_is_placed_by_its_butt_and_direction(built):
    butt, way = np.array([1.0, 2, 3]), np.array([0.6, 0, 0.8])
    face = np.array([0.8, 0.1, -0.6])
    placed = racket.place(built, butt, way, face)
    along = (placed.vertices - butt) @ way
    assert along.min() == pytest.approx(0, abs=1e-5)
    assert along.max() == pytest.approx(racket.LENGTH_M, abs=1e-4)
    top = placed.vertices[np.argmax(along)]
    np.testing.assert_allclose(top, butt + racket.LENGTH_M * way, atol=0.006)
    normal = face - (face @ way) * way
    thick = (placed.vertices - butt) @ (normal / np.linalg.norm(normal))
    assert np.ptp(thick) == pytest.approx(2 * max(racket.GRIP_RADII_M), abs=1e-4)
    volumes = [mesh.volume(each.vertices, each.triangles) for each in (built, placed)]
    assert volumes[0] == pytest.approx(volumes[1], rel=1e-3), "moved, not mirrored"
