"""Lens and sensor: light is kept, blur has its width, noise its size."""

import numpy as np
import pytest

from virtualgym.rendering import sensor


def plane(size=(60, 80)):
    return np.zeros((2, *size), np.float32) + np.indices(size)[::-1].astype(np.float32) / 100 - 0.4


@pytest.mark.parametrize("motion", [(3.0, 0.0), (0.0, -4.4), (2.5, 1.5), (-6.2, 3.1)])
def test_the_motion_kernel_is_an_even_line(motion):
    kernel = sensor.line_kernel(motion)
    assert kernel.sum() == pytest.approx(1, abs=1e-5)
    half = kernel.shape[0] // 2
    rows, columns = np.indices(kernel.shape) - half
    assert (kernel * columns).sum() == pytest.approx(0, abs=1e-5)
    assert (kernel * rows).sum() == pytest.approx(0, abs=1e-5)
    # An even line of length L has the variance L^2 / 12; sharing between pixels adds at most 1 / 4.
    for values, length in ((columns, motion[0]), (rows, motion[1])):
        assert 0 <= (kernel * values**2).sum() - length**2 / 12 < 0.25
    covariance = (kernel * columns * rows).sum()
    assert covariance == pytest.approx(motion[0] * motion[1] / 12, abs=0.06)


def test_the_middle_keeps_its_light_and_the_corners_lose_a_quarter():
    xy = plane()
    picture = sensor.develop(np.full((60, 80, 3), 200, np.float32), xy)
    assert picture.dtype == np.uint8
    bright = np.unravel_index(np.argmin((xy**2).sum(axis=0)), (60, 80))
    np.testing.assert_array_equal(picture[bright], 200)
    assert picture.min() == 150
    assert (picture[np.unravel_index(np.argmax((xy**2).sum(axis=0)), (60, 80))] == 150).all()


def test_noise_has_its_size_and_needs_a_generator():
    light = np.full((60, 80, 3), 128, np.float32)
    clean = sensor.develop(light.copy(), plane()).astype(float)
    noisy = sensor.develop(light.copy(), plane(), noise=5.0, rng=np.random.default_rng(0))
    assert np.std(noisy - clean) == pytest.approx(5.0, rel=0.03)
    with pytest.raises(ValueError, match="random generator"):
        sensor.develop(light, plane(), noise=1.0)


def test_values_beyond_eight_bits_are_clipped():
    light = np.zeros((60, 80, 3), np.float32)
    light[:, 40:] = 400
    picture = sensor.develop(light, plane(), noise=3.0, rng=np.random.default_rng(0))
    assert picture[:, :20].max() < 20
    assert picture[:, 60:].min() == 255
