import numpy as np
import pytest

from courtside.devices.realsense import lens as realsense_lens
from courtside.geometry import camera
from courtside.study.errors import InputError

K = np.array([[640.0, 0, 641.2], [0, 639.0, 362.1], [0, 0, 1]])
SIZE = (1280, 720)
GIVEN = np.array([-0.0562, 0.0663, -0.0009, 0.0004, -0.0212])  # of the order of a real camera's


@pytest.mark.parametrize("model", ["Brown Conrady", "plumb_bob", "None"])
def test_opencv_s_own_model_stays(model):
    found = realsense_lens.five_coefficients("f", model, GIVEN, K, SIZE)
    assert np.array_equal(found, GIVEN)


@pytest.mark.parametrize("model", ["Inverse Brown Conrady", "Kannala Brandt4", "F-Theta"])
def test_no_distortion_is_none_in_every_model(model):
    assert not realsense_lens.five_coefficients("f", model, np.zeros(5), K, SIZE).any()


@pytest.mark.parametrize("model", ["Modified Brown Conrady", "inverse brown conrady"])
def test_the_tangential_part_after_the_radial_one(model):
    found = realsense_lens.five_coefficients("f", model, GIVEN, K, SIZE)
    plane = np.random.default_rng(0).uniform((-0.95, -0.5), (0.95, 0.5), (500, 2))
    k1, k2, p1, p2, k3 = GIVEN
    x, y = plane.T
    square = x**2 + y**2
    x, y = (v * (1 + k1 * square + k2 * square**2 + k3 * square**3) for v in (x, y))
    wanted = np.stack(
        [
            x + 2 * p1 * x * y + p2 * (square + 2 * x**2),
            y + 2 * p2 * x * y + p1 * (square + 2 * y**2),
        ],
        axis=-1,
    )
    assert np.allclose(realsense_lens.modified(GIVEN, plane), wanted)
    assert np.abs((camera.distort(found, plane) - wanted) * 640).max() < 0.1


@pytest.mark.parametrize(
    ("model", "given"),
    [
        ("Kannala Brandt4", [0.1, 0, 0, 0, 0]),
        ("Inverse Brown Conrady", [9.0, -40, 5, 2, 3]),
        ("Inverse Brown Conrady", [np.nan, 0, 0, 0, 0]),
    ],
)
def test_what_cannot_be_brought_to_five_coefficients_is_refused(model, given):
    with pytest.raises(InputError, match="f: expected a lens"):
        realsense_lens.five_coefficients("f", model, given, K, SIZE)


@pytest.mark.parametrize(
    "model", ["Brown Conrady", "Inverse Brown Conrady", "Modified Brown Conrady"]
)
def test_the_camera_s_own_software_agrees(model):
    rs = pytest.importorskip("pyrealsense2", reason="the camera's software is not installed")
    lens = rs.intrinsics()
    lens.width, lens.height = SIZE
    lens.fx, lens.fy, lens.ppx, lens.ppy = K[0, 0], K[1, 1], K[0, 2], K[1, 2]
    lens.model = getattr(rs.distortion, model.lower().replace(" ", "_"))
    lens.coeffs = GIVEN.tolist()
    found = realsense_lens.five_coefficients("f", model, GIVEN, K, SIZE)
    for plane in ([-0.9, -0.5], [0.3, 0.4], [0.9, 0.1]):
        theirs = rs.rs2_project_point_to_pixel(lens, [*plane, 1.0])
        ours = camera.distort(found, np.array(plane)) * np.diag(K)[:2] + K[:2, 2]
        assert np.abs(ours - theirs).max() < 0.1
