"""Rays against quads by linear algebra; texels by finite differences; packed textures."""

import numpy as np
import pytest

from virtualgym.hall.quads import Quad
from virtualgym.rendering import textured_quads

EYE = np.array([0.3, -0.4, 0.2])
STEPS = np.array([[0.001, 0.0, 0.0], [0.0, 0.0, 0.0012]])
VELOCITY = np.array([0.5, 0.2, -0.3])


def quads(texture=None):
    rng = np.random.default_rng(3)
    texture = rng.integers(0, 255, (40, 60, 3)).astype(np.uint8) if texture is None else texture
    made = []
    for _ in range(12):
        corner = [rng.uniform(-3, 1), rng.uniform(2, 6), rng.uniform(-2, 1)]
        made.append(
            Quad(corner, *rng.uniform(0.3, 2, (2, 3)) * [[1, 0.3, 0.2], [0.2, 0.3, 1]], texture)
        )
    return made


def solve(quad, origin, direction):
    """Return distance, u and v (0..1) of a ray on a quad's plane."""
    matrix = np.column_stack([direction, -quad.u, -quad.v])
    return np.linalg.solve(matrix, quad.origin - origin)


def rays(count=400):
    rng = np.random.default_rng(0)
    aim = np.column_stack(
        [rng.uniform(-3, 3, count), np.full(count, 3.0), rng.uniform(-2, 2, count)]
    )
    return (aim / 3).astype(np.float32)


def test_the_nearest_quad_is_hit():
    made, direction = quads(), rays()
    found = textured_quads.Surfaces(made).hit(EYE.astype(np.float32), direction)
    for ray, index in zip(direction, found, strict=True):
        hits = [solve(quad, EYE, ray) for quad in made]
        inside = [s if s > 0 and 0 < u < 1 and 0 < v < 1 else np.inf for s, u, v in hits]
        assert index == (np.argmin(inside) if np.min(inside) < np.inf else -1)
    assert 50 < (found >= 0).sum() < 380


@pytest.mark.parametrize("moving", [False, True])
def test_texels_and_distances_are_exact(moving):
    made, direction = quads(), rays()
    surfaces = textured_quads.Surfaces(made)
    index = np.arange(len(direction)) % len(made)
    time_s = np.linspace(-0.05, 0.05, len(direction)).astype(np.float32) if moving else None
    view = textured_quads.View(surfaces, EYE, STEPS, VELOCITY if moving else None)
    distance = view.distance(index, direction.T, time_s)
    u, v, major, minor = view.texels(index, direction.T, time_s)
    for k in range(0, len(direction), 7):
        origin = EYE + (VELOCITY * time_s[k] if moving else 0)
        quad, ray = made[index[k]], direction[k].astype(float)
        truth = solve(quad, origin, ray)
        if not 0.5 < truth[0] < 20:
            continue
        assert distance[k] == pytest.approx(truth[0], rel=1e-4)
        np.testing.assert_allclose([u[k], v[k]], truth[1:] * [60, 40], rtol=1e-3, atol=1e-2)
        beside = [solve(quad, origin, ray + step * 1e-3)[1:] for step in STEPS]
        sides = (np.array(beside) - truth[1:]) * [60, 40] / 1e-3
        lengths = np.linalg.norm(sides, axis=1)
        assert np.linalg.norm(major[:, k]) == pytest.approx(lengths.max(), rel=2e-2)
        area = abs(np.linalg.det(sides))
        assert minor[k] == pytest.approx(area / lengths.max(), rel=5e-2, abs=1e-4)


def test_far_textures_are_averaged_and_near_ones_are_not():
    stripes = np.zeros((64, 64, 3), np.uint8)
    stripes[:, ::2] = 200
    wall = [Quad([-1, 2, 1], [2, 0, 0], [0, 0, -2], stripes)]
    direction = np.stack([np.linspace(-0.4, 0.4, 500), np.ones(500), np.zeros(500)]).astype(
        np.float32
    )
    index = np.zeros(500, np.intp)
    colours = {}
    for pixel in (0.001, 0.1):
        view = textured_quads.View(
            textured_quads.Surfaces(wall), np.zeros(3), np.array([[pixel, 0, 0], [0, 0, pixel]])
        )
        colours[pixel] = textured_quads.shade(view, index, direction)
    assert colours[0.001].std() == pytest.approx(200 / np.sqrt(12), rel=0.05)  # a triangular wave
    np.testing.assert_allclose(colours[0.1], 100, atol=2)


