"""Packed textures: nothing overlaps, every level is the mean of the one before."""

import numpy as np
import pytest

from virtualgym.rendering import textured_quads


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
