"""What the sizes of a session's cameras say, without any file of pictures."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.records import covariance
from courtside.geometry import camera as geometry
from courtside.validation import calibrated
from fixtures.recordings import rooms_filmed

SIZES = {name: {f"{name}.mp4": (320, 180)} for name in ("left", "right", "back")}


def faults(hall, **changes):
    return list(calibrated.faults(hall.session(), {**SIZES, **changes}))


def test_sizes_that_fit_say_nothing(hall):
    assert faults(hall) == []
    assert faults(hall, left={}) == []


@pytest.mark.parametrize(
    ("size", "key"),
    [
        ((640, 360), "`scale: 2`"),
        ((310, 180), "`crop_px: [x, y, 310, 180]`"),
        ((120, 90), "`crop_px: [0, 0, 240, 180], scale: 0.5`"),
        ((180, 320), "turned by a quarter"),
    ],
)
def test_a_wrong_size_names_the_key_that_mends_it(hall, size, key):
    (line,) = faults(hall, left={"left.mp4": size})
    assert line.startswith("left.mp4: expected 320x180 px, the size that camera left was")
    assert key in line


def test_another_calibration_is_not_read_where_the_session_does_not_use_it(hall):
    hall.content["calibration"]["file"] = str(hall.root / "none.toml")
    assert faults(hall, left={"left.mp4": (640, 360)}) == []


def test_a_covariance_of_other_cameras_is_told(hall):
    hall.around()
    path = hall.root / "covariance.npz"
    covariance.write(path, covariance.CameraCovariance(["left", "rear"], np.eye(28)))
    (line,) = faults(hall)
    assert line.startswith(
        f"{path}: expected the covariance of cameras right, back, found that of left, rear; "
        f"it lies beside {hall.root / 'cameras.toml'}"
    )
    covariance.write(path, covariance.CameraCovariance(["right", "back", "left"], np.eye(42)))
    assert faults(hall) == []
    path.write_bytes(b"no archive")
    (line,) = faults(hall)
    assert line.startswith(f"{path}: expected")


def test_one_pose_of_two_cameras_is_told_with_their_names(hall):
    first, second, *others = hall.around()
    cameras = [first, replace(second, cam_from_world=first.cam_from_world), *others]
    geometry.write_toml(hall.root / "cameras.toml", cameras, source="test")
    (line,) = faults(hall)
    assert line.startswith(f"{hall.root / 'cameras.toml'}: cameras left and right: expected a pose")


def test_a_unit_that_the_session_states_wrongly_is_not_advised_again(hall):
    path = hall.root / "cameras.toml"
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(line for line in lines if not line.startswith("unit")))
    assert faults(hall) == []
    hall.content["calibration"]["unit"] = "mm"
    (line,) = faults(hall)
    assert "cameras 0.1 to 150 m apart, found 0.002 m between the farthest with `unit: mm`" in line
    assert line.endswith("of the session file; correct it, or remove it: in m it would be 2 m")
    hall.calibrate(rooms_filmed.SIZE, apart=400)
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(line for line in lines if not line.startswith("unit")))
    hall.content["calibration"]["unit"] = "m"
    (line,) = faults(hall)
    assert "300 m of the world's origin, found 400 m with `unit: m` of the session file" in line
