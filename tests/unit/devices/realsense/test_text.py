from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.devices.realsense import text as realsense_text
from courtside.study.errors import InputError

TURN = Rotation.from_euler("xyz", [0.1, -0.2, 0.3])


def text(data):
    return SimpleNamespace(data=data)


def test_a_text_message_becomes_its_pairs():
    assert realsense_text.pairs(text("a=1;b=x=y;c")) == {"a": "1", "b": "x=y"}
    assert realsense_text.pairs(text(3.0)) == {}
    assert realsense_text.pairs(None) == {}


@pytest.mark.parametrize(("data", "wanted"), [("0.001", 0.001), (50.0, 50.0)])
def test_a_number_is_read_from_text_or_number(data, wanted):
    assert realsense_text.number(text(data)) == wanted


@pytest.mark.parametrize("message", [None, text("none"), text(None), SimpleNamespace()])
def test_a_message_without_a_number_is_nan(message):
    assert np.isnan(realsense_text.number(message))
    assert np.isnan(realsense_text.number_in(message, "depth_units"))


def test_a_lens_is_read_from_message_and_text():
    message = SimpleNamespace(
        width=640,
        height=480,
        K=np.array([390.0, 0, 331, 0, 391, 242, 0, 0, 1]),
        D=np.arange(5.0),
        distortion_model="Brown Conrady",
    )
    other = SimpleNamespace(
        width=640, height=480, k=message.K, d=message.D, distortion_model="Brown Conrady"
    )
    words = text(
        "width=640;height=480;fx=390;ppx=331;fy=391;ppy=242;model=Brown Conrady;coeffs=0,1,2,3,4"
    )
    for found in (message, other, words):
        size, matrix, model, coefficients = realsense_text.lens("f", found)
        assert size == [640, 480]
        assert np.array_equal(matrix, message.K.reshape(3, 3))
        assert model == "Brown Conrady"
        assert np.array_equal(coefficients, np.arange(5))


def test_a_transform_is_read_from_message_and_text():
    x, y, z, w = TURN.as_quat()
    message = SimpleNamespace(
        rotation=SimpleNamespace(x=x, y=y, z=z, w=w),
        translation=SimpleNamespace(x=0.015, y=0.0, z=-0.001),
    )
    columns = ",".join(f"{value:.6f}" for value in TURN.as_matrix().T.ravel())
    words = text(f"rotation={columns};translation=0.015,0.0,-0.001")
    for found, near in ((message, 1e-12), (words, 2e-6)):
        placed = realsense_text.place("f", found)
        assert np.abs(placed[:, :3] - TURN.as_matrix()).max() < near
        assert placed[:, 3].tolist() == [0.015, 0.0, -0.001]


@pytest.mark.parametrize(
    "message",
    [
        None,
        text("rotation=1,0,0;translation=0,0,0"),
        text("rotation=1,0,0,0,1,0,0,0,-1;translation=0,0,0"),
        text("rotation=nan,0,0,0,1,0,0,0,1;translation=0,0,0"),
        text("rotation=1,0,0,0,1,0,0,0,1;translation=15,0,0"),
        SimpleNamespace(
            rotation=SimpleNamespace(x=0, y=0, z=0, w=0), translation=SimpleNamespace(x=0, y=0, z=0)
        ),
    ],
)
def test_what_is_no_place_is_refused(message):
    with pytest.raises(InputError, match="f: expected its place"):
        realsense_text.place("f", message)
