"""OptiTrack's `.mcal`, against the page that describes it."""

import numpy as np
import pytest
from scipy import optimize

from courtside.calibration import file_formats
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import foreign_files as theirs

LENS = (0.108, -0.099, -6e-5, -8e-4, 3e-4)  # of the size of the example on that page


def read(tmp_path, text, encoding="utf-16"):
    path = tmp_path / "hall.mcal"
    path.write_bytes(text.encode(encoding))
    return file_formats.read(path)


def undistorted(x, y, lens):
    """Return the ideal place of a seen one: written anew after "How to Use Intrinsics"."""
    k1, k2, k3, tx, ty = lens
    r2 = x**2 + y**2
    k = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    return x * k + 2 * tx * x * y + ty * (r2 + x * x), y * k + 2 * ty * x * y + tx * (r2 + y * y)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le"])
def test_a_camera_without_distortion_sees_the_same_px(tmp_path, encoding):
    found = read(tmp_path, theirs.optitrack(), encoding)
    assert [camera.name for camera in found] == ["C1", "C2"]
    xyz = theirs.in_camera()
    expected = [1500, 1490] * xyz[:, :2] / xyz[:, 2:] + [950, 545]
    np.testing.assert_allclose(cameras.project(found[0], theirs.POINTS), expected, atol=1e-6)


def test_a_lens_stated_as_its_inverse_is_turned_round(tmp_path):
    camera, _ = read(tmp_path, theirs.optitrack(LENS))
    xyz = theirs.in_camera()
    ideal = xyz[:, :2] / xyz[:, 2:]
    seen = [
        optimize.fsolve(lambda p, at=at: np.subtract(undistorted(*p, LENS), at), at, xtol=1e-13)
        for at in ideal
    ]
    expected = [1500, 1490] * np.array(seen) + [950, 545]
    assert np.abs(expected - ([1500, 1490] * ideal + [950, 545])).max() > 10
    # Tangential terms in x^2 instead of 2 x^2 are not OpenCV's: 0.09 px are left in the corners.
    np.testing.assert_allclose(cameras.project(camera, theirs.POINTS), expected, atol=0.12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('LensCenterY="545"', "", "C1: expected IntrinsicStandardCameraModel LensCenterY"),
        ('VerticalFocalLength="1490"', 'VerticalFocalLength="0"', "C1: expected positive focal"),
        ("Extrinsic X", "Extrinsic x", "C1: expected Extrinsic X as one"),
        ("OrientMatrix8", "OrientMatrix9", "C1: expected Extrinsic OrientMatrix8"),
        ('k1="0"', 'k1="90"', "C1: expected a lens that five coefficients"),
        ("Serial", "serial", "different names"),
    ],
)
def test_malformed_is_one_line_to_mend(tmp_path, old, new, message):
    assert old in theirs.optitrack()
    with pytest.raises(InputError, match=message) as caught:
        read(tmp_path, theirs.optitrack().replace(old, new))
    assert "hall.mcal" in str(caught.value)
    assert "\n" not in str(caught.value)
