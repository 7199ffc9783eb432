"""How a video's size tells what was done to the calibrated picture, and the camera that fits it."""

import cv2
import numpy as np
import pytest

from courtside.geometry import camera as geometry
from courtside.geometry import picture_size
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError

K = np.array([[1500.0, 0, 1000], [0, 1480, 500], [0, 0, 1]])
CAMERA = Camera("left", (1920, 1080), K, np.array([-0.2, 0.05, 1e-3, -1e-3, 0]), np.eye(3, 4))
SIZES = [
    ((1920, 1080), (1920, 1080), "same", ""),
    ((1920, 1080), (960, 540), "scaled", "scale: 0.5"),
    ((1920, 1080), (1280, 720), "scaled", "scale: 0.6667"),
    ((1920, 1080), (3840, 2160), "scaled", "scale: 2"),
    ((1088, 1920), (544, 960), "scaled", "scale: 0.5"),
    ((1920, 1080), (854, 480), "scaled", "scale: 0.4447"),
    ((1088, 1920), (1080, 1920), "cut out", "crop_px: [0, 0, 1080, 1920]"),
    ((1920, 1080), (1900, 1060), "cut out", "crop_px: [0, 0, 1900, 1060]"),
    ((1920, 1080), (608, 1080), "cut out", "crop_px: [0, 0, 608, 1080]"),
    ((4000, 3000), (1920, 1080), "cut out and scaled", "crop_px: [0, 0, 4000, 2250], scale: 0.48"),
    ((1088, 1920), (540, 960), "cut out and scaled", "crop_px: [0, 0, 1080, 1920], scale: 0.5"),
    ((1920, 1080), (1080, 1920), "turned", ""),
    ((1920, 1080), (540, 960), "turned", ""),
    ((1088, 1920), (1920, 1080), "turned", ""),
]


@pytest.mark.parametrize(("calibrated", "video", "kind", "keys"), SIZES)
def test_cut_out_scaled_and_turned_are_told_apart(calibrated, video, kind, keys):
    found = picture_size.relation(calibrated, video)
    assert (found.kind, found.keys) == (kind, keys)
    kept = found.crop_px[2:] if found.crop_px else calibrated
    if kind != "turned":
        assert picture_size.scaled_size(kept, found.scale or 1) == video
    message = picture_size.advice(calibrated, video)
    if kind in ("scaled", "cut out and scaled"):
        assert found.keys in message
    assert kind == "same" or ("crop_px" in message) == (kind != "turned")


def test_a_half_size_video_is_never_taken_for_a_cut_out():
    for width in range(640, 4000, 146):
        for height in range(360, 2400, 154):
            found = picture_size.relation((width, height), (width // 2, height // 2))
            assert found.scale == pytest.approx(0.5, abs=0.01)
            assert found.crop_px is None or min(found.crop_px[2:]) > 0.98 * min(width, height)


@pytest.mark.parametrize("scale", [0.5, 0.6667, 2])
def test_a_scaled_camera_sees_a_point_where_the_scaled_picture_shows_it(scale):
    picture = np.zeros((1080, 1920), np.uint8)
    (x, y) = at = geometry.project(CAMERA, [0.3, -0.2, 4.0])
    cv2.circle(picture, (round(x * 16), round(y * 16)), 20 * 16, 255, -1, cv2.LINE_AA, 4)
    shown = geometry.scaled(CAMERA, scale)
    small = cv2.resize(picture, shown.size, interpolation=cv2.INTER_AREA)
    moments = cv2.moments(small)
    centre = np.array([moments["m10"], moments["m01"]]) / moments["m00"]
    assert np.abs(centre - geometry.project(shown, [0.3, -0.2, 4.0])).max() < 0.1 * max(1, scale)
    assert np.abs(geometry.in_other_picture(shown, CAMERA, centre) - at).max() < 0.2


def test_a_wrong_size_is_told_with_the_key_that_mends_it():
    geometry.check_size(CAMERA, (1920, 1080), "left.mp4")
    with pytest.raises(InputError, match=r"left.mp4: expected 1920x1080 .* `scale: 0.5`"):
        geometry.check_size(CAMERA, (960, 540), "left.mp4")
    with pytest.raises(InputError, match="turned by a quarter"):
        geometry.check_size(CAMERA, (1080, 1920), "left.mp4")
