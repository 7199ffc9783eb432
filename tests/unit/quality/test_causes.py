"""The cause of a camera's disagreement is found by test, for each fault that is planted."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.quality import causes
from fixtures.people import judged

SAME = dict.fromkeys(("c0", "c1", "c2", "c3"), (0, 1))
LINES = "it does not see the court's lines where the others do: 16.3 px away"


def found(cameras, at=2, **said):
    return causes.find(judged.gathered(cameras), at, found_limit=0.9, **said)


@pytest.mark.parametrize("degrees", [1.0, -2.0, 3.0])
@pytest.mark.parametrize("axis", [(0, 1, 0), (1, 0, 0)])
def test_a_camera_that_is_turned(degrees, axis):
    cause = found(judged.turned(judged.footage(), 2, degrees, axis))
    assert cause.name == causes.CALIBRATION
    assert f"turned by {abs(degrees):.1f} degrees" in cause.sentence


@pytest.mark.parametrize("shift_s", [0.06, -0.1, 0.2, -0.4])
def test_a_clock_that_is_off(shift_s):
    cause = found(judged.footage(offset_s={2: shift_s}))
    assert cause.name == causes.CLOCK
    stated = float(cause.sentence.split("moved by ")[1].split(" s")[0])
    assert stated == pytest.approx(-shift_s, abs=0.021)


def test_a_camera_that_follows_the_other_person():
    cause = found(judged.followed(judged.footage(), SAME | {"c2": (1, 0)}))
    assert cause.name == causes.IDENTITY and "somebody else" in cause.sentence


def test_a_person_who_is_found_and_not_followed():
    cause = found(judged.followed(judged.footage(), SAME | {"c2": (-1, -1)}))
    assert cause.name == causes.IDENTITY and "followed in 0%" in cause.sentence


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_nobody_is_found(share):
    cause = found(judged.footage(hidden={2: share}))
    assert cause.name == causes.DETECTION and f"{share:.0%}" in cause.sentence


@pytest.mark.parametrize(("first", "second"), [(2, 3), (0, 2)])
@pytest.mark.parametrize("rows", [(0, 1), (-1, -1)])
def test_two_videos_that_are_exchanged(first, second, rows):
    right, names = judged.footage(), list(SAME)
    cameras = list(right)
    for at, other in ((first, second), (second, first)):
        cameras[at] = replace(right[other], camera=right[at].camera)
    followed = SAME | {names[first]: rows, names[second]: rows}
    for at, other in ((first, second), (second, first)):
        cause = found(judged.followed(cameras, followed), at)
        assert cause.name == causes.EXCHANGED
        assert f"its video is given for {names[other]}" in cause.sentence


@pytest.mark.parametrize(("first", "second", "at"), [(0, 1, 3), (2, 3, 0), (2, 3, 1)])
def test_exchanged_videos_of_two_others_that_agree_with_each_other(first, second, at):
    """Of one person, these cameras seem turned: with the videos of neighbours exchanged."""
    right = judged.followed(judged.footage(), dict.fromkeys(SAME, (0,)))
    cameras = list(right)
    for one, other in ((first, second), (second, first)):
        cameras[one] = replace(right[other], camera=right[one].camera)
    cause = found(cameras, at)
    assert cause.name == causes.EXCHANGED
    assert f"the videos of c{first} and c{second} are exchanged" in cause.sentence


@pytest.mark.parametrize("late_s", [1.0, 2.0])
@pytest.mark.parametrize("at", [0, 2])
def test_a_clock_that_is_far_off_is_no_exchange_of_videos(late_s, at):
    cameras = judged.footage(60, offset_s={2: late_s})
    cause = found(judged.followed(cameras, dict.fromkeys(SAME, (0,))), at)
    assert cause.name != causes.EXCHANGED


def test_a_stranger_is_followed_and_the_person_never_found():
    cameras = judged.footage()
    view = cameras[2].tracklets
    view.xy[...] = np.array([1920.0, 0.0]) + view.xy[:1] * np.array([-1.0, 1.0])  # goes elsewhere
    cause = found(cameras)
    assert cause.name == causes.DETECTION and "nobody found in it is the person" in cause.sentence


@pytest.mark.parametrize("away_px", [-600, -300, 300, 600])
def test_a_bystander_near_the_person_is_no_turned_camera(away_px):
    cameras = judged.footage()
    view = cameras[2].tracklets
    view.xy[...] = view.xy[:1, :1] + np.array([away_px, 0.0])  # stands still
    cause = found(cameras)
    assert cause.name == causes.DETECTION and "nobody found in it is the person" in cause.sentence


def test_a_take_of_one_frame_has_no_clock_to_be_moved():
    cause = found(judged.turned(judged.footage(n_frames=1), 2, 3.0))
    assert cause.name == causes.CALIBRATION


def test_one_person_in_one_frame_is_too_little_to_compare():
    one = judged.followed(judged.footage(n_frames=1), dict.fromkeys(SAME, (0,)))
    cause = found(judged.turned(one, 2, 3.0))
    assert cause.name == causes.UNKNOWN and "too few frames" in cause.sentence


def test_poor_keypoints():
    cameras = judged.footage()
    rng = np.random.default_rng(0)
    cameras[2].tracklets.xy[...] += rng.normal(0, 25, cameras[2].tracklets.xy.shape)
    cause = found(cameras)
    assert cause.name == causes.DETECTION and "poor" in cause.sentence


def test_of_two_cameras_neither_is_blamed():
    cause = found(judged.turned(judged.footage(n_cameras=2), 1, 3.0), at=1)
    assert cause.name == causes.UNKNOWN and "no third camera" in cause.sentence


def test_a_person_whom_the_others_do_not_place():
    cause = found(judged.footage(hidden=dict.fromkeys((0, 1, 3), 1.0)))
    assert cause.name == causes.UNKNOWN and "do not agree" in cause.sentence


def test_nobody_is_followed_in_any_camera():
    cause = found(judged.followed(judged.footage(), dict.fromkeys(SAME, (-1, -1))))
    assert cause.name == causes.IDENTITY and "none of them is followed" in cause.sentence


@pytest.mark.parametrize("fault", ["keypoints", "calibration", "two cameras"])
def test_painted_lines_decide_where_no_test_of_people_does(fault):
    cameras = judged.footage(n_cameras=2 if fault == "two cameras" else 4)
    at = len(cameras) - 1
    if fault == "keypoints":
        view = cameras[at].tracklets
        view.xy[...] += np.random.default_rng(0).normal(0, 25, view.xy.shape)
    else:
        cameras = judged.turned(cameras, at, 2.0)
    cause = found(cameras, at, doubt=LINES)
    assert cause.name == causes.CALIBRATION
    assert cause.sentence == f"its calibration is off: {LINES}"


@pytest.mark.parametrize("fault", ["detection", "clock", "identity"])
def test_painted_lines_do_not_hide_what_a_test_of_people_shows(fault):
    cameras = {
        "detection": lambda: judged.footage(hidden={2: 0.5}),
        "clock": lambda: judged.footage(offset_s={2: 0.1}),
        "identity": lambda: judged.followed(judged.footage(), SAME | {"c2": (1, 0)}),
    }[fault]()
    assert found(cameras, 2, doubt=LINES) == found(cameras, 2, others=True) == found(cameras, 2)
    assert found(cameras, 2).name == fault
