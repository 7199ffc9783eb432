"""Meshes: their volume, normals and union, against solids whose values are known."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from virtualgym.body import mesh


def solid(points):
    """Return outward triangles of the convex hull of points on it."""
    hull = ConvexHull(points)
    first, second, third = np.moveaxis(points[hull.simplices], 1, 0)
    outward = np.einsum("ij,ij->i", np.cross(second - first, third - first), hull.equations[:, :3])
    return np.where(outward[:, None] > 0, hull.simplices, hull.simplices[:, ::-1]), hull.volume


def sphere(n=600):
    points = np.random.default_rng(0).normal(size=(n, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def test_volume_is_that_of_the_solid_wherever_it_is():
    points = sphere()
    triangles, expected = solid(points)
    assert mesh.volume(points, triangles) == pytest.approx(expected)
    assert mesh.volume(points * 2 + [5, -3, 9], triangles) == pytest.approx(8 * expected)
    assert mesh.volume(points, triangles[:, ::-1]) == pytest.approx(-expected)


def test_normals_point_out_of_a_sphere():
    points = sphere()
    triangles, _ = solid(points)
    found = mesh.normals(points, triangles)
    assert np.einsum("ij,ij->i", found, points).min() > 0.95
    lonely = mesh.normals(np.vstack([points, [0, 0, 0]]), triangles)
    assert (lonely[-1] == 0).all()


def triangle(shift, colour):
    return mesh.Mesh(np.eye(3) + shift, np.array([[0, 1, 2]]), np.array([colour], dtype=np.uint8))


def test_joined_meshes_keep_corners_and_colours():
    parts = [triangle(at, (at, 0, 0)) for at in range(3)]
    found = mesh.join(parts)
    assert found.vertices.dtype == np.float32 and found.triangles.dtype == np.int32
    for at, part in enumerate(parts):
        np.testing.assert_array_equal(found.vertices[found.triangles[at]], part.vertices)
        assert found.colours[at].tolist() == [at, 0, 0]


@pytest.mark.parametrize(
    ("vertices", "triangles", "colours", "message"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]], np.zeros((1, 3), np.uint8), "expected vertices"),
        (np.zeros((3, 3)), [[0, 1, 3]], np.zeros((1, 3), np.uint8), "expected corners among 3"),
        (np.zeros((3, 3)), [[0, 1]], np.zeros((1, 2), np.uint8), "expected triangles"),
        (np.zeros((3, 3)), [[0, 1, 2]], np.zeros((2, 3), np.uint8), r"found uint8 \(2, 3\)"),
        (np.zeros((3, 3)), [[0, 1, 2]], np.zeros((1, 3)), r"expected colours .* found float64"),
    ],
)
def test_invalid_meshes_are_refused(vertices, triangles, colours, message):
    with pytest.raises(ValueError, match=message):
        mesh.Mesh(vertices, np.array(triangles), colours)
