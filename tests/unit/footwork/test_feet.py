"""Footwork of a take against the virtual gym's plants."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from courtside.footwork import feet
from fixtures.people import walking_feet


def test_a_split_step_of_the_virtual_gym_is_found_and_the_first_step_after_it():
    points, _ = walking_feet.record(walking_feet.hop(), 3.0)
    contacts, steps, events = feet.find(points, walking_feet.CUTOFFS)
    assert events.event.tolist() == ["split_step", "step"]
    assert events.foot.tolist() == ["both", "left"]
    assert events.stop_s.tolist() == pytest.approx([1.0, 1.9], abs=0.035)
    assert events.start_s.tolist() == pytest.approx([0.82, 1.6], abs=0.035)
    assert len(steps) == 5
    stands = contacts.probability[0] > 0.5
    assert stands[:20].all()
    assert not stands[27].any()


@pytest.mark.parametrize("up_m", [0.4, 2.0])
def test_feet_in_the_air_all_the_time_do_not_stand(up_m):
    points, _ = walking_feet.record(walking_feet.hop(), 0.7)
    lifted = replace(points, xyz=points.xyz + np.array([0, 0, up_m]))
    contacts, steps, _ = feet.find(lifted, walking_feet.CUTOFFS)
    assert (contacts.probability < 0.5).all()
    assert (contacts.held < 0.5).all()
    assert steps.empty


@pytest.mark.parametrize("up_m", [-0.06, 0.06])
def test_feet_stand_on_a_floor_that_the_calibration_has_some_centimetres_off(up_m):
    points, _ = walking_feet.record(walking_feet.gait(), 5.0)
    lifted = replace(points, xyz=points.xyz + np.array([0, 0, up_m]))
    steps = [feet.find(one, walking_feet.CUTOFFS)[1] for one in (points, lifted)]
    assert len(steps[0]) > 8
    pd.testing.assert_frame_equal(*steps)


@pytest.mark.parametrize("m_s", [0.25, 0.4])
def test_feet_on_the_rests_of_a_wheelchair_do_not_stand(m_s):
    points, _ = walking_feet.record(walking_feet.gait(1), 5.0)
    standing = points.xyz[:, :1] + np.random.default_rng(0).normal(0, 0.004, points.xyz.shape)
    ahead = np.array([0, 1, 0]) * m_s * points.time_s[:, None, None]
    rolling = replace(points, xyz=standing + ahead + np.array([0, 0, 0.1]))
    contacts, steps, _ = feet.find(rolling, walking_feet.CUTOFFS)
    assert (contacts.probability < 0.5).all()
    assert steps.empty


def test_feet_that_go_far_by_small_steps_stand():
    """Somebody who waits moves each foot by 4 cm once a second: 0.8 m in 20 s."""
    points, _ = walking_feet.record(walking_feet.gait(1), 20.0)
    standing = points.xyz[:, :1] + np.random.default_rng(0).normal(0, 0.004, points.xyz.shape)
    time_s = points.time_s[:, None, None]
    went_m = 0.04 * (np.floor(time_s) + np.clip(time_s % 1 / 0.2, 0, 1))
    contacts, *_ = feet.find(
        replace(points, xyz=standing + np.array([0, 1, 0]) * went_m), walking_feet.CUTOFFS
    )
    assert (contacts.probability > 0.5).mean() > 0.7


def test_a_heel_that_is_hidden_for_a_while_makes_no_lunges():
    points, _ = walking_feet.record(walking_feet.gait(), 12.0)
    xyz, heel = points.xyz.copy(), points.joints.tolist().index("left_heel")
    xyz[0, (points.time_s >= 2.4) & (points.time_s < 2.9), heel] = np.nan
    _, steps, events = feet.find(replace(points, xyz=xyz), walking_feet.CUTOFFS)
    assert set(events.event) == {"step"}
    cut = steps[steps.foot == "left"]
    assert sorted(set(cut.seen_until_s)) == pytest.approx([2.4, 12.0], abs=0.06)


@pytest.mark.parametrize(("rate_hz", "lines"), [(15, 1), (25, 0)])
def test_a_low_frame_rate_is_told_once(caplog, rate_hz, lines):
    points, _ = walking_feet.record(walking_feet.gait(), 5.0, rate_hz=rate_hz)
    feet.find(points, walking_feet.CUTOFFS)
    assert len(caplog.messages) == lines
    assert all("15 frames per second are few for footwork" in line for line in caplog.messages)


def test_a_skeleton_without_heels_gives_no_contacts():
    points, _ = walking_feet.record(walking_feet.hop(), 3.0)
    joints = np.array([name.replace("heel", "sole") for name in points.joints.tolist()])
    contacts, steps, events = feet.find(replace(points, joints=joints), walking_feet.CUTOFFS)
    assert np.isnan(contacts.probability).all()
    assert steps.empty
    assert events.empty


@pytest.mark.parametrize(("lacking", "remedy"), [("time", "longer"), ("heel", "network")])
def test_what_contacts_lack_is_told(caplog, lacking, remedy):
    """A take of 8 frames is too short with any network."""
    points, _ = walking_feet.record(walking_feet.hop(), 8 / 30)
    joints = np.array([name.replace(lacking, "sole") for name in points.joints.tolist()])
    feet.find(replace(points, joints=joints), walking_feet.CUTOFFS)
    (line,) = caplog.messages
    assert "no contacts" in line
    assert ("longer" in line, "network" in line) == (remedy == "longer", remedy == "network")


def test_a_foot_that_is_never_seen_is_told(caplog):
    points, _ = walking_feet.record(walking_feet.gait(), 5.0)
    feet.find(points, walking_feet.CUTOFFS)
    assert not caplog.messages
    points.xyz[:, :, points.joints.tolist().index("left_heel")] = np.nan
    _, steps, _ = feet.find(points, walking_feet.CUTOFFS)
    (line,) = caplog.messages
    assert "p1: expected heel and toe of the left foot" in line
    assert set(steps.foot) == {"right"}


def test_the_leg_is_thigh_and_shank():
    points, _ = walking_feet.record(walking_feet.hop(), 3.0, sigma_m=0.0)
    assert 0.5 < feet.leg_length(points, 0) < 1.2
    nobody = replace(points, xyz=np.full_like(points.xyz, np.nan))
    assert np.isnan(feet.leg_length(nobody, 0))
