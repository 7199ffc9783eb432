"""Vicon's `.xcp`, against its lens solved by hand."""

import numpy as np
import pytest

from courtside.calibration import file_formats
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import foreign_files as theirs

LENS = (3.1e-8, -4e-15, 2e-21)  # per px^2, px^4 and px^6: 3 % at the corner, as of real lenses


def read(tmp_path, text):
    path = tmp_path / "hall.xcp"
    path.write_text(text)
    return file_formats.read(path)


def seen(radial, centre):
    """Return the px where Vicon's camera sees the points: its lens undoes what it did."""
    xyz = theirs.in_camera()
    ideal = 1500 * xyz[:, :2] / xyz[:, 2:] + [950, 545] - centre
    k1, k2, k3 = radial
    found = []
    for place in ideal:
        length = np.hypot(*place)
        roots = np.roots([k3, 0, k2, 0, k1, 0, 1, -length])
        real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real >= 0)]
        found.append(place * (real.min() / length if length else 1.0) + centre)
    return np.array(found)


def test_a_camera_without_distortion_sees_the_same_px(tmp_path):
    (camera,) = read(tmp_path, theirs.vicon())
    assert (camera.name, camera.size) == ("2101", (1920, 1080))
    xyz = theirs.in_camera()
    np.testing.assert_allclose(
        cameras.project(camera, theirs.POINTS),
        1500 * xyz[:, :2] / xyz[:, 2:] + [950, 545],
        atol=1e-6,
    )


@pytest.mark.parametrize("centre", [(950, 545), (958, 538)])
def test_a_lens_stated_as_its_inverse_is_turned_round(tmp_path, centre):
    (camera,) = read(tmp_path, theirs.vicon(LENS, centre))
    straight = seen((0, 0, 0), centre)
    bent = seen(LENS, centre)
    assert np.abs(bent - straight).max() > 15
    np.testing.assert_allclose(cameras.project(camera, theirs.POINTS), bent, atol=0.05)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("Vicon3Parameter", "ViconFisheye", "2101: expected VICON_RADIAL2 of Vicon3Parameter"),
        ('FOCAL_LENGTH="1500"', "", "2101: expected FOCAL_LENGTH .* found nothing"),
        ('FOCAL_LENGTH="1500"', 'FOCAL_LENGTH="-1"', "2101: expected a positive FOCAL_LENGTH"),
        ('SKEW="0"', 'SKEW="3"', "2101: .*no skew"),
        ('POSITION="', 'POSITION="x ', "2101: expected POSITION"),
        ('ORIENTATION="', 'ORIENTATION="0 0 0 0 ', "2101: expected ORIENTATION"),
        (' 0.0 0.0 0.0"/>', ' 1e-3 0.0 0.0"/>', "2101: expected a lens that five coefficients"),
        ("<KeyFrame FOCAL", '<KeyFrame FRAME="9"/><KeyFrame FOCAL', "2101: .*camera at rest"),
        ("<Cameras>", "<!DOCTYPE x><Cameras>", "found a DOCTYPE"),
        ("</Cameras>", "", "expected XML"),
    ],
)
def test_malformed_is_one_line_to_mend(tmp_path, old, new, message):
    assert old in theirs.vicon()
    with pytest.raises(InputError, match=message) as caught:
        read(tmp_path, theirs.vicon().replace(old, new))
    assert "hall.xcp" in str(caught.value)
    assert "\n" not in str(caught.value)
