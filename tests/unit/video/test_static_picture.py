"""Static pictures: the median, whether the camera moved, and light."""

import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.video import static_picture
from fixtures.recordings.still_pictures import moved, texture

LIMITS = {"max_shift_px": 1.0, "max_zoom_percent": 0.2}


@pytest.mark.parametrize("n", [*range(1, 27), 40])
def test_the_median_is_that_of_numpy(n):
    frames = np.random.default_rng(n).integers(0, 256, (n, 131, 200, 3), dtype=np.uint8)
    expected = np.floor(np.median(frames.astype(int), axis=0) + 0.5)
    found = static_picture.temporal_median(list(frames))
    assert found.dtype == np.uint8
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("frames", [[], [texture(0), texture(0, (320, 180))]])
def test_the_median_wants_pictures_of_one_size(frames):
    with pytest.raises(ValueError, match="one size"):
        static_picture.temporal_median(frames)


def walkers(n):
    """Pictures of an empty room through which someone walks, each place covered in few of them."""
    empty, someone = texture(0), texture(9, (40, 200))
    frames = [empty.copy() for _ in range(n)]
    for at, frame in enumerate(frames):
        frame[100:300, 20 + 55 * at : 60 + 55 * at] = someone
    return empty, frames


def test_the_static_picture_is_the_empty_room():
    empty, frames = walkers(11)
    image, found = static_picture.static_picture("left", "left.mp4", frames, **LIMITS)
    np.testing.assert_array_equal(image, empty)
    assert found.known and np.hypot(*found.shift_px) < 0.1


def test_one_picture_is_not_checked():
    image, found = static_picture.static_picture("left", "left.jpg", [texture(0)], **LIMITS)
    np.testing.assert_array_equal(image, texture(0))
    assert not found.known


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (((3.0, 0.0),), "shifted by 3.0 px"),
        (((0.0, 0.0), 1.01), r"zoomed by \+(0.9[89]|1.0[012]) %"),
        (((0.0, 0.0), 1.0, 1.0), r"turned by \+(0.99|1.0[01]) deg"),
    ],
)
def test_a_camera_that_moves_meanwhile_is_named(change, reason):
    frames = [texture(0)] * 4 + [moved(texture(0), *change)] * 5
    with pytest.raises(InputError, match=reason) as caught:
        static_picture.static_picture("left", "left.mp4", frames, **LIMITS)
    message = str(caught.value)
    assert message.startswith("camera left: ") and "last third of left.mp4" in message
    assert "\n" not in message and "film it again" in message


@pytest.mark.parametrize("after", [6, 10, 12])
def test_a_knock_in_the_later_half_of_a_take_is_told(after):
    """The median of all 25 pictures is that before the knock."""
    take = [texture(0)] * (25 - after) + [moved(texture(0), shift_px=(5, 0))] * after
    static_picture.check_still("left", texture(0), static_picture.temporal_median(take), **LIMITS)
    with pytest.raises(InputError, match=r"last third of left\.mp4, found it shifted by 5\.\d px"):
        static_picture.check_kept_still("left", "left.mp4", take, **LIMITS)


def test_a_camera_that_zooms_in_a_take_is_not_sent_to_steady_alone():
    """`steady` takes out rotations only."""
    take = [texture(0)] * 12 + [moved(texture(0), (0, 0), 1.01)] * 13
    with pytest.raises(InputError, match=r"zoomed by \+.* unless it zoomed, state `steady: true`"):
        static_picture.check_kept_still("left", "left.mp4", take, **LIMITS)


def test_a_take_is_no_knock_where_people_stand_still_for_a_third_or_hide_the_background():
    stands = [texture(0).copy() for _ in range(25)]
    for picture in stands[:9]:
        picture[100:200, 100:160] = (200, 30, 30)
    static_picture.check_kept_still("left", "left.mp4", stands, **LIMITS)
    hidden = [np.zeros_like(texture(0))] * 9 + [texture(0)] * 16
    static_picture.check_kept_still("left", "left.mp4", hidden, **LIMITS)
    static_picture.check_kept_still("left", "left.mp4", stands[:2], **LIMITS)


def test_small_movements_pass():
    found = static_picture.check_still(
        "left", texture(0), moved(texture(0), (0.5, -0.5), 1.001), **LIMITS
    )
    np.testing.assert_allclose(found.shift_px, (0.5, -0.5), atol=0.1)
    assert found.zoom == pytest.approx(1.001, abs=5e-4)


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (texture(1), "found only .* background points that agree"),
        (texture(0, (320, 180)), "found 640x360 and 320x180 pixels"),
    ],
)
def test_views_that_cannot_be_compared_are_said(other, message):
    with pytest.raises(InputError, match=message):
        static_picture.check_still("left", texture(0), other, **LIMITS)


def test_mostly_black_pictures_are_refused():
    lamp = np.full((100, 200, 3), 15, np.uint8)
    lamp[:, :36] = 255  # 18 % are bright
    with pytest.raises(InputError, match=r"left.mp4: .* 82 % of it black"):
        static_picture.static_picture("left", "left.mp4", [lamp], **LIMITS)
    lamp[:, :44] = 255
    static_picture.check_light("left.mp4", lamp)
    blue = np.zeros((100, 200, 3), np.uint8)
    blue[..., 0] = 60  # a dark grey value, but light
    static_picture.check_light("left.mp4", blue)
