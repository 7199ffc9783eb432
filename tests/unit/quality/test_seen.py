"""A take on common times, and its persons placed by the other cameras."""

import numpy as np
import pytest

from courtside.quality import seen as views
from courtside.records.keypoints import skeleton as limbs
from fixtures.people import judged, walker


def middles(frames):
    """Return the true middles (P, S, 6, 3) of both sides."""
    at = [[walker.SKELETON.index(s + j) for j in limbs.LIMBS] for s in ("left_", "right_")]
    whole = judged.bodies(np.arange(150) / judged.RATE_HZ)
    return (whole[:, frames][:, :, at[0]] + whole[:, frames][:, :, at[1]]) / 2


def test_the_others_place_everybody_without_the_camera():
    cameras = judged.turned(judged.footage(), 2, 3.0)
    seen = judged.gathered(cameras)
    apart = np.linalg.norm(seen.others[2] - middles(seen.at), axis=-1)
    assert np.median(apart) < 0.02
    there = views.typical(seen.errors(2, seen.xy[2][:, seen.at]))
    assert np.median(there) > 0.15  # 3 degrees at 8 m are 0.42 m


def test_a_camera_that_is_left_out_places_nobody():
    seen = judged.gathered(judged.turned(judged.footage(), 2, 3.0))
    rest = [views.disagreement(seen, [k for k in range(4) if k != out]) for out in range(4)]
    assert int(np.argmin(rest)) == 2 and rest[2] < 0.4 * min(np.delete(rest, 2))
    alone = views.without(seen, (2,))
    for camera in (0, 1, 3):
        error = views.typical(alone.errors(camera, alone.xy[camera][:, alone.at]))
        assert np.median(error) < 0.025


def test_two_cameras_leave_no_others():
    seen = judged.gathered(judged.footage(n_cameras=2))
    assert np.isnan(seen.others).all()
    assert seen.expected(0).all()  # not known to be away


def test_whoever_leaves_the_picture_is_not_expected_there():
    cameras = judged.footage()
    seen = judged.gathered(cameras)
    assert seen.expected(1).all()
    away = judged.gathered(judged.turned(cameras, 1, 60.0))
    assert not away.expected(1).any()


@pytest.mark.parametrize("n_frames", [1, 2, 150])
def test_short_takes_are_gathered(n_frames):
    seen = judged.gathered(judged.footage(n_frames=n_frames))
    assert seen.others.shape == (4, 2, n_frames, 6, 3)


def test_below_five_frames_per_second_empty_pictures_are_no_absence():
    """No frame is within 0.2 s of the empty ones: who left when is not known."""
    followed = np.ones((2, 1, 60), bool)
    followed[:, :, 20:45] = False
    assert not views._left(followed, np.arange(60) / 4).any()
