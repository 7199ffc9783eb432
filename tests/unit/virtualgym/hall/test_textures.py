"""Textures: exact shares on edges, contrast, sizes, and the same seed giving the same bytes."""

import numpy as np
import pytest

from virtualgym.hall import textures


def rng(seed=0):
    return np.random.default_rng(seed)


def test_painted_rectangles_have_their_exact_area_and_centre():
    image = np.zeros((40, 50, 3), np.uint8)
    textures.paint(image, (33.7, 25.1, 10.3, 12.6), (200, 100, 240))
    share = image / np.array([200, 100, 240])
    np.testing.assert_allclose(share.sum(axis=(0, 1)), (33.7 - 10.3) * (25.1 - 12.6), rtol=2e-3)
    rows, columns = np.indices(image.shape[:2]) + 0.5
    weight = share[..., 0] / share[..., 0].sum()
    assert (columns * weight).sum() == pytest.approx((33.7 + 10.3) / 2, abs=0.01)
    assert (rows * weight).sum() == pytest.approx((25.1 + 12.6) / 2, abs=0.01)


def test_paint_covers_in_part_and_stays_inside():
    image = np.full((10, 10, 3), 100, np.uint8)
    textures.paint(image, (-5, -5, 4, 20), (200, 200, 200), cover=0.5)
    assert (image[:, :4] == 150).all()
    assert (image[:, 4:] == 100).all()
    before = image.copy()
    textures.paint(image, (12, 12, 15, 15), (0, 0, 0))
    np.testing.assert_array_equal(image, before)


def test_contrast_is_scaled_about_the_mean_colour():
    texture = rng().integers(80, 160, (60, 60, 3)).astype(np.uint8)
    weak = textures.scale_contrast(texture, 0.4)
    np.testing.assert_allclose(weak.mean((0, 1)), texture.mean((0, 1)), atol=0.1)
    np.testing.assert_allclose(weak.std((0, 1)), 0.4 * texture.std((0, 1)), rtol=0.01)


def test_blotches_are_noise_about_zero():
    values = textures.multiscale_noise((300, 400), (20, 50, 100), rng())
    assert abs(values.mean()) < 0.03
    assert 0.3 < values.std() < 0.8


MAKERS = {
    "planks": lambda r: textures.planks((3.0, 2.0), 0.01, 1.0, 5, r),
    "wall": lambda r: textures.wall((12.0, 10.0), 0.05, 1.0, False, r),
    "window": lambda r: textures.window((2.0, 1.5), 0.01, r),
    "poster": lambda r: textures.poster((150, 200), r),
    "crate": lambda r: textures.crate((150, 200), r),
    "cloth": lambda r: textures.cloth((150, 200), (60, 44, 120), r),
}
SIZES = {"planks": (200, 300), "wall": (200, 240)}


@pytest.mark.parametrize("name", MAKERS)
def test_textures_follow_their_seed(name):
    first, same, other = (MAKERS[name](rng(seed)) for seed in (1, 1, 2))
    assert first.dtype == np.uint8
    assert first.shape == (*SIZES.get(name, (150, 200)), 3)
    np.testing.assert_array_equal(first, same)
    assert (first != other).mean() > 0.1
    assert first.std() > 3


def test_a_plain_wall_repeats_its_windows():
    def differences(same_windows):
        texel_m = 0.05
        texture = textures.wall((20.0, 10.0), texel_m, 1.0, same_windows, rng()).astype(float)
        step, first = (
            round(textures.WINDOW_SPACING_M / texel_m),
            round(textures.WINDOW_SPACING_M / 2 / texel_m),
        )
        wide, tall = (round(length / texel_m) for length in textures.WINDOW_M)
        top = 200 - round((textures.WINDOW_SILL_M + textures.WINDOW_M[1]) / texel_m)
        panes = [texture[top : top + tall, x : x + wide] for x in (first, first + step)]
        return np.abs(panes[0] - panes[1]).mean()

    assert differences(True) == 0
    assert differences(False) > 5
