"""A lens stated as its inverse: found again, or refused."""

import numpy as np
import pytest

from courtside.calibration.foreign import inverse_lens
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras.foreign_files import DIST, SIZE, K


def test_the_coefficients_of_a_known_lens_are_found_again():
    camera = cameras.Camera("left", SIZE, K, DIST, np.eye(3, 4))
    found = inverse_lens.coefficients("a", SIZE, K, lambda xy: cameras.undistort(camera, xy))
    np.testing.assert_allclose(found, DIST, atol=1e-8)


def test_another_lens_is_refused():
    with pytest.raises(InputError, match=r"a: expected a lens that five coefficients .* px; cali"):
        inverse_lens.coefficients("a", SIZE, K, lambda xy: np.abs(xy - 900) ** 0.5 / 100)
    with pytest.raises(InputError, match="without limits"):
        inverse_lens.coefficients("a", SIZE, K, lambda xy: np.full_like(xy, np.inf))
