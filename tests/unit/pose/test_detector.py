"""Cutting out rotated squares: a marked pixel must land where the geometry says."""

import numpy as np
import pytest

from courtside.pose import detector
from courtside.pose.detector import Region


@pytest.mark.parametrize("angle_deg", [0, 30, -75, 180])
def test_a_bright_spot_maps_back_to_its_place(angle_deg):
    image = np.zeros((400, 500, 3), np.uint8)
    image[148:153, 228:233] = 255
    region = Region(240.0, 160.0, 128.0, np.deg2rad(angle_deg))
    patch = detector.cut_out(image, region, 256)
    rows, columns = np.nonzero(patch[..., 0] > 128)
    fraction = np.array([columns.mean(), rows.mean()]) / 256
    np.testing.assert_allclose(detector.to_picture(fraction, region), [230, 150], atol=0.6)


def test_rotation_turns_x_towards_y():
    np.testing.assert_allclose(detector.rotate(np.array([1.0, 0.0]), np.pi / 2), [0, 1], atol=1e-12)
