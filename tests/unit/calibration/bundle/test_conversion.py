"""Cameras as a network and back: against OpenCV's projection."""

import numpy as np
import pytest

from courtside.calibration.bundle import conversion
from courtside.calibration.bundle import problem as networks
from courtside.study.errors import InputError
from fixtures.cameras import networks_made
from fixtures.cameras.scene import opencv_projection


def test_images_become_cameras_with_the_same_view():
    made = networks_made.make(3, 10)
    made.lens[:, 1] = 1.002
    found = conversion.cameras_of(made, ["side", "back"], [networks_made.SIZE] * 2)
    for v, camera in enumerate(found):
        ours = opencv_projection(camera, made.xyz)
        mine = made.image_idx == v
        np.testing.assert_allclose(ours, (networks.residuals(made) + made.xy)[mine], atol=1e-8)
    assert [c.name for c in found] == ["side", "back"] and found[0].size == networks_made.SIZE


def test_cameras_become_the_network_that_they_are_of():
    made = networks_made.make(3, 10)
    made.lens[:, 1] = 1.002
    sizes = [networks_made.SIZE] * len(made.cam_from_world)
    back = conversion.network_of(conversion.cameras_of(made, list("abcde"), sizes))
    np.testing.assert_array_equal(back.cam_from_world, made.cam_from_world)
    np.testing.assert_allclose(back.lens, made.lens[made.lens_of_image], rtol=1e-15)


@pytest.mark.parametrize("f_px", [-14340.5, np.nan])
def test_a_camera_whose_adjustment_diverged_is_told(f_px):
    made = networks_made.make(3, 10)
    made.lens[1, 0] = f_px
    with pytest.raises(InputError, match="camera back: expected an adjustment that converges"):
        conversion.cameras_of(made, ["side", "back"], [networks_made.SIZE] * 2)