def test_surfaces_take_the_atlas_of_earlier_ones_with_the_same_textures_only():
    red, blue = (np.full((8, 8, 3), bgr, np.uint8) for bgr in ((0, 0, 200), (200, 0, 0)))
    walls = [[Quad([-1, away, 1], [2, 0, 0], [0, 0, -2], red)] for away in (2, 3)]
    painted = [Quad([-1, 2, 1], [2, 0, 0], [0, 0, -2], blue)]
    first = textured_quads.Surfaces(walls[0])
    assert textured_quads.Surfaces(walls[1], earlier=first).packed is first.packed
    view = textured_quads.View(textured_quads.Surfaces(painted, earlier=first), np.zeros(3), STEPS)
    ahead = np.array([[0.0], [1.0], [0.0]], np.float32)
    np.testing.assert_allclose(
        textured_quads.shade(view, np.array([0]), ahead), [[200, 0, 0]], atol=0.01
    )


def test_colour_is_texture_times_light():
    texture = np.full((8, 8, 3), (10, 80, 160), np.uint8)
    wall = [Quad([-1, 2, 1], [2, 0, 0], [0, 0, -2], texture, light) for light in (1.0, 1.5)]
    view = textured_quads.View(textured_quads.Surfaces(wall), np.zeros(3), STEPS)
    direction = np.array([[0.0, 0.1], [1.0, 1.0], [0.0, 0.1]], np.float32)
    found = textured_quads.shade(view, np.array([0, 1]), direction)
    np.testing.assert_allclose(found, [[10, 80, 160], [15, 120, 240]], atol=0.01)


def test_lookup_is_bilinear_for_any_number_of_points():
    image = np.zeros((50, 80, 4), np.uint8)
    image[..., 0], image[..., 1] = np.arange(80) * 3, np.arange(50)[:, None] * 5
    rng = np.random.default_rng(0)
    for count in (1, 1023, 1024, 1500):
        x, y = (rng.uniform(0, most, count).astype(np.float32) for most in (79, 49))
        found = textured_quads.lookup(image, x, y)
        assert found.shape == (count, 4)
        # Places are rounded to 1/32 px, colours to whole numbers.
        np.testing.assert_allclose(found[:, :2], np.column_stack([x * 3, y * 5]), atol=0.6)


# Packed textures: nothing overlaps, every level is the mean of the one before.


def textures():
    rng = np.random.default_rng(0)
    sizes = [(64, 64), (5, 300), (128, 32), (1, 1), (37, 53), (64, 64)]
    return [rng.integers(0, 255, (*size, 3)).astype(np.uint8) for size in sizes]


def at(packed, number, level, x, y):
    """Look up texels (full size) of a texture at a level."""
    left, top, *ratio = packed.places[number, level]
    x, y = (
        np.asarray(v, np.float32) * r + start
        for v, r, start in zip((x, y), ratio, (left, top), strict=True)
    )
    return textured_quads.lookup(packed.image, x, y)[:, :3]


def test_every_texel_is_found_again():
    made = textures()
    packed = textured_quads.pack(made)
    np.testing.assert_array_equal(packed.sizes, [t.shape[1::-1] for t in made])
    for number, texture in enumerate(made):
        rows, columns = np.indices(texture.shape[:2]).reshape(2, -1) + 0.5
        found = at(packed, number, 0, columns, rows)
        np.testing.assert_array_equal(found, texture.reshape(-1, 3))


def test_smaller_levels_are_means():
    packed = textured_quads.pack(textures())
    texture = textures()[0].astype(float)
    for level in range(1, 6):
        side = 1 << level
        means = texture.reshape(64 // side, side, 64 // side, side, 3).mean(axis=(1, 3))
        rows, columns = (np.indices(means.shape[:2]).reshape(2, -1) + 0.5) * side
        found = at(packed, 0, level, columns, rows).astype(float)
        assert np.abs(found - means.reshape(-1, 3)).max() <= level  # rounded once a level
    for number in range(len(textures())):
        last = at(packed, number, textured_quads.LEVELS - 1, [0.5], [0.5])
        assert np.isfinite(last).all()


def test_edges_show_no_neighbour():
    dark, bright = np.zeros((16, 16, 3), np.uint8), np.full((16, 16, 3), 255, np.uint8)
    packed = textured_quads.pack([dark, bright, dark, bright])
    edge = np.linspace(0, 16, 33)
    for number, value in enumerate((0, 255, 0, 255)):
        for level in range(textured_quads.LEVELS):
            for x, y in (
                (edge, 0 * edge),
                (edge, 0 * edge + 16),
                (0 * edge, edge),
                (0 * edge + 16, edge),
            ):
                assert (at(packed, number, level, x, y) == value).all()


def test_a_texture_too_large_for_lookups_is_refused():
    with pytest.raises(ValueError, match="expected textures that fit"):
        textured_quads.pack([np.zeros((textured_quads.LARGEST + 1, 1, 3), np.uint8)])
