"""Parts of pictures as tensors: every pixel where the geometry says, and back."""

import numpy as np
import pytest

from courtside.pose.networks import inputs
from courtside.pose.networks.inputs import Input, Window


def test_layout_colours_and_scale_are_as_declared():
    patch = np.zeros((4, 6, 3), np.uint8)
    patch[1, 2] = (10, 20, 30)  # blue, green, red
    how = {"size": (6, 4), "mean": (5, 5, 5), "std": (5, 10, 25)}
    red_first = Input(**how, channels="rgb").tensor(patch)
    assert red_first.shape == Input(**how, channels="rgb").shape == (1, 3, 4, 6)
    assert red_first.dtype == np.float32 and red_first.flags.c_contiguous
    np.testing.assert_allclose(red_first[0, :, 1, 2], [5, 1.5, 0.2])
    blue_first = Input(**how, channels="bgr", layout="nhwc")
    assert blue_first.shape == (1, 4, 6, 3)
    np.testing.assert_allclose(blue_first.tensor(patch)[0, 1, 2], [1, 1.5, 1])


@pytest.mark.parametrize("ends_inside", [False, True])
def test_a_window_maps_pixels_there_and_back(ends_inside):
    image = np.zeros((400, 500, 3), np.uint8)
    image[150, 230] = 255
    less = int(ends_inside)  # one pixel of the input is half a pixel of the picture
    sides = (48 - less) / 2, (64 - less) / 2
    window = Window(240 - less / 4, 160 - less / 4, *sides, (48, 64), ends_inside)
    patch = window.cut(image)
    row, column = np.unravel_index(patch[..., 0].argmax(), (64, 48))
    fraction = np.array([column, row]) / (np.array([48, 64]) - less)
    np.testing.assert_allclose(window.to_picture(fraction), [230, 150], atol=1e-9)


@pytest.mark.parametrize("mirror", [1.0, 47 / 48])
def test_a_mirrored_window_exchanges_left_and_right(mirror):
    image = np.zeros((64, 48, 3), np.uint8)
    image[10, 31] = 255
    window = Window(24, 32, 48, 64, (48, 64))
    rows, columns = np.nonzero(window.cut(image, mirror=mirror)[..., 0])
    assert (rows == 10).all() and (columns == round(mirror * 48) - 31).all()


def test_outside_the_picture_is_the_border():
    patch = Window(0, 0, 20, 20, (20, 20)).cut(np.full((30, 30, 3), 9, np.uint8), (1, 2, 3))
    assert (patch[:9, :9] == (1, 2, 3)).all()
    assert (patch[11:, 11:] == 9).all()


@pytest.mark.parametrize(("centred", "corner"), [(False, (0, 0)), (True, (0, -20))])
def test_a_letterbox_shows_the_whole_picture(centred, corner):
    image = np.full((60, 100, 3), 200, np.uint8)
    window = inputs.letterbox(image.shape, (50, 50), centred=centred)
    patch = window.cut(image, inputs.PADDING)
    assert (patch[..., 0] == 200).sum() == pytest.approx(50 * 30, rel=0.05)
    np.testing.assert_allclose(window.to_picture(np.zeros(2)), corner)
    assert patch[-1, 0, 0] == 114
    assert patch[0, 0, 0] == (114 if centred else 200)
