"""Every motion: its options, its events, its chance."""

import numpy as np
import pytest

from fixtures.people.performers import BODY, COURT, perform, performed
from virtualgym.body import stance
from virtualgym.movement import catalogue


def numbers(motion, times=(0.3, 1.7, 2.9, 4.1)):
    """Return all joints of a motion at some times (T, J, 3) m."""
    return np.array([[*stance.joints(motion.stance(t), BODY).values()] for t in times])


@pytest.mark.parametrize("name", catalogue.MOTIONS)
def test_a_seed_decides_everything_and_another_differs(name):
    np.testing.assert_array_equal(numbers(perform(name, 5)), numbers(performed(name, 5)))
    assert np.abs(numbers(performed(name, 5)) - numbers(performed(name))).max() > 0.05


@pytest.mark.parametrize("name", ["shot", "walk", "tpose_clap"])
def test_left_handed_players_mirror_right_handed_ones(name):
    right, left = performed(name, 3), perform(name, 3, hand="left")
    for time_s in np.linspace(0, right.seconds, 12):
        mine, image = (stance.joints(m.stance(time_s), BODY) for m in (right, left))
        expected = mine["right_wrist"] * [-1, 1, 1] + [COURT.size_m[0], 0, 0]
        np.testing.assert_allclose(image["left_wrist"], expected, atol=1e-9)
    assert (right.stance(1).racket_hand, left.stance(1).racket_hand) == ("right", "left")
    np.testing.assert_array_equal(left.planted("left"), right.planted("right"))


def test_players_of_the_far_half_turn_half_round():
    near, far = performed("lunge", 3), perform("lunge", 3, half="far")
    for time_s in (0.5, 2.5):
        mine, other = near.stance(time_s).pelvis, far.stance(time_s).pelvis
        np.testing.assert_allclose(mine[:2] + other[:2], COURT.size_m)
        assert mine[1] < COURT.size_m[1] / 2 < other[1]


@pytest.mark.parametrize("name", catalogue.MOTIONS)
def test_events_lie_within_the_motion(name):
    motion = performed(name)
    assert all(0 < time_s < motion.seconds for time_s in motion.events.values())


@pytest.mark.parametrize(
    ("name", "events"),
    [
        ("shot", {"hit", "hit_start", "hit_stop"}),
        ("lunge", {"hit_1", "hit_2"}),
        ("tpose_clap", {"tpose_1_start", "tpose_1_stop", "clap_1", "clap_2"}),
        ("tpose_clap_bouncing", {"clap_1", "clap_1_rebound_1", "clap_1_rebound_2", "clap_2"}),
    ],
)
def test_motions_name_what_happens(name, events):
    assert events <= set(performed(name).events)


def test_only_claps_are_without_a_racket():
    bare = {name for name in catalogue.MOTIONS if performed(name).stance(0.0).racket is None}
    assert bare == {"tpose_clap", "tpose_clap_bouncing", "single_view"}


@pytest.mark.parametrize("height", [1.5, 2.0])
def test_bodies_of_any_size_keep_their_feet_on_the_floor(height):
    body = stance.Proportions.of_height(height)
    motion = perform("rally", body=body, seconds=8.0)
    for side in stance.SIDES:
        for start, stop in motion.planted(side):
            at = [stance.joints(motion.stance(t), body)[f"{side}_ankle"] for t in (start, stop)]
            np.testing.assert_allclose(at[0], at[1], atol=0.002)
            assert at[0][2] == pytest.approx(body.ankle_height, abs=0.001)
